#!/bin/sh
# slipway diagnose as a person or a script meets it.
#   diagnose_command_test.sh SLIPWAY SOURCE_FOLDER
set -eu
slipway="$1"
source="$2"
data="$source/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

# Every fourth drive shows the same; the whole of p05 is held by the documents that print what it shows.
mkdir "$folder/few"
for campaign in p01 p05; do
  cp -r "$data/gap-practice/$campaign" "$folder/few/$campaign"
  chmod -R u+w "$folder/few/$campaign"
  python3 - "$folder/few/$campaign/campaign.json" <<'FEW'
import json, sys
campaign = json.load(open(sys.argv[1]))
campaign["drives"] = campaign["drives"][::4]
json.dump(campaign, open(sys.argv[1], "w"))
FEW
done

# Motors whose constant and friction change in the cold.
expect 0 "$slipway" diagnose "$folder/few/p05" --data "$data" --json --report "$folder/report" --model "$folder/model"
cp "$folder/out" "$folder/first.json"
cmp "$folder/first.json" "$folder/report/diagnosis.json"
# A report that can't be written is refused before the work.
# A shipped campaign is named anywhere; a folder of that name without a campaign does not stand in its way.
mkdir "$folder/elsewhere" "$folder/elsewhere/p05"
status=0
(cd "$folder/elsewhere" && "$slipway" diagnose p05 --reference nowhere --data "$data" >"$folder/out" 2>"$folder/err") || status=$?
[ "$status" = 2 ] || { echo "status $status"; exit 1; }
holds 'there is no folder "nowhere"' "$folder/err"
expect 1 "$slipway" diagnose "$data/gap-practice/p05" --data "$data" --json --report "$folder/first.json/report"
[ ! -s "$folder/out" ]
python3 - "$folder" <<'CHECK'
import json, pathlib, sys, xml.dom.minidom
folder = pathlib.Path(sys.argv[1])
def refuse(word): raise ValueError(word)
d = json.loads((folder / "first.json").read_text(), parse_constant=refuse)
assert d["format"] == "diagnosis/1" and d["verdict"] == "effects", d["verdict"]
assert [e["name"] for e in d["effects"]] == ["motor_temperature"], d["effects"]
assert abs(sum(c["probability"] for c in d["candidates"]) - 1) < 1e-9
assert [] in [c["effects"] for c in d["candidates"]] and ["unknown"] in [c["effects"] for c in d["candidates"]]
current = next(c for c in d["gap"]["channels"] if c["channel"] == "current")
assert current["with_effects"]["value"] < 0.5 * current["retuned"]["value"], current
assert any("temperature" in c["variable"] for r in d["where"]["regimes_of_effect"] for c in r["condition"])
channels = d["where"]["channels_of_effects"]
assert channels[0]["channel"] == "current" and channels[0]["share"] > 0.9, channels
assert abs(sum(c["share"] for c in channels) - 1) < 1e-6, channels
report = (folder / "report" / "report.md").read_text()
assert "squared deviations of the noise, is current" in report
pictures = sorted(p.stem for p in (folder / "report").glob("*.svg"))
assert {"ladder", "explanations", "channels", "windows", "parameters"} <= set(pictures), pictures
for name in pictures:
    assert f"({name}.svg)" in report
    xml.dom.minidom.parse(str(folder / "report" / f"{name}.svg"))
page = (folder / "report" / "report.html").read_text()
for name in pictures:
    assert f'<figure id="{name}">' in page, name
xml.dom.minidom.parseString(page.replace("<!DOCTYPE html>", ""))
assert {"map", "regimes"} <= set(pictures), pictures
assert 0.9 < current["closed_fraction"]["value"] <= 1, current
[rover], [soils] = (list((folder / "model" / kind).iterdir()) for kind in ("rovers", "soils"))
assert json.loads(rover.read_text()) == d["model"]["rover"] and rover.stem == d["model"]["rover"]["name"]
assert json.loads(soils.read_text()) == d["model"]["soils"]
CHECK

# The corrected model is planned with like any other.
mkdir "$folder/data"
cp -r "$data/rovers" "$data/soils" "$source/tests/api/small_world/terrains" "$folder/data"
chmod -R u+w "$folder/data"
cp -r "$folder/model/." "$folder/data"
rover="$(basename "$folder/model/rovers/"*.json .json)"
soil="$(basename "$folder/model/soils/"*.json .json)"
sed -i "s/mer_b_sandy_loam/$soil/" "$folder/data/terrains/yard/terrain.json"
predict() {
  expect verdict "$slipway" predict --data "$folder/data" --terrain yard --rover "$rover" --path 20,30 28,30 30,36 --draws 4 --json "$@"
}
predict --motor-temp-c -60
cp "$folder/out" "$folder/cold.json"
predict --motor-temp-c 20
python3 - "$folder/cold.json" "$folder/out" "$soil" <<'CHECK'
import json, sys
cold, warm = (json.load(open(name)) for name in sys.argv[1:3])
energy = [answer["summary"]["energy_wh"] for answer in (cold, warm)]
assert energy[0] > 1.2 * energy[1], energy
assert sys.argv[3] in json.dumps(warm["provenance"]), warm["provenance"]
CHECK

