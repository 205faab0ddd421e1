#!/usr/bin/env bash
# Installs what is missing, then builds and runs the tests with sanitizers, but those that take long (ctest --preset long). Whatever is
# up to date is not built again.
#   tests/run.sh [PRESET]     dev (default: Clang), gcc, release (Clang) or release-gcc
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-dev}

case $preset in
  *gcc) .ci/install-packages ;;
  *) .ci/install-packages clang ;;
esac
# A folder that another compiler has begun would lose its settings.
cache=build/dev/CMakeCache.txt
if [ "$preset" = dev ] && [ -e "$cache" ] && ! grep -q '^CMAKE_CXX_COMPILER:.*clang' "$cache"; then rm -rf build/dev; fi
cmake --workflow --preset "$preset"
