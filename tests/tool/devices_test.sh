# Devices that are slow, are something else, or are waited for: each message says what is the matter, each command ends within a
# second of SIGINT and SIGTERM, and what was recorded stays.
. "$ROSIN_SOURCE/tests/tool/common.sh"
make_rig described
"$tool" fake-rig described --line line --sled sled --homing 3.6 --seconds 120 </dev/null >ready.txt 2>&1 & fake=$!
trap 'kill $fake 2>/dev/null || true' EXIT
for _ in $(seq 100); do grep -qs ready ready.txt && break; sleep 0.05; done
bow=(--kind bow --speed 0.2 --normal-force 0.3 --distance -0.04 --acceleration 20)

# The two lines swapped, each on its own, and both at once on one.
expect 2 record rig --like described --source described/quiet.wav --faster 1 "${bow[@]}" --sled line
says "line: this is no G-code controller: packets of frames come, as from a digitiser"
expect 2 record rig --like described --source serial:sled --kind quiet
says "sled: no packet of frames came: a G-code controller talks (<Idle|MPos:0.000"
expect 2 record rig --like described --source serial:line "${bow[@]}" --sled line
says "line: is in use already"
expect 2 record rig --like described --source serial:line "${bow[@]}" --sled sled --home --home-seconds 0.5
says "sled: is busy (homing): no end of it after 0.500 s"
[ ! -e rig/bow-1.wav ] || { echo "FAILED: a take without a stroke"; failures=$((failures + 1)); }

# Homing takes longer than any other answer may, and is no part of the take.
expect 0 record rig --like described --source serial:line "${bow[@]}" --sled sled --home
perl -ne 'exit !($1 > 0.2 && $1 < 1.5) if /bow-1: ([0-9.]+) s,/' out.txt || { echo "FAILED: homing is in the take"; cat out.txt; failures=$((failures + 1)); }

# ends SIGNAL COMMAND…: it has a pipe for its standard input, runs for a second, and ends within another one after the signal.
ends() {
  local signal=$1 begun
  shift
  "$tool" "$@" <&4 >out.txt 2>err.txt & local one=$!
  sleep 1
  kill -0 $one 2>/dev/null || { echo "FAILED: rosin $* did not wait"; cat out.txt err.txt; failures=$((failures + 1)); }
  begun=$(date +%s%N)
  kill -"$signal" $one 2>/dev/null || true
  for _ in $(seq 100); do kill -0 $one 2>/dev/null || break; sleep 0.05; done
  kill -KILL $one 2>/dev/null && wait $one 2>/dev/null
  got=0
  wait $one || got=$?
  [ $((($(date +%s%N) - begun) / 1000000)) -lt 1300 ] || { echo "FAILED: rosin $* went on after SIG$signal"; failures=$((failures + 1)); }
}
mkfifo silent
exec 4<>silent
for signal in INT TERM; do
  ends $signal record rig --source serial:line "${bow[@]}" --sled sled --home
  says "sled: stopped while homing"
  same "$got" 2
  ends $signal record rig --source serial:line --kind quiet --take "while-$signal"
  says "while-$signal: "
  same "$got" 0
  perl -e 'exit !(-s $ARGV[0] > 104 + 4 * 48000 * 0.5)' "rig/while-$signal.wav" || { echo "FAILED: the take did not stay"; failures=$((failures + 1)); }
  ends $signal record rig --source - --kind quiet
  says "stopped before a frame came"
  head -c 100000 described/quiet.wav >part
  cat part >&4 & writer=$!
  ends $signal record rig --source - --bare --channels 2 --kind quiet --take "pipe-$signal"
  says "pipe-$signal: "
  kill $writer 2>/dev/null || true
done
# A stroke that is broken off: the sled comes to rest, and the next one begins from there.
ends INT record rig --source serial:line --kind bow --speed 0.02 --normal-force 0.3 --sled sled --unlock --distance -0.2 --acceleration 1
says "bow-2: "
expect 2 record rig --source serial:line --kind bow --speed 0.2 --normal-force 0.3 --sled sled --distance 0.3 --acceleration 20
says "the stroke would end at"
expect 0 record rig --source serial:line "${bow[@]}" --sled sled
expect 0 check rig
finish
