# rosin simulate: the recordings against the rig file and the truth, what it refuses, and that the truth stays out.
. "$ROSIN_SOURCE/tests/tool/common.sh"

cat >rig.toml <<'TOML'
# a comment that stays
schema = 1
title = "a test"

[string]
length_m = 0.314
tension_N = 72.5
fundamental_Hz = 660
bending_stiffness_Nm2 = 4.7e-5

[channels]
near = { index = 0, newtons_per_full_scale = 1.65, gain_tolerance = 0.05 }
far = { index = 1, newtons_per_full_scale = 1.96, gain_tolerance = 0.02 }

[contact]
position = 0.3

# what only the simulation knows
[friction]
terms = [
  { coefficient = 0.4, speed_m_s = 0.02 },
]
constant = 0.41234

[torsion]
speed_ratio = 7
impedance_ratio = 3.5
q = 15

[model]
friction = "velocity-curve"

[[take]]
name = "pluck-1"
kind = "pluck"
file = "pluck-1.wav"
force_N = 1.0
start_s = 0.0123

[[take]]
name = "quiet"
kind = "quiet"
file = "quiet.wav"

[simulate]
rate_Hz = 64000
duration_s = 0.1
noise_N = 4e-4

nominal_scatter = true
seed = 77

# the bowed take
[[take]]
name = "bow-1"
kind = "bow"
file = "more/bow-1.wav"
speed_m_s = 0.2
normal_force_N = 0.3
speed_profile_m_s = [
  [0, 0],
  [0.02, 0.2]]
TOML

# key TRUTH NAME: a number out of the truth
key() { sed -n "s/^ *\"$2\": \(-\{0,1\}[0-9.e+-]*\),\{0,1\}$/\1/p" "$1" | head -n 1; }
# holds EXPRESSION: an awk condition
holds() {
  awk "BEGIN { exit !($1) }" || { echo "FAILED: $1"; failures=$((failures + 1)); }
}
# samples FILE: the frames of a 16 bit WAV file of two channels
samples() { tail -c +45 "$1" | od -An -v -t d2 -w4; }

expect 0 simulate rig.toml --out made
says "pluck-1 (pluck, made/pluck-1.wav): 0.1 s at 64000 Hz" "stick-slip" "rig: made/rig.toml" "truth: made-truth/truth.json" \
  "assumed: simulate.bits = 16, none given"
no_messages
same "$(find made made-truth -type f | sort | tr '\n' ' ')" \
  "made-truth/bow-1.csv made-truth/truth.json made/more/bow-1.wav made/pluck-1.wav made/quiet.wav made/rig.toml "

# the folder is sound to the rest of the tool, and tells nothing of the truth
expect 0 validate made/rig.toml
expect 0 check made
says "0 error(s)"
for secret in "[simulate" "[friction" 0.41234 start_s 0.0123 4e-4 77 "only the simulation knows"; do
  grep -qF "$secret" made/rig.toml && { echo "FAILED: the rig file tells $secret"; failures=$((failures + 1)); }
done
same "$(tail -n +2 made/rig.toml | grep -c .)" "$(($(grep -c . rig.toml) - 13))"
for stays in "# a comment that stays" "# the bowed take" "\\[\\[take\\]\\]" "speed_profile_m_s = \\["; do
  grep -q "^$stays" made/rig.toml || { echo "FAILED: the rig file has lost $stays"; failures=$((failures + 1)); }
done

# drawn within the tolerances, and not at them
truth=made-truth/truth.json
same "$(key $truth seed)" 77
for name in length_m:0.314:0.002 tension_N:72.5:0.02 fundamental_Hz:660:0.003 bending_stiffness_Nm2:4.7e-5:0.05 force_N:1:0.03; do
  IFS=: read -r what nominal tolerance <<<"$name"
  value=$(key $truth "$what")
  holds "$value != $nominal && $value / $nominal - 1 <= $tolerance && 1 - $value / $nominal <= $tolerance"
done
near=$(key $truth gain) far=$(key <(sed -n '/"far": {/,$p' $truth) gain)
holds "$near != 1 && $near < 1.05 && $near > 0.95 && $far != 1 && $far < 1.02 && $far > 0.98 && $near != $far"

