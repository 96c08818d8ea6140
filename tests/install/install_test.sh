#!/bin/sh
# An install into an empty prefix: the program works from any directory and finds its data in the promised order, and an
# outside CMake project finds and uses a library.
#   install_test.sh CMAKE BUILD_FOLDER SOURCE_FOLDER SLIPWAY CXX_COMPILER VERSION
set -eu
cmake="$1"
build="$2"
source="$3"
built="$4"
compiler="$5"
version="$6"
folder="$(cd "$(mktemp -d)" && pwd -P)"
trap 'rm -rf "$folder"' EXIT
unset SLIPWAY_DATA

. "$source/tests/command_expectations.sh"

# Moved after it was installed: nothing may point back to where it was installed or built.
"$cmake" --install "$build" --prefix "$folder/first" >"$folder/install.log" || { cat "$folder/install.log"; exit 1; }
mv "$folder/first" "$folder/prefix"
prefix="$folder/prefix"
slipway="$prefix/bin/slipway"
for file in share/slipway/data/rovers/msl-class.json share/doc/slipway/LICENSE share/doc/slipway/README.md \
  include/slipway/sim/soil/soil.h; do
  [ -f "$prefix/$file" ] || { echo "$file was not installed"; exit 1; }
done

# The version stands alone in the first line, the data folder in the second.
cd /
says() {
  expect 0 "$@" --version
  [ "$(sed -n 1p "$folder/out")" = "$version" ] || { echo "another version:"; cat "$folder/out"; exit 1; }
  sed -n 2p "$folder/out" >"$folder/second"
}
says "$slipway"
holds "^data: $prefix/share/slipway/data (found by looking under the install prefix)$" "$folder/second"
says "$built"
holds "^data: $source/data (found by looking beside the executable)$" "$folder/second"

# The same plan as the build folder's program with the source tree's data.
plan="plan --start 8142688.55,-276614.34 --goal 8142660,-276640 --routes 1 --json"
expect verdict "$built" $plan --data "$source/data"
mv "$folder/out" "$folder/wanted"
expect verdict "$slipway" $plan
cmp "$folder/wanted" "$folder/out"
expect 0 "$slipway" campaign list
holds '^fido_table_1 ' "$folder/out"
expect 0 "$slipway" validate --only kernel_cross_check

# Each place comes before those that were tried so far.
folder_with() {
  mkdir -p "$2/rovers"
  cp "$source/data/rovers/$1.json" "$2/rovers"
  cp -r "$source/data/soils" "$2"
}
folder_with mer-class "$prefix/bin/data"
folder_with fido-class "$folder/variable"
folder_with cuadriga "$folder/option"
says "$slipway"
holds "^data: $prefix/bin/data (found by looking beside the executable)$" "$folder/second"
expect 0 "$slipway" rovers
holds mer-class "$folder/out"
says env SLIPWAY_DATA="$folder/variable" "$slipway"
holds "^data: $folder/variable (found by SLIPWAY_DATA)$" "$folder/second"
expect 0 env SLIPWAY_DATA="$folder/variable" "$slipway" rovers
holds fido-class "$folder/out"
expect 0 env SLIPWAY_DATA="$folder/variable" "$slipway" rovers --data "$folder/option"
holds cuadriga "$folder/out"
# What is named and is no data folder is refused: another folder's answer would not be what was asked for.
expect 1 env SLIPWAY_DATA="$folder/none" "$slipway" rovers
holds "SLIPWAY_DATA: $folder/none has no folders rovers and soils" "$folder/err"
expect 1 "$slipway" rovers --data "$folder/none"
holds "--data: $folder/none has no folders rovers and soils" "$folder/err"

# Without any data, every place that was looked at.
rm -r "$prefix/bin/data"
mv "$prefix/share/slipway/data" "$folder/away"
expect 1 "$slipway" rovers
for place in '--data: is not given' 'SLIPWAY_DATA: is not given' "beside the executable: $prefix/bin/data has no" \
  "under the install prefix: $prefix/share/slipway/data has no"; do
  holds "$place" "$folder/err"
done
says "$slipway"
holds '^data: none' "$folder/second"
mv "$folder/away" "$prefix/share/slipway/data"

# An outside project.
"$cmake" -S "$source/tests/install/consumer" -B "$folder/consumer" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" >"$folder/out" 2>&1 || { cat "$folder/out"; exit 1; }
"$cmake" --build "$folder/consumer" >"$folder/out" 2>&1 || { cat "$folder/out"; exit 1; }
expect 0 "$folder/consumer/consumer"
holds '^pull .* N, load ' "$folder/out"
if "$cmake" -S "$source/tests/install/consumer" -B "$folder/other" -G Ninja -DCMAKE_PREFIX_PATH="$folder/none" \
  -DCMAKE_CXX_COMPILER="$compiler" >"$folder/out" 2>&1; then
  echo "the outside project found some other slipway"
  exit 1
fi
echo "as expected"
