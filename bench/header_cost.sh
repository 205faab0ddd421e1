#!/usr/bin/env bash
# What it costs to include a public header: processor time of a translation unit that holds nothing else, the least of a few
# runs, less that of an empty one; and the lines that the compiler gets to see. Prints a table, the dearest first.
#   bench/header_cost.sh [HEADER… | dearest]     for instance core/stage.hpp; all of them without arguments; dearest: those alone
#                                                that no other header includes, and Eigen/Dense
#   CXX=clang++ RUNS=3 FLAGS="-isystem /usr/include/eigen3" bench/header_cost.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cxx=${CXX:-g++} runs=${RUNS:-2}
read -ra flags <<<"${FLAGS:--isystem /usr/include/eigen3 -isystem /usr/include/gemmi/third_party}"
compile=("$cxx" -std=c++20 -O0 -c -o /dev/null -x c++ -I include "${flags[@]}" -)

if [ "${1:-}" = dearest ]; then
  mapfile -t headers < <(cd include && find rosin -name '*.hpp' ! -path '*/adapt/*' | sort |
    grep -vxF "$(find rosin -name '*.hpp' ! -path rosin/rosin.hpp -exec grep -hoE '<rosin/[^>]+>' {} + | tr -d '<>')" | sed 's|^rosin/||')
elif [ $# -gt 0 ]; then headers=("$@")
else mapfile -t headers < <(cd include/rosin && find . -name '*.hpp' | sed 's|^\./||' | sort); fi

# seconds TEXT: of processor time to compile TEXT; nothing if it does not compile
seconds() {
  local least="" one TIMEFORMAT='%U %S'
  for ((run = 0; run < runs; ++run)); do
    one=$({ time printf '%s' "$1" | "${compile[@]}" 2>/dev/null; } 2>&1) || return 0
    one=$(awk '{ print $1 + $2 }' <<<"$one")
    least=$(awk -v a="${least:-1e9}" -v b="$one" 'BEGIN { print a < b ? a : b }')
  done
  echo "$least"
}

empty=$(seconds "")
echo "$("$cxx" --version | head -n 1), an empty file: $empty s, Eigen/Dense: $(seconds '#include <Eigen/Dense>') s"
echo
echo "| header | s | thousand lines |"
echo "|---|---|---|"
for header in "${headers[@]}"; do
  cost=$(seconds "#include <rosin/$header>"$'\n')
  if [ -z "$cost" ]; then
    echo "$header: does not compile here; is its package installed?" >&2
    continue
  fi
  lines=$(printf '#include <rosin/%s>\n' "$header" | "$cxx" -std=c++20 -E -P -x c++ -I include "${flags[@]}" - | wc -l)
  awk -v h="$header" -v c="$cost" -v e="$empty" -v l="$lines" 'BEGIN { printf "| %s | %.2f | %.0f |\n", h, (c > e ? c - e : 0), l / 1000 }'
done | sort -t'|' -k3,3nr -k2,2
