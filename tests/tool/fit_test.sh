# rosin fit: the values that a closed form was made with, the file it writes, and what it refuses.
. "$ROSIN_SOURCE/tests/tool/common.sh"
perl "$ROSIN_SOURCE/tests/tool/closed_form_rig.pl" rig

# field FILE PATH: a number out of the JSON, by a path like string.fundamental_Hz.value
field() {
  perl -MJSON::PP -0777 -e 'my $v = decode_json(do { open my $f, "<", $ARGV[0]; <$f> }); for (split /\./, $ARGV[1]) { $v = /^\d+$/ && ref $v eq "ARRAY" ? $v->[$_] : $v->{$_} } print $v' "$1" "$2"
}
# near WHAT VALUE TRUTH LIMIT
near() {
  perl -e 'exit !(abs($ARGV[0] - $ARGV[1]) <= $ARGV[2])' -- "$2" "$3" "$4" && return 0
  echo "FAILED: $1 is $2, not within $4 of $3"
  failures=$((failures + 1))
}

expect 0 fit rig
says "pitch f0" "random" "systematic" "held out: predicted" "assumed: impedance_Ns_m"
expect 0 fit rig --json fit.json
near pitch "$(field fit.json string.fundamental_Hz.value)" 240.31 0.001
near position "$(field fit.json positions.0.position.value)" 0.2987 1e-5
near "delay near" "$(field fit.json positions.0.delay_near_s.value)" 6.21489e-4 2e-8
near "1/Q" "$(field fit.json string.inverse_quality.value)" 0.00125 1e-5
near "gain ratio" "$(field fit.json gain_ratio.value)" 1.0357873 2e-4
near stiffness "$(field fit.json string.inharmonicity.value)" 0 2e-7
near noise "$(field fit.json channels.near.noise_N)" 0.0003 3e-5
near "release 1" "$(field fit.json takes.0.release_s.value)" 0.0101234 2e-8
near "release 3, predicted" "$(field fit.json takes.2.release_s.value)" 0.0107777 3e-8
same "$(field fit.json takes.2.role)" held-out
# noise of 0.3 mN on some 0.15 N rms
near "residual, held out" "$(field fit.json takes.2.residual)" 0.002 0.0015
# errors are honest: each within four of its standard deviations
near "pitch in sd" "$(perl -e "print((240.31 - $(field fit.json string.fundamental_Hz.value)) / $(field fit.json string.fundamental_Hz.sd))")" 0 4
near "ratio in sd" "$(perl -e "print((1.0357873 - $(field fit.json gain_ratio.value)) / $(field fit.json gain_ratio.sd))")" 0 4

expect 2 fit rig --json fit.json
says "fit.json: exists already; --force overwrites it"
expect 0 fit rig --json fit.json --force
expect 0 fit rig --json
says '"format": "calibration"' '"sha256"'
expect 0 validate fit.json
says "a valid calibration"

# a pluck that cannot be used is left out and named; none at all is refused
cp -r rig clipped
perl -e 'open my $f, "+<:raw", "clipped/pluck-2.wav"; seek $f, 44 + 4 * 3000, 0; print $f pack("v", 32767) x 400'
expect 1 fit clipped
says "pluck-2" "left out for the error above"
mkdir none && cp rig/*.wav none
awk '/^\[\[take\]\]/ { take = 1 } /^hold_out/ { next } { print } /^kind = "pluck"/ { print "hold_out = true" }' rig/rig.toml >none/rig.toml
expect 2 fit none
says "no pluck to calibrate from"
expect 2 fit absent
expect 2 fit

# plucks that begin after their release: no advice on polarity and channels; what rings is used, and what cannot be known is said
cp -r rig late
for n in 1 2 3; do
  perl -e 'open my $f, "<:raw", $ARGV[0]; local $/; my $b = <$f>; my $skip = 4 * int(0.0115 * unpack("V", substr $b, 24, 4));
    print substr($b, 0, 40), pack("V", length($b) - 44 - $skip), substr($b, 44 + $skip)' "rig/pluck-$n.wav" >"late/pluck-$n.wav"
done
expect 1 check late
says "begins after the release" "cannot be told from it"
is_silent_about "polarity of this channel"
is_silent_about "swapped"
expect 1 fit late --json late.json
says "no pluck holds its release" "polarity, order of the channels, place of the contact" "pitch, stiffness and loss"
near "pitch of what rings" "$(field late.json results.0.fundamental_Hz.value)" 240.31 0.02
expect 2 fit late --emit-header late.hpp

# single channels
mkdir pickup && cp rig/pluck-1.wav pickup
cat >pickup/rig.toml <<'TOML'
schema = 1
[string]
fundamental_Hz = 240
length_m = 0.4
tension_N = 40
[channels]
coil = { index = 0, quantity = "string-velocity", position = 0.21 }
other = { index = 1, quantity = "unused" }
[[take]]
name = "pluck-1"
kind = "pluck"
file = "pluck-1.wav"
TOML
expect 0 fit pickup --json pickup.json
near "pickup's pitch" "$(field pickup.json results.0.fundamental_Hz.value)" 240.31 0.02
near "pickup's pitch in sd" "$(perl -e "print((240.31 - $(field pickup.json results.0.fundamental_Hz.value)) / $(field pickup.json results.0.fundamental_Hz.sd))")" 0 5
expect 0 validate pickup.json

# a page, where gnuplot is; a plain word where it is not
mkdir empty
PATH_WAS=$PATH
tool=$(command -v "$tool")
PATH=$here/empty "$tool" fit rig --report page.html >out.txt 2>err.txt && { echo "FAILED: a report without gnuplot"; failures=1; }
PATH=$PATH_WAS
says "gnuplot draws the figures, and it is not on the PATH"
if command -v gnuplot >/dev/null; then
  expect 0 fit rig --report page.html
  same "$(grep -c '<svg' page.html)" 3
  grep -q 'src=\|href="http' page.html && { echo "FAILED: the page is not self-contained"; failures=1; }
else
  echo "skipped: the report, no gnuplot"
fi
finish
