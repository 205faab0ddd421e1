# rosin record and rosin live from a real JACK server with its dummy driver, on which another client plays a simulated stroke round and
# round: every frame is there and in its place, or said to be missing.
. "$ROSIN_SOURCE/tests/tool/common.sh"
if [ ! -x "${ROSIN_JACK_PLAYER:-}" ] || ! command -v jackd >/dev/null; then
  echo "no jackd, or built without JACK: not tried"
  exit 0
fi
export JACK_DEFAULT_SERVER=rosin-tool-$$ JACK_NO_AUDIO_RESERVATION=1
expect 0 simulate "$ROSIN_SOURCE/examples/rehearsal" --out played
expect 0 fit played --json fit.json
jackd -n "$JACK_DEFAULT_SERVER" -S -r -d dummy -r 48000 -p 256 >jackd.txt 2>&1 & server=$!
ended=unknown
stop_server() {  # a second signal would end it before it has left JACK's list of servers, which holds eight
  [ $ended = unknown ] || return 0
  kill $server 2>/dev/null || true
  ended=0; wait $server || ended=$?
}
trap stop_server EXIT
mkfifo hold
"$ROSIN_JACK_PLAYER" played/bow-1.wav <hold >ready.txt 2>&1 &
exec 3>hold
for _ in $(seq 300); do grep -qs . ready.txt && break; sleep 0.05; done
same "$(cat ready.txt)" ready

# as_played NAME: no frame of the take differs from the loop but those that are said to be missing (a busy machine may be late).
as_played() {
  perl -e '
    my ($name) = @ARGV;
    local $/;
    open(my $j, "<", "$name.json"); my $json = <$j>;
    my %missing;
    while ($json =~ /"frame": (\d+),\s+"frames": (\d+)/g) { $missing{$_} = 1 for $1 .. $1 + $2 - 1 }
    open(my $p, "<:raw", "played/bow-1.wav"); my $loop = substr(<$p>, 44); my $n = length($loop) / 4;
    open(my $w, "<:raw", "played/$name.wav"); my $file = <$w>;
    my @x = unpack("f<*", substr($file, 8 + index($file, "data")));
    my $take = pack("s<*", map { 32768 * $_ } @x);
    my $at = index($loop . $loop, substr($take, 0, 400));
    die "the loop is not there\n" if $at < 0 || $at % 4;
    for my $i (0 .. length($take) / 4 - 1) {
      next if $missing{$i};
      die "frame $i is wrong\n" if substr($take, 4 * $i, 4) ne substr($loop, 4 * (($at / 4 + $i) % $n), 4);
    }
    die "the length is wrong\n" if @x != 2 * 96000;
    printf "%s: %d frames missing\n", $name, scalar keys %missing' "$1" || failures=$((failures + 1))
}
listen() {  # exit 1: frames are missing
  local got=0
  "$tool" "$@" --source jack:player:1,player:2 --kind bow --speed 0.2 --normal-force 0.3 --seconds 2 >out.txt 2>err.txt || got=$?
  [ $got -le 1 ] || says "(exit 0 or 1 instead of $got)"
}
listen record played --take recorded --json
cp out.txt recorded.json
as_played recorded
listen live played --calibration fit.json --take heard --json heard.json
as_played heard
expect 2 record played --source jack:player:1,nobody:2 --kind quiet
says "jack: there is no port nobody:2 to listen to"

# The server goes away: what was recorded stays.
"$tool" record played --source jack:player:1,player:2 --take cut --kind quiet >out.txt 2>err.txt & recorder=$!
sleep 1
stop_server
got=0; wait $recorder || got=$?
same $got 1
says "jack: the server is gone"
same $ended 0   # and could leave in order
[ "$(stat -c %s played/cut.wav)" -gt 100000 ] || { echo "FAILED: what was recorded did not stay"; failures=1; }
finish
