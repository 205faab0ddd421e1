#!/usr/bin/env bash
# The matrix of docs/reference/challenge.md: every effect in turn, at several strengths and levels of noise and taken out of the
# catalogue, two effects, and none, each set under seeds of its own. On all cores, in rounds that lengthen every set, so that it
# can be stopped and gone on with at any time:
#   examples/matrix.sh FOLDER [ROUNDS [SEEDS]]
# After 8 rounds it has 1172 rigs, 30 with each effect at full strength. ROSIN names another program than
# build/release/bin/rosin. FOLDER/matrix.md has every set's score. SEEDS: where they begin (100000); others draw other rigs.
set -euo pipefail
folder=${1:?folder for rigs, diagnoses and scores} rounds=${2:-8} seeds=${3:-100000}
rosin=$(realpath "${ROSIN:-$(dirname "${BASH_SOURCE[0]}")/../build/release/bin/rosin}")
cores=$(nproc)
effects=(bending-stiffness frequency-dependent-loss tension-modulation second-polarization point-mass point-damper support-resonance
  ac-coupling channel-skew channel-crosstalk mains-hum sensor-nonlinearity sensor-resonance
  slow-release torsion tension-drift rod-resonance finite-contact-width speed-ripple normal-force-ripple
  thermal-friction elasto-plastic-friction)
mkdir -p "$folder" && cd "$folder"

drawn() { # set, rigs after 8 rounds, seed, options: effects as they are drawn
  local set=$1 rigs=$2 seed=$3
  shift 3
  "$rosin" challenge --out "$set" --seed "$seed" --count $((round * rigs / 8)) "$@" "${part[@]}" >/dev/null
}
in_turn() { # set, rigs of each effect after 8 rounds, seed of the first effect, options of the rigs -- of the diagnosis
  local set=$1 rigs=$2 seed=$3 rig_options=()
  shift 3
  while [ "$1" != -- ]; do rig_options+=("$1"); shift; done
  shift
  for effect in "${effects[@]}"; do
    "$rosin" challenge --out "$set" --seed "$((seed++))" --count $((round * rigs / 8)) --effect "$effect" --only-make \
      "${rig_options[@]}" "${part[@]}" >/dev/null
  done
  "$rosin" challenge --out "$set" "$@" "${part[@]}" >/dev/null
}
all_sets() {
  in_turn one 30 $((seeds + 1000)) --
  drawn none 240 $((seeds + 3000)) --effects 0
  drawn two 96 $((seeds + 2000)) --effects 2
  in_turn tenth 2 $((seeds + 6000)) --strength 0.1 --
  in_turn db50 2 $((seeds + 5000)) --noise-db 50 --
  in_turn db40 2 $((seeds + 4000)) --noise-db 40 --
  in_turn left 2 $((seeds + 8000)) -- --leave-out
}

for core in $(seq "$cores"); do
  (part=(--shard "$core/$cores"); for round in $(seq "$rounds"); do all_sets; done) 2>"part-$core.log" &
done
wait
round=$rounds part=()
all_sets # scores what all parts have done
cat {one,none,two,tenth,db50,db40}/challenge.md left/left-out.md >matrix.md
