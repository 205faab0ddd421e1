# rosin init: a rig file from a folder of recordings; what is bad in tables by file, line, column and reason; then check and reconstruct.
. "$ROSIN_SOURCE/tests/tool/common.sh"

# machine FOLDER N: whole_N.csv as a bowing machine writes it (50 kHz, CRLF, no header), with beta_N.csv and timestamp_N.csv.
# PERL, if set, is run on each row (@x: normal force, speed, near, far; $i; $eol) before it is written.
machine() {
  mkdir -p "$1"
  perl -e '
    my ($folder, $number, $code) = @ARGV;
    srand($number);
    my ($beta, $speed, $press) = (0.08 + 0.01 * $number, 0.1, 0.5);
    open(my $out, ">:raw", "$folder/whole_$number.csv") or die;
    for my $i (0 .. 29999) {
      my ($t, $eol) = ($i / 50000, "\r\n");
      my $n = $t < 0.05 || $t > 0.5 ? 0 : $press;
      my $v = $t < 0.05 ? 0 : $t < 0.1 ? $speed * ($t - 0.05) / 0.05 : $speed;
      my $saw = $v / $beta * (130 * $t - int(130 * $t) - 0.5) * ($t > 0.5 ? 0.3 : 1);
      my $drag = 0.4 * $n * $v / $speed;
      my @x = ($n + 0.04, $v, (1 - $beta) * $drag + $saw, $beta * $drag - $saw);
      $_ += 1e-3 * (rand() + rand() + rand() - 1.5) for @x[0, 2, 3];
      my $text = join(",", map { sprintf("%.7g", $_) } @x);
      eval $code if $code;
      die $@ if $@;
      print $out $text . $eol;
    }
    open($out, ">:raw", "$folder/beta_$number.csv") or die;
    printf $out "%.6g\r\n", $beta;
    open($out, ">:raw", "$folder/timestamp_$number.csv") or die;
    print $out "10000,20000\r\n";' "$1" "$2" "${PERL:-}"
}

# complete FOLDER: what a notebook says is filled in.
complete() {
  sed -i -E 's/^# (length_m|tension_N|bending_stiffness_Nm2) /\1 /; s/^# fundamental_Hz = [0-9.]+/fundamental_Hz = 130.0/' "$1/rig.toml"
}

