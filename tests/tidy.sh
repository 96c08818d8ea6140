#!/bin/sh
# Runs clang-tidy (.clang-tidy) over every source file of ours; takes a while, so it is not part of ctest.
#   sh tests/tidy.sh [ROOM...]     needs what tests/run.sh installs and the package clang-tidy
set -eu
cd "$(dirname "$0")/.."
command -v clang-tidy >/dev/null || { echo "tests/tidy.sh: install clang-tidy first: apt-get install clang-tidy" >&2; exit 1; }
# clang can't read what g++ precompiled, so every file is looked at alone.
cmake --preset check -B build/tidy -DSLIPWAY_PCH=OFF >/dev/null || { echo "tests/tidy.sh: cmake could not configure" >&2; exit 1; }
find ${*:-core dem sim planner campaign api server} -name '*.cc' | sort | xargs -P "$(nproc)" -n 1 clang-tidy --quiet -p build/tidy
