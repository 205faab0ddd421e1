# rosin record: sources, what is refused before anything happens, and what goes wrong while it records: gaps, a pulled device,
# an overrun, a full disk. What was recorded stays.
. "$ROSIN_SOURCE/tests/tool/common.sh"
make_rig described
cat >>described/rig.toml <<'TOML'

[[take]]
name = "numbers"
kind = "quiet"
file = "numbers.wav"
TOML
# Frame n of the take that is played is n, -n.
perl -e '
  my $bytes = pack("s<*", map { ($_, -$_) } 1 .. 30000);
  open(my $out, ">:raw", "described/numbers.wav") or die;
  print $out "RIFF" . pack("V", 36 + length $bytes) . "WAVEfmt " . pack("VvvVVvv", 16, 1, 2, 48000, 192000, 4, 16) . "data" . pack("V", length $bytes) . $bytes'

# From files and pipes, the same samples.
expect 0 record rig --like described --source described/pluck-1.wav --kind pluck --wire 1
says "pluck-1: 0.300 s, 2 channels at 48000 Hz, 16 bits"
expect 0 record rig --source - --kind pluck --wire 0.5 --hold-out --json <described/pluck-2.wav
says '"take": "pluck-2"' '"frames": 14400' '"lost_frames": 0'
tail -c +45 described/quiet.wav >bare
expect 0 record rig --source - --bare --rate 48000 --take noise --kind quiet --seconds 0.25 <bare
for pair in pluck-1:pluck-1 pluck-2:pluck-2 quiet:noise; do
  cmp <(tail -c +45 "described/${pair%:*}.wav" | head -c 40000) <(tail -c +105 "rig/${pair#*:}.wav" | head -c 40000) || failures=$((failures + 1))
done
expect 0 check rig
grep -q 'hold_out = true' rig/rig.toml || { echo "FAILED: hold_out is not there"; failures=1; }

# An ALSA device in user space, which plays the samples of a file (as fast as it can, so that an overrun is no wonder).
cat >asound.conf <<CONF
pcm.null { type null }
pcm.played { type file slave.pcm { type null } file "/dev/null" infile "$here/bare" format "raw" }
CONF
export ALSA_CONFIG_PATH=$here/asound.conf
got=0
"$tool" record rig --source alsa:played --rate 48000 --take alsa --kind quiet --seconds 0.2 >out.txt 2>err.txt || got=$?
if [ $got != 2 ]; then
  says "alsa: 0.200 s, 2 channels at 48000 Hz, 16 bits"
  cmp <(head -c 38400 bare) <(tail -c +105 rig/alsa.wav) || failures=$((failures + 1))
  expect 2 record rig --source alsa:nothing --kind quiet
  says "alsa nothing: "
else
  says "this rosin was built without it"
fi
expect 2 record rig --source jack:nobody:out_1,nobody:out_2 --kind quiet
says "jack:"

# Refused, and nothing is left behind.
takes=$(grep -c '^\[\[take\]\]' rig/rig.toml)
expect 2 record new --source described/quiet.wav --kind quiet
says "new/rig.toml: is not there; --like names a rig file"
expect 2 record rig --like described --source described/quiet.wav --kind quiet
says "exists already; --like is for a new rig"
expect 2 record rig --source described/quiet.wav --kind bow
says "a bowed take needs --speed and --normal-force"
expect 2 record rig --source described/quiet.wav --kind pluck
says "a pluck needs --wire"
expect 2 record rig --source described/quiet.wav --take pluck-1 --kind pluck --wire 1
says "is the name of an earlier take"
expect 2 record rig --source none.wav --kind quiet
says "none.wav: no such file"
expect 2 record rig --source serial:/nowhere --kind quiet
says "/nowhere: No such file or directory"
expect 2 record rig --source - --bare --channels 1 --kind quiet <bare
says "the source has 1 channel(s)"
expect 1 record rig --source described/quiet.wav --kind quiet --trigger 0.5
says "the source ended before the trigger was reached" "nothing was recorded"
[ ! -e rig/quiet-1.wav ] || { echo "FAILED: an empty take"; failures=1; }
same "$(grep -c '^\[\[take\]\]' rig/rig.toml)" "$takes"

# The string is released 20 ms after the beginning: the trigger needs 60 ms to know its mean.
{ for _ in 1 2 3 4 5 6; do perl -e 'open(my $in, "<:raw", "described/pluck-1.wav"); local $/; print substr(<$in>, 44, 3000)'; done; tail -c +45 described/pluck-1.wav; } >late
expect 0 record rig --source - --bare --take late --kind pluck --wire 1 --trigger 0.2 --before 0.01 --seconds 0.2 <late
says "late: 0.200 s"

