# Sourced by the tests of the tool: how to call it, what to expect of it, and a rig to try it on. All they make is in a folder of their
# own under the current one, which is made anew; nothing else is touched.
set -euo pipefail
tool=$1
export LC_ALL=C
tool=$(realpath "$(command -v "$tool")")
here=$PWD/$(basename "$0" .sh).work
rm -rf "${here:?}"
mkdir "$here"
cd "$here"
failures=0

# expect CODE COMMAND…: runs the tool; its output is then in $out, its messages in $err.
expect() {
  local code=$1 got=0
  shift
  "$tool" "$@" >out.txt 2>err.txt || got=$?
  out=$(cat out.txt)
  err=$(cat err.txt)
  if [ "$got" != "$code" ]; then
    echo "FAILED: rosin $* : exit $got instead of $code"
    sed 's/^/  | /' out.txt err.txt
    failures=$((failures + 1))
  fi
}

# says TEXT… / is_silent_about TEXT / quiet: of the last call's output and messages together; of its messages.
says() {
  local text
  for text in "$@"; do
    grep -qF -- "$text" out.txt err.txt && continue
    echo "FAILED: \"$text\" was not said:"
    sed 's/^/  | /' out.txt err.txt
    failures=$((failures + 1))
  done
}
is_silent_about() {
  grep -qF -- "$1" out.txt err.txt || return 0
  echo "FAILED: \"$1\" was said:"
  sed 's/^/  | /' out.txt err.txt
  failures=$((failures + 1))
}
no_messages() {
  [ -s err.txt ] || return 0
  echo "FAILED: messages where none were expected:"
  sed 's/^/  | /' err.txt
  failures=$((failures + 1))
}
same() {
  [ "$1" = "$2" ] && return 0
  echo "FAILED: \"$1\" is not \"$2\""
  failures=$((failures + 1))
}
# without EFFECT…: a catalogue that does not know them, as options.
without() { printf -- '--without %s ' "$@"; }
# What takes long to seek in plucks, where it is not what is tested.
elsewhere="second-polarization point-mass support-resonance sensor-nonlinearity slow-release sympathetic-string phantom-partials"
finish() {
  [ "$failures" = 0 ] || exit 1
  echo "all as expected"
}

# feed RATE LOG: numbered frames n, -n (32 bits each) at the pace of the clock; how many of them have been read out of the pipe stands in the file LOG.
feed() {
  perl -MTime::HiRes=time,sleep -e '
    $SIG{PIPE} = sub { exit };
    my ($rate, $name) = @ARGV;
    my ($block, $at, $start) = ($rate / 200, 0, time);
    open(my $log, ">", $name) or die;
    while (1) {
      my $due = $start + $at / $rate;
      sleep($due - time) if $due > time;
      my $bytes = pack("l<*", map { ($_, -$_) } $at .. $at + $block - 1);
      for (my $sent = 0; $sent < length $bytes; ) {
        my $done = syswrite(STDOUT, $bytes, length($bytes) - $sent, $sent) // exit;
        $sent += $done;
      }
      $at += $block;
      my $waiting = pack("i", 0);
      ioctl(STDOUT, 0x541B, $waiting) or die "FIONREAD: $!\n";
      sysseek($log, 0, 0);
      syswrite($log, sprintf("%012d", $at - unpack("i", $waiting) / 8));
    }' "$1" "$2"
}

# make_rig FOLDER: a rig with two plucks and a quiet take, 16 bit, 48 kHz, as a sum of partials with a little noise.
# PERL, if set, is code that is run on each frame before it is written ($near and $far in newtons, $t in s, $take).
make_rig() {
  mkdir -p "$1"
  cat >"$1/rig.toml" <<'TOML'
schema = 1
title = "a test"

[string]
length_m = 0.65
tension_N = 70
fundamental_Hz = 330

[channels]
near = { index = 0, newtons_per_full_scale = 2, gain_tolerance = 0.05 }
far = { index = 1, newtons_per_full_scale = 2, gain_tolerance = 0.05 }

[contact]
position = 0.3

[[take]]
name = "pluck-1"
kind = "pluck"
file = "pluck-1.wav"
force_N = 1.0

[[take]]
name = "pluck-2"
kind = "pluck"
file = "pluck-2.wav"
force_N = 0.5
hold_out = true

[[take]]
name = "quiet"
kind = "quiet"
file = "quiet.wav"
TOML
  perl -e '
    my ($folder, $code) = @ARGV;
    my $pi = atan2(0, -1);
    srand(1);
    for my $take ("pluck-1", "pluck-2", "quiet") {
      my $force = $take eq "pluck-1" ? 1 : $take eq "pluck-2" ? 0.5 : 0;
      my ($rate, $f0, $beta, $frames, $lead) = (48000, 330, 0.3, 14400, 960);
      my (@near, @far);
      for my $n (1 .. 50) {
        my $w = 2 * $pi * $n * $f0 * sqrt(1 + 6e-5 * $n * $n) / $rate;
        my $a = $force * 2 / ($n * $pi) * sin($n * $pi * $beta) * cos($pi * $n / 102) ** 2;
        my ($re, $im, $c, $s) = ($a, 0, cos($w) * (1 - $w / 1600), sin($w) * (1 - $w / 1600));
        for my $i ($lead .. $frames - 1) {
          $near[$i] += $re;
          $far[$i] += $n % 2 ? $re : -$re;
          ($re, $im) = ($re * $c - $im * $s, $im * $c + $re * $s);
        }
      }
      my $bytes = "";
      for my $i (0 .. $frames - 1) {
        my $t = $i / $rate;
        my $near = $i < $lead ? $force * (1 - $beta) : $near[$i];
        my $far = $i < $lead ? $force * $beta : $far[$i];
        $_ += 1e-3 * (rand() + rand() + rand() - 1.5) for $near, $far;
        eval $code if $code;
        die $@ if $@;
        $bytes .= pack("v", int(16384 * $_ + ($_ < 0 ? -0.5 : 0.5)) & 0xffff)
          for map { $_ > 1.99993 ? 1.99993 : $_ < -2 ? -2 : $_ } $near, $far;
      }
      open(my $out, ">:raw", "$folder/$take.wav") or die;
      print $out "RIFF" . pack("V", 36 + length $bytes) . "WAVEfmt " . pack("VvvVVvv", 16, 1, 2, $rate, 4 * $rate, 4, 16);
      print $out "data" . pack("V", length $bytes) . $bytes;
      close($out) or die;
    }' "$1" "${PERL:-}"
}
