#!/usr/bin/perl
# A rig folder made from closed forms: three plucks and a stroke of an ideal string with constant Q, forces on both ends.
#
#   closed_form_rig.pl FOLDER [ac] [short] [skew=SECONDS] [leak=FRACTION] [pitch=HERTZ]
#
# ac: the near channel is AC coupled, and says so.  skew: the far channel of the plucks comes late by that much.  leak: that part of
# each channel is in the other one too. The rig file says nothing of the last two. pitch: of the string; the rig file says 240 Hz all the same.
# short: plucks of a tenth of a second at 16 kHz, and no stroke.
#
# Pluck of 1 N at p:  F_near = sum_n 2/(n pi) sin(n pi p) Re exp(s_n t), F_far with (-1)^(n+1). Its negative derivative is the answer
# to a force impulse, so a stroke is the convolution of the contact force with it. The force is smooth and goes into truth.csv.
use strict;
use warnings;

my ($folder, @options) = @ARGV;
my ($kind, $short, $skew, $leak, $pitch) = ('', 0, 0, 0, 240.31);
for (@options) {
  if (/^skew=(.+)/) { $skew = $1 }
  elsif (/^leak=(.+)/) { $leak = $1 }
  elsif (/^pitch=(.+)/) { $pitch = $1 }
  elsif ($_ eq 'short') { $short = 1 }
  else { $kind = $_ }
}
my ($rate, $f0, $p, $q, $pi) = ($short ? 16000 : 48000, $pitch, 0.2987, 800, 4 * atan2(1, 1));
my @gain = (1.013, 0.978);
my $full = 2;
srand 7;

sub noise { return 0.0003 * 1.7 * (rand(2) - 1) }

my (@decay, @omega, @weight);
for my $n (1 .. int(0.47 * $rate / $f0)) {
  my $w = 2 * $pi * $n * $f0;
  push @decay, $w / (2 * $q);
  push @omega, $w * sqrt(1 - 1 / (4 * $q * $q));
  push @weight, 2 / ($n * $pi) * sin($n * $pi * $p);
}

# Modes above the last one follow a slow force at once.
my @rest = (1 - $p, $p);
for my $k (0 .. $#weight) {
  $rest[0] -= $weight[$k];
  $rest[1] -= $k % 2 ? -$weight[$k] : $weight[$k];
}

sub write_wav {
  my ($name, $near, $far) = @_;
  my $data = '';
  for my $i (0 .. $#$near) {
    for my $x ($gain[0] * ($near->[$i] + $leak * $far->[$i]), $gain[1] * ($far->[$i] + $leak * $near->[$i])) {
      my $v = int(32768 * ($x + noise()) / $full + 32768.5) - 32768;
      $data .= pack('v', ($v < -32768 ? -32768 : $v > 32767 ? 32767 : $v) & 0xffff);
    }
  }
  open my $out, '>:raw', "$folder/$name" or die "$name: $!";
  print $out 'RIFF', pack('V', 36 + length $data), 'WAVEfmt ', pack('VvvVVvv', 16, 1, 2, $rate, 4 * $rate, 4, 16), 'data', pack('V', length $data), $data;
  close $out;
}

# A first-order high-pass that has forgotten what was before, exact for signals that are straight between samples.
sub coupled {
  my ($x) = @_;
  return $x if $kind ne 'ac';
  my ($a, $y, $before) = (exp(-2 * $pi * 3.0 / $rate), 0, $x->[0]);
  my $b = (1 - $a) / (2 * $pi * 3.0 / $rate);
  return [map { my $v = $y = $a * $y + $b * ($_ - $before); $before = $_; $v } @$x];
}

sub pluck {
  my ($name, $force, $release, $duration) = @_;
  my (@near, @far);
  for my $i (0 .. int($duration * $rate)) {
    my ($t, $late) = ($i / $rate - $release, $i / $rate - $release - $skew);
    my ($n, $f) = ($t < 0 ? 1 - $p : 0, $late < 0 ? $p : 0);
    if ($t >= 0) {
      for my $k (0 .. $#decay) {
        my $v = $weight[$k] * exp(-$decay[$k] * $t) * cos($omega[$k] * $t);
        $n += $v;
        $f += $k % 2 ? -$v : $v if !$skew;
      }
    }
    if ($skew && $late >= 0) {
      $f += ($_ % 2 ? -1 : 1) * $weight[$_] * exp(-$decay[$_] * $late) * cos($omega[$_] * $late) for 0 .. $#decay;
    }
    push @near, $force * $n;
    push @far, $force * $f;
  }
  write_wav($name, coupled(\@near), \@far);
}

