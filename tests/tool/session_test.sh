# A whole laboratory session that nobody attends: a simulated string behind a serial line, a simulated sled; noise, plucks,
# calibration, strokes that are reconstructed while they are recorded, and the truth at the end.
. "$ROSIN_SOURCE/tests/tool/common.sh"
"$tool" simulate "$ROSIN_SOURCE/examples/rehearsal" --out played --truth truth >/dev/null 2>&1

mkfifo hand
"$tool" fake-rig played --line line --sled sled --seconds 120 <hand >ready.txt & fake=$!
exec 3>hand
trap 'kill $fake 2>/dev/null || true' EXIT
for _ in $(seq 100); do grep -qs ready ready.txt && break; sleep 0.05; done

expect 0 record rig --like "$ROSIN_SOURCE/examples/rehearsal" --source serial:line --kind quiet --seconds 0.34
says "quiet-1: 0.340 s, 2 channels at 48000 Hz, 16 bits"
n=0
for wire in 1.0 0.5; do
  n=$((n + 1))
  { sleep 0.4; echo pluck-$n >&3; } &
  expect 0 record rig --source serial:line --kind pluck --wire $wire --trigger 0.05 --before 0.01 --seconds 0.34
  no_messages
done
expect 0 check rig
expect 0 fit rig --json fit.json
expect 0 live rig --calibration fit.json --source serial:line --kind bow --speed 0.2 --normal-force 0.3 \
  --sled sled --distance -0.06 --acceleration 20 --rest 0.02 --out live.csv --out live.wav --json live.json
says "bow-1: " "late by " " slips"
grep -q '"lost_frames": 0' live.json || { echo "FAILED: frames were lost"; failures=1; }
expect 0 reconstruct rig --take bow-1 --calibration fit.json --out whole.csv --no-fine-tune
expect 0 validate whole.csv

# The sled knows its way: no further than it goes, and not faster than its acceleration lets it.
expect 2 record rig --source serial:line --kind bow --speed 0.12 --normal-force 0.45 --sled sled --distance 0.5
says "the stroke would end at 440.000 mm"
expect 2 record rig --source serial:line --kind bow --speed 0.12 --normal-force 0.45 --sled sled --distance 0.001
says "never reaches 0.120 m/s"
kill $fake
wait $fake 2>/dev/null || true
[ ! -e line ] || { echo "FAILED: the line is still there"; failures=1; }

# The live result is the whole record's, to the error that its filters were designed for; and both are the truth, shifted by the
# time that passed until the sled moved.
start=$(perl -e '
  local $/;
  open(my $a, "<:raw", "played/bow-1.wav"); my $played = substr(<$a>, 44);
  open(my $b, "<:raw", "rig/bow-1.wav"); my $recorded = substr(<$b>, 104);
  for (my $i = 0; $i + 4000 < length $recorded; $i += 4) {
    next if substr($recorded, $i, 16) ne substr($played, 0, 16);
    print $i / 4 if substr($recorded, $i, 4000) eq substr($played, 0, 4000);
  }')
[ -n "$start" ] || { echo "FAILED: what was played is not in the take"; failures=1; }
perl -e '
  my ($start) = @ARGV;
  my ($sum, $square, $n, $row, $rows) = (0, 0, 0, 0, 0);
  open(my $l, "<", "live.csv"); open(my $w, "<", "whole.csv"); open(my $s, ">", "shifted.csv");
  my $whole; do { $whole = <$w> } while ($whole =~ /^#/);
  print $s scalar <$l>;
  while (my $line = <$l>) {
    my @a = split /,/, $line, -1; my @b = split /,/, scalar <$w>, -1;
    if ($a[1] ne "" && $b[1] ne "") { $sum += ($a[1] - $b[1]) ** 2; $square += $b[1] ** 2; $n++ }
    my $t = ($row++ - $start) / 48000;
    if ($t >= 0 && $t < 0.35) { $a[0] = $t; $rows++, print $s join(",", @a) }
  }
  open(my $t, "<", "truth/bow-1.csv"); open(my $c, ">", "cut.csv");
  while (<$t>) { print $c $_ if /^[#a-z]/ || $rows-- > 0 }
  my $relative = sqrt($sum / $square);
  printf "live against the whole record: %.5f over %d samples\n", $relative, $n;
  exit !($relative < 2e-3 && $n > 15000)' "$start" || { echo "FAILED: the live result is not that of the whole record"; failures=1; }
expect 0 compare shifted.csv cut.csv
delta=$(sed -n 's/^force_N: Delta \([0-9.]*\).*/\1/p' out.txt)
cat out.txt
perl -e 'exit !(@ARGV && $ARGV[0] ne "" && $ARGV[0] < 0.01)' -- "$delta" || { echo "FAILED: Delta against the truth"; failures=1; }

# From a file; the result as lines for another program, and one that does not listen to the end. The take goes on.
"$tool" live rig --calibration fit.json --source rig/bow-1.wav --no-take --speed 0.2 --normal-force 0.3 --out - >lines.txt 2>err.txt
cmp lines.txt live.csv || { echo "FAILED: the lines on standard output are not those of the file"; failures=1; }
"$tool" live rig --calibration fit.json --source rig/bow-1.wav --take again --speed 0.2 --normal-force 0.3 --out - 2>err.txt | head -n 2 >lines.txt || true
says "standard output: Broken pipe; the take goes on" "again: "
expect 2 live rig --calibration fit.json --source rig/bow-1.wav --take again --speed 0.2 --normal-force 0.3
says "is the name of an earlier take"
expect 2 live rig --calibration rig/rig.toml --source rig/bow-1.wav --no-take
says "is not JSON"
expect 2 live rig --calibration fit.json --source rig/bow-1.wav --no-take --position 0.3 --pass 30000 --stop 20000
says "pass has to be below stop"
finish
