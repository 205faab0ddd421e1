#!/usr/bin/env bash
# From nothing to a reconstructed friction force: installs what is missing from Debian, builds the tool, simulates the rig
# of examples/demo, and treats its recordings as if nothing else were known. The truth is looked at only at the end.
# The first run takes the time of a build, later ones seconds. Results: build/demo/
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

.ci/install-packages clang
cache=build/release/CMakeCache.txt
if [ -e "$cache" ] && ! grep -q '^CMAKE_CXX_COMPILER:.*clang' "$cache"; then rm -rf build/release; fi  # begun with another compiler
levels=()
[ -e "$cache" ] || levels=(-DROSIN_TOOL_LEVELS=host)  # for this machine alone: half of the time
[ -x build/release/bin/rosin ] || echo "building build/release/bin/rosin: some five minutes on two cores, 1.5 GB a core"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake --preset release "${levels[@]}" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
cmake --build --preset tool

rosin=build/release/bin/rosin demo=build/demo
mkdir -p $demo
step() { printf '\n== %s\n' "$*"; }

step "rosin simulate: recordings to $demo/rig, the truth to $demo/truth"
$rosin simulate examples/demo --out $demo/rig --truth $demo/truth --force >$demo/simulate.txt
grep -E '^(quiet|pluck|bow|warning)' $demo/simulate.txt

step "rosin check: are the recordings sound?"
$rosin check $demo/rig >$demo/check.txt || { cat $demo/check.txt >&2; exit 1; }
tail -n 1 $demo/check.txt

step "rosin fit: calibration from the plucks"
$rosin fit $demo/rig --json $demo/fit.json --report $demo/fit.html --force >$demo/fit.txt
sed -n '/^ *value/p; /^  \(pitch\|wave impedance\|bending stiffness\|Q at\|position\|gain near, \|gain far, \)/p' $demo/fit.txt

for take in bow-1 bow-2; do
  step "rosin reconstruct: take $take"
  $rosin reconstruct $demo/rig --take $take --calibration $demo/fit.json --out $demo/$take.csv --report $demo/$take.html --force >$demo/$take.txt
  head -n 1 $demo/$take.txt
  echo "against the truth, $($rosin compare $demo/$take.csv $demo/truth/$take.csv | grep -v torsion)"
done

cat <<EOF

Delta: normalised rms difference, 0 to 1. The scale is the strength of the breaking wires, which no recording tells;
rosin fit states it as a systematic error. The pages with all figures:
EOF
printf '  %s\n' "$PWD"/$demo/{fit,bow-1,bow-2}.html