# The folder itself does as well, on the ground that the request names; the answer says whose soil it was.
cp "$folder/out" "$folder/copied.json"
mkdir "$folder/world"
cp -r "$data/rovers" "$data/soils" "$source/tests/api/small_world/terrains" "$folder/world"
world="--data $folder/world --terrain yard --rover mer-class --draws 4"
expect verdict "$slipway" predict $world --path 20,30 28,30 30,36 --motor-temp-c 20 --json --model "$folder/model" --ground mer_b_sandy_loam
python3 - "$folder/copied.json" "$folder/out" <<'CHECK'
import json, sys
copied, taken = (json.load(open(name)) for name in sys.argv[1:3])
assert copied["summary"] == taken["summary"]
assert copied["provenance"]["soils"] == taken["provenance"]["soils"], taken["provenance"]
assert taken["rover"] == copied["rover"] != "mer-class"
CHECK

# What it changes in a plan: the same request without the model is one side, with it the other.
route="$world --start 20,30 --goal 30,60"
expect verdict "$slipway" plan $route --json
cp "$folder/out" "$folder/before.json"
expect verdict "$slipway" plan $route --json --model "$folder/model" --ground mer_b_sandy_loam
cp "$folder/out" "$folder/after.json"
expect 0 "$slipway" plan $route --json --model "$folder/model" --ground mer_b_sandy_loam --compare
python3 - "$folder" "$folder/out" <<'CHECK'
import json, pathlib, sys
folder, compared = pathlib.Path(sys.argv[1]), json.load(open(sys.argv[2]))
assert compared["format"] == "plan-comparison/1"
assert compared["nominal"] == json.loads((folder / "before.json").read_text())
assert compared["corrected"] == json.loads((folder / "after.json").read_text())
for side in ("nominal", "corrected"):
    ranks = sorted(pair[side]["rank"] for pair in compared["routes"] if pair[side])
    assert ranks == [route["rank"] for route in compared[side]["summary"]], ranks
for pair in compared["routes"]:
    before, after = pair["nominal"], pair["corrected"]
    assert before["mean_slip"] > 1.05 * after["mean_slip"], pair
    assert any(change.startswith("mean_slip") for change in pair["changed"]), pair
    assert (before["verdict"] != after["verdict"]) == any(c.startswith("verdict") for c in pair["changed"]), pair
CHECK
expect 0 "$slipway" plan $route --model "$folder/model" --ground mer_b_sandy_loam --compare
holds '^1 nominal (rank 1)' "$folder/out"
holds '^Route 1: mean_slip' "$folder/out"
expect 2 "$slipway" plan $route --model "$folder/model" --ground mer_b_sandy_laom
holds '/ground/0: unknown soil "mer_b_sandy_laom"; did you mean "mer_b_sandy_loam"' "$folder/err"
expect 2 "$slipway" plan $route --model "$folder/model" --ground jlu_mars_3_loose
holds '/ground/0: "jlu_mars_3_loose" is no soil of this terrain' "$folder/err"
expect 2 "$slipway" plan --data "$folder/world" --terrain yard --rover msl-class --start 20,30 --goal 30,60 --model "$folder/model"
holds '/rover: the model was made of "mer-class": it says nothing of "msl-class"' "$folder/err"
expect 2 "$slipway" plan $route --compare
expect 2 "$slipway" plan $route --model "$folder/model" --compare --map "$folder/map.svg"
cp -r "$folder/model" "$folder/torn"
rm "$folder/torn/soils/"*
sed -i 's/"nominal":"mer-class"/"nominal":7/' "$folder/torn/model.json"
expect 1 "$slipway" plan $route --model "$folder/torn"
holds 'model.json#/rover/nominal' "$folder/err"

# Without an effect it is not named; and the answer is the same on any number of threads.
for threads in 1 2; do
  expect 0 "$slipway" diagnose "$folder/few/p01" --data "$data" --without motor_temperature --threads $threads --json
  cp "$folder/out" "$folder/without-$threads.json"
done
cmp "$folder/without-1.json" "$folder/without-2.json"
python3 - "$folder/without-1.json" <<'CHECK'
import json, sys
d = json.load(open(sys.argv[1]))
assert d["provenance"]["withheld"] == ["motor_temperature"]
assert (d["verdict"], d["effects"]) == ("no_gap", []), d["reason"]
named = [e["name"] for e in d["effects"]] + [name for c in d["candidates"] for name in c["effects"]]
assert "motor_temperature" not in named, named
CHECK

# Faults of all files, each with its place.
cp -r "$data/gap-practice/p05" "$folder/broken"
chmod -R u+w "$folder/broken"
sed -i 's/"mass_kg": 174.0/"mass_kg": -174.0/; s/"terrain": "tilt_18"/"terrain": "tilt_81"/' "$folder/broken/campaign.json"
sed -i '5s/^[^,]*,/five,/' "$folder/broken/D002.csv"
rm "$folder/broken/D003.csv"
expect 2 "$slipway" diagnose "$folder/broken" --data "$data" --json
holds 'campaign.json, line 7, column 14 (/rover/mass_kg)' "$folder/err"
holds 'campaign.json, line [0-9]*, column 15 (/drives/43/terrain)' "$folder/err"
holds 'campaign.json, line [0-9]*, column 12 (/drives/2/file)' "$folder/err"
holds 'D002.csv, line 5, column 1 (t_s)' "$folder/err"
[ ! -s "$folder/out" ]
printf '{"format": "drive-campaign/1",\n "name" "p05"}' >"$folder/broken/campaign.json"
expect 2 "$slipway" diagnose "$folder/broken" --data "$data"
holds 'line 2, column' "$folder/err"
expect 2 "$slipway" diagnose "$folder/nowhere" --data "$data"
expect 2 "$slipway" diagnose "$data/gap-practice/p05" --data "$data" --without tether
holds 'unknown effect "tether"' "$folder/err"
echo "as expected"
