#!/bin/sh
# slipway worlds: its scores are counted again from their file, and a page that says something else is noticed. That
# a seed gives the same scores on any number of threads is a test of the library.
#   worlds_command_test.sh SLIPWAY DATA_FOLDER DOCS_PAGE
set -eu
slipway="$1"
data="$2"
page="$3"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

expect 0 "$slipway" worlds --data "$data" --seed 31 --worlds 1 --drives 4 --csv "$folder/one.csv"
holds '^### Planners in worlds whose truth is known' "$folder/out"
cp "$folder/out" "$folder/printed"
expect 0 "$slipway" worlds --scores "$folder/one.csv" --plots "$folder/plots"
cmp "$folder/out" "$folder/printed"
holds 'svg' "$folder/plots/worlds_reliability.svg"

# A table that was changed by hand.
sed 's/^| shortest | 40 of 40 |/| shortest | 39 of 40 |/' "$page" >"$folder/page.md"
cmp -s "$page" "$folder/page.md" && { echo "the page was not altered"; exit 1; }
expect 1 "$slipway" worlds --scores "$data/validation/worlds_scores.csv" --check "$folder/page.md"
expect 0 "$slipway" worlds --scores "$data/validation/worlds_scores.csv" --write "$folder/page.md"
cmp "$page" "$folder/page.md"

expect 2 "$slipway" worlds --data "$data" --rover no-such-rover --worlds 1
expect 2 "$slipway" worlds --scores "$folder/one.csv" --seed 3
expect 1 "$slipway" worlds --scores "$folder/nothing.csv"
echo "as expected"
