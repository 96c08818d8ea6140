#!/bin/sh
# Installs, builds (warnings are errors) and runs every test. Further arguments go to ctest: sh tests/run.sh -L unit
set -eu
cd "$(dirname "$0")/.."

say() { printf '\n== %s\n' "$*"; }
fail() { echo "tests/run.sh: $*" >&2; exit 1; }

say "installing what is missing"
sh deploy/install.sh --test || fail "the packages above could not be installed; mend that and run this again"
say "configuring (preset check)"
cmake --preset check || fail "cmake could not configure; the first message above says what is missing"
say "building (preset check)"
cmake --build --preset check || fail "the build broke; the first error above says where"
say "running every test"
ctest --preset check --progress -j "$(nproc)" "$@" || fail "a test failed; run it alone with: ctest --preset check -R NAME"
