#!/bin/sh
# Runs clang-tidy (.clang-tidy) over every source file of ours, and says which sources it did not see. All of it takes
# about 35 minutes of processor time, so it is not part of ctest: tests about 12, sim 5, api and server 3.5 each, gap 3, the
# other rooms 5 together.
#   sh tests/tidy.sh [FOLDER...]     needs what tests/run.sh installs and the package clang-tidy
#   JOBS=1 sh tests/tidy.sh sim      on one processor
set -eu
cd "$(dirname "$0")/.."
command -v clang-tidy >/dev/null || { echo "tests/tidy.sh: install clang-tidy first: apt-get install clang-tidy" >&2; exit 1; }
# Most of the time would go to reading the same headers once for every source, so clang-tidy reads the batches of
# cmake/unity.cmake. Clang can't read what g++ precompiled, so the preset does without. The analyser takes sources that a
# batch includes for headers, which it passes over, unless the path of the batch contains "UnifiedSource".
build=build/tidy/UnifiedSource
cmake --preset tidy >/dev/null || { echo "tests/tidy.sh: cmake could not configure" >&2; exit 1; }

rooms=${*:-core dem sim steps planner gap campaign benchmark api validation server bench tests}
# Every source of these folders. What Simbody's headers say is Simbody's: the judge of the multibody's equations in tests/sim.
sources=$(for room in $rooms; do find "$PWD/${room%/}" -name '*.cc'; done |
  grep -v -e '/simbody_multibody\.cc$' -e '/tests/install/')
# What the compiler is given for each: a batch that includes it, or the source itself.
given=$(sed -n 's/^ *"file": "\(.*\)",*$/\1/p' $build/compile_commands.json | sort -u)
units=$(for file in $given; do
  case $file in
    "$PWD/$build"/*) sed -n "s|^#include \"\(.*\.cc\)\"\$|\1 $file|p" "$file" ;;
    *) echo "$file $file" ;;
  esac
done)
missing=$(printf '%s\n' "$units" "$sources" | awk 'NF == 2 {unit[$1] = 1} NF == 1 && !($1 in unit)')
[ -z "$missing" ] || { echo "tests/tidy.sh: no target of preset tidy compiles" $missing >&2; exit 1; }

# A batch is meant to include sources, which clang-tidy would find suspicious. The analyser gives up a function after so
# many states: with a quarter of its default it takes a quarter of the time. Clang does not know all of g++'s options.
printf '%s\n' "$sources" "$units" | awk 'NF == 1 {wanted[$1] = 1} NF == 2 && $1 in wanted {print $2}' | sort -u |
  xargs -P "${JOBS:-$(nproc)}" -n 1 clang-tidy --quiet -p $build --checks=-bugprone-suspicious-include \
    --extra-arg=-Xclang --extra-arg=-analyzer-config --extra-arg=-Xclang --extra-arg=max-nodes=50000 \
    --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-unused-command-line-argument
