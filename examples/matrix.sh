#!/usr/bin/env bash
# The matrix of docs/reference/challenge.md: effects hidden at several strengths and levels of noise, none, two, and such as the
# catalogue does not know, each set under its own seed. On all cores, in rounds that lengthen every set, so that it can be
# stopped and gone on with at any time:
#   examples/matrix.sh FOLDER [ROUNDS]
# A round is 134 rigs, 8 rounds are 1072. ROSIN names another program than build/release/bin/rosin.
# FOLDER/matrix.md has every set's score.
set -euo pipefail
folder=${1:?folder for rigs, diagnoses and scores} rounds=${2:-8}
rosin=$(realpath "${ROSIN:-$(dirname "${BASH_SOURCE[0]}")/../build/release/bin/rosin}")
cores=$(nproc)
mkdir -p "$folder" && cd "$folder"

set_of() { # name, rigs a round, seed, options
  local name=$1 rigs=$2 seed=$3
  shift 3
  "$rosin" challenge --out "$name" --seed "$seed" --count $((round * rigs)) "$@" >/dev/null
}
all_sets() {
  set_of one 60 81001 "$@"
  set_of none 30 83003 --effects 0 "$@"
  set_of two 12 82002 --effects 2 "$@"
  set_of tenth 8 86006 --strength 0.1 "$@"
  set_of db40 8 84004 --noise-db 40 "$@"
  set_of db50 8 85005 --noise-db 50 "$@"
  set_of left 8 88008 --leave-out "$@"
}

for part in $(seq "$cores"); do
  (for round in $(seq "$rounds"); do all_sets --shard "$part/$cores"; done) 2>"part-$part.log" &
done
wait
round=$rounds
all_sets # scores what all parts have done
cat {one,none,two,tenth,db50,db40}/challenge.md left/left-out.md >matrix.md
