#!/bin/sh
# The command's exit status and files, as a person or a script meets them.
#   command_test.sh SLIPWAY DATA_FOLDER DOCS_PAGE
set -eu
slipway="$1"
data="$2"
page="$3"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

expect 0 "$slipway" validate --data "$data" --only kernel_cross_check --only ding_2011 --plots "$folder/plots"
holds '^\[2/2\] ding_2011' "$folder/err"
holds '^### Single-wheel tests of Ding' "$folder/out"
[ "$(ls "$folder/plots" | tr '\n' ' ')" = "ding_2011.svg kernel_cross_check.svg " ] || { echo "other plots"; exit 1; }
mv "$folder/plots" "$folder/first"
expect 0 "$slipway" validate --data "$data" --only kernel_cross_check --only ding_2011 --plots "$folder/plots" --json
cmp "$folder/first/ding_2011.svg" "$folder/plots/ding_2011.svg"
python3 -c 'import json, sys; d = json.load(open(sys.argv[1])); assert d["holds"] and len(d["comparisons"]) == 2, d' \
  "$folder/out"

expect 2 "$slipway" validate --data "$data" --only no_such_comparison
holds 'kernel_cross_check' "$folder/err"
expect 2 "$slipway" validate --data "$data" --only ding_2011 --check "$page"
expect 1 "$slipway" validate --data "$folder" --only plate_tests

# A band that the model leaves. A page that says something else is noticed by the code that worlds_command_test.sh runs;
# all comparisons against the page that ships are a test of their own.
cp -r "$data" "$folder/data"
sed -i 's/^0.2,26,29,/0.2,26,26.5,/' "$folder/data/validation/roverdevkit_bands.csv"
expect 1 "$slipway" validate --data "$folder/data" --only kernel_cross_check
holds 'a stated band does not hold' "$folder/err"
echo "as expected"
