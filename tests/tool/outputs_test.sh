# Where results go: files, links, pipes, devices, standard output; names and titles of any kind; what a picture that fails takes along
# (nothing); and messages that tell the reason.
. "$ROSIN_SOURCE/tests/tool/common.sh"
perl "$ROSIN_SOURCE/tests/tool/closed_form_rig.pl" rig
fail() { echo "FAILED: $1"; failures=$((failures + 1)); }
expect 0 fit rig --json fit.json
table=(reconstruct rig --take bow-1 --calibration fit.json --no-fine-tune)
expect 0 "${table[@]}" --out plain.csv
rows() { grep -vc '^#' "$1"; }

# links are followed, pipes and devices written to; nothing takes their place
echo old >target
ln -s target link
expect 2 "${table[@]}" --out link
says "link: exists already; --force overwrites it"
expect 0 "${table[@]}" --out link --force
[ -L link ] || fail "a link was replaced"
same "$(rows target)" "$(rows plain.csv)"
mkfifo pipe
cat pipe >from_pipe &
expect 0 "${table[@]}" --out pipe
wait $!
[ -p pipe ] || fail "a pipe was replaced"
same "$(rows from_pipe)" "$(rows plain.csv)"
if mknod node c 1 3 2>/dev/null; then
  expect 0 "${table[@]}" --out node --force
  [ -c node ] || fail "a device was replaced"
fi
expect 0 "${table[@]}" --out /dev/stdout
same "$(rows out.txt)" "$(rows plain.csv)"
expect 2 "${table[@]}" --out pipe --format mat
says "is no file; this format goes to a file only"
if [ -c /dev/full ]; then
  expect 2 "${table[@]}" --out /dev/full --json full.json
  says "/dev/full: cannot be written: No space left on device" "Delta of the two versions"
  [ -s full.json ] || fail "one output that fails takes another one along"
fi
expect 2 "${table[@]}" --out rig --force
says "rig: is a folder"
is_silent_about "--force overwrites"
expect 2 "${table[@]}" --report -
says "this goes to a file only"

# a picture that fails is a warning; the user's own gnuplot files and temporary folder make no difference
if command -v gnuplot >/dev/null; then
  mkdir home "it's" gnuplot_of_ours
  printf 'set datafile separator ","\n' >home/.gnuplot
  HOME=$here/home GNUPLOT_LIB=/nowhere GNUTERM=nonsense TMPDIR="$here/it's" expect 0 fit rig --report own.html --json own.json
  same "$(grep -c '<svg' own.html)" "$(grep -c '</svg>' own.html)"
  grep -q '<svg' own.html || fail "no figures"
  printf '#!/bin/sh\necho "it broke" >&2\nexit 1\n' >gnuplot_of_ours/gnuplot
  chmod +x gnuplot_of_ours/gnuplot
  PATH=$here/gnuplot_of_ours:$PATH expect 1 fit rig --report broken.html --json broken.json
  says "warning: the figures are missing: gnuplot failed: it broke" "pitch f0"
  [ -s broken.json ] || fail "the result hangs on the picture"
  grep -q "the figures are missing" broken.html || fail "the page does not say what it lacks"
  TMPDIR=$here/nowhere expect 1 "${table[@]}" --report broken2.html --out broken2.csv
  says "warning: the figures are missing: no temporary folder could be made"
  same "$(rows broken2.csv)" "$(rows plain.csv)"
  sed 's/^title = .*/title = "`touch pwned` %d {\\\\it @x} 100 % \\"it'"'"'s\\""/' rig/rig.toml >rig/odd.toml
  expect 0 fit rig/odd.toml --report odd.html
  [ ! -e pwned ] || fail "a title is run as a command"
else
  echo "skipped: the pages, no gnuplot"
fi

# titles and names
cp -r rig "odd [1] %d 'rig'"
sed -i 's/^title = .*/title = "first line\\nsecond line, of \\"two\\" [x] 100 % -"/' "odd [1] %d 'rig'/rig.toml"
expect 0 reconstruct "odd [1] %d 'rig'" --take bow-1 --calibration fit.json --no-fine-tune --out "-odd,
name.csv"
expect 0 compare "./-odd,
name.csv" plain.csv
expect 0 validate "./-odd,
name.csv"
grep -q '^# rig first line second line, of "two" \[x\] 100 % -$' "./-odd,
name.csv" || fail "the title is not one comment"
sed 's/^name = "bow-1"/name = "bow\\n1"/' rig/rig.toml >rig/two.toml
expect 2 check rig/two.toml
says ".name: must be one line, without control characters"

# messages
: >empty.toml
expect 2 check empty.toml
says "empty.toml: is empty"
expect 2 check nowhere
says "nowhere: cannot be read: No such file or directory"
expect 2 reconstruct rig --take bow-1 --calibration empty.toml
says "empty.toml: is empty"
expect 2 compare rig plain.csv
says "rig: cannot be read: is a folder"
expect 2 diagnos rig
says "there is no command diagnos; did you mean diagnose?"
expect 2 check rig --jsn
says "there is no option --jsn; did you mean --json?"
expect 2 check rig --strct --wrong=3
says "--strct; did you mean --strict?"
expect 2 check rig again
says "not expected: again"
expect 2 "${table[@]}" --out x.csv --pass 0,5
says "--pass: 0,5 is no finite number; the decimal mark is a point"
expect 2 "${table[@]}" --out x.csv --pass -3
says "--pass: must be larger than 0, is -3"
[ ! -e x.csv ] || fail "something is left behind by what was refused"
perl -ne 'exit 1 if length > 400' err.txt || fail "a message without end"

# what was refused leaves no folder; takes of any spelling are left out of what a new rig is like
expect 2 record new/deep --like rig --source rig/bow-1.wav --kind bow
says "a bowed take needs --speed and --normal-force"
[ ! -e new ] || fail "an empty folder is left behind"
mkdir like
sed 's/\[\[take\]\]/  [[ take ]]/' rig/rig.toml >like/rig.toml
expect 0 record new --like like --source rig/bow-1.wav --kind quiet --take q --seconds 0.05
same "$(grep -c 'take *\]\]' new/rig.toml)" 1
expect 2 record new --source rig/bow-1.wav --kind quiet --take 'a
b' --seconds 0.05
says "name: must be one line"
ls new | grep -q '^a' && fail "a refused take is left behind"
expect 0 check new --json
finish
