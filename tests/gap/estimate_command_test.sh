#!/bin/sh
# slipway estimate as a person or a script meets it.
#   estimate_command_test.sh SLIPWAY SOURCE_FOLDER
set -eu
slipway="$1"
source="$2"
data="$source/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

# The plates of the sand of data/validation: published beside them n 1.34 over all samples.
awk -F, 'NR==1{print "test,plate_radius_m,sinkage_m,pressure_pa"} NR>1{printf "%s,%s,%s,%s\n",$1,$2/2000,$4,$5*1000}' \
  "$data/validation/plate_sinkage_large_sandbox.csv" >"$folder/plates.csv"
expect 0 "$slipway" estimate plates "$folder/plates.csv" --data "$data" --json --soil-out "$folder/soil.json" --plot "$folder/plates.svg"
cp "$folder/out" "$folder/first.json"
expect 0 "$slipway" estimate plates "$folder/plates.csv" --data "$data" --json
cmp "$folder/first.json" "$folder/out"
python3 - "$folder" <<'CHECK'
import json, pathlib, sys, xml.dom.minidom
folder = pathlib.Path(sys.argv[1])
def refuse(word): raise ValueError(word)
d = json.loads((folder / "first.json").read_text(), parse_constant=refuse)
[estimate] = d["estimates"]
p = {p["name"]: p for p in estimate["parameters"]}
assert set(p) == {"k_c", "k_phi", "n"}, p
# The samples differ by more than their stated errors, so that the model does not hold and no number is called determined.
assert abs(p["n"]["value"] - 1.34) < 0.03 and p["n"]["determination"] == "undetermined", p["n"]
assert "the model does not hold" in p["n"]["words"], p["n"]
soils = json.loads((folder / "soil.json").read_text())
assert soils["format"] == "soils/1" and soils["soils"] == [estimate["soil"]]
xml.dom.minidom.parse(str(folder / "plates.svg"))
CHECK

# wheel_tests SOIL FILE COLUMN...: what slipway wheel reports on a soil, as a table of tests.
wheel_tests() {
  "$slipway" wheel --data "$data" --rover mer-class --soil "$1" --sweep slip=0.05:0.65:0.1 --sweep load_n=40,100,180,260 --json >"$folder/sweep.json"
  shift
  python3 - "$folder" "$@" <<'MAKE'
import json, pathlib, sys
folder, file, *columns = pathlib.Path(sys.argv[1]), *sys.argv[2:]
rows = json.loads((folder / "sweep.json").read_text())["rows"]
with open(folder / file, "w") as out:
    print(*columns, sep=",", file=out)
    for r in rows:
        print(*(r["slip" if column == "slip_ratio" else column] for column in columns), sep=",", file=out)
MAKE
}

# A wheel that slipway wheel reports on, from another soil.
wheel_tests dry_sand tests.csv load_n slip_ratio torque_nm drawbar_pull_n sinkage_m current_a
expect 0 "$slipway" estimate wheel "$folder/tests.csv" --data "$data" --rover mer-class --soil unknown_ground
holds 'friction_angle: .* determined' "$folder/out"
expect 0 "$slipway" estimate wheel "$folder/tests.csv" --data "$data" --rover mer-class --channels current --json
expect 0 "$slipway" estimate drives "$data/gap-practice/p01" --data "$data" --channels current
holds 'current ' "$folder/out"

# The soils whose c1 and c2 are drawn are the shipped ones in all else.
python3 - "$data" <<'CHECK'
import json, pathlib, sys
data = pathlib.Path(sys.argv[1])
shipped = {s["name"]: s for f in (data / "soils").glob("*.json") for s in json.loads(f.read_text())["soils"]}
for soil in json.loads((data / "beliefs" / "closures_drawn.json").read_text())["soils"]:
    assert soil["std"].pop("c1") > 0 and soil["std"].pop("c2") > 0, soil["name"]
    nominal = dict(shipped[soil["name"]])
    for s in (soil, nominal):
        s["correlation"] = [c for c in s.get("correlation", []) if c["first"] != "c1"]
        del s["assumed"]
    assert soil == nominal, soil["name"]
CHECK

# A belief about soils from the tests of two: the same bytes twice, and what is free in one alone is refused.
wheel_tests mpf_cloddy firm.csv load_n slip_ratio torque_nm drawbar_pull_n sinkage_m
python3 - "$folder" <<'MAKE'
import json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
few = {"walkers": 16, "burn_in": 50, "steps": 100, "every": 5}
def soil(name, start, table):
    return {"name": name, "tests": [str(folder / table)], "max_slip_angle_deg": 0,
            "estimate": {"soil": start, "rover": "mer-class", "free": ["n", "c1", "c2"], "prior": "soil",
                         "channels": ["torque", "drawbar_pull", "sinkage"],
                         "bounds": [{"parameter": p, "lowest": 0, "highest": 0.9} for p in ("c1", "c2")]}}
belief = {"format": "soil-belief/1", "summary": "two made soils", "between": ["c1", "c2"], "usual_spread": [0.25, 0.25],
          "of_soil": few, "of_hierarchy": few, "seed": 3,
          "soils": [soil("loose", "dry_sand", "tests.csv"), soil("firm", "mpf_cloddy", "firm.csv")]}
(folder / "belief.json").write_text(json.dumps(belief))
belief["between"] = ["c1", "c3"]
belief["soils"][1]["estimate"]["free"] = ["n"]
(folder / "wrong.json").write_text(json.dumps(belief))
MAKE
expect 0 "$slipway" estimate belief "$folder/belief.json" --data "$data" --json
cp "$folder/out" "$folder/once"
expect 0 "$slipway" estimate belief "$folder/belief.json" --data "$data" --json
cmp "$folder/once" "$folder/out"
python3 - "$folder/out" <<'CHECK'
import json, sys
d = json.load(open(sys.argv[1]))
# c1 of the made soils is 0.18 and 0.43.
loose, firm = d["soils"]
for soil, c1 in ((loose, 0.18), (firm, 0.43)):
    assert abs(soil["alone"]["mean"][0] - c1) < 0.02 + 3 * soil["alone"]["std"][0], soil
assert 0.05 < d["next_soil"]["std"][0] < 0.4, d["next_soil"]
assert [b["name"] for b in d["between"]] == ["c1", "c2"], d["between"]
CHECK
expect 0 "$slipway" estimate belief "$folder/belief.json" --data "$data"
holds 'one not tested' "$folder/out"
expect 2 "$slipway" estimate belief "$folder/wrong.json" --data "$data"
holds '/between/1' "$folder/err"
holds 'unknown parameter "c3"' "$folder/err"

# Faults, each with its place.
sed '3s/^[^,]*/heavy/; 5s/,[^,]*/,7/' "$folder/tests.csv" >"$folder/broken.csv"
expect 2 "$slipway" estimate wheel "$folder/broken.csv" --data "$data" --rover mer-class
holds 'broken.csv, line 3, column 1 (load_n)' "$folder/err"
holds 'broken.csv, line 5, column 2 (slip_ratio)' "$folder/err"
expect 2 "$slipway" estimate wheel "$folder/tests.csv" --data "$data"
holds '/radius_m' "$folder/err"
expect 2 "$slipway" estimate wheel "$folder/tests.csv" --data "$data" --rover mer-class --free m,n --channels smell
holds 'unknown parameter "m"' "$folder/err"
holds 'unknown channel "smell"' "$folder/err"
expect 2 "$slipway" estimate plates "$folder/nowhere.csv" --data "$data"
echo "as expected"
