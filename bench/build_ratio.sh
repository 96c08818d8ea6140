#!/bin/sh
# Processor time of a release build from scratch, as a multiple of compiling one fixed file, so that machines and days compare.
#   sh bench/build_ratio.sh [BUILD_FOLDER]     a new folder by default; without a compiler cache
set -eu
cd "$(dirname "$0")/.."
. tests/stages.sh
folder=${1:-$(mktemp -d)}
export CCACHE_DISABLE=1

# Runs a command and leaves in `ticks` what it took of the processor, in hundredths of a second.
measure() {
  began=$(processor_ticks)
  "$@" >"$folder/log" 2>&1 || { tail -20 "$folder/log" >&2; exit 1; }
  ticks=$(($(processor_ticks) - began))
}

mkdir -p "$folder"
printf '#include <Eigen/Dense>\n#include <map>\n#include <string>\nint main() { Eigen::MatrixXd a = Eigen::MatrixXd::Random(5, 5); std::map<std::string, double> m; m["x"] = a.ldlt().solve(a).trace(); return m.size() > 1; }\n' >"$folder/reference.cc"
measure c++ -std=c++20 -O2 -isystem /usr/include/eigen3 -c "$folder/reference.cc" -o "$folder/reference.o"
reference=$ticks
cmake --preset release -B "$folder/build" >"$folder/log"
measure cmake --build "$folder/build"
build=$ticks
lines=$(git ls-files core dem sim steps planner gap campaign api server | grep -E '\.(cc|h)$' | xargs cat | wc -l)
echo "$build $reference $lines" | awk '{ printf "release build %.0f s of the processor (%.1f min), reference file %.1f s, ratio %.0f; %d lines in the product\n", $1 / 100, $1 / 6000, $2 / 100, $1 / $2, $3 }'
