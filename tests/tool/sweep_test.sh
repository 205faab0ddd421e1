# rosin sweep: the same plane at once, in shards, and gone on with after a stop; pictures; refusals.
. "$ROSIN_SOURCE/tests/tool/common.sh"

cat >rig.toml <<'TOML'
schema = 1
[string]
length_m = 0.33
tension_N = 45
fundamental_Hz = 392
bending_stiffness_Nm2 = 1e-5
quality = 300
[channels]
near = { index = 0, newtons_per_full_scale = 1 }
far = { index = 1, newtons_per_full_scale = 1 }
[contact]
position = 0.1
[torsion]
speed_ratio = 5
impedance_ratio = 2.5
q = 20
[[take]]
name = "bow-1"
kind = "bow"
file = "bow-1.wav"
speed_m_s = 0.1
normal_force_N = 0.2
TOML
plane=(rig.toml --position 0.08:0.16:2 --force-range 0.01:1:4 --periods 40 --rate 128000)

expect 0 sweep "${plane[@]}" --out whole.csv --svg whole.svg
says "whole.csv: 8 of 8 points"
no_messages
same "$(grep -c '^[0-9]' whole.csv)" 8
grep -q '<svg' whole.svg && grep -q 'Helmholtz' whole.svg || { echo "FAILED: no picture"; failures=$((failures + 1)); }

# what is heard at a hundredth of a newton is not what is heard at a newton
[ "$(awk -F, '/^[0-9]/ { print $4 }' whole.csv | sort -u | wc -l)" -ge 2 ] || { echo "FAILED: one regime everywhere"; failures=$((failures + 1)); }

# in shards
for k in 1 2; do expect 0 sweep "${plane[@]}" --out "part$k.csv" --shard "$k/2" --threads 1; says "4 of 8 points"; done
expect 0 sweep --merge part1.csv part2.csv --out merged.csv
cmp whole.csv merged.csv || failures=$((failures + 1))
expect 2 sweep --merge part1.csv part2.csv --out merged.csv
says "merged.csv: exists already; --force overwrites it"

# stopped in the middle of a line, then gone on with
head -c "$(($(wc -c <whole.csv) - 60))" whole.csv >stopped.csv
expect 0 sweep "${plane[@]}" --out stopped.csv --json
says '"points": 8' '"of": 8'
cmp whole.csv stopped.csv || failures=$((failures + 1))

# another plane is not mixed in
expect 2 sweep "${plane[@]}" --speed 0.3 --out stopped.csv
says "stopped.csv: holds another plane; --force overwrites it"
for changed in 's/^quality = 300/quality = 310/' 's/^length_m = 0.33/length_m = 0.34/' \
  '$a [terminations]\nfar = { modes = [{ frequency_Hz = 2400, q = 20, mass_kg = 0.01 }] }'; do
  sed "$changed" rig.toml >other.toml
  expect 2 sweep other.toml "${plane[@]:1}" --out stopped.csv
  says "stopped.csv: holds another plane; --force overwrites it"
done
expect 2 sweep --merge part1.csv rig.toml --out new.csv
says "rig.toml: is no file of rosin sweep"

# after Guettler
expect 0 sweep rig.toml --plane guettler --acceleration 1:10:2 --force-range 0.1:0.5:2 --periods 30 --rate 128000 --out guettler.csv
says "guettler.csv: 4 of 4 points"
grep -q '^index,acceleration_m_s2,force_N,' guettler.csv || { echo "FAILED: no header"; failures=$((failures + 1)); }

# what cannot be
expect 2 sweep rig.toml --out x.csv --shard 3/2
says "--shard: 3/2 is not K/N"
expect 2 sweep rig.toml --out x.csv --force-range 0:1:3
says "force_N: both ends must be above 0"
expect 2 sweep rig.toml --out x.csv --position 0.1:1.5:3
says "--position: must lie below 1"
expect 2 sweep rig.toml --out x.csv --force-range 0.1-0.5
says "is not FIRST:LAST:COUNT"
expect 2 sweep rig.toml --out x.csv --rate 100
says "--rate:"
expect 2 sweep none.toml --out x.csv
says "none.toml: cannot be read"
[ ! -e x.csv ] || { echo "FAILED: something was written"; failures=$((failures + 1)); }
# a contact in the clamp is a point that cannot be simulated, not the end of the sweep
expect 0 sweep rig.toml --position 0.001:0.1:2 --force-range 0.2:0.2:1 --periods 20 --rate 128000 --out edge.csv
says "impossible: 1"
finish
