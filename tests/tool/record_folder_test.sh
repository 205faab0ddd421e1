# A rig folder that several use: two recorders and an editor at once, names that are wanted twice, what is broken or cannot be
# written at the moment. Nothing that anybody wrote into rig.toml is lost, and no take that is being written is touched.
. "$ROSIN_SOURCE/tests/tool/common.sh"
make_rig described
# 6 s; each frame is n, -n, and n counts from 1 to 30000, again and again.
perl -e '
  my $bytes = pack("s<*", map { ($_ % 30000 + 1, -($_ % 30000) - 1) } 0 .. 287999);
  open(my $out, ">:raw", "numbers.wav") or die;
  print $out "RIFF" . pack("V", 36 + length $bytes) . "WAVEfmt " . pack("VvvVVvv", 16, 1, 2, 48000, 192000, 4, 16) . "data" . pack("V", length $bytes) . $bytes'

fail() { echo "FAILED: $*" && failures=$((failures + 1)); }
numbered() {  # FILE FRAMES: no frame is missing or altered, the head tells of all, and there are so many at least
  perl -e '
    my ($file, $least) = @ARGV;
    open(my $in, "<:raw", $file) or die "$file: $!\n";
    local $/;
    my $all = <$in>;
    my @x = unpack("s<*", substr($all, 104));
    unpack("V", substr($all, 100, 4)) == 2 * @x or die "$file: the head tells of another length\n";
    for my $i (0 .. @x / 2 - 1) {
      my $n = ($x[0] - 1 + $i) % 30000 + 1;
      die "$file: frame $i\n" if $x[2 * $i] != $n || $x[2 * $i + 1] != -$n;
    }
    die "$file: only " . @x / 2 . " frames\n" if @x < 2 * $least' "$1" "$2" || fail "$1"
}
new_rig() {
  rm -rf rig
  expect 0 record rig --like described --source described/quiet.wav --kind quiet --take first --seconds 0.01
}
once() {  # TEXT…: each is in rig.toml once
  local text
  for text in "$@"; do same "$text: $(grep -cF -- "$text" rig/rig.toml)" "$text: 1"; done
}
nothing_left() {
  same "$(cd rig && find . ! -name '*.wav' -type f | sort | tr '\n' ' ')" "./rig.toml "
  expect 0 check rig
  is_silent_about "puts it in order"
}
# record_slowly NAME SPEED OPTIONS…: in the background, as $recorder, until the take's file is there.
record_slowly() {
  local name=$1 speed=$2
  shift 2
  "$tool" record rig --source numbers.wav --faster "$speed" --kind quiet --take "$name" "$@" >"$name.txt" 2>"$name.err" & recorder=$!
  for _ in $(seq 500); do
    [ ! -s "rig/$name.wav" ] || ! grep -qs "\"$name\"" rig/rig.toml || return 0
    sleep 0.02
  done
  fail "$name.wav has not come"
}
ends() {  # CODE PROCESS
  local got=0
  wait "$2" || got=$?
  same "exit $got" "exit $1"
}

# Two recorders and an editor that adds to the file in place, or puts another one there under the folder's lock.
new_rig
for name in a b; do
  "$tool" record rig --source numbers.wav --faster 4 --kind quiet --count 10 --seconds 0.5 >$name.txt 2>$name.err &
  declare "$name=$!"
done
for i in 1 2 3 4 5 6 7 8; do
  sleep 0.15
  if [ $((i % 2)) = 0 ]; then printf '# note %s of mine\n' "$i" >>rig/rig.toml
  else flock rig bash -c "{ printf '# note %s of mine\n' $i; cat rig/rig.toml; } >edited; mv edited rig/rig.toml"; fi
done
# shellcheck disable=SC2154
ends 0 "$a"
# shellcheck disable=SC2154
ends 0 "$b"
for i in 1 2 3 4 5 6 7 8; do once "# note $i of mine"; done
same "$(find rig -name 'quiet-*.wav' | wc -l)" 20
for take in rig/quiet-*.wav; do once "file = \"$(basename "$take")\"" && numbered "$take" 24000; done
nothing_left

# An editor saves a text that is older than the take: the take is put in again when it is over, and the edit stays.
new_rig
cp rig/rig.toml older
record_slowly mine 3
{ echo "# at the top"; cat older; } >edited && mv edited rig/rig.toml
ends 0 $recorder
once "# at the top" 'name = "mine"' 'name = "first"'
head -1 rig/rig.toml | grep -qx "# at the top" || fail "the order is another one"
nothing_left

