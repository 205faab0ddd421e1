#!/usr/bin/env bash
# Draws demo.svg, the figure of the README, from what examples/demo.sh left in build/demo (or from the folder given).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
demo=${1:-build/demo}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Slips as rosin counts them: the surface (rolling included) slower than half the rod, until it is back at three quarters.
awk -F, -v rod=0.2 '/^#/ { next } !columns { for (i = 1; i <= NF; ++i) at[$i] = i; columns = NF; next }
  $at["velocity_m_s"] == "" || $1 < 0.014 { next }
  { v = $at["velocity_m_s"] + $at["torsion_velocity_m_s"]; t = 1000 * $1 }
  !slip && v < rod / 2 { slip = 1; from = t }
  slip && v > 0.75 * rod { slip = 0; printf "set object rectangle from %.4f, graph 0 to %.4f, graph 1 behind fillcolor \"#ffe9c9\" fillstyle solid noborder\n", from, t }
' "$demo/bow-1.csv" >"$work/slips.gp"

gnuplot - <<GNUPLOT
set terminal svg size 940,470 font "Helvetica,12" background "white"
set output "docs/figures/demo.svg"
set datafile separator ","
set datafile commentschars "#"
set datafile missing ""
set multiplot layout 2,2 margins 0.075,0.985,0.115,0.885 spacing 0.055,0.045
set border linecolor "#555555"
set tics textcolor "#333333" nomirror
set grid ytics linecolor "#dddddd"
set style line 1 linecolor "#16467d" linewidth 1.1
set style line 2 linecolor "#f5a45d" linewidth 4.5
set style line 3 linecolor "#777777" linewidth 1 dashtype (2,3)
set key outside top left horizontal samplen 2.5
show = 0
ranges(a, b) = sprintf("set xrange [%g:%g]", a, b)

eval ranges(4, 18)
set format x ""
set ylabel "friction force (N)"
set yrange [-0.02:0.4]
set ytics 0.1
plot "$demo/truth/bow-1.csv" using (1000*\$1):2 every 2::1 with lines linestyle 2 title "truth of the simulation", \
     "$demo/bow-1.csv" using (1000*\$1):2 every 2::1 with lines linestyle 1 title "rosin, from the forces at both ends"
eval ranges(300, 306.15)
unset ylabel
load "$work/slips.gp"
set key right
plot "$demo/truth/bow-1.csv" using (1000*\$1):2 every ::1 with lines linestyle 2 notitle, \
     "$demo/bow-1.csv" using (1000*\$1):2 every ::1 with lines linestyle 1 notitle, \
     NaN with boxes fillcolor "#ffe9c9" fillstyle solid linewidth 0 title "slipping", NaN linestyle 3 title "speed of the rod"
unset object
set key noautotitle
unset key
set format x "%g"
set xlabel "time (ms): from the start of the stroke"
set ylabel "string's velocity there (m/s)"
eval ranges(4, 18)
set yrange [-2.2:0.6]
set ytics 0.5
plot "$demo/truth/bow-1.csv" using (1000*\$1):3 every 2::1 with lines linestyle 2, \
     "$demo/bow-1.csv" using (1000*\$1):3 every 2::1 with lines linestyle 1, \
     "$demo/truth/bow-1.csv" using (1000*\$1):5 every 2::1 with lines linestyle 3
eval ranges(300, 306.15)
set xlabel "time (ms): four periods, 0.3 s later"
unset ylabel
load "$work/slips.gp"
plot "$demo/truth/bow-1.csv" using (1000*\$1):3 every ::1 with lines linestyle 2, \
     "$demo/bow-1.csv" using (1000*\$1):3 every ::1 with lines linestyle 1, 0.2 with lines linestyle 3
unset multiplot
GNUPLOT
echo docs/figures/demo.svg
