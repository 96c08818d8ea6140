#!/bin/sh
# slipway steps and slipway watch of measured steps, as a person or a script meets them.
#   steps_command_test.sh SLIPWAY SOURCE_FOLDER
set -eu
slipway="$1"
data="$2/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

marias="$data/terrains/gale/curiosity_steps_0960_1000.csv"

# Every row of the table has its forecast; the keys are those that others read.
for learn in none sols drive; do
  expect 0 "$slipway" steps score "$marias" --data "$data" --learn "$learn" --json
  cp "$folder/out" "$folder/$learn.json"
done
expect 0 "$slipway" steps score "$marias" --data "$data" --terrain gale --json --plot "$folder/steps.svg"
cp "$folder/out" "$folder/map.json"
python3 - "$folder" "$marias" <<'CHECK'
import csv, json, pathlib, sys, xml.dom.minidom
folder, table = pathlib.Path(sys.argv[1]), list(csv.DictReader(open(sys.argv[2])))
def refuse(word): raise ValueError(word)
for name in ("none", "sols", "drive", "map"):
    d = json.loads((folder / f"{name}.json").read_text(), parse_constant=refuse)
    assert d["format"] == "steps-score/1" and len(d["steps"]) == len(table), name
    for step, row in zip(d["steps"], table):
        assert set(step) == {"sol", "path_pitch_deg", "slip", "slip_p05", "slip_p50", "slip_p95", "p_over_0_2", "p_over_0_4"}, step
        assert step["sol"] == int(row["sol"]) and step["slip"] == float(row["slip"]), (name, step)
        if step["slip_p50"] is None:
            assert name == "map", step
            continue
        assert step["slip_p05"] <= step["slip_p50"] <= step["slip_p95"], step
        assert 0 <= step["p_over_0_4"] <= step["p_over_0_2"] <= 1, step
    s = d["summary"]
    # Well outside of what was measured here (0.0192 to 0.0247; 88 to 92 %).
    assert s["median_error"]["value"] < 0.03 and 0.8 < s["in_90_band"]["value"] < 0.97, (name, s["median_error"], s["in_90_band"])
assert json.loads((folder / "drive.json").read_text())["summary"]["step_over_0_4"]["auc"] > 0.93
xml.dom.minidom.parse(str(folder / "steps.svg"))
CHECK

# Ordinary ground raises no alarm; where Curiosity was stopped on gentle slopes there is one, and it names a place.
head -400 "$data/steps/curiosity_0045_0582.csv" >"$folder/plains.csv"
expect 0 "$slipway" watch "$folder/plains.csv" --data "$data"
holds 'no sol came onto loose ground' "$folder/out"
expect 6 "$slipway" watch "$marias" --data "$data" --json
python3 - "$folder/out" <<'CHECK'
import json, sys
d = json.load(open(sys.argv[1]))
assert {978, 983} <= {a["sol"] for a in d["alarms"]} and all(a["cause"] == "soft_patch" for a in d["alarms"]), d
CHECK

# Faults with their line and column; nothing is written of them.
sed '3s/^[^,]*/seven/' "$marias" >"$folder/broken.csv"
expect 2 "$slipway" steps score "$folder/broken.csv" --data "$data"
holds 'line 3' "$folder/err"
expect 2 "$slipway" steps score "$folder/nowhere.csv" --data "$data"
expect 2 "$slipway" steps score "$marias" --data "$data" --rover no-such-rover
holds 'no-such-rover' "$folder/err"
expect 2 "$slipway" steps score "$data/steps/perseverance_0014_0700.csv" --data "$data" --terrain gale
holds 'no step lies on terrain' "$folder/err"
expect 2 "$slipway" steps learn "$marias" --data "$data" --class "dune=978:x" --class "other=5" --out "$folder/soils.json"
holds 'dune=978:x' "$folder/err"
holds 'no step of the tables belongs to' "$folder/err"
[ ! -e "$folder/soils.json" ]
echo "as expected"
