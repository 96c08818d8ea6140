#!/bin/sh
# Installs, builds (warnings are errors) and runs the tests. Ends with a table of what each stage took, and the twenty tests that
# took longest.
#   sh tests/run.sh                       the tests that a change must pass
#   sh tests/run.sh -C full               those and the long ones, some two hours more (CONTRIBUTING.md lists them)
#   sh tests/run.sh -L unit               further arguments go to ctest
#   SANITIZE=yes sh tests/run.sh          builds what reads bytes from outside and its fuzzers once more, with the address and
#                                         undefined-behaviour sanitizers, and runs those too
#   SANITIZE=full sh tests/run.sh         the same with the tests of the simulation
set -eu
cd "$(dirname "$0")/.."
. tests/stages.sh

# The tests that took longest, as ctest has noted it in the file of its costs: seconds by the clock, the mean over the runs.
print_dearest() {
  costs=build/check/Testing/Temporary/CTestCostData.txt
  [ "$tested" = yes ] && [ -s "$costs" ] || return 0
  printf '\n%-56s %8s\n' "the twenty dearest tests" "seconds"
  sed '/^---/,$d' "$costs" | sort -k 3,3nr | head -20 | awk '{ printf "%-56s %8.1f\n", $1, $3 }'
}
tested=no
trap 'print_stages; print_dearest' EXIT

stage "install packages" sh deploy/install.sh --test ||
  fail "the packages above could not be installed; mend that and run this again"
stage "configure" cmake --preset check || fail "cmake could not configure; the first message above says what is missing"
stage "build" cmake --build --preset check || fail "the build broke; the first error above says where"
tested=yes
# One more than processors: tests that wait for a service or a browser leave theirs idle.
stage "test" ctest --preset check --progress -j "$(($(nproc) + 1))" "$@" ||
  fail "a test failed; run it alone with: ctest --preset check -R NAME"
case "${SANITIZE:-}" in
  yes) sanitized=sanitized_tests readers_alone=ON ;;
  full) sanitized=more_sanitized_tests readers_alone=OFF ;;
  *) exit 0 ;;
esac
stage "configure with sanitizers" cmake --preset asan -DSLIPWAY_SANITIZE_READERS_ALONE=$readers_alone || fail "cmake could not configure the preset asan"
stage "build with sanitizers" cmake --build --preset asan --target "$sanitized" || fail "the build with sanitizers broke"
stage "test with sanitizers" ctest --preset asan --progress -j "$(nproc)" ||
  fail "a sanitizer found something; run the test alone with: ctest --preset asan -R NAME"