# While rig.toml is half written, gone or broken, the take goes on; it joins when the file is whole.
new_rig
cp rig/rig.toml whole
head -c 150 whole >rig/rig.toml
"$tool" record rig --source numbers.wav --faster 30 --kind quiet --take hurried >out.txt 2>err.txt & recorder=$!
sleep 0.3; cp whole rig/rig.toml
wait $recorder || true  # it may have been refused before it began
new_rig
record_slowly patient 3
cp rig/rig.toml whole
for broken in "" "schema = " "$(head -c 150 whole)"; do
  printf '%s' "$broken" >rig/rig.toml
  sleep 0.1
done
cp whole rig/rig.toml
ends 0 $recorder
once 'name = "patient"'
nothing_left
record_slowly kept 3
cp rig/rig.toml whole
echo "[string" >rig/rig.toml
ends 1 $recorder
grep -q "rig.toml:1.*kept.wav is kept, and the next" kept.err || fail "$(cat kept.err)"
same "$(cat rig/rig.toml)" "[string"
expect 2 check rig
says "kept.recording.toml: was left by a recording that was broken off; its samples are in kept.wav"
grep -v kept whole >rig/rig.toml
perl -0pi -e 's/\n\[\[take\]\]\nkind = "quiet"\n(?=\n|$)//' rig/rig.toml
expect 0 check rig
says "kept.recording.toml: was left by a recording that was broken off; its samples are in kept.wav, which is not in rig.toml yet"
expect 0 record rig --source described/quiet.wav --kind quiet --seconds 0.01
says "kept.wav: is in rig.toml now, as take kept"
once 'name = "kept"'
numbered rig/kept.wav 280000
nothing_left

# The same name twice: the second is refused before it begins, and the first is not touched. A name that nobody gave is another one.
new_rig
record_slowly same 3
expect 2 record rig --source numbers.wav --kind quiet --take same
says "the name of an earlier take"
"$tool" record rig --source numbers.wav --faster 3 --kind pluck --wire 1 --trigger 1.9 >waits.txt 2>waits.err & waiting=$!
for _ in $(seq 500); do [ ! -e rig/pluck-1.recording.toml ] || break; sleep 0.02; done
expect 2 record rig --source numbers.wav --kind quiet --take pluck-1
says "pluck-1.recording.toml: another program is recording a take of this name"
expect 0 record rig --source described/pluck-1.wav --kind pluck --wire 1
says "pluck-2: 0.300 s"
expect 0 check rig
says "rig/same.wav: is being recorded" "rig/pluck-1.wav: is being recorded"
ends 1 $waiting
ends 0 $recorder
numbered rig/same.wav 288000
nothing_left

# Two begin a new folder at once.
rm -rf rig
for name in a b; do
  "$tool" record rig --like described --source numbers.wav --faster 10 --kind quiet --take $name >$name.txt 2>$name.err & declare "$name=$!"
done
wait "$a" || grep -q "exists already; --like is for a new rig" a.err || fail "$(cat a.err)"
wait "$b" || grep -q "exists already; --like is for a new rig" b.err || fail "$(cat b.err)"
for take in rig/[ab].wav; do once "file = \"$(basename "$take")\"" && numbered "$take" 288000; done
once "schema = 1"
nothing_left

# Nobody else writes over a take that is being recorded, or over its rig file.
new_rig
record_slowly written 3
expect 2 simulate "$ROSIN_SOURCE/examples/rehearsal" --out rig --truth truth.json --force
says "rig: something is being recorded there"
expect 2 fit described --json rig/written.wav --force
says "rig/written.wav: is being written by another program"
ends 0 $recorder
numbered rig/written.wav 288000

# A take of a second recorder does not touch the first one's file; after a kill all of it is found.
new_rig
record_slowly long 1
expect 0 record rig --source described/quiet.wav --kind quiet --take short --seconds 0.05
is_silent_about "long.wav"
sleep 0.7
{ kill -9 $recorder; wait $recorder; } 2>/dev/null || true
bytes=$(stat -c %s rig/long.wav)
expect 0 check rig
says "long.recording.toml: was left by a recording that was broken off; its samples are in long.wav; the next \`rosin record\`"
expect 0 record rig --source described/quiet.wav --kind quiet --seconds 0.01
says "long.wav: was broken off; its header is in order now"
numbered rig/long.wav $(((bytes - 104) / 4 - 1))
nothing_left

