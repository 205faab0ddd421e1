#!/usr/bin/env bash
# Draws docs/figures/papers_fig2.svg to papers_fig8.svg from what examples/18_the_papers_figures.cpp writes. Argument: that program, built.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"${1:-../../build/release/examples/example_18_the_papers_figures}" "$work"
for n in 2 3 4 5 6 7 8; do
  (cd "$work" && gnuplot "fig$n.gp")
  # a tenth of a pixel is fine enough for what is drawn; numbers in text are left alone
  sed -E '/<text|tspan|viewBox/!s/([0-9]+\.[0-9])[0-9]+/\1/g' "$work/fig$n.svg" >"papers_fig$n.svg"
done
