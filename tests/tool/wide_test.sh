# rosin diagnose: a bow of three places, 7.16 mm wide, parts of which slide on while others hold. What they do looks a little like a rod
# that resonates, which does not account for it: the width stands by itself.
. "$ROSIN_SOURCE/tests/tool/common.sh"

expect 0 challenge --out wide --seed 811017 --count 17 --effect finite-contact-width --shard 5/17 --only-make
same "$(ls wide/rigs)" challenge-81101700016
expect 0 diagnose wide/rigs/challenge-81101700016 --json wide.json $(without $elsewhere point-damper tension-modulation torsion \
  elasto-plastic-friction creep speed-ripple normal-force-ripple thermal-friction)
says ": explained" "The bow touches the string over"
perl -MJSON::PP -e '
  local $/;
  my $said = decode_json(<STDIN>)->{missing};
  my ($low, $high) = @{ $said->[0]{parameters}{width_m}{ci95} };
  die "not the width\n" unless @$said == 1 && $said->[0]{effect} eq "finite-contact-width" && $low < 0.00716 && 0.00716 < $high' <wide.json
finish
