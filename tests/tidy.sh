#!/bin/sh
# Runs clang-tidy (.clang-tidy) over every source file of ours; takes a while, so it is not part of ctest.
#   sh tests/tidy.sh [FOLDER...]     needs what tests/run.sh installs and the package clang-tidy
set -eu
cd "$(dirname "$0")/.."
command -v clang-tidy >/dev/null || { echo "tests/tidy.sh: install clang-tidy first: apt-get install clang-tidy" >&2; exit 1; }
# clang can't read what g++ precompiled, so every file is looked at alone.
cmake --preset tidy >/dev/null || { echo "tests/tidy.sh: cmake could not configure" >&2; exit 1; }
# What Simbody's headers say is Simbody's: the judge of the multibody's equations in tests/sim.
find ${*:-core dem sim planner gap campaign benchmark api validation server bench tests} -name '*.cc' \
  ! -name 'simbody_multibody.cc' ! -path 'tests/install/*' | sort |
  xargs -P "$(nproc)" -n 1 clang-tidy --quiet -p build/tidy
