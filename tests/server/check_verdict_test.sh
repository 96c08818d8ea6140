#!/bin/sh
# slipway check, predict and plan end with the status of their verdict; the old form of check says what it is called now.
#   check_verdict_test.sh SLIPWAY SOURCE_FOLDER
set -eu
slipway="$1"
data="$2/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
. "$(dirname "$0")/../command_expectations.sh"

level="--path 8142640,-276640 8142638,-276640.2"
# Bars that any drive keeps, that none keeps, and that a few draws can't decide.
expect 0 "$slipway" check --data "$data" $level --max-embedding 1 --max-expected-stops 1000
grep -q '^GO$' "$folder/out" || { echo "no GO"; cat "$folder/out"; exit 1; }
expect 3 "$slipway" check --data "$data" $level --max-slip 0.001 --max-expected-stops 0.001
grep -q '^NO-GO$' "$folder/out"
grep -q 'slip_check trips in' "$folder/out"
expect 4 "$slipway" check --data "$data" $level --max-embedding 0.0001 --max-expected-stops 1000 --draws 40
grep -q '^UNKNOWN$' "$folder/out"
grep -q '40 draws of the ground do not decide' "$folder/out"

# A path that leaves the limit of tilt behind has a verdict: it arrived and ended with 0.
expect 3 "$slipway" predict --data "$data" --path 8142640,-276640 8142600,-276645 --max-tilt-deg 2 --draws 8
grep -q '^NO-GO$' "$folder/out"
expect 3 "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142630,-276641 --max-slip 0.001 --draws 2 --json

# A command sequence, a set of rules, and what can't be used.
expect verdict "$slipway" check --data "$data" --start 8142640,-276640,180 --command drive=2 turn=20 arc=2,5 --rules slip_70 --json
grep -q '"max_slip":0.7' "$folder/out"
expect 2 "$slipway" check --data "$data" --start 8142640,-276640 --command hop=2 --rules no_such
grep -q '/commands/0' "$folder/err"
grep -q '/rules' "$folder/err"
grep -q '/start' "$folder/err"
expect 2 "$slipway" check some_campaign --model some_model
grep -q 'slipway test-model' "$folder/err" "$folder/out"

# With drives of the past as evidence the same drive has other odds, and the answer says how many drives count.
expect verdict "$slipway" check --data "$data" $level --as-of-sol 978 --draws 64 --json
grep -q '"past_drives":6' "$folder/out"
echo "verdicts and exit statuses agree"
