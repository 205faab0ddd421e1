# rosin record, killed at random moments: the take can be read, every sample is right, at most the last 0.1 s of what it had read
# is missing, and the rig file is whole. The first is killed while it starts, when what a pipe holds may be missing, too.
# ROSIN_KILLS says how often (50 for a thorough look).
. "$ROSIN_SOURCE/tests/tool/common.sh"
make_rig described
rate=48000

# Half a minute at most, until a file is there.
wait_for() {
  for _ in $(seq 1500); do
    [ -e "$1" ] && return
    sleep 0.02
  done
  echo "FAILED: $1 has not come" && failures=$((failures + 1))
}

worst=0
for trial in $(seq "${ROSIN_KILLS:-4}"); do
  rm -rf rig fifo handed
  mkfifo fifo
  feed $rate handed >fifo & feeder=$!
  "$tool" record rig --like described --source - --bare --bits 32 --rate $rate --kind quiet <fifo >out.txt 2>err.txt & recorder=$!
  if [ "$trial" -gt 1 ]; then wait_for rig/rig.toml; fi
  sleep "$(perl -e 'srand($$ + $ARGV[0]); printf "%.4f", rand($ARGV[0] > 1 ? 1.2 : 0.3)' "$trial")"
  handed=$(cat handed 2>/dev/null) || true
  handed=${handed:-0}
  { kill -9 $recorder; wait $recorder; wait $feeder; } 2>/dev/null || true
  missing=$(perl -e '
    my ($handed) = @ARGV;
    my $take = "rig/quiet-1.wav";
    if (!-s $take) { print $handed; exit }
    open(my $in, "<:raw", $take) or die "no take\n";
    local $/; my $bytes = <$in>;
    substr($bytes, 0, 4) eq "RIFF" or die "no header\n";
    my @x = unpack("l<*", substr($bytes, 104));
    for my $i (0 .. @x / 2 - 1) { die "frame $i is $x[2*$i], $x[2*$i+1]\n" if $x[2 * $i] != $i || $x[2 * $i + 1] != -$i }
    print $handed - int(@x / 2)' "$((10#$handed))") || failures=$((failures + 1))
  most=$((rate / 10))
  [ "$trial" -gt 1 ] || most=$((most + 65536 / 8))  # a pipe holds so much
  [ "${missing:-99999}" -le "$most" ] || { echo "FAILED: kill $trial: $missing of $handed frames are missing"; failures=$((failures + 1)); }
  [ "${missing:-0}" -le "$worst" ] || worst=$missing
  if [ "$trial" -gt 1 ] || [ -e rig/rig.toml ]; then expect 0 check rig; fi
done
echo "at most $worst frames, $(perl -e "printf '%.3f', $worst / $rate") s, were missing"

# the next recording puts the header in order
expect 0 record rig --source described/quiet.wav --kind quiet
says "was broken off; its header is in order now"
same "$(perl -e 'open(my $in, "<:raw", "rig/quiet-1.wav"); local $/; my $b = <$in>; print unpack("V", substr($b, 100, 4)) - length(substr($b, 104))')" 0
expect 0 check rig
finish
