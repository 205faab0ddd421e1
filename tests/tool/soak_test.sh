# rosin live for a long time on a serial line at 128 kHz (48 kHz in the short form): no frame lost, none wrong, no growth of
# memory, every block done before the next. ROSIN_SOAK_S says how long; ROSIN_SOAK_RATE at which rate.
. "$ROSIN_SOURCE/tests/tool/common.sh"
seconds=${ROSIN_SOAK_S:-4}
export ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}quarantine_size_mb=1   # or the sanitizer's own memory grows
sink=(--out soak.wav)
[ "$seconds" -lt 120 ] || sink=()   # seven channels of floating point would fill a disk
mkdir small
sed "s/rate_Hz = 48000/rate_Hz = ${ROSIN_SOAK_RATE:-48000}/" "$ROSIN_SOURCE/examples/rehearsal/rig.toml" >small/rig.toml
"$tool" simulate small --out played >/dev/null 2>&1
expect 0 fit played --json fit.json
"$tool" fake-rig played --line line --loop bow-1 </dev/null >ready.txt & fake=$!
trap 'kill $fake 2>/dev/null || true' EXIT
for _ in $(seq 100); do grep -qs ready ready.txt && break; sleep 0.05; done
expect 0 live played --calibration fit.json --source serial:line --take soak --kind bow --speed 0.2 --normal-force 0.3 --seconds "$seconds" --json soak.json "${sink[@]}"
perl -e '
  my ($seconds) = @ARGV;
  local $/;
  open(my $j, "<", "soak.json"); my $json = <$j>;
  sub value { $json =~ /"$_[0]": ([-0-9.e]+)/ or die "no $_[0]\n"; $1 }
  my ($early, $late) = (value("resident_bytes_early"), value("resident_bytes_late"));
  printf "%.1f s at %d Hz, %d frames lost; memory %.1f MB after 1 s, %.1f MB at the end; longest block %.2f ms of %.1f ms, of which the processor worked %.2f ms at most, its writing %.2f ms at most; busy %.1f %%; buffer at most %.1f %% full\n",
    value("duration_s"), value("sampling_rate_Hz"), value("lost_frames"), $early / 1e6, $late / 1e6, 1e3 * value("worst_block_s"), 1e3 * value("worst_block_lasts_s"), 1e3 * value("worst_block_processor_s"), 1e3 * value("worst_write_s"),
    100 * value("busy"), 100 * value("fullest_buffer");
  die "frames were lost\n" if value("lost_frames") != 0;
  die "the take is too short\n" if abs(value("duration_s") - $seconds) > 1e-3;
  die "memory grows\n" if $late - $early > 4e6;
  die "the buffer filled\n" if value("fullest_buffer") > 0.2;
  # every frame of the take is that of the loop
  open(my $p, "<:raw", "played/bow-1.wav"); my $loop = substr(<$p>, 44);
  $/ = \(1 << 20);
  open(my $w, "<:raw", "played/soak.wav"); read($w, my $head, 104);
  read($w, my $first, 4000);
  my $at = 0;
  $at += 4 while $at < length $loop && substr($loop . $loop, $at, 4000) ne $first;
  die "the loop is not there\n" if $at >= length $loop;
  seek($w, 104, 0);
  while (my $piece = <$w>) {
    my $expected = substr($loop, $at) . $loop x (1 + int(length($piece) / length($loop)));
    die "wrong samples\n" if $piece ne substr($expected, 0, length $piece);
    $at = ($at + length $piece) % length $loop;
  }' "$seconds" || failures=$((failures + 1))
# What the machine itself books as a program's processor time without having given it (virtual machines do): the longest step of a loop
# that does nothing. It is in every block's time as well.
[ "$seconds" -lt 120 ] || perl -MTime::HiRes=clock_gettime,CLOCK_MONOTONIC,CLOCK_PROCESS_CPUTIME_ID -e '
  my ($end, $last, $most) = (clock_gettime(CLOCK_MONOTONIC) + 60, clock_gettime(CLOCK_PROCESS_CPUTIME_ID), 0);
  while (clock_gettime(CLOCK_MONOTONIC) < $end) {
    my $now = clock_gettime(CLOCK_PROCESS_CPUTIME_ID);
    $most = $now - $last if $now - $last > $most;
    $last = $now;
  }
  printf "a loop that does nothing, 60 s: one step of it took %.2f ms of processor time\n", 1e3 * $most;'
finish
