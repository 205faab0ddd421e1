# rosin validate: each of the three formats, sound and with one thing wrong.
. "$ROSIN_SOURCE/tests/tool/common.sh"
formats=$ROSIN_SOURCE/docs/formats

for format in rig reconstruction diagnosis; do
  "$tool" validate --print-schema "$format" | cmp - "$formats/$format.schema.json" || { echo "FAILED: schema $format"; failures=1; }
done
expect 2 validate
expect 2 validate none.toml
expect 2 validate --print-schema nonsense

# bad FORMAT-FILE POINTER SED-SCRIPT…: one change, and where the schema says it is wrong
bad() {
  local file=$1 place=$2
  sed -E "$3" "$file" >"changed.${file##*.}"
  cmp -s "$file" "changed.${file##*.}" && { echo "FAILED: $3 changes nothing"; failures=1; }
  expect 1 validate "changed.${file##*.}"
  says "$place" "not a valid"
}

make_rig rig
cp rig/rig.toml rig.toml
expect 0 validate rig.toml
says "rig.toml: a valid rig"
bad rig.toml "changed.toml:6: /string/tension_N: " 's/^tension_N = 70/tension_N = -70/'
bad rig.toml "changed.toml:4: /string: " 's/^tension_N/tension_n/'
bad rig.toml "changed.toml:5: /string/length_m: " 's/^length_m = .*/length_m = "long"/'
bad rig.toml "changed.toml:1: /: " 's/^schema.*//'
bad rig.toml "changed.toml:1: /schema: " 's/^schema.*/schema = 2/'
bad rig.toml "changed.toml:10: /channels/near: " 's/newtons_per_full_scale = 2, gain_tolerance = 0.05/gain_tolerance = 0.05/'
bad rig.toml "changed.toml:14: /contact/position: " 's/^position = 0.3/position = 1.3/'
bad rig.toml "changed.toml:18: /take/0/kind: " 's/^kind = "pluck"/kind = "plonk"/'
bad rig.toml "/take/0: " 's/^force_N = 1.0//'
bad rig.toml "/take/2: " 's/^file = "quiet.wav"/file = "quiet.wav"\nspeed_m_s = 1/'
expect 1 validate changed.toml --json
says '"valid": false' '"pointer": "/take/2"' '"format": "rig"'
echo 'a = ' >broken.toml
expect 2 validate broken.toml
says "broken.toml:1: "

cat >result.csv <<'CSV'
# rosin 0.1.0 reconstruct
# take bow-1
time_s,force_N,velocity_m_s,force_near_N,force_far_N,velocity_near_m_s,velocity_far_m_s,force_sd_N,velocity_sd_m_s,torsion_velocity_m_s
0,,,,,,,,,
7.8125e-06,0.1,0.2,0.1,0.1,0.2,0.2,0.001,0.002,0
1.5625e-05,0.11,0.2,0.1,0.1,0.2,0.2,0.001,0.002,0
CSV
expect 0 validate result.csv
says "result.csv: a valid reconstruction"
bad result.csv "/columns: " 's/force_sd_N/force_error_N/'
bad result.csv "/data/time_s/ascending: " 's/^7.8125e-06,/2e-05,/'
bad result.csv "/data/time_s/empty: " 's/^0,/,/'
bad result.csv "/data/force_sd_N/minimum: " 's/0.1,0.2,0.2,0.001/0.1,0.2,0.2,-0.001/'
bad result.csv "/comments: " 's/^#.*//'
sed 's/^0,/0,x/' result.csv >broken.csv
expect 2 validate broken.csv
says 'broken.csv:4: "x" is not a number'

cat >diagnosis.json <<'JSON'
{
  "schema": 1,
  "rig": "E string, glass rod, run 12",
  "verdict": "explained",
  "mismatch": { "take": "pluck-1", "channel": "far", "time_s": [0.0081, 0.0093], "band_Hz": [3100, 4400],
                "position": null, "residual_over_noise": 38.2 },
  "missing": [
    { "effect": "support-resonance", "where": { "end": "far" }, "probability": 0.998, "indistinguishable_from": [],
      "parameters": { "frequency_Hz": { "value": 3630, "ci95": [3611, 3650] }, "q": { "value": 14, "ci95": [12, 16] } },
      "statement": "The far termination is not rigid: it resonates at 3.63 kHz." } ],
  "ranking": [ { "effects": ["support-resonance"], "log10_evidence": 0.0 }, { "effects": ["sensor-resonance"], "log10_evidence": -41.7 } ],
  "calibration": { "delay_near_s": { "value": 2.2e-4, "sd": 1e-9 } },
  "fit": { "metric": "pluck-residual", "held_out": ["pluck-3"], "before": 0.127, "after": 0.0016, "noise_floor": 0.0015 },
  "assumed": [ "impedance_Ns_m = 0.1749, from tension and fundamental" ]
}
JSON
expect 0 validate diagnosis.json
says "a valid diagnosis"
bad diagnosis.json "/verdict: " 's/"explained"/"understood"/'
bad diagnosis.json "/mismatch: " 's/"explained"/"no-mismatch"/'
bad diagnosis.json "/missing/0/probability: " 's/0.998/1.998/'
bad diagnosis.json "/missing/0/where/end: " 's/"end": "far"/"end": "left"/'
bad diagnosis.json "/missing/0/parameters/q/ci95: " 's/\[12, 16\]/[12]/'
bad diagnosis.json "/fit/metric: " 's/pluck-residual/residual/'
bad diagnosis.json "/fit/after: " 's/"after": 0.0016/"after": null/'
bad diagnosis.json "/ranking/1/log10_evidence: " 's/-41.7/41.7/'
bad diagnosis.json "/: " 's/"assumed"/"guessed"/'
sed 's/"schema": 1,/"schema": 1/' diagnosis.json >broken.json
expect 2 validate broken.json
says "line 3"
cp diagnosis.json diagnosis.txt
expect 2 validate diagnosis.txt
says "the name says no format"
finish