# while the wire holds, the ends carry force (1 - position) and force position, through the gains
position=$(key $truth position) force=$(key $truth force_N)
read -r mean_near mean_far sd < <(samples made/pluck-1.wav | head -n 700 | awk '
  { a += $1; b += $2; aa += $1 * $1 } END { print a / NR * 1.65 / 32768, b / NR * 1.96 / 32768, sqrt(aa / NR - a * a / NR / NR) * 1.65 / 32768 }')
holds "sqrt(($mean_near / ($near * $force * (1 - $position)) - 1) ^ 2) < 2e-4"
holds "sqrt(($mean_far / ($far * $force * $position) - 1) ^ 2) < 4e-4"
holds "$sd > 3.6e-4 && $sd < 4.4e-4"
# and lets go when the truth says so
same "$(key $truth release_s)" 0.0123
last=$(samples made/pluck-1.wav | awk -v hold="$(awk "BEGIN { print $mean_near / 1.65 * 32768 }")" '
  !at && sqrt(($1 - hold) ^ 2) > 60 { at = (NR - 1) / 64000 } END { print at }')
holds "$last > 0.0122 && $last < 0.0128"

# the truth of the bowed take: a row a sample; rod as in the profile; force within friction; momentum: the mean forces balance
awk -F, '/^#/ { next }
  !seen++ { if ($0 != "time_s,force_N,velocity_m_s,torsion_velocity_m_s,rod_velocity_m_s") { print "FAILED: header " $0; bad = 1 }; next }
  { n++; if ($2 > top) top = $2; if ($1 > 0.005 && $1 < 0.015) { d = $5 - 10 * $1; if (d * d > 1e-8) bad = 2 }
    if ($1 >= 0.05) { m++; v += $3; f += $2 } }
  END { if (n != 6400) { print "FAILED: " n " rows"; bad = 1 }
    if (top < 0.2 || top > 1.1 * 0.3 * 0.81234) { print "FAILED: force up to " top; bad = 1 }
    if (v / m > 0.02 || v / m < -0.02) { print "FAILED: the string drifts " v / m; bad = 1 }
    print f / m > "mean_force"; exit bad }' made-truth/bow-1.csv || failures=$((failures + 1))
read -r mean_near mean_far < <(samples made/more/bow-1.wav | tail -n +3201 | awk '
  { a += $1; b += $2 } END { print a / NR * 1.65 / 32768, b / NR * 1.96 / 32768 }')
holds "sqrt((($mean_near / $near + $mean_far / $far) / $(cat mean_force) - 1) ^ 2) < 1e-2"

# the same seed makes the same files, another seed others; npy and a truth in one file; nothing is overwritten
expect 0 simulate rig.toml --out again --truth again.json --format npy --json
says '"seed": 77' '"truth": "again-bow-1.npy"' '"motion": "stick-slip"' '"tool": "rosin"'
no_messages
same "$(ls again*.*)" "$(printf 'again-bow-1.npy\nagain.json')"
for file in pluck-1.wav quiet.wav more/bow-1.wav rig.toml; do cmp "made/$file" "again/$file" || failures=$((failures + 1)); done
expect 0 simulate rig.toml --out other --seed 78
cmp -s made/quiet.wav other/quiet.wav && { echo "FAILED: another seed, the same noise"; failures=$((failures + 1)); }
same "$(key other-truth/truth.json seed)" 78
expect 2 simulate rig.toml --out other
says "other/rig.toml: exists already; --force overwrites it"
rm other/rig.toml
expect 2 simulate rig.toml --out other --json
says '"errors": [' "other-truth/truth.json: exists already"
no_messages
expect 0 simulate rig.toml --out other --force
cmp made/quiet.wav other/quiet.wav || failures=$((failures + 1))
expect 2 simulate rig.toml --out new --truth new/truth
says "the truth must not lie in the folder of the recordings"
expect 2 simulate rig.toml --out .
says ".: is the folder of the rig file itself"

# every law, every channel, floating point, a rig file in which all stands in one line
cat >laws.toml <<'TOML'
schema = 1
string = { length_m = 0.65, tension_N = 70, fundamental_Hz = 196, quality = 700 }
simulate = { rate_Hz = 48000, duration_s = 0.03, bits = 0, seed = 3 }
friction = { static_coefficient = 0.8, dynamic_coefficient = 0.3, stribeck_speed_m_s = 0.1, ambient_C = 30 }
take = [ { name = "p", kind = "pluck", file = "p.wav", force_N = 1, start_s = 0.01 },
         { name = "b", kind = "bow", file = "b.wav", speed_m_s = 0.1, normal_force_N = 0.5 } ]
[channels]
far = { index = 0, newtons_per_full_scale = 2, ac_coupled_Hz = 5 }
near = { index = 2, newtons_per_full_scale = 2 }
magnet = { index = 3, quantity = "string-velocity" }
sled = { index = 4, quantity = "bow-speed", metres_per_second_per_full_scale = 1 }
press = { index = 5, quantity = "normal-force", newtons_per_full_scale = 2 }
spare = { index = 6, quantity = "unused" }
moved = { index = 7, quantity = "string-displacement", metres_per_full_scale = 0.01 }
[contact]
position = 0.2
[model]
friction = "elasto-plastic"
TOML
expect 0 simulate laws.toml --out elastic
says "note: friction.ambient_C has no meaning for the law elasto-plastic: not used" "note: no [torsion]" "assumed: friction.bristle_stiffness_N_m = 5e+05"
expect 0 check elastic
grep -qE "_coefficient|simulate =|start_s" elastic/rig.toml && { echo "FAILED: the rig file tells the friction"; failures=$((failures + 1)); }
grep -q PEAK elastic/p.wav && { echo "FAILED: the file holds the time of its making"; failures=$((failures + 1)); }
same "$(head -n 20 elastic-truth/b.csv | grep -c temperature_K)" 0
sed 's/"elasto-plastic"/"thermal"/' laws.toml >thermal.toml
expect 2 simulate thermal.toml --out thermal
says "thermal.toml: friction: yield curve: the steady temperature falls with speed at"
sed -i 's/static_coefficient.*_m_s = 0.1, //' thermal.toml
expect 0 simulate thermal.toml --out thermal
same "$(grep -v '^#' thermal-truth/b.csv | head -n 1)" time_s,force_N,velocity_m_s,torsion_velocity_m_s,rod_velocity_m_s,temperature_K
awk -F, '/^[0-9]/ { if (!n++) first = $6; if ($6 > top) top = $6 } END { exit !(first > 303.1 && first < 303.2 && top > 305 && top < 450) }' \
  thermal-truth/b.csv || { echo "FAILED: temperatures"; failures=$((failures + 1)); }

# refuse SED-SCRIPT MESSAGE…: one change to the rig file, and what is said of it
refuse() {
  local change=$1
  shift
  sed -E "$change" rig.toml >changed.toml
  cmp -s rig.toml changed.toml && { echo "FAILED: $change changes nothing"; failures=$((failures + 1)); }
  expect 2 simulate changed.toml --out refused
  says "$@"
  [ ! -e refused ] || { echo "FAILED: $change: something was made"; failures=$((failures + 1)); }
}
refuse 's/^tension_N = 72.5//' "changed.toml:5: string.tension_N: is missing"
refuse 's/^seed = 77/sead = 77/' "simulate.sead: unknown key; did you mean seed?"
refuse 's/^rate_Hz = 64000/rate_Hz = 1200/' "simulate.rate_Hz: 1200 Hz cannot hold the fundamental of 660 Hz"
refuse 's/^rate_Hz = 64000/rate_Hz = 64000.5/' "simulate.rate_Hz: must be a whole number"
refuse 's/^duration_s = 0.1/duration_s = 3000/' "simulate.duration_s: a take must have 2 to 4000000 samples"
refuse 's/^duration_s = 0.1/duration_s = 0.012/' 'take "pluck-1".start_s: the take ends before'
refuse 's/^start_s = 0.0123/start_s = 0/' 'take "pluck-1".start_s: the wire has to hold'
refuse 's/^force_N = 1.0/&\nposition_unknown = true/' 'take "pluck-1".position_unknown: a simulation has to know'
refuse 's/"pluck-1.wav"/"pluck-1.flac"/' 'take "pluck-1".file: is pluck-1.flac; simulated recordings are WAV files'
refuse 's/"pluck-1.wav"/"..\/pluck-1.wav"/' "leads out of the folder"
refuse 's/"pluck-1.wav"/"more\/..\/quiet.wav"/' "is the file of another take too"
refuse 's/^speed_m_s = 0.2/&\nstart_s = 0.01/' "stands beside speed_profile_m_s"
refuse 's|^\[torsion\]|[terminations]\nfar = { modes = [ { frequency_Hz = 460, q = 0, mass_kg = 0.1 } ] }\n\n&|' "terminations.far"
refuse 's/^friction = "velo/physics = ["torsion", "point-mass"]\n&/' 'model.physics: "point-mass" cannot be simulated'
refuse 's/^far = .*/&\nmicrophone = { index = 2, quantity = "sound" }/' "channels.microphone.quantity: sound cannot be simulated"
refuse 's/^far = .*/&\nmagnet = { index = 2, quantity = "string-velocity", position = 0.4 }/' "channels.magnet.position: is not the contact"
refuse 's/^constant = .*/&\nstatic_coefficient = 0.8/' "give one of them"
expect 2 simulate rig.toml --out new --seed -1
expect 2 simulate none.toml --out new
says "none.toml: cannot be read"
touch blocked
expect 2 simulate rig.toml --out blocked
says "blocked"

# with the model of a diagnosis: a bead is hidden, found by rosin diagnose, and put in again
cat >plain.toml <<'TOML'
schema = 1
string = { length_m = 0.33, tension_N = 55, fundamental_Hz = 440, quality = 900 }
contact = { position = 0.3 }
simulate = { rate_Hz = 16000, duration_s = 0.03, seed = 4 }
take = [ { name = "pluck-1", kind = "pluck", file = "pluck-1.wav", force_N = 1.0 } ]
[channels]
near = { index = 0, newtons_per_full_scale = 2, gain_tolerance = 0.05 }
far = { index = 1, newtons_per_full_scale = 2, gain_tolerance = 0.05 }
TOML
cat >bead.json <<'JSON'
{ "verdict": "explained", "calibration": { "fundamental_Hz": { "value": 440.3 } },
  "missing": [ { "effect": "point-mass", "where": { "position": 0.62 },
                 "parameters": { "position": { "value": 0.62 }, "mass_kg": { "value": 2e-6 } } } ] }
JSON
# residual MADE: rms of what two recordings of pluck-1 differ by / rms of the first, the larger of two channels
residual() { paste <(samples bead/pluck-1.wav) <(samples "$1/pluck-1.wav") | awk '
  { a += ($1 - $3) ^ 2; b += ($2 - $4) ^ 2; aa += $1 ^ 2; bb += $2 ^ 2 } END { a /= aa; b /= bb; print sqrt(a > b ? a : b) }'; }
expect 0 simulate plain.toml --model bead.json --out bead
says "with: point-mass"
grep -q '"point-mass"' bead-truth/truth.json || { echo "FAILED: the truth does not tell the bead"; failures=$((failures + 1)); }
grep -q "bead\|point-mass\|0.62" bead/rig.toml && { echo "FAILED: the rig file tells the bead"; failures=$((failures + 1)); }
expect 0 diagnose bead --json found.json
says "point-mass"
expect 0 simulate bead --model found.json --out again-with-bead   # rate and duration: those of the recording
says "0.03 s at 16000 Hz" "with: point-mass"
perl -MJSON::PP -e 'local $/; my $d = decode_json(<STDIN>); $d->{missing} = []; print encode_json($d)' <found.json >none.json
expect 0 simulate bead --model none.json --out without
is_silent_about "with:"
with=$(residual again-with-bead) without=$(residual without)
holds "$with < 0.005 && $without > 0.3"

# every effect that can be simulated, at once (one law of friction at a time); what cannot be is refused by its name
cat >>plain.toml <<'TOML'
[torsion]
speed_ratio = 5
impedance_ratio = 3
q = 15
TOML
sed -i 's/^\(take = .*\) ]$/\1, { name = "bow-1", kind = "bow", file = "bow-1.wav", speed_m_s = 0.2, normal_force_N = 0.5 } ]/' plain.toml
cat >all.json <<'JSON'
{ "verdict": "unexplained", "calibration": { "fundamental_Hz": { "value": 440.3 }, "ln_gain_near": { "value": 0.01 } }, "missing": [
  { "effect": "bending-stiffness", "parameters": { "bending_stiffness_Nm2": { "value": 5e-5 } } },
  { "effect": "frequency-dependent-loss", "parameters": { "loss_internal_s": { "value": 2e-7 } } },
  { "effect": "air-loss", "parameters": { "loss_air_sqrt_Hz": { "value": 1e-2 } } },
  { "effect": "tension-modulation", "parameters": { "axial_stiffness_N": { "value": 10000 } } },
  { "effect": "second-polarization", "parameters": { "detuning": { "value": 3e-3 }, "coupling": { "value": 0.05 } } },
  { "effect": "point-mass", "parameters": { "position": { "value": 0.62 }, "mass_kg": { "value": 2e-6 } } },
  { "effect": "point-damper", "parameters": { "position": { "value": 0.8 }, "resistance_Ns_m": { "value": 1e-3 } } },
  { "effect": "support-resonance", "where": { "end": "far" }, "parameters": { "frequency_Hz": { "value": 3000 }, "q": { "value": 15 }, "mass_kg": { "value": 0.004 } } },
  { "effect": "ac-coupling", "parameters": { "cutoff_Hz": { "value": 5 } } },
  { "effect": "sensor-resonance", "where": { "channel": "near" }, "parameters": { "frequency_Hz": { "value": 6000 }, "q": { "value": 12 } } },
  { "effect": "channel-skew", "parameters": { "skew_s": { "value": 2e-6 } } },
  { "effect": "channel-crosstalk", "parameters": { "fraction": { "value": 0.02 } } },
  { "effect": "sensor-nonlinearity", "where": { "channel": "far" }, "parameters": { "quadratic_per_N": { "value": 0.03 } } },
  { "effect": "mains-hum", "parameters": { "frequency_Hz": { "value": 50 }, "amplitude_N": { "value": 0.01 } } },
  { "effect": "slow-release", "parameters": { "duration_s": { "value": 4e-5 } } },
  { "effect": "finite-pluck-width", "parameters": { "width_m": { "value": 0.003 } } },
  { "effect": "phantom-partials", "where": { "channel": "near" }, "parameters": { "sensed_axial_stiffness_N": { "value": 1000 } } },
  { "effect": "clock-drift", "parameters": { "relative": { "value": 2e-5 } } },
  { "effect": "torsion", "parameters": { "speed_ratio": { "value": 6 }, "impedance_ratio": { "value": 3 }, "q": { "value": 15 } } },
  { "effect": "tension-drift", "parameters": { "relative": { "value": 0.01 } } },
  { "effect": "rod-resonance", "parameters": { "frequency_Hz": { "value": 1500 }, "q": { "value": 10 }, "mass_kg": { "value": 0.003 } } },
  { "effect": "finite-contact-width", "parameters": { "width_m": { "value": 0.004 } } },
  { "effect": "speed-ripple", "parameters": { "frequency_Hz": { "value": 120 }, "relative": { "value": 0.03 } } },
  { "effect": "elasto-plastic-friction", "parameters": { "bristle_stiffness_N_m": { "value": 20000 } } } ] }
JSON
expect 0 simulate plain.toml --model all.json --out all
says "with: elasto-plastic-friction" 'all.json: its verdict is "unexplained"' "mains-hum: a diagnosis tells neither phase" "speed-ripple: a diagnosis tells no phase"
same "$(grep -c '^with: ' out.txt)" 24
same "$(key all-truth/truth.json bristle_stiffness_N_m)" 20000.0
same "$(key all-truth/truth.json speed_ratio)" 6.0
expect 0 check all
says "the sensor seems to be AC coupled"
is_silent_about "clipped"
sed 's/point-mass/gremlins/' bead.json >changed.json
expect 2 simulate plain.toml --model changed.json --out refused
says 'changed.json: "gremlins" cannot be simulated'
sed 's/mass_kg/mass/' bead.json >changed.json
expect 2 simulate plain.toml --model changed.json --out refused
says '"point-mass" cannot be simulated: it has no mass_kg'
sed 's/fundamental_Hz/pitch/' bead.json >changed.json
expect 2 simulate plain.toml --model changed.json --out refused
says 'calibration has no "fundamental_Hz"'
expect 2 simulate plain.toml --model plain.toml --out refused
says "plain.toml: is no diagnosis"
expect 2 simulate plain.toml --model nothing.json --out refused
says "nothing.json"

# clipping and a string that does not slip are said
sed 's/1.65/0.5/; s/normal_force_N = 0.3/normal_force_N = 30/' rig.toml >loud.toml
expect 0 simulate loud.toml --out loud
says "warning: take pluck-1, channel near:" "samples beyond full scale" "warning: take bow-1: the string is sticking in the second half"

# a bow that travels along the string, and one that is lifted; the books of energy
sed 's/^normal_force_N = 0.3/&\nposition_profile = [[0, 0.3], [0.1, 0.27]]/' rig.toml >travels.toml
expect 0 simulate travels.toml --out travels
says "stick-slip"
holds "$(key travels-truth/truth.json string_error) ^ 2 < 1e-20 && $(key travels-truth/truth.json error) ^ 2 < 1e-4 && $(key travels-truth/truth.json rod_J) > 0"
grep -q '"position_profile"' travels-truth/truth.json || { echo "FAILED: the truth does not tell the way"; failures=$((failures + 1)); }
grep -q "^position_profile" travels/rig.toml || { echo "FAILED: the rig file does not tell the way"; failures=$((failures + 1)); }
expect 0 check travels
sed 's/^normal_force_N = 0.3/&\nnormal_force_profile_N = [[0.04, 0.3], [0.045, 0]]/' rig.toml >lifted.toml
expect 0 simulate lifted.toml --out lifted
says "stick-slip"
refuse 's/^normal_force_N = 0.3/&\nposition_profile = [[0, 0.3], [0.1, 1.2]]/' "position_profile[1][1]: must be larger than 0 and less than 1"
# on an end that moves a bow travels by waves: where its way leads nowhere it does what the modes do
sed '/^moved/d; s/^take/terminations = { far = { modes = [ { frequency_Hz = 460, q = 9, mass_kg = 0.1 } ] } }\n&/' thermal.toml >moving.toml
sed 's/normal_force_N = 0.5/&, position_profile = [[0, 0.2]]/' moving.toml >there.toml
sed 's/normal_force_N = 0.5/&, position_profile = [[0, 0.2], [0.03, 0.15]]/' moving.toml >moves.toml
for name in moving there moves; do expect 0 simulate $name.toml --out $name --truth $name-truth; done
expect 0 compare there-truth/b.csv moving-truth/b.csv --at-most 0.02
expect 1 compare moves-truth/b.csv moving-truth/b.csv --at-most 0.1

# rosin compare: against itself, against another take, and what does not belong together
expect 0 compare made-truth/bow-1.csv made-truth/bow-1.csv --at-most 0
says "force_N: Delta 0.00000; scale 1.00000"
expect 1 compare thermal-truth/b.csv elastic-truth/b.csv --at-most 0.01
awk -F, -v CONVFMT=%.17g '/^[0-9]/ { $2 = $2 * 1.02; $3 *= 0.99 } { print }' OFS=, made-truth/bow-1.csv >scaled.csv
expect 0 compare scaled.csv made-truth/bow-1.csv --at-most 1e-6
says "scale 1.02000" "scale 0.99000"
expect 0 compare scaled.csv made-truth/bow-1.csv --json
says '"delta_after_scale": ' '"pass_Hz": 19200'
expect 2 compare made-truth/bow-1.csv elastic-truth/b.csv
says "not the same take"
sed 's/^# truth of take bow-1/# truth of take bow-2/' made-truth/bow-1.csv >other-take.csv
expect 2 compare other-take.csv made-truth/bow-1.csv
says "other-take.csv is of take bow-2, made-truth/bow-1.csv of take bow-1: not the same take"
expect 2 compare made-truth/truth.json made-truth/bow-1.csv
awk -F, '/^[0-9]/ && ++n == 1000 { $2 = "" } { print }' OFS=, made-truth/bow-1.csv >gap.csv
expect 2 compare gap.csv made-truth/bow-1.csv --at-most 0.01
says "gap.csv: force_N: no value in row 1000, between rows that have one"
expect 2 compare made-truth/bow-1.csv scaled.csv --at-most nan
says "nan is no finite number"
finish
