#!/bin/sh
# Installs, builds (warnings are errors), runs every test, and says how long each stage took. Further arguments go to ctest:
#   sh tests/run.sh -L unit
set -eu
cd "$(dirname "$0")/.."
. deploy/stages.sh

say() { printf '\n== %s\n' "$*"; }
fail() { print_stages; echo "tests/run.sh: $*" >&2; exit 1; }

stage install
say "installing what is missing"
sh deploy/install.sh --test || fail "the packages above could not be installed; mend that and run this again"
stage configure
say "configuring (preset check, sources in batches)"
cmake --preset check -DSLIPWAY_UNITY=ON || fail "cmake could not configure; the first message above says what is missing"
stage build
say "building (preset check)"
cmake --build --preset check || fail "the build broke; the first error above says where"
stage test
say "running every test"
ctest --preset check --progress -j "$(nproc)" "$@" || fail "a test failed; run it alone with: ctest --preset check -R NAME"
print_stages