for n in 1 2 3 10; do machine strokes $n; done
before=$(cat strokes/*.csv | sha256sum)
expect 0 init strokes
says "strokes/rig.toml: 4 take(s) in the public layout"
same "$(grep '^name' strokes/rig.toml | tr '\n' ' ')" 'name = "whole_1" name = "whole_2" name = "whole_3" name = "whole_10" '
grep -q '^contact_position = 0.18$' strokes/rig.toml || { echo "FAILED: no position"; failures=1; }
grep -q '^steady_s = \[0.2, 0.4\]' strokes/rig.toml || { echo "FAILED: no steady_s"; failures=1; }
grep -q 'bow speed 0.1 m/s, normal force 0.5 N (0.04 N of offset taken off)' strokes/rig.toml || { echo "FAILED: nothing measured"; failures=1; }
expect 2 check strokes
says "rig.toml:7: string.fundamental_Hz: is missing" "rig.toml:7: string.length_m: is missing" "rig.toml:7: string.tension_N: is missing"
complete strokes
expect 0 validate strokes/rig.toml
expect 0 check strokes
says "whole_1 (bow, whole_1.csv): 0.6 s at 50000 Hz" "steady from 0.200 to 0.400 s: bow speed 0.1 m/s, normal force 0.5 N" \
  "note: reads 0.04 N while the bow is off the string" "assumed: channels.near: its column is in SI units" "0 error(s), 0 warning(s)"
expect 0 check strokes --json
says '"normal_force_N": 0.5' '"normal_offset_N"'
expect 2 init strokes
says "strokes/rig.toml: exists already; --force overwrites it"
same "$(cat strokes/*.csv | sha256sum)" "$before"

# what is asked for
expect 0 init strokes --force --every 2
same "$(grep -c '^name' strokes/rig.toml)" 2
expect 0 init strokes --force --take 'whole_1*' --take whole_3
same "$(grep '^name' strokes/rig.toml | tr '\n' ' ')" 'name = "whole_1" name = "whole_3" name = "whole_10" '
expect 0 init strokes --force --beta 0.095..0.11
same "$(grep '^name' strokes/rig.toml | tr '\n' ' ')" 'name = "whole_2" name = "whole_3" '
expect 2 init strokes --force --take nobody
says "none of its 4 recordings is one that was asked for"
expect 2 init strokes --force --beta 0.2
says "0.2 is no range, as 0.08..0.12"
expect 2 init none
says "none: no such folder"

# elsewhere, and in a binary form: the same numbers
expect 0 init strokes --out elsewhere --binary
complete elsewhere
expect 0 check elsewhere
says "whole_1 (bow, whole_1.npy)" "normal force 0.5 N" "0 error(s), 0 warning(s)"
[ ! -e strokes/whole_1.npy ] || { echo "FAILED: written beside the recordings"; failures=1; }
expect 0 init strokes --force --binary
expect 0 init strokes --force
says "4 take(s)"
grep -q '^file = "whole_1.npy"' strokes/rig.toml || { echo "FAILED: the binary form is not taken"; failures=1; }
expect 2 init . --take nobody

# folders of their own, as an archive has them
mkdir -p archive/r_v1 archive/r_v2
cp strokes/*_1.csv archive/r_v1
cp strokes/*_1.csv archive/r_v2
expect 0 init archive
same "$(grep '^name' archive/rig.toml | tr '\n' ' ')" 'name = "r_v1-whole_1" name = "r_v2-whole_1" '

# bad CODE TEXT: row 101 of a stroke (or each) is changed; init leaves the stroke out and says why
bad() {
  rm -rf bad
  machine bad 1
  PERL="$1" machine bad 2
  expect 1 init bad
  says "left out: bad/whole_2.csv" "$2"
}
bad '$text = "1,2,3" if $i == 100' "bad/whole_2.csv:101: has 3 column(s), the first line has 4"
bad '$text = "1,2,3,4,5" if $i == 100' "bad/whole_2.csv:101: has 5 column(s), the first line has 4"
bad '$text = "1,2,overload,4" if $i == 100' 'bad/whole_2.csv:101: column 3 (index 2): "overload" is not a number'
bad '$text = "1,2,nan,4" if $i == 100' 'bad/whole_2.csv:101: column 3 (index 2): "nan" is no finite number'
bad '$text = "1,2,,4" if $i == 100' 'bad/whole_2.csv:101: column 3 (index 2): is empty'
bad '$text =~ s/,/;/g; $text =~ s/\./,/g' 'has a decimal comma: export the table with points'
bad '$text =~ s/\./,/g' "if its numbers have decimal commas, export it with points"
bad '@x = (0.04, 0.05, 0.5, 0.06); $text = join(",", @x); $text =~ s/\./,/g' "seems to have decimal commas between columns that commas separate"
bad '$text = $eol = "" if $i == 9000; $text = "0.5,0.1" if $i > 8998 && $i < 9001' "column(s), the first line has 4"
bad '$x[1] = 0; $text = join(",", @x)' "channel bow: the bow does not move"
bad '$x[0] = -$x[0]; $text = join(",", @x)' "channel normal: the normal force is below zero"
bad '@x[2, 3] = @x[3, 2]; $text = join(",", @x)' "near and far are swapped"
rm -rf bad
machine bad 1
rm bad/beta_1.csv
echo "0.3,x" >bad/timestamp_1.csv
expect 0 init bad
says 'take whole_1: bad/timestamp_1.csv:1: column 2 (index 1): "x" is not a number'
grep -q '^# contact_position = .* to be filled in' bad/rig.toml || { echo "FAILED: no place for the position"; failures=1; }
complete bad
expect 2 check bad
says "contact.position: is missing"

# a rate that is not the true one, gaps in a column of times, columns that are not there
cp -r strokes wrong && sed -i 's/^rate_Hz = 50000/rate_Hz = 44100/' wrong/rig.toml
complete wrong
expect 1 check wrong
says "as if recorded at 50000 samples a second" "check the sample rate"
mkdir timed
perl -e 'print "time_s,near (N),far (N),speed (m/s),normal force\n"; for my $i (0 .. 4999) { my $t = $i + ($i > 3000 ? 25 : 0);
  printf "%.6f,%.5f,%.5f,0.1,0.5\n", $t / 10000, sin($i / 10) + 0.01 * rand(), 0.5 + sin($i / 10) + 0.01 * rand() }' >timed/bow-1.csv
expect 2 init timed
says "timed/bow-1.csv:3003: column 1 (time_s): the time jumps by 0.0026 s where a step is 0.0001 s: 25 row(s) are missing"
perl -i -pe 's/^([\d.]+)/sprintf("%.6f", ($. - 2) \/ 10000)/e if $. > 1' timed/bow-1.csv
expect 0 init timed
grep -q '^time_column = 0' timed/rig.toml && grep -q '^near = { column = "near (N)"' timed/rig.toml || { echo "FAILED: the header is not understood"; failures=1; }
grep -q '^bow = { column = "speed (m/s)", quantity = "bow-speed" }' timed/rig.toml || { echo "FAILED: no bow speed"; failures=1; }
sed -i 's/column = "near (N)"/column = "nearest"/; s/^# position = .*/position = 0.1/' timed/rig.toml
complete timed
expect 2 check timed
says 'has the columns time_s, near (N), far (N), speed (m/s), normal force, but channels.near.column is "nearest"'
sed -i '/^time_column/d' timed/rig.toml
expect 2 check timed
says "rate_Hz: is missing, and there is neither [files] rate_Hz nor [files] time_column"

# sound files: what they do not tell is to be filled in
make_rig sound
mv sound/rig.toml sound/other.toml
expect 0 init sound
says "3 take(s)"
grep -q '^kind = "pluck"' sound/rig.toml && grep -q '^# force_N' sound/rig.toml || { echo "FAILED: plucks are not prepared"; failures=1; }
grep -q '^# near = { index = 0, newtons_per_full_scale' sound/rig.toml || { echo "FAILED: no channels to fill in"; failures=1; }

finish
