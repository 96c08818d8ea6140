#!/bin/sh
# Runs clang-tidy (.clang-tidy) over every source file of ours; takes a while, so it is not part of ctest.
#   sh tests/tidy.sh [ROOM...]     needs a configured build/check and the package clang-tidy
set -eu
cd "$(dirname "$0")/.."
[ -f build/check/compile_commands.json ] || { echo "tests/tidy.sh: configure first: cmake --preset check" >&2; exit 1; }
command -v clang-tidy >/dev/null || { echo "tests/tidy.sh: install clang-tidy first: apt-get install clang-tidy" >&2; exit 1; }
find ${*:-core dem sim planner campaign api server} -name '*.cc' | sort | xargs -P "$(nproc)" -n 1 clang-tidy --quiet -p build/check
