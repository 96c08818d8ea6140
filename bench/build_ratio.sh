#!/bin/sh
# Processor time of a release build from scratch, as a multiple of compiling one fixed file, so that machines and days compare.
#   sh bench/build_ratio.sh [BUILD_FOLDER]     a new folder by default; without a compiler cache
set -eu
cd "$(dirname "$0")/.."
folder=${1:-$(mktemp -d)}
export CCACHE_DISABLE=1

# User and system seconds of a command.
seconds() {
  /usr/bin/time -f '%U %S' -o "$folder/time" "$@" >"$folder/log" 2>&1 || { tail -20 "$folder/log" >&2; exit 1; }
  tail -1 "$folder/time" | awk '{ print $1 + $2 }'
}

mkdir -p "$folder"
printf '#include <Eigen/Dense>\n#include <map>\n#include <string>\nint main() { Eigen::MatrixXd a = Eigen::MatrixXd::Random(5, 5); std::map<std::string, double> m; m["x"] = a.ldlt().solve(a).trace(); return m.size() > 1; }\n' >"$folder/reference.cc"
reference=$(seconds c++ -std=c++20 -O2 -isystem /usr/include/eigen3 -c "$folder/reference.cc" -o "$folder/reference.o")
cmake --preset release -B "$folder/build" >"$folder/log"
build=$(seconds cmake --build "$folder/build")
lines=$(git ls-files core dem sim steps planner gap campaign api server | grep -E '\.(cc|h)$' | xargs cat | wc -l)
echo "$build $reference $lines" | awk '{ printf "release build %.0f s of the processor (%.1f min), reference file %.1f s, ratio %.0f; %d lines in the product\n", $1, $1 / 60, $2, $1 / $2, $3 }'
