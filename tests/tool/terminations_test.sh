# Terminations that move, the whole way: simulated as declared, found again from the plucks, and reconstructed with.
. "$ROSIN_SOURCE/tests/tool/common.sh"

cat >rig.toml <<'TOML'
schema = 1
title = "a far end that moves"

[string]
length_m = 0.33
tension_N = 55
fundamental_Hz = 440
bending_stiffness_Nm2 = 6e-5
quality = 900

[channels]
near = { index = 0, newtons_per_full_scale = 2, gain_tolerance = 0.05 }
far = { index = 1, newtons_per_full_scale = 2, gain_tolerance = 0.05 }

[contact]
position = 0.3

[terminations]
near = "rigid"
far = { modes = [ { frequency_Hz = 2400, q = 12, mass_kg = 0.004 } ] }

[torsion]
speed_ratio = 5.5
impedance_ratio = 2.8
q = 25

[friction]
terms = [ { coefficient = 0.4, speed_m_s = 0.02 } ]
constant = 0.41

[model]
physics = ["bending-stiffness", "torsion"]
friction = "velocity-curve"

[simulate]
rate_Hz = 32000
duration_s = 0.08
noise_N = 1e-4
seed = 5

[[take]]
name = "pluck-1"
kind = "pluck"
file = "pluck-1.wav"
force_N = 1.0

[[take]]
name = "pluck-2"
kind = "pluck"
file = "pluck-2.wav"
force_N = 1.0
contact_position = 0.18

[[take]]
name = "bow-1"
kind = "bow"
file = "bow-1.wav"
speed_m_s = 0.15
normal_force_N = 1.2
TOML

holds() {
  awk "BEGIN { exit !($1) }" || { echo "FAILED: $1"; failures=$((failures + 1)); }
}
# delta RESULT KEY: of force_N and velocity_m_s against the truth
delta() { "$tool" compare "$1" made-truth/bow-1.csv --json | sed -n "s/^ *\"$2\": \([0-9.e+-]*\),*$/\1/p" | head -n 2 | paste -s -d ' '; }

expect 0 simulate rig.toml --out made
says "stick-slip"
grep -A 6 '"terminations"' made-truth/truth.json | grep -q '"mass_kg": 0.004' || { echo "FAILED: the truth does not tell the termination"; failures=$((failures + 1)); }
for end in fit rigid; do
  mkdir $end
  ln made/*.wav $end
  sed "s/^far = { modes.*/far = \"$end\"/" made/rig.toml >$end/rig.toml
done