# Smooth humps of the contact force, at rest first.
sub contact_force {
  my ($t) = @_;
  my $sum = 0;
  for my $k (0 .. 21) {
    my $u = ($t - 0.02 - 0.0037 * $k) / 0.0006;
    $sum += (0.10 + 0.06 * sin(1.7 * $k)) * exp(-0.5 * $u * $u) if abs($u) < 9;
  }
  return $sum;
}

sub times_c {
  my ($a, $b, $c, $d) = @_;
  return ($a * $c - $b * $d, $a * $d + $b * $c);
}

sub stroke {
  my ($name) = @_;
  my (@near, @far);
  # z' = s z + force, exact for a force that is straight between samples: z <- E z + A old + B new
  my (@step, @old, @new);
  for my $k (0 .. $#decay) {
    my ($x, $y, $size) = (-$decay[$k], $omega[$k], $decay[$k] ** 2 + $omega[$k] ** 2);
    my @e = (exp($x / $rate) * cos($y / $rate), exp($x / $rate) * sin($y / $rate));
    my @whole = times_c($e[0] - 1, $e[1], $x / $size, -$y / $size);                                  # (E - 1) / s
    my @ramp = times_c(($whole[0] - 1 / $rate) * $rate, $whole[1] * $rate, $x / $size, -$y / $size);  # ((E - 1) / s - T) / (s T)
    push @step, \@e;
    push @new, \@ramp;
    push @old, [$whole[0] - $ramp[0], $whole[1] - $ramp[1]];
  }
  my $before = 0;
  my @z = map { [0, 0] } 0 .. $#decay;
  open my $truth, '>', "$folder/truth.csv" or die $!;
  for my $i (0 .. int(0.13 * $rate)) {
    my $force = contact_force($i / $rate);
    print $truth "$force\n";
    my ($n, $f) = (0, 0);
    for my $k (0 .. $#decay) {
      my ($re, $im) = times_c(@{$z[$k]}, @{$step[$k]});
      $re += $old[$k][0] * $before + $new[$k][0] * $force;
      $im += $old[$k][1] * $before + $new[$k][1] * $force;
      $z[$k] = [$re, $im];
      my $v = $weight[$k] * ($decay[$k] * $re + $omega[$k] * $im);    # - Re s z
      $n += $v;
      $f += $k % 2 ? -$v : $v;
    }
    $before = $force;
    push @near, $n + $force * $rest[0];
    push @far, $f + $force * $rest[1];
  }
  write_wav($name, coupled(\@near), \@far);
}

mkdir $folder;
pluck('pluck-1.wav', 1.0, 0.0101234, $short ? 0.1 : 0.6);
pluck('pluck-2.wav', 0.5, 0.0115511, $short ? 0.1 : 0.25);
pluck('pluck-3.wav', 0.75, 0.0107777, $short ? 0.1 : 0.25);
stroke('bow-1.wav') if !$short;
my $ac = $kind eq 'ac' ? ', ac_coupled_Hz = 3.0' : '';
open my $rig, '>', "$folder/rig.toml" or die $!;
print $rig <<"END";
schema = 1
title = "a string of the tests"

[string]
length_m = 0.40
tension_N = 40.0
fundamental_Hz = 240.0

[channels]
near = { index = 0, newtons_per_full_scale = $full, gain_tolerance = 0.05$ac }
far = { index = 1, newtons_per_full_scale = $full, gain_tolerance = 0.05 }

[contact]
position = 0.30

[torsion]
speed_ratio = 6.0
impedance_ratio = 3.0
q = 15

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

[[take]]
name = "pluck-3"
kind = "pluck"
file = "pluck-3.wav"
force_N = 0.75
hold_out = true
END
print $rig <<"END" if !$short;

[[take]]
name = "bow-1"
kind = "bow"
file = "bow-1.wav"
speed_m_s = 0.3
normal_force_N = 0.3
END
