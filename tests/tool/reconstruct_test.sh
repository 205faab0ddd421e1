# rosin reconstruct: the contact force that the recordings were made from, the format of what is written, and what is refused.
. "$ROSIN_SOURCE/tests/tool/common.sh"
perl "$ROSIN_SOURCE/tests/tool/closed_form_rig.pl" rig

# differs FILE: Delta of force_N against the truth, after one scale factor, and that factor; mean taken out.
differs() {
  perl -e '
    open my $t, "<", "rig/truth.csv"; my @truth = <$t>;
    open my $f, "<", $ARGV[0]; my ($column, @x, @y, $row);
    while (<$f>) {
      next if /^#/;
      chomp; my @c = split /,/, $_, -1;
      if (!defined $row) { $row = 0; ($column) = grep { $c[$_] eq "force_N" } 0 .. $#c; next }
      if ($c[$column] ne "" && $c[0] < 0.125) { push @x, $c[$column]; push @y, $truth[$row] }
      $row++;
    }
    my ($mx, $my, $xx, $xy, $yy) = (0) x 5;
    $mx += $_ / @x for @x; $my += $_ / @y for @y;
    for my $i (0 .. $#x) { my ($a, $b) = ($x[$i] - $mx, $y[$i] - $my); $xx += $a * $a; $xy += $a * $b; $yy += $b * $b }
    my $s = $xy / $xx;
    printf "%.5f %.5f %d %d\n", sqrt(($s * $s * $xx - 2 * $s * $xy + $yy) / ($s * $s * $xx + $yy)), $s, scalar @truth, $row' "$1"
}
below() {
  perl -e 'exit !($ARGV[0] < $ARGV[1])' -- "$2" "$3" && return 0
  echo "FAILED: $1 is $2, not below $3"
  failures=$((failures + 1))
}

expect 0 reconstruct rig --take bow-1 --out a.csv
says "Delta of the two versions" "fine tuning" "common scale"
is_silent_about "the search had to move"
read -r delta scale truth_rows rows < <(differs a.csv)
below "Delta against the truth" "$delta" 0.012   # sensor noise of 0.25 mN on humps of some 40 mN, to 14.4 kHz
below "scale's error" "$(perl -e "print abs($scale - 1)")" 0.04
same "$rows" "$truth_rows"
expect 0 validate a.csv
grep -q "^# input .*bow-1.wav sha256 $(sha256sum rig/bow-1.wav | cut -d' ' -f1)" a.csv || { echo "FAILED: no checksum"; failures=1; }
grep -q '^# assumed: impedance_Ns_m' a.csv || { echo "FAILED: no assumed values"; failures=1; }
same "$(grep -v '^#' a.csv | head -1 | cut -d, -f1-10)" \
  "time_s,force_N,velocity_m_s,force_near_N,force_far_N,velocity_near_m_s,velocity_far_m_s,force_sd_N,velocity_sd_m_s,torsion_velocity_m_s"
same "$(grep -v '^#' a.csv | sed -n 2p | cut -d, -f2-7)" ",,,,,"   # what cannot be known is empty

# the same through a calibration file, bit for bit but for its name
expect 0 fit rig --json fit.json
expect 0 reconstruct rig --take bow-1 --calibration fit.json --out b.csv
read -r delta_file _ < <(differs b.csv)
same "$delta_file" "$delta"

# a lower band holds less noise; the paper's processing is another one; no tuning leaves the plucks' word
expect 0 reconstruct rig --take bow-1 --out c.csv --pass 5000 --stop 8000 --calibration fit.json --no-fine-tune
read -r low _ < <(differs c.csv)
below "Delta below 5 kHz" "$low" "$delta"
expect 0 reconstruct rig --take bow-1 --out d.csv --paper --calibration fit.json --no-fine-tune
read -r paper _ < <(differs d.csv)
below "Delta" "$delta" "$paper"
expect 0 reconstruct rig --take bow-1 --no-fine-tune --calibration fit.json --json n.json
grep -q '"fine_tuning": null' n.json || { echo "FAILED: fine tuning although switched off"; failures=1; }

# the slips, one by one: each row again from the samples between its times
expect 0 reconstruct rig --take bow-1 --out s.csv --slips slips.csv --json s.json --calibration fit.json --no-fine-tune
says "loops of force against velocity: no sense"   # humps of a force that no friction made
grep -q '"sense": "none"' s.json || { echo "FAILED: no loops in the summary"; failures=1; }
perl -e '
  sub rows { open my $f, "<", $_[0] or die; my (@name, @out);
    while (<$f>) { next if /^#/; chomp; my @c = split /,/, $_, -1; if (!@name) { @name = @c } else { my %r; @r{@name} = @c; push @out, \%r } } @out }
  my @take = rows("s.csv"); my ($bad, $n, $rod, $rate) = (0, 0, 0.3, 48000);
  my $near = sub { my ($what, $a, $b, $scale) = @_; if (abs($a - $b) > 1e-4 * $scale) { print "FAILED: $what $a is not $b\n"; $bad = 1 } };
  for my $s (rows("slips.csv")) {
    my ($i, $j) = map { int($s->{$_} * $rate + 0.5) } "begin_s", "end_s";
    my @v = map { $_->{velocity_m_s} + $_->{torsion_velocity_m_s} - $rod } @take[$i .. $j]; my @f = map { $_->{force_N} } @take[$i .. $j];
    my ($way, $work, $area, $fast) = (0) x 4;
    for my $k (0 .. $#v) {
      $fast = -$v[$k] if abs($v[$k]) > abs($fast);
      if ($k) { $way -= ($v[$k] + $v[$k - 1]) / (2 * $rate); $work -= ($v[$k] * $f[$k] + $v[$k - 1] * $f[$k - 1]) / (2 * $rate) }
      $area += ($v[$k - 1] * $f[$k] - $v[$k] * $f[$k - 1]) / 2;   # $k - 1 = -1: the last
    }
    $near->("distance", $s->{distance_m}, $way, 1e-3);
    $near->("work", $s->{dissipated_J}, $work, 1e-4);
    $near->("area", $s->{loop_area_W}, $area, 0.1);
    $near->("speed", $s->{fastest_m_s}, $fast, 1);
    $near->("place", $s->{to_m} - $s->{from_m}, $take[$j]{place_on_rod_m} - $take[$i]{place_on_rod_m}, 1e-3);
    $n++;
  }
  print "FAILED: $n slips\n" if $n < 10;
  exit($bad || $n < 10)' || failures=$((failures + 1))
expect 2 reconstruct rig --take bow-1 --slips slips.csv
says "slips.csv: exists already"

# other forms
expect 0 reconstruct rig --take bow-1 --out a.npy --format npy --calibration fit.json --no-fine-tune
same "$(head -c 6 a.npy | tail -c 5)" NUMPY
expect 0 reconstruct rig --take bow-1 --out - --pass 5000 --calibration fit.json --no-fine-tune
grep -q '^time_s,force_N' out.txt || { echo "FAILED: no table on standard output"; failures=1; }
expect 0 reconstruct rig --take bow-1 --json --calibration fit.json --no-fine-tune
says '"format": "reconstruction-summary"'
expect 2 reconstruct rig --take bow-1 --out a.csv
says "a.csv: exists already; --force overwrites it"
expect 0 reconstruct rig --take bow-1 --out a.csv --force --calibration fit.json --no-fine-tune

# AC coupled: the mean is unknown, and is estimated aloud
perl "$ROSIN_SOURCE/tests/tool/closed_form_rig.pl" ac ac
expect 0 reconstruct ac --take bow-1 --out ac.csv
says "AC coupled sensors; estimated as"
read -r delta_ac _ < <(differs ac.csv)
below "Delta, AC coupled" "$delta_ac" 0.03

# a bow that is lifted: the string rings on, at the pitch and with the loss that it was made with
cat >lifted.toml <<'TOML'
schema = 1
string = { length_m = 0.314, tension_N = 72.5, fundamental_Hz = 660, bending_stiffness_Nm2 = 4.7e-5, quality = 800 }
contact = { position = 0.3 }
simulate = { rate_Hz = 64000, duration_s = 0.2, seed = 4 }
model = { physics = ["bending-stiffness"], friction = "velocity-curve" }
take = [ { name = "pluck-1", kind = "pluck", file = "pluck-1.wav", force_N = 1.0 },
  { name = "pluck-2", kind = "pluck", file = "pluck-2.wav", force_N = 0.6 },
  { name = "bow-1", kind = "bow", file = "bow-1.wav", speed_m_s = 0.3, normal_force_N = 0.3, normal_force_profile_N = [[0.06, 0.3], [0.064, 0]] } ]
[channels]
near = { index = 0, newtons_per_full_scale = 2 }
far = { index = 1, newtons_per_full_scale = 2 }
TOML
expect 0 simulate lifted.toml --out lifted
expect 0 reconstruct lifted --take bow-1 --out lifted.csv --json lifted.json
says "free decay at the end: the bow is off from 0.06" "against the plucks; Q"
perl -MJSON::PP -e 'local $/; my $d = decode_json(<STDIN>); my $f = $d->{free_decay};
  exit !(abs($f->{fundamental_Hz} / 660 - 1) < 6e-5 && abs($f->{cents_from_plucks}) < 0.2 && abs(800 * $f->{loss}[0]{inverse_q} - 1) < 0.01
         && $f->{begin_s} < 0.066 && $d->{slips}[-1][1] <= $f->{begin_s})' <lifted.json || { echo "FAILED: the free decay is not the string that was bowed"; failures=$((failures + 1)); }

# what cannot be done is said
expect 2 reconstruct rig --take bow-2
says 'no take "bow-2"; bowed takes: bow-1'
expect 2 reconstruct rig --take pluck-1
says "of kind pluck"
expect 2 reconstruct rig --take bow-1 --pass 20 --stop 40
says "--pass 20 --stop 40: pass, and the distance from pass to stop, have to be at least the fundamental"
expect 2 reconstruct rig --take bow-1 --pass 20000 --stop 30000
says "half the sampling rate"
expect 2 reconstruct rig --take bow-1 --calibration rig/rig.toml
says "is not JSON"
echo '{"missing": []}' >other.json
expect 2 reconstruct rig --take bow-1 --calibration other.json
says "other.json: is no calibration by force plucks"
expect 2 reconstruct rig --take bow-1 --pass nan
says "nan is no finite number"
echo '{"format": "calibration", "kind": "force-plucks", "schema": 1}' >empty.json
expect 2 reconstruct rig --take bow-1 --calibration empty.json
expect 2 reconstruct rig --take bow-1 --model empty.json
says "is no diagnosis"
echo '{"missing": [], "calibration": {}}' >bare.json
expect 2 reconstruct rig --take bow-1 --model bare.json
says 'calibration has no "fundamental_Hz"'
cp -r rig short
perl -e 'my $d = "\0" x 400; open my $f, ">:raw", "short/bow-1.wav"; print $f "RIFF", pack("V", 36 + length $d), "WAVEfmt ", pack("VvvVVvv", 16, 1, 2, 48000, 192000, 4, 16), "data", pack("V", length $d), $d'
expect 2 reconstruct short --take bow-1
sed '/^near/d; s/^far/coil/; s/gain_tolerance.*/quantity = "string-velocity", position = 0.2 }/; s/index = 1/index = 0/' rig/rig.toml >short/rig.toml
expect 2 reconstruct short --take bow-1

# what cannot be so: a speed in mm/s, a normal force in the wrong decade; the table is written all the same
cp -r rig wrong
sed -i 's/^speed_m_s = 0.3/speed_m_s = 30/' wrong/rig.toml
expect 1 reconstruct wrong --take bow-1 --calibration fit.json --out wrong.csv
says "no slip was found" "with a speed = 0.3 it would be"
expect 0 validate wrong.csv

if command -v gnuplot >/dev/null; then
  expect 0 reconstruct rig --take bow-1 --report page.html
  grep -q 'place of the contact on the rod' page.html || { echo "FAILED: no track along the rod"; failures=1; }
  [ "$(grep -c '<svg' page.html)" -ge 6 ] || { echo "FAILED: figures are missing"; failures=1; }
else
  echo "skipped: the report, no gnuplot"
fi
finish
