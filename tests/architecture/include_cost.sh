#!/usr/bin/env bash
# What #include <rosin/rosin.hpp> has the compiler instantiate, header by header, against the reviewed list beside this file: cost that
# creeps back is a failure, whatever the machine's mood. Counted in Clang's own trace; a count belongs to the header in whose text
# the compiler first needed it, "afterwards" to the bodies that it compiles at the end of the file.
#   include_cost.sh CLANG++ ROOT EIGEN [--write]      --write: makes the list anew, to be reviewed like any other change
set -euo pipefail
cxx=$1 root=$2 eigen=$3
list=$root/tests/architecture/include_cost.txt
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo '#include <rosin/rosin.hpp>' >"$work/all.cpp"
"$cxx" -std=c++20 -O0 -I "$root/include" -isystem "$eigen" -ftime-trace -ftime-trace-granularity=0 -c -o "$work/all.o" "$work/all.cpp"

# One event a line: begin, duration, name, detail.
tr '{' '\n' <"$work/all.json" | awk '
  /"name":"(Source|InstantiateClass|InstantiateFunction|PerformPendingInstantiations)"/ {
    match($0, /"ts":[0-9]+/); ts = substr($0, RSTART + 5, RLENGTH - 5)
    match($0, /"dur":[0-9]+/); dur = substr($0, RSTART + 6, RLENGTH - 6)
    match($0, /"name":"[A-Za-z]+"/); name = substr($0, RSTART + 8, RLENGTH - 9)
    detail = "-"
    if (name == "Source") { getline; if (match($0, /"detail":"[^"]*"/)) detail = substr($0, RSTART + 10, RLENGTH - 11) }
    print ts, dur, name, detail
  }' | sort -k1,1n -k2,2nr -s >"$work/events"

awk '
  { while (depth && end[depth] <= $1) --depth }
  $3 == "Source" || $3 == "PerformPendingInstantiations" {
    end[++depth] = $1 + $2
    at[depth] = $3 == "Source" ? ($4 ~ /\/rosin\/[a-z]/ && $4 !~ /^\/usr\// ? $4 : at[depth - 1]) : "afterwards"
    sub(/.*\/include\/rosin\//, "", at[depth])
    next
  }
  { where = depth && at[depth] != "" ? at[depth] : "afterwards"; if ($3 == "InstantiateClass") ++classes[where]; else ++functions[where]; seen[where] = 1 }
  END { for (where in seen) print where, classes[where] + 0, functions[where] + 0 }' "$work/events" | sort >"$work/now"

if [ "${4:-}" = --write ]; then
  { echo "# header, classes, functions instantiated by #include <rosin/rosin.hpp>, Clang 14 (include_cost.sh --write)"; cat "$work/now"; } >"$list"
  exit 0
fi
if ! "$cxx" --version | grep -q 'clang version 14'; then
  echo "the list is of Clang 14: not compared"
  exit 0
fi
# A little more than reviewed is let pass: another release of the standard library.
grep -v '^#' "$list" | awk -v now="$work/now" '
  { classes[$1] = $2; functions[$1] = $3; all_classes += $2; all_functions += $3 }
  END {
    while ((getline < now) > 0) {
      sum_classes += $2; sum_functions += $3
      if ($2 > classes[$1] + 25 + classes[$1] / 10 || $3 > functions[$1] + 10 + functions[$1] / 10) {
        printf "%s: %d classes and %d functions instantiated, %d and %d reviewed\n", $1, $2, $3, classes[$1], functions[$1]; bad = 1
      }
    }
    printf "together: %d classes and %d functions instantiated, %d and %d reviewed\n", sum_classes, sum_functions, all_classes, all_functions
    if (sum_classes > 1.02 * all_classes + 25 || sum_functions > 1.02 * all_functions + 25) bad = 1
    exit bad
  }'
