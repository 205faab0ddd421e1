# rosin diagnose: what is hidden in closed-form plucks is named with its value, what is not there is not, and what cannot be done is said.
. "$ROSIN_SOURCE/tests/tool/common.sh"
make() { perl "$ROSIN_SOURCE/tests/tool/closed_form_rig.pl" "$@"; }

# holds FILE EXPRESSION…: true of the diagnosis in FILE ($d; $m is the first missing effect, value(NAME) of its parameters; about(X, Y, TOLERANCE))
holds() {
  local file=$1 what
  shift
  for what in "$@"; do
    perl -MJSON::PP -e '
      local $/;
      open my $in, "<", $ARGV[0] or die "$ARGV[0]: $!";
      our $d = decode_json(<$in>);
      our $m = $d->{missing}[0] // {};
      sub value { $m->{parameters}{$_[0]}{value} // "nan" }
      sub about { abs($_[0] / $_[1] - 1) < $_[2] }
      my $true = eval $ARGV[1];
      die $@ if $@;
      exit !$true' "$file" "$what" && continue
    echo "FAILED: $file: not so: $what"
    failures=$((failures + 1))
  done
}
explained='$d->{verdict} eq "explained" && @{$d->{missing}} == 1'
improved='$d->{fit}{before} > 10 * $d->{fit}{noise_floor} && $d->{fit}{after} < 1.2 * $d->{fit}{noise_floor}'

make late short skew=1e-5
page=()
if command -v gnuplot >/dev/null; then page=(--report late.html); else echo "skipped: the report, no gnuplot"; fi
expect 0 diagnose late --json late.json "${page[@]}"
says "a string of the tests: explained" "The far channel comes 10 us late against the near one." "channel-skew" "assumed: impedance_Ns_m" \
  "sensor or string: the force's two versions disagree" "behind wave "
no_messages
holds late.json "$explained" "$improved" '$m->{effect} eq "channel-skew"' 'about(value("skew_s"), 1e-5, 0.005)' \
  '"@{$d->{ranking}[0]{effects}}" eq "channel-skew" && $d->{ranking}[0]{log10_evidence} == 0' '"@{$d->{fit}{held_out}}" eq "pluck-3"' \
  '$d->{mismatch}{take} =~ /pluck-[12]/ && $d->{mismatch}{residual_over_noise} > 10' '$d->{mismatch}{time_s}[0] > 0.009' \
  '@{$d->{assumed}} > 0 && $d->{calibration}{fundamental_Hz}{value} > 240' \
  '$d->{mismatch}{class} eq "sensor-or-string" && $d->{mismatch}{wave} > 0' \
  '$d->{mismatch}{maps}{pluck}{force}{parting_N} > 3 * $d->{mismatch}{maps}{pluck}{force}{parting_noise_N}' \
  '@{$d->{mismatch}{maps}{pluck}{far}{over_noise}} + 1 == @{$d->{mismatch}{maps}{pluck}{far}{time_s}}' \
  'about($d->{ranking}[0]{left}, $d->{fit}{after}, 0.02)' '!grep { $_->{left} && $_->{left} < 0.9 * $d->{fit}{after} } @{$d->{ranking}}'
expect 0 validate late.json
if [ ${#page[@]} -gt 0 ]; then
  # Before, after, spectra, the map, the plucking force; the sentence; and nothing that comes from elsewhere.
  same "$(grep -c '<svg' late.html)" 5
  grep -q 'class="summary">The far channel comes 10 us late' late.html || { echo "FAILED: no sentence on the page"; failures=1; }
  grep -q 'runner-up' late.html || { echo "FAILED: no runners-up on the page"; failures=1; }
  ! grep -E '(src|href)="http' late.html || { echo "FAILED: the page needs the network"; failures=1; }
fi

# Another effect, to standard output. The interval misses once in twenty, so twice its half width is allowed.
make leaky short leak=0.02
expect 0 diagnose leaky --json
says '"verdict": "explained"'
cp out.txt leaky.json
holds leaky.json "$explained" "$improved" '$m->{effect} eq "channel-crosstalk"' 'about(value("fraction"), 0.02, 0.005)' \
  'abs(value("fraction") - 0.02) < ($m->{parameters}{fraction}{ci95}[1] - $m->{parameters}{fraction}{ci95}[0])'
expect 0 validate leaky.json
expect 2 diagnose leaky --without gremlins
says "gremlins"

# Nothing is missing, and there is a single pluck.
make plain short
perl -0pe 's/\n\[\[take\]\]\nname = "pluck-2".*//s' plain/rig.toml >single.toml
mv single.toml plain/rig.toml
expect 0 diagnose plain --json plain.json
says "no-mismatch" "Simulation and recordings agree to within the noise."
holds plain.json '$d->{verdict} eq "no-mismatch" && !@{$d->{missing}} && !defined $d->{mismatch} && !defined $d->{fit}{after}' \
  'about($d->{fit}{before}, $d->{fit}{noise_floor}, 0.2)'
expect 0 validate plain.json

# Samples that a recorder left out of one pluck: it contradicts the others, and that is why.
make cut short
cut_frames() { # FILE FIRST COUNT: of a WAV file with a header of 44 bytes and frames of 4
  perl -e 'local $/; open my $f, "+<:raw", $ARGV[0] or die; my $all = <$f>; substr($all, 44 + 4 * $ARGV[1], 4 * $ARGV[2]) = "";
    substr($all, 4, 4) = pack "V", length($all) - 8; substr($all, 40, 4) = pack "V", length($all) - 44; seek $f, 0, 0; print $f $all; truncate $f, length $all' "$@"
}
cut_frames cut/pluck-1.wav 700 5
expect 0 diagnose cut --json cut.json
says "pluck-1 contradicts the other plucks: 5 samples are missing in it"
holds cut.json "$explained" '$m->{effect} eq "dropouts" && value("samples") == 5' 'about(value("time_s"), 700 / 16000, 0.05)' '$d->{mismatch}{take} eq "pluck-1"' \
  '$d->{fit}{before} > 10 * $d->{fit}{noise_floor} && $d->{fit}{after} < 1.3 * $d->{fit}{noise_floor}'
expect 0 validate cut.json

# Where every pluck lost samples, what they are before that is fitted; so many are lost, not all from the first to the last of them.
make lost short
blank_frames() { # FILE FIRST COUNT…
  perl -e 'my $name = shift; local $/; open my $f, "+<:raw", $name or die; my $all = <$f>;
    while (my ($first, $count) = splice @ARGV, 0, 2) { substr($all, 44 + 4 * $first, 4 * $count) = "\0" x (4 * $count) }
    seek $f, 0, 0; print $f $all' "$@"
}
blank_frames lost/pluck-1.wav 1450 9 1530 11
blank_frames lost/pluck-2.wav 1500 8
blank_frames lost/pluck-3.wav 1400 15
expect 0 diagnose lost --json lost.json
says "pluck-2: as no pluck is whole, used until it lost samples, 0.0927 s"
is_silent_about "left out"
holds lost.json '$d->{verdict} eq "explained" && @{$d->{missing}} == 6' '!grep { $_->{effect} ne "dropouts" } @{$d->{missing}}' \
  'value("samples") == 20' 'about(value("time_s"), 1450 / 16000, 1e-3)' '$d->{fit}{after} < 1.3 * $d->{fit}{noise_floor}'
expect 0 validate lost.json
for n in 1 2 3; do blank_frames lost/pluck-$n.wav 600 9; done
expect 2 diagnose lost
says "lost/rig.toml: no pluck to compare with" "samples were lost" "pluck-1: left out for the error above"

# One of three plucks is of another string, so that nothing rings as declared together: it is that one, and the others are told.
make other short
make else short pitch=270.2
cp else/pluck-2.wav other/pluck-2.wav
expect 0 diagnose other --json other.json
says "a string of the tests: unexplained" "pluck-2 contradicts the other plucks: by itself it rings at 270.2"
holds other.json '$d->{verdict} eq "unexplained" && $d->{mismatch}{take} eq "pluck-2"'

# The plucks were made elsewhere than the rig file says.
make moved short
perl -i -pe 's/^position = 0\.[0-9]+/position = 0.34/m' moved/rig.toml
expect 0 diagnose moved --json moved.json
says "The string was plucked at 0.298"
holds moved.json "$explained" '$m->{effect} eq "pluck-position"' 'abs(value("position") - 0.2987) < 1e-3' '$d->{fit}{before} > 10 * $d->{fit}{noise_floor}'

# A rod that touches six thousandths of the length beside the wire is found there, and nothing is missing; farther off than both
# places may be, it is not.
make_rig rod
sed -i '/^hold_out/d; s/^force_N = 0.5/&\ncontact_position = 0.25/' rod/rig.toml
cat >>rod/rig.toml <<'TOML'

[model]
friction = "velocity-curve"

[simulate]
rate_Hz = 48000
duration_s = 0.12
noise_N = 4e-4
seed = 5

[[take]]
name = "bow-1"
kind = "bow"
file = "bow-1.wav"
speed_m_s = 0.15
normal_force_N = 0.4
contact_position = 0.306
TOML
expect 0 simulate rod --out beside
perl -i -ne 'print unless /^contact_position = 0.306/' beside/rig.toml
strokes_only=$(without second-polarization tension-modulation sympathetic-string point-mass point-damper support-resonance clamped-end \
  resistive-end sensor-resonance channel-crosstalk phantom-partials clock-drift mains-hum slow-release)
expect 0 diagnose beside $strokes_only --json beside.json
says "no-mismatch" "bow-1: bowed at 0.3060 of the length, where its two versions part least, not where the plucks were"
holds beside.json '$d->{verdict} eq "no-mismatch"'
perl -i -pe 's/^position = 0.3$/$&\nposition_tolerance = 0.002/' beside/rig.toml
expect 0 diagnose beside $strokes_only
says "unexplained" "It shows in bow-1."
is_silent_about "bowed at"

# One channel that knows of no newton goes through the same door: partials alone, and what is declared is all there is.
make heard
perl -i -0pe 's/^near.*\n//m; s/^far.*/coil = { index = 1, quantity = "string-velocity", position = 0.2 }/m' heard/rig.toml
expect 0 diagnose heard --json heard.json
says "no-mismatch" "assumed: amplitude and phase of every partial are free" "assumed: the strokes were not examined"
holds heard.json '$d->{verdict} eq "no-mismatch" && !@{$d->{missing}}' 'about($d->{fit}{before}, $d->{fit}{noise_floor}, 0.2)' \
  '"@{$d->{fit}{held_out}}" eq "pluck-3"' 'about($d->{calibration}{fundamental_Hz}{value}, 240.31, 1e-4)' 'about($d->{calibration}{inverse_quality}{value}, 1 / 800, 0.01)'
expect 0 validate heard.json

# Nothing is overwritten unasked, and that is said before the work.
before=$(sha256sum plain.json)
expect 2 diagnose plain --json plain.json
says "plain.json: exists already; --force overwrites it"
expect 2 diagnose plain --report plain.json
says "plain.json"
same "$(sha256sum plain.json)" "$before"

# What cannot be done is said.
variant() { mkdir -p "$1" && cp late/*.wav "$1" && perl -0pe "$2" late/rig.toml >"$1/rig.toml"; }
variant held 's/(force_N = \S+\n)(hold_out = true\n)?/$1hold_out = true\n/g'
expect 2 diagnose held
says "every pluck is marked hold_out: none is left to fit"
# Of two plucks both are fitted, but for one that is marked.
variant two 's/\n\[\[take\]\]\nname = "pluck-3".*?(?=\n\[\[take\]\]|\z)//s; s/(name = "pluck-1")/$1\nhold_out = true/'
expect 0 diagnose two $(without $elsewhere) --json two.json
is_silent_about "two plucks only"
holds two.json "$explained" '$m->{effect} eq "channel-skew"' '"@{$d->{fit}{held_out}}" eq "pluck-1"'
variant none 's/\n\[\[take\]\].*//s; s/$/\n[[take]]\nname = "quiet"\nkind = "quiet"\nfile = "pluck-3.wav"\n/'
expect 2 diagnose none
says "no pluck to compare with"
variant pickup 's/^near.*\n//m; s/^far.*/coil = { index = 0, quantity = "string-velocity", position = 0.2 }/m'
expect 2 diagnose pickup
says "pluck-2, channel coil: not used: signal: less than 0.15"
variant gone 's/pluck-1\.wav/nothing.wav/'
rm gone/pluck-2.wav
expect 2 diagnose gone
says "pluck-1" "nothing.wav: no such file"
variant dead ''
perl -e 'for (@ARGV) { open my $f, "+<:raw", $_ or die; local $/; my $all = <$f>; for (my $i = 46; $i < length $all; $i += 4) { substr($all, $i, 2) = "\0\0" }
  seek $f, 0, 0; print $f $all }' dead/*.wav
expect 2 diagnose dead
says "no pluck to compare with" "channel far" "silent: the channel does not move at all"
variant folder 's/pluck-1\.wav/folder.wav/'
mkdir -p folder/folder.wav
expect 2 diagnose folder
says "pluck-1" "folder.wav: is a folder"
variant broken 's/force_N = 1.0/force_N = "much"/'
expect 2 diagnose broken
says "rig.toml" "force_N"
expect 2 diagnose nowhere

# Before anything is recorded: the rig file is enough.
mkdir -p planned && sed 's/\r//' late/rig.toml >planned/rig.toml
expect 0 diagnose planned --isolability --json plan.json
holds plan.json '@{$d->{effects}} == @{$d->{cosine}} && @{$d->{cosine}[0]} == @{$d->{cosine}}' '$d->{cosine}[1][1] == 1' \
  'grep { my $c = join(" ", @$_); $c =~ /slow-release/ && $c =~ /finite-pluck-width/ } @{$d->{classes}}' \
  'grep { $_->{effect} eq "channel-skew" && $_->{detectable}{value} < 1e-6 } @{$d->{effects}}'
expect 0 diagnose planned --isolability
says "channel-skew: seen from skew_s" "cannot be told apart"
expect 2 diagnose late --noise 1e-3
expect 2 diagnose
finish