# the plucks tell frequency, Q and mass: the heaviest share of the far end's admittance is the mode that was declared
expect 0 fit fit --json fit.json
read -r frequency quality mass < <(perl -MJSON::PP -e '
  local $/; open my $f, "<", "fit.json" or die;
  my @modes = sort { $a->{mass_kg}{value} <=> $b->{mass_kg}{value} } @{decode_json(<$f>)->{terminations}{far}};
  print join(" ", map { $modes[0]{$_}{value} } "frequency_Hz", "q", "mass_kg"), "\n"')
holds "sqrt(($frequency / 2400 - 1) ^ 2) < 0.003"
holds "sqrt(($quality / 12 - 1) ^ 2) < 0.05"
holds "sqrt(($mass / 0.004 - 1) ^ 2) < 0.05"

# force and velocity under the bow: with the end as fitted against an end taken for rigid
expect 0 reconstruct fit --take bow-1 --calibration fit.json --out fitted.csv
expect 0 reconstruct rigid --take bow-1 --out rigid.csv
read -r rigid_N rigid_m_s < <(delta rigid.csv delta)
read -r off_N off_m_s < <(delta fitted.csv delta)
holds "$off_N < 0.007 && $off_N < 0.5 * $rigid_N"
holds "$off_m_s < 0.007 && $off_m_s < 0.5 * $rigid_m_s"

# a diagnosis begins with what is declared, and names what is not; a corrected model keeps both
expect 0 diagnose made --json declared.json
says "no-mismatch"
expect 0 diagnose rigid --json named.json
says "explained" "support-resonance, far end"
for end in made rigid; do
  expect 0 simulate $end --model "$([ $end = made ] && echo declared || echo named).json" --out $end-again
  grep -A 6 '"terminations"' $end-again-truth/truth.json | grep -q '"mass_kg": 0.00\(39\|40\)' || { echo "FAILED: the corrected model of $end has lost the termination"; failures=$((failures + 1)); }
done

# the same end as a file: the same motion, but for what a table cannot hold
awk 'BEGIN {
  print "frequency_Hz,admittance_re,admittance_im"
  for (f = 10; f <= 12000; f += 10) {
    w = 2 * 3.14159265358979 * f; w0 = 2 * 3.14159265358979 * 2400; a = w0 * w0 - w * w; b = w * w0 / 12; d = 0.004 * (a * a + b * b)
    printf "%g,%.9g,%.9g\n", f, w * b / d, w * a / d
  }
}' >bridge.csv
sed 's/^far = { modes.*/far = "bridge.csv"/' rig.toml >table.toml
expect 0 simulate table.toml --out of-table
says "note: terminations.far: bridge.csv: by "
cmp -s bridge.csv of-table/bridge.csv || { echo "FAILED: the table is not beside the rig file that names it"; failures=$((failures + 1)); }
mkdir taken
cp bridge.csv taken
expect 2 simulate table.toml --out taken
says "taken/bridge.csv: exists already"
read -r table_N table_m_s < <("$tool" compare of-table-truth/bow-1.csv made-truth/bow-1.csv --json | sed -n "s/^ *\"delta\": \([0-9.e+-]*\),*$/\1/p" | head -n 2 | paste -s -d ' ')
holds "$table_N < 0.05"
holds "$table_m_s < 0.05"

expect 0 diagnose of-table --json table.json
says "no-mismatch" "terminations.far: bridge.csv: by "

# noise in a file is repaired, and told; what takes no energy at all is refused
awk -F, 'NR % 40 == 3 { $2 = -$2 / 10 } { print $1 "," $2 "," $3 }' bridge.csv >noisy.csv
sed 's/^far = { modes.*/far = "noisy.csv"/; s/^duration_s.*/duration_s = 0.01/' rig.toml >noisy.toml
expect 0 simulate noisy.toml --out noisy
says "terminations.far: noisy.csv: negative real parts ("
awk -F, 'NR > 1 { $2 = -$2 } { print $1 "," $2 "," $3 }' bridge.csv >active.csv
sed 's/^far = { modes.*/far = "active.csv"/' rig.toml >active.toml
expect 2 simulate active.toml --out refused
says "active.toml: terminations.far: active.csv: the admittance is not passive"

# what the simulation has no means for
sed 's/^far = { modes.*/far = "fit"/' rig.toml >fit.toml
expect 2 simulate fit.toml --out refused
says 'fit.toml: terminations.far: "fit" cannot be simulated: it asks the plucks, and there are none yet; declare "rigid", modes or a file'
printf 'frequency_Hz,admittance_re,admittance_im\n100,1e-3,0\n9000,1e-3,0\n' >short.csv
sed 's/^far = { modes.*/far = "short.csv"/' rig.toml >short.toml
expect 2 simulate short.toml --out refused
says "short.toml: terminations.far: short.csv: an admittance needs 8 points at least"
mkdir inner
sed 's/^far = { modes.*/far = "..\/bridge.csv"/' rig.toml >inner/rig.toml
expect 2 simulate inner --out refused
says "terminations.far: ../bridge.csv leads out of the folder of the rig"
sed 's/^near = { index.*/&\nmoved = { index = 2, quantity = "string-displacement", metres_per_full_scale = 0.01 }/' rig.toml >moved.toml
expect 2 simulate moved.toml --out refused
says "channels.moved.quantity: a displacement cannot be simulated where [terminations] move"
finish