# A holder of the lock that was killed holds it no more; one that stands still does not keep Ctrl-C from ending anything.
flock rig sleep 60 & holder=$!
sleep 0.3
{ pkill -9 -P $holder; kill -9 $holder; wait $holder; } 2>/dev/null || true
expect 0 record rig --source described/quiet.wav --kind quiet --seconds 0.01
flock rig sleep 8 & holder=$!
sleep 0.3
"$tool" record rig --source described/quiet.wav --kind quiet >out.txt 2>err.txt & recorder=$!
sleep 0.3
begin=$(date +%s%N)
kill -INT $recorder
ends 2 $recorder
[ $(($(date +%s%N) - begin)) -lt 3000000000 ] || fail "the lock was waited for, although a signal had come"
says "rig: another program is changing it"
{ pkill -9 -P $holder; kill -9 $holder; wait $holder; } 2>/dev/null || true

# Comments, order, the mode and a link stay; a list in brackets is gone on with; a name that a person has given to another take
# meanwhile stays his.
new_rig
mkdir elsewhere
{ cat rig/rig.toml; printf '\n# the end, without a line break'; } >elsewhere/mine.toml
chmod 640 elsewhere/mine.toml
ln -sf ../elsewhere/mine.toml rig/rig.toml
cp elsewhere/mine.toml before
expect 0 record rig --source described/quiet.wav --kind quiet --take linked --seconds 0.01
[ -L rig/rig.toml ] || fail "the link is gone"
same "$(stat -c %a elsewhere/mine.toml)" 640
head -c "$(stat -c %s before)" elsewhere/mine.toml | cmp - before || fail "what was there was altered"
once 'name = "linked"'
new_rig
perl -0pi -e 's/\n\[\[take\]\]\n.*/\n/s; s/^/take = [ # all of them\n  {name = "first", kind = "quiet", file = "first.wav"}, # the first\n]\n/' rig/rig.toml
expect 0 record rig --source described/quiet.wav --kind quiet --take listed --seconds 0.01
once '# all of them' '# the first' 'name = "listed", kind = "quiet", file = "listed.wav"'
expect 0 check rig
new_rig
mkfifo hand
"$tool" record rig --source - --bare --rate 48000 --kind quiet --take mine <hand >mine.txt 2>mine.err & recorder=$!
exec 3>hand
for _ in $(seq 500); do [ ! -s rig/mine.recording.toml ] || break; sleep 0.02; done
cp rig/first.wav rig/other.wav
printf '\n[[take]]\nname = "mine"\nkind = "quiet"\nfile = "other.wav"\n' >>rig/rig.toml
tail -c +45 numbers.wav >&3
exec 3>&-
ends 0 $recorder
once 'name = "mine"' 'name = "mine-2"' 'file = "mine.wav"'
nothing_left

# What is left of a change of rig.toml goes, but not what stands nowhere else.
cp rig/rig.toml rig/rig.toml.swap
head -c 100 rig/rig.toml >rig/rig.toml.part
expect 0 check rig
says "rig.toml.part: is being written, or was left" "rig.toml.swap: was left where the change of rig.toml was broken off"
expect 0 record rig --source described/quiet.wav --kind quiet --seconds 0.01
nothing_left
{ cat rig/rig.toml; echo "# mine alone"; } >rig/rig.toml.swap
expect 0 record rig --source described/quiet.wav --kind quiet --seconds 0.01
says "rig.toml.saved-1: is what an editor had written"
grep -qx "# mine alone" rig/rig.toml.saved-1 || fail "an editor's text was lost"
expect 0 check rig
says "rig.toml.saved-1: has lines that rig.toml has not"

# A folder that cannot be written into: said before anything is recorded. (root may write anywhere.)
new_rig
chmod 555 rig
if [ "$(id -u)" = 0 ]; then
  chmod 755 .. . 2>/dev/null || true
  as_nobody="setpriv --reuid=65534 --regid=65534 --clear-groups"
  $as_nobody test -r rig/rig.toml 2>/dev/null && $as_nobody test -x "$tool" || as_nobody=
else as_nobody=env; fi
if [ -n "$as_nobody" ]; then
  got=0
  $as_nobody "$tool" record rig --source described/quiet.wav --kind quiet >out.txt 2>err.txt || got=$?
  same "exit $got" "exit 2"
  says "rig/quiet-1.recording.toml: Permission denied"
fi
chmod 755 rig
nothing_left

# Nothing was recorded: nothing is left.
expect 1 record fresh --like described --source described/quiet.wav --kind quiet --trigger 0.9
says "nothing was recorded"
[ ! -e fresh ] || fail "an empty folder was left"
finish
