# The frame: version, help of every command, usage errors.
. "$ROSIN_SOURCE/tests/tool/common.sh"

version=$(sed -n 's/.*ROSIN_VERSION_STRING "\(.*\)"/\1/p' "$ROSIN_SOURCE/include/rosin/version.hpp")
expect 0 --version
same "$out" "rosin $version"
no_messages

expect 0 --help
says "Usage: rosin" "check" "validate" "Exit status: 0 done, 1 something was found, 2 bad input or usage."
commands=$("$tool" --help | sed -n '/^Subcommands:/,/^$/p' | sed -n 's/^  \([a-z][a-z-]*\) .*/\1/p')
[ -n "$commands" ] || { echo "FAILED: no commands in the help"; failures=1; }
for command in $commands; do
  expect 0 "$command" --help
  says "Usage: rosin $command" "--help" "Exit status: 0 "
  # every option and every positional says what it is
  bare=$(sed -n '/^\(Options\|Positionals\):/,/^$/p' out.txt | grep -E '^  [^ ].{0,31}$' | grep -vE '  [A-Z]' || true)
  wrapped=$(sed -n '/^\(Options\|Positionals\):/,/^$/p' out.txt | grep -cE '^ {20,}[^ ]' || true)
  [ "$(printf '%s' "$bare" | grep -c .)" -le "$wrapped" ] || { echo "FAILED: $command: without explanation: $bare"; failures=1; }
done

expect 2
expect 2 nonsense
expect 2 check
expect 2 check --nonsense x
expect 2 check "$here/none"
says "none: cannot be read"
finish
