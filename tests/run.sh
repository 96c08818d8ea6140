#!/bin/sh
# Installs, builds (warnings are errors) and runs every test. Ends with a table of what each stage took.
#   sh tests/run.sh                       everything
#   sh tests/run.sh -L unit               further arguments go to ctest
#   SANITIZE=yes sh tests/run.sh          builds the quick tests and the fuzzers once more, with the address and
#                                         undefined-behaviour sanitizers, and runs those too
set -eu
cd "$(dirname "$0")/.."
. tests/stages.sh

stage "install packages" sh deploy/install.sh --test ||
  fail "the packages above could not be installed; mend that and run this again"
stage "configure" cmake --preset check || fail "cmake could not configure; the first message above says what is missing"
stage "build" cmake --build --preset check || fail "the build broke; the first error above says where"
stage "test" ctest --preset check --progress -j "$(nproc)" "$@" ||
  fail "a test failed; run it alone with: ctest --preset check -R NAME"
[ "${SANITIZE:-}" = yes ] || exit 0
stage "configure with sanitizers" cmake --preset asan || fail "cmake could not configure the preset asan"
stage "build with sanitizers" cmake --build --preset asan || fail "the build with sanitizers broke"
stage "test with sanitizers" ctest --preset asan --progress -j "$(nproc)" ||
  fail "a sanitizer found something; run the test alone with: ctest --preset asan -R NAME"
