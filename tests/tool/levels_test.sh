# The tool takes the vector unit of its machine from a library that is there for two levels: both give the same answers, to rounding.
. "$ROSIN_SOURCE/tests/tool/common.sh"
fail() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}
library=$(dirname "$tool")/../lib/rosin
fast=$library/glibc-hwcaps/x86-64-v3/librosin_compiled.so
if [ ! -e "$fast" ]; then
  echo "this tool is built for one level: nothing to compare"
  exit 0
fi
loader=$(ls /lib64/ld-linux-x86-64.so.2)
"$loader" --list --glibc-hwcaps-mask x86-64-v2 "$tool" | grep -q 'rosin/librosin_compiled.so' || fail "the base level is not found"
if "$loader" --help | grep -q 'x86-64-v3 (supported'; then
  "$loader" --list "$tool" | grep -q 'x86-64-v3/librosin_compiled.so' || fail "the machine has x86-64-v3, and its level is not taken"
else
  echo "this machine has no x86-64-v3: nothing to compare"
  exit 0
fi

perl "$ROSIN_SOURCE/tests/tool/closed_form_rig.pl" rig
expect 0 fit rig --json fast.json
"$loader" --glibc-hwcaps-mask x86-64-v2 "$tool" fit rig --json base.json >base.txt 2>&1 || fail "the base level does not run"
# Every number of the two calibrations, in order.
perl -e '
  sub numbers { open my $f, "<", shift; local $/; my $text = <$f>; $text =~ s/"(?:[^"\\]|\\.)*"//g; return $text =~ /-?\d+\.?\d*(?:[eE][-+]?\d+)?/g }
  my @a = numbers("fast.json"); my @b = numbers("base.json");
  die "other numbers\n" if @a != @b || @a < 20;
  for my $i (0 .. $#a) {
    my $size = abs($a[$i]) > abs($b[$i]) ? abs($a[$i]) : abs($b[$i]);
    die "$a[$i] and $b[$i]\n" if abs($a[$i] - $b[$i]) > 2e-3 * $size;
  }' || fail "the levels differ"
finish