# The ringing of one take does not trigger the next; what comes after half a second of rest does.
{ cat late; for _ in $(seq 32); do head -c 3000 late; done; cat late; } >twice
expect 0 record rig --source - --bare --kind pluck --wire 1 --trigger 0.02 --before 0.01 --seconds 0.05 --count 2 <twice
says "pluck-3: 0.050 s" "pluck-4: 0.050 s"
expect 1 record rig --source - --bare --kind pluck --wire 1 --trigger 0.02 --before 0.01 --seconds 0.05 --count 2 <late
says "pluck-5: 0.050 s" "the source ended before the trigger was reached"
expect 0 check rig
is_silent_about "begins after"
expect 0 record rig --source - --bare --take short --kind pluck --wire 1 --trigger 0.2 --before 0.001 --seconds 0.2 <late
says "--before 0.001 s is less than two periods of the string"

# A harmed line: every missing frame is in a gap that the rig file tells of; all others are in their place.
start_rig() {
  rm -f ready.txt
  "$tool" fake-rig described --line line --seconds 120 "$@" </dev/null >ready.txt & fake=$!
  for _ in $(seq 100); do grep -qs ready ready.txt && break; sleep 0.05; done
}
trap 'kill $fake 2>/dev/null || true' EXIT
start_rig --loop numbers --harm 0.03
expect 1 record rig --source serial:line --take harmed --kind quiet --seconds 1.5 --json
says "frames are missing"
cp out.txt harmed.json
perl -e '
  local $/;
  open(my $j, "<", "harmed.json"); my $json = <$j>;
  my %silent;
  while ($json =~ /"frame": (\d+),\s+"frames": (\d+)/g) { $silent{$_} = 1 for $1 .. $1 + $2 - 1 }
  open(my $w, "<:raw", "rig/harmed.wav"); my @x = unpack("s<*", substr(<$w>, 104));
  my ($first) = grep { !$silent{$_} } 0 .. $#x / 2;
  for my $i (0 .. $#x / 2) {
    my $n = $silent{$i} ? 0 : ($x[2 * $first] - 1 + $i - $first) % 30000 + 1;
    die "frame $i is $x[2 * $i], $x[2 * $i + 1] instead of $n\n" if $x[2 * $i] != $n || $x[2 * $i + 1] != -$n;
  }
  my $lost = keys %silent;
  $json =~ /"lost_frames": $lost,/ or die "the sum is wrong\n";
  $json =~ /"frames": 72000,/ or die "the length is wrong\n";
  die "only $lost missing\n" if $lost < 500' || failures=$((failures + 1))
grep -q '^# gap: [0-9]* frames are missing from frame' rig/rig.toml || { echo "FAILED: the rig file does not tell of the gaps"; failures=1; }

# Nobody takes the frames for a while; then the device is pulled.
kill $fake; wait $fake 2>/dev/null || true
start_rig --loop numbers
"$tool" record rig --source serial:line --take halted --kind quiet --seconds 3 >out.txt 2>err.txt & recorder=$!
sleep 0.5; kill -STOP $recorder; sleep 2; kill -CONT $recorder
got=0; wait $recorder || got=$?
same $got 1
says "frames are missing"
"$tool" record rig --source serial:line --take pulled --kind quiet >out.txt 2>err.txt & recorder=$!
for _ in $(seq 200); do perl -e 'exit !(-e "rig/pulled.wav" && -s _ > 104 + 4 * 48000 * 0.25)' && break; sleep 0.05; done
kill $fake
got=0; wait $recorder || got=$?
same $got 1
says "the device is gone" "pulled: 0."
perl -e 'exit !(-s "rig/pulled.wav" > 104 + 4 * 48000 * 0.2)' || { echo "FAILED: what was recorded did not stay"; failures=1; }

# A full disk.
got=0
( ulimit -f 100; "$tool" record rig --source described/numbers.wav --take full --kind quiet >out.txt 2>err.txt ) || got=$?
same $got 1
says "full.wav: File too large; what was recorded before stays" "full: 0.5"
grep -q '"full"' rig/rig.toml || { echo "FAILED: the take is not in the rig file"; failures=1; }
expect 0 record rig --source rig/full.wav --take copy --kind quiet
says "copy: 0.5"
finish
