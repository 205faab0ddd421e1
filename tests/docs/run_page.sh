#!/usr/bin/env bash
# run_page.sh PAGE TOOL SCRATCH: runs what a page tells its reader to type.
#
#   ```sh          run, in order, in one shell; a command that fails fails the page
#   ```console     "$ command" lines are run; the lines below each are what it has to print ("…" stands for anything)
#   ```sh no-run   not run (it installs, builds or takes long): the scripts and presets it names have to exist, and
#                  the tool has to know the subcommands and options
#
# A ```sh block that installs or builds (a script of the project, cmake, apt-get, git) counts as no-run.
#
# The folder of the page's commands holds links to the project's files, so that relative paths work and nothing is
# written into the checkout.
set -euo pipefail
page=$1 tool=$2 scratch=$3
root=$(cd "$(dirname "$0")/../.." && pwd)

if [ -n "$(ls -A "$scratch" 2>/dev/null)" ] && [ ! -d "$scratch/.page" ]; then echo "run_page.sh: $scratch is no scratch folder of an earlier run: left alone" >&2; exit 1; fi
rm -rf "$scratch"
mkdir -p "$scratch/build/release" "$scratch/.page"
for entry in "$root"/* "$root"/.ci; do
  [ "$(basename "$entry")" = build ] || ln -s "$entry" "$scratch/"
done
ln -s "$(dirname "$tool")" "$scratch/build/release/bin"
cp "$root/CMakePresets.json" "$scratch/.page/presets"
PATH=$(dirname "$tool"):$PATH
export PATH LC_ALL=C.UTF-8
cd "$scratch"

fail() { echo "$(basename "$page"): $*" >&2; exit 1; }

# Compares what a command printed with what the page shows; "…" matches any text, also over lines.
as_shown() {
  local pattern actual
  pattern=$(sed 's/[][*?\\()|+@!]/\\&/g; s/…/*/g' "$1") actual=$(<"$2")
  # shellcheck disable=SC2053  # the right side is a pattern on purpose
  [[ $actual == $pattern ]]
}

check_unrun() {
  local line word words sub help
  while IFS= read -r line; do
    line=${line%%#*}
    read -ra words <<<"$line"
    [ ${#words[@]} -gt 0 ] || continue
    for word in "${words[@]}"; do
      case $word in
        */*.sh | .ci/*) [ -x "$root/$word" ] || fail "no executable $word" ;;
      esac
    done
    if [[ $line =~ --preset[\ =]([a-z-]+) ]]; then
      grep -q "\"name\": \"${BASH_REMATCH[1]}\"" .page/presets || fail "no preset ${BASH_REMATCH[1]}"
    fi
    if [[ ${words[0]} == rosin || ${words[0]} == */rosin ]]; then
      sub=${words[1]:-}
      [[ $sub == -* ]] && sub=""
      help=$("$tool" ${sub:+"$sub"} --help) || fail "the tool has no subcommand $sub"
      for word in "${words[@]:1}"; do
        [[ $word != --* ]] || grep -qE -- "${word%%=*}\b" <<<"$help" || fail "rosin $sub has no option $word"
      done
    fi
  done <<<"$1"
}

check_block() {
  bash -n <<<"$block" || fail "not shell: $block"
  check_unrun "$block"
}

# One script for the whole page, so that variables and folders carry over from block to block.
script=.page/script; : >"$script"
n=0 state=text block=""
flush_command() {
  [ -n "${command:-}" ] || return 0
  n=$((n + 1))
  printf '%s' "$shown" >".page/$n.shown"
  { printf '%s >.page/%d.printed\n' "{ $command
}" "$n"
    # shellcheck disable=SC2016  # expanded when the script runs
    printf 'as_shown .page/%d.shown .page/%d.printed || fail "%s does not print what the page shows, but:\n$(<.page/%d.printed)"\n' \
      "$n" "$n" "$(printf '%s' "$command" | tr -d '\\"`$')" "$n"; } >>"$script"
  command=""
}
while IFS= read -r line || [ -n "$line" ]; do
  case $state:$line in
    text:'```sh') state=sh block="" ;;
    text:'```sh no-run') state=unrun block="" ;;
    text:'```console') state=console command="" shown="" ;;
    text:'```sh '* | text:'```console '*) fail "unknown kind of block: $line" ;;
    text:'```'*) state=other ;;
    other:'```') state=text ;;
    sh:'```')
      if grep -qE '^(\.ci/|tests/run\.sh|examples/demo\.sh|cmake |sudo |apt-get |git )' <<<"$block"; then check_block
      else printf '%s' "$block" >>"$script"; fi
      state=text ;;
    unrun:'```') check_block; state=text ;;
    console:'```') flush_command; state=text ;;
    sh:* | unrun:*) block+=$line$'\n' ;;
    console:'$ '*) flush_command; command=${line#'$ '} shown="" ;;
    console:*) shown+=${shown:+$'\n'}$line ;;
  esac
done <"$page"
[ "$state" = text ] || fail "a block is not closed"

trap 'echo "$(basename "$page"): failed: $BASH_COMMAND" >&2' ERR
# shellcheck source=/dev/null
source "$script"
