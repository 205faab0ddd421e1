#!/usr/bin/env bash
# Installs what is missing from Debian and builds the tool; quick where both are there.
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/install-packages
cmake --workflow --preset tool
build/release/bin/rosin --version
