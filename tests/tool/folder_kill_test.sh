# A rig folder in which one recorder is killed at random moments while a second one records into it, all the time, and at every other
# four kills a third one that takes a new name every tenth of a second. After each kill nothing that was recorded is lost and rig.toml is
# whole; `check` names what is left, and the next that records into the folder puts it in order. Nobody touches the second's take.
# ROSIN_KILLS says how often.
. "$ROSIN_SOURCE/tests/tool/common.sh"
make_rig described
rate=8000
fail() { echo "FAILED: kill $trial: $*" && failures=$((failures + 1)); }
trial=0

# frames_of FILE: how many there are; all of them are n, -n, from any n on, and with HEAD the head tells of just as many.
frames_of() {
  perl -e '
    my ($file, $head) = @ARGV;
    open(my $in, "<:raw", $file) or die "$file: $!\n";
    local $/;
    my $all = <$in> // "";
    length $all >= 104 or print(0), exit;
    my @x = unpack("l<*", substr($all, 104));
    my $count = int(@x / 2);
    for my $i (0 .. $count - 1) { die "$file: frame $i\n" if $x[2 * $i] != $x[0] + $i || $x[2 * $i + 1] != -$x[2 * $i] }
    die "$file: the head tells of another length\n" if $head && unpack("V", substr($all, 100, 4)) != length(substr($all, 104));
    print $count' "$@"
}
# begin NAME OPTIONS…: a recorder with a feeder of its own; their processes are ${NAME}_recorder and ${NAME}_feeder.
begin() {
  local name=$1
  shift
  rm -f "$name.fifo" "$name.handed"
  mkfifo "$name.fifo"
  feed $rate "$name.handed" >"$name.fifo" & declare -g "${name}_feeder=$!"
  "$tool" record rig --source - --bare --bits 32 --rate $rate --kind quiet "$@" <"$name.fifo" >"$name.txt" 2>"$name.err" &
  declare -g "${name}_recorder=$!"
}
handed() {
  local frames
  frames=$(cat "$1.handed" 2>/dev/null) || true
  echo $((10#${frames:-0}))
}

"$tool" record rig --like described --source described/quiet.wav --kind quiet --take first >/dev/null
{ echo "# mine, at the top"; cat rig/rig.toml; echo "# mine, in between"; } >edited && mv edited rig/rig.toml
begin second --take second
for _ in $(seq 500); do grep -q '"second"' rig/rig.toml && break; sleep 0.02; done

worst=0 left=0 empty=0
for trial in $(seq "${ROSIN_KILLS:-50}"); do
  third_recorder=
  [ $((trial / 4 % 2)) = 0 ] || begin third --count 1000 --seconds 0.1
  take=victim-$trial
  begin victim --take "$take"
  # The moment counts from the start, from when it has got its name, or from its first samples.
  case $((trial % 4)) in
    0) from= within=0.3 ;;
    1) from=rig/$take.recording.toml within=0.05 ;;
    *) from=rig/$take.wav within=0.6 ;;
  esac
  if [ -n "$from" ]; then for _ in $(seq 5000); do [ ! -e "$from" ] || break; sleep 0.002; done; fi
  sleep "$(perl -e 'srand($$ + $ARGV[0]); printf "%.4f", rand($ARGV[1])' "$trial" $within)"
  given=$(handed victim)
  # shellcheck disable=SC2154
  { kill -9 "$victim_recorder"; wait "$victim_recorder"; wait "$victim_feeder"; } 2>/dev/null || true
  if [ -z "$third_recorder" ]; then  # nobody has come yet
    expect 0 check rig
    if [ -e "rig/$take.recording.toml" ]; then
      says "rig/$take.recording.toml: was left by a recording that" "the next \`rosin record\`"
      left=$((left + 1))
    elif [ -e "rig/$take.wav" ]; then fail "$take.wav has no note"; fi
    says "rig/second.wav: is being recorded"
  fi
  there=0
  if [ -e "rig/$take.wav" ]; then
    there=$(frames_of "rig/$take.wav") || fail "$take"
    # what it had read and not handed on is 0.1 s at most; a pipe that nobody has read from yet does not count
    [ "$there" = 0 ] || [ $((given - there)) -le $((rate / 10)) ] || fail "$((given - there)) of $given frames are missing"
    [ "$there" = 0 ] || [ $((given - there)) -le $worst ] || worst=$((given - there))
  fi
  if [ -n "$third_recorder" ]; then
    kill -TERM "$third_recorder"
    got=0; wait "$third_recorder" || got=$?
    # 1: the signal came before a take's first sample; 143: before the program knew of signals
    [ $got -le 1 ] || [ $got = 143 ] || fail "the third: exit $got: $(cat third.err)"
    # shellcheck disable=SC2154
    wait "$third_feeder" 2>/dev/null || true
  fi
  expect 0 record rig --source described/quiet.wav --kind quiet --seconds 0.01
  [ ! -e "rig/$take.recording.toml" ] || fail "$take was not put in order"
  if [ "$there" -gt 0 ]; then
    [ "$(frames_of "rig/$take.wav" head)" = "$there" ] || fail "$take.wav has not the frames that it had"
    [ "$(grep -cF "\"$take.wav\"" rig/rig.toml)" = 1 ] || fail "$take is in rig.toml $(grep -cF "\"$take.wav\"" rig/rig.toml) times"
  else
    [ ! -e "rig/$take.wav" ] || fail "$take.wav is empty"
    ! grep -qF "\"$take.wav\"" rig/rig.toml || fail "rig.toml names $take, of which nothing was recorded"
    empty=$((empty + 1))
  fi
  [ "$failures" -lt 10 ] || break
done
echo "at most $worst frames were missing; nothing had been recorded $empty times; check named a note $left times"

# shellcheck disable=SC2154
{ given=$(handed second); kill -TERM "$second_recorder"; wait "$second_recorder" || fail "the second: $(cat second.err)"; } 2>/dev/null
frames=$(frames_of rig/second.wav head) || fail "the second's take was altered"
[ "$frames" -ge $((given - rate / 10)) ] || fail "the second's take has $frames frames of $given"
expect 0 check rig
is_silent_about "puts it in order"
is_silent_about "no take in rig.toml names"
for file in rig/*.wav; do
  same "$file: $(grep -cF "\"$(basename "$file")\"" rig/rig.toml)" "$file: 1"
done
same "$(grep -c '^# mine, ' rig/rig.toml)" 2
same "$(head -1 rig/rig.toml)" "# mine, at the top"
same "$(cd rig && find . ! -name '*.wav' -type f | sort | tr '\n' ' ')" "./rig.toml "
finish
