# emitted_header.sh TOOL COMPILER EIGEN: the header that `rosin fit --emit-header` writes holds, bit for bit, what the library designs from
# the calibration file of the same fit; it is written once, and only where it makes sense.
. "$ROSIN_SOURCE/tests/tool/common.sh"
compiler=$2 eigen=$3
perl "$ROSIN_SOURCE/tests/tool/closed_form_rig.pl" rig

expect 0 fit rig --json fit.json --emit-header rig.hpp
says "header rig.hpp: "
expect 2 fit rig --emit-header rig.hpp
says "rig.hpp: exists already; --force overwrites it"
expect 2 fit rig --emit-header -
expect 2 fit rig --emit-header other.hpp --emit-position 0.4
says "no pluck there"
expect 2 fit rig --emit-header other.hpp --emit-pass 20000 --emit-stop 30000
expect 2 fit rig --emit-header other.hpp --emit-namespace 3d
expect 2 fit rig --pickup --emit-header other.hpp
[ ! -e other.hpp ] || { echo "FAILED: a header that was refused is there"; failures=1; }
expect 0 fit rig --emit-header near.hpp --emit-double --emit-version near --emit-rate 96000 --emit-error 0.01 --emit-namespace near

# number PATH: out of the calibration file
number() {
  perl -MJSON::PP -0777 -e 'my $v = decode_json(do { open my $f, "<", "fit.json"; <$f> }); for (split /\./, $ARGV[0]) { $v = ref $v eq "ARRAY" ? $v->[$_] : $v->{$_} } printf "%.17g", $v' "$1"
}
cat >numbers.hpp <<HPP
constexpr rosin::bow_point at{{$(number positions.0.delay_near_s.value), $(number positions.0.delay_far_s.value)}, $(number positions.0.stiffness_s2.value),
  {1 / $(number string.inverse_quality.value), $(number string.loss_internal_s.value), $(number string.loss_air_sqrt_Hz.value)}, $(number string.impedance_Ns_m.value)};
constexpr std::array<double, 2> gain{$(number channels.near.gain.value), $(number channels.far.gain.value)};
HPP
"$compiler" -std=c++20 -O1 -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Werror -I. -I"$ROSIN_SOURCE/include" -isystem "$eigen" \
  "$ROSIN_SOURCE/tests/firmware/emitted_header.cpp" -o emitted_header
./emitted_header || failures=1
finish
