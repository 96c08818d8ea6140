#!/bin/sh
# slipway test-model: a model made of one half of a campaign's drives predicts the other half.
#   check_command_test.sh SLIPWAY SOURCE_FOLDER
set -eu
slipway="$1"
source="$2"
data="$source/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

# Every fourth drive and those two behind them, so that both have every slope and temperature.
for half in 0 1; do
  cp -r "$data/gap-practice/p05" "$folder/half-$half"
  chmod -R u+w "$folder/half-$half"
  python3 - "$folder/half-$half/campaign.json" "$half" <<'HALVE'
import json, sys
path, half = sys.argv[1], int(sys.argv[2])
campaign = json.load(open(path))
campaign["name"] = f"p05-{half}"
campaign["drives"] = campaign["drives"][2 * half::4]
json.dump(campaign, open(path, "w"), indent=1)
HALVE
done
expect 0 "$slipway" diagnose "$folder/half-0" --data "$data" --model "$folder/model"
holds '"noise"' "$folder/model/model.json"

expect 0 "$slipway" test-model "$folder/half-1" --model "$folder/model" --data "$data" --json --threads 1
cp "$folder/out" "$folder/check.json"
expect 0 "$slipway" test-model "$folder/half-1" --model "$folder/model" --data "$data" --json --threads 2
cmp "$folder/out" "$folder/check.json"
python3 - "$folder/check.json" <<'CHECK'
import json, sys
d = json.load(open(sys.argv[1]))
assert d["format"] == "model-check/1" and d["campaign"] == "p05-1" and d["model"]["campaign"] == "p05-0", d
assert d["drives"] == 11
current, slip = (next(c for c in d["channels"] if c["channel"] == name and c["slope"] == "all") for name in ("current", "slip"))
for error in ("rms", "median_abs"):
    down = current[error]["down_percent"]
    low, high = down["interval_90"]
    assert 75 < low <= down["value"] <= high <= 100, (error, down)
    assert abs(down["value"] - 100 * (1 - current[error]["corrected"] / current[error]["nominal"])) < 0.01
for channel in (current, slip):
    assert 0.4 < channel["within_50"] < 0.9 and 0.8 < channel["within_90"] <= 1, channel
slopes = [c for c in d["channels"] if c["channel"] == "current" and c["slope"] != "all"]
assert [c["slope"] for c in slopes] == ["up", "level", "down"], slopes
assert sum(c["values"] for c in slopes) == current["values"]
CHECK
expect 0 "$slipway" test-model "$folder/half-1" --model "$folder/model" --data "$data"
holds '^current  *all' "$folder/out"
holds 'note: Intervals of the corrected prediction account for' "$folder/out"

# Soil that is called otherwise is refused with its place, and taken where it is named.
sed -i 's/"nominal"/"sand"/g' "$folder/half-1/campaign.json"
expect 2 "$slipway" test-model "$folder/half-1" --model "$folder/model" --data "$data"
holds '/soils/sand: "sand" is none of the soils that the model corrects: nominal' "$folder/err"
expect 0 "$slipway" test-model "$folder/half-1" --model "$folder/model" --data "$data" --ground sand --json
# Another rover, and a ground that is not there: both are told.
sed -i 's/"mer-class"/"mer-b"/' "$folder/half-1/campaign.json"
expect 2 "$slipway" test-model "$folder/half-1" --model "$folder/model" --data "$data" --ground snad
holds "/rover/name: the campaign's rover is \"mer-b\", the model's was \"mer-class\"" "$folder/err"
holds '/ground/0: unknown soil "snad"; did you mean "sand"' "$folder/err"
# Neither drives nor a model: the faults of both.
sed -i '5s/^[^,]*,/five,/' "$folder/half-1/D003.csv"
rm "$folder/model/model.json"
expect 2 "$slipway" test-model "$folder/half-1" --model "$folder/model" --data "$data"
holds 'D003.csv, line 5, column 1 (t_s)' "$folder/err"
holds 'model.json#' "$folder/err"
[ ! -s "$folder/out" ]
echo "as expected"
