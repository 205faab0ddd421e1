# rosin check on a sound rig and on rigs with one thing wrong.
. "$ROSIN_SOURCE/tests/tool/common.sh"

make_rig sound
expect 0 check sound
says "pluck-1 (pluck, pluck-1.wav)" "released at 0.0" "rings at 3" "0 error(s), 0 warning(s)" "assumed: impedance_Ns_m = 0.1632, from tension and fundamental"
no_messages
expect 0 check sound/rig.toml --strict
expect 0 check sound --json
says '"tool": "rosin"' '"errors": 0' "\"sha256\": \"$(sha256sum sound/pluck-2.wav | cut -d' ' -f1)\"" \
  "\"sha256\": \"$(sha256sum sound/rig.toml | cut -d' ' -f1)\"" '"--json": "true"'
no_messages

# a bar on a terminal, none in a pipe
if command -v script >/dev/null; then
  script -qec "'$tool' check sound >/dev/null" /dev/null </dev/null >terminal.txt || true
  grep -q 'checking \[' terminal.txt || { echo "FAILED: no progress on a terminal"; failures=1; }
fi

PERL='($near, $far) = ($far, $near)' make_rig swapped
expect 1 check swapped
says "pluck-1.wav: take pluck-1 (swapped/rig.toml:16)" "error: the release reaches the ends as if plucked at 0." "near and far are swapped"
expect 1 check swapped --json
says '"kind": "swapped-channels"' '"severity": "error"' '"errors": 2'

PERL='$far = -$far' make_rig inverted
expect 1 check inverted
says "channel far" "the release steps upwards" "turn the polarity"

PERL='$near = 1.9 if $near > 0.6 and $t > 0.05 and $take eq "pluck-1"; $near *= 1.6' make_rig clipped
expect 1 check clipped
says "pluck-1.wav" "channel near" "clipped at 1.000 of full scale" "lower the gain"

PERL='($near, $far) = (0, 0)' make_rig silent
expect 1 check silent
says "silent: the channel does not move at all" "quiet.wav" "not even noise"

PERL='our @held; @held = ($near, $far) unless $t > 0.1 and $t < 0.1005; ($near, $far) = @held' make_rig dropped
expect 1 check dropped
says "samples were lost" "0.1000 to 0.1005 s"

PERL='$near += 0.02 * sin(100 * $pi * $t)' make_rig hum
expect 0 check hum
says "warning: mains hum of 50 Hz, 0.02 N" "0 error(s), 3 warning(s)"
expect 1 check hum --strict

# values that are off by a power of ten: said by name, with the likely value
make_rig kilo
sed -i 's/^fundamental_Hz = 330/fundamental_Hz = 0.33/' kilo/rig.toml
expect 1 check kilo
says "kilo/rig.toml: error: string.fundamental_Hz is 0.33, and 330 would agree with all the rest" "error: rings at 33" "fundamental_Hz is 0.33"
expect 1 check kilo --json
says '"kind": "power-of-ten"' '"take": null'
cp -r sound milli
sed -i 's/^length_m = 0.65/length_m = 650/; s/^force_N = 0.5/force_N = 5/' milli/rig.toml
expect 1 check milli
says "string.length_m is 650, and 0.65 would agree" "off by a power of ten; force_N = 0.5"

# what cannot be read: nothing is calculated, and all of it is said at once
make_rig broken
head -c 20000 sound/pluck-1.wav >broken/pluck-1.wav
rm broken/quiet.wav
expect 2 check broken
says "broken/rig.toml:29: take \"quiet\".file: broken/quiet.wav: no such file"
cp sound/quiet.wav broken
sed -i 's/^tension_N = 70/tension_N = -70/; s/^force_N = 0.5/force = 0.5/' broken/rig.toml
expect 2 check broken
says "rosin: broken/rig.toml:6: string.tension_N: must be larger than 0" "unknown key; did you mean force_N?"
cp sound/rig.toml broken
expect 2 check broken
says "broken/rig.toml:16: take \"pluck-1\".file: broken/pluck-1.wav: truncated: the header promises 57600 bytes of samples, the file holds 19956"
expect 2 check broken --json
says '"errors": [' "truncated"
no_messages

# headers that do not tell the length are read to the end; others are refused in words
make_rig lengths
perl -pi -e 'BEGIN { binmode STDIN; $/ = undef } substr($_, 40, 4) = pack("V", 0)' lengths/pluck-1.wav
perl -pi -e 'BEGIN { $/ = undef } substr($_, 40, 4) = pack("V", 0x7ffff000)' lengths/pluck-2.wav
expect 0 check lengths
says "0 error(s), 0 warning(s)" "note: lengths/pluck-1.wav: its header does not tell how long it is" "note: lengths/pluck-2.wav: its header"
perl -pi -e 'BEGIN { $/ = undef } substr($_, 24, 4) = pack("V", 0)' lengths/pluck-1.wav
perl -pi -e 'BEGIN { $/ = undef } $_ .= "data" . pack("V", 4) . "abcd"' lengths/quiet.wav
expect 2 check lengths
says "lengths/pluck-1.wav: its header says 0 samples a second" "lengths/quiet.wav: holds two chunks of samples"
finish
