#!/bin/sh
# slipway tune as a person or a script meets it.
#   tune_command_test.sh SLIPWAY DATA_FOLDER
set -eu
slipway="$1"
data="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

cat >"$folder/table.json" <<'TABLE'
{"format": "campaign-table/1", "name": "small", "summary": "short drives on two tilts", "sources": [],
 "rover": "fido-class", "gravity_m_s2": 9.81, "seed": 3, "draw_soils": false, "simulation": {"contact_points": 1},
 "terrains": [{"name": "level", "soil": "artemis_dry_sand", "cell_m": 0.5},
              {"name": "slope", "soil": "artemis_dry_sand", "tilt_deg": 3, "cell_m": 0.5}],
 "sensors": {"position_m": {"noise": 0.001}, "attitude_deg": {"noise": 0.1}},
 "drives": [{"id": "ahead", "legs": [{"length_m": 0.5}], "repeats": 2, "final_only": true},
            {"id": "legs", "legs": [{"length_m": 0.3}, {"length_m": 0.2, "curvature_1_m": 0.5}]}]}
TABLE
expect 0 "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/real"
tune() {
  wanted="$1"
  shift
  expect "$wanted" "$slipway" tune "$folder/table.json" --data "$data" "$@"
}

tune 0 --measured "$folder/real" --parameter soil.shear_modulus_m=0.006..0.02 --coarse 3 --fine 3 --threads 2 --out "$folder/one"
holds '^6 drives, 4 of them different' "$folder/out"
holds 'soil.shear_modulus_m = 0.0' "$folder/out"
[ -s "$folder/one/score-shear_modulus_m.svg" ]
tune 0 --measured "$folder/real" --parameter soil.shear_modulus_m=0.006..0.02 --coarse 3 --fine 3 --threads 1 --out "$folder/again"
diff -r "$folder/one" "$folder/again"

tune 0 --measured "$folder/real" --parameter soil.shear_modulus_m=0.006..0.02:log soil.friction_angle_deg=24..32 \
  --prior soil.friction_angle_deg=27.3,1 --coarse 2 --fine 2 --each-tilt --json --out "$folder/two"
cmp "$folder/out" "$folder/two/tuning.json"
python3 - "$folder/two" <<'CHECK'
import json, pathlib, sys, xml.dom.minidom
folder = pathlib.Path(sys.argv[1])
tuning = json.loads((folder / "tuning.json").read_text())
assert tuning["format"] == "tuning/1" and len(tuning["drives"]) == 4 and tuning["unmeasured"] == []
assert [t["tilt_deg"] for t in tuning["best_of_tilts"]] == [0, 3], tuning["best_of_tilts"]
assert all(len(s["drives"]) == 4 and len(s["x"]) == 2 for s in tuning["sets"])
scores = [s["score"] for s in tuning["sets"] if s["score"] is not None]
assert abs(min(scores) - tuning["best"]["score"]) < 1e-9
fit = tuning["least_squares"]
assert fit["score"] <= tuning["best"]["score"] and fit["correlation"][0][0] == 1, fit
assert all(e["std"] is None or e["std"] > 0 for e in fit["estimates"])
pictures = sorted(p.name for p in folder.glob("*.svg"))
assert pictures == ["score-coarse-shear_modulus_m-friction_angle_deg.svg", "score-fine-shear_modulus_m-friction_angle_deg.svg"]
for picture in pictures: xml.dom.minidom.parse(str(folder / picture))
CHECK

# One end that is far off: named, and the estimate stays.
echo 'drive,x_m,y_m,yaw_deg' >"$folder/ends.csv"
python3 - "$folder/real" "$folder/ends.csv" <<'CHECK'
import csv, pathlib, sys
with open(sys.argv[2], "a") as out:
    for k, name in enumerate(("ahead-level-r1", "ahead-level-r2", "ahead-slope-r1", "ahead-slope-r2")):
        end = list(csv.DictReader(open(pathlib.Path(sys.argv[1]) / f"{name}.csv")))[-1]
        out.write(f"{name},{float(end['x_m']) - (0.3 if k == 3 else 0)},{end['y_m']},{end['yaw_deg']}\n")
CHECK
for loss in none cauchy; do
  tune 0 --measured "$folder/ends.csv" --drives 'ahead-*' --parameter soil.shear_modulus_m=0.006..0.03 --coarse 4 --fine 3 \
    --loss "$loss" --out "$folder/$loss"
done
holds 'far off: ahead-slope' "$folder/out"
python3 - "$folder" <<'CHECK'
import json, pathlib, sys
fits = {loss: json.loads((pathlib.Path(sys.argv[1]) / loss / "tuning.json").read_text()) for loss in ("none", "cauchy")}
assert "loss_scale" not in fits["none"] and fits["cauchy"]["loss_scale"] == 2.385, fits["cauchy"].get("loss_scale")
plain, robust = (fits[loss]["least_squares"] for loss in ("none", "cauchy"))
assert plain["beyond_loss_scale"] == [] and len(robust["beyond_loss_scale"]) == 1
assert robust["noise"] < 0.3 * plain["noise"], (robust["noise"], plain["noise"])
assert robust["estimates"][0]["value"] < plain["estimates"][0]["value"]
CHECK
tune 0 --help
holds 'huber' "$folder/out"
status=0
"$slipway" tune "$folder/table.json" --data "$data" --measured "$folder/real" --parameter soil.n=1..1.2 --loss median >/dev/null 2>&1 || status=$?
[ "$status" != 0 ] || { echo "an unknown loss is taken"; exit 1; }

# A survey's CSV of some of the drives.
printf 'drive,x_m,y_m,yaw_deg\nahead-level-r1,0.4,0,0\nahead-slope-r1,0.35,0,0\n' >"$folder/survey.csv"
tune 0 --measured "$folder/survey.csv" --parameter soil.shear_modulus_m=0.006..0.05 --coarse 2 --fine 2 --sweep-only --drives 'ahead-*'
holds '2 of 4 drives have no measured end' "$folder/err"

# Mistakes, each with its place.
tune 2 --measured "$folder/real" --parameter soil.shear=0.006..0.02 --parameter soil.n=1..9
holds '/parameters/0/name' "$folder/err"
holds 'effects.slip_sinkage.n1' "$folder/err"
holds '/parameters/1/highest' "$folder/err"
tune 2 --measured "$folder/real" --parameter soil.n=1-2 --prior soil.n=1
holds '/parameter' "$folder/err"
holds '/prior' "$folder/err"
tune 2 --measured "$folder/real" --parameter soil.n=1..1.2 --drives 'bend-*'
tune 1 --measured "$folder/nowhere" --parameter soil.n=1..1.2
printf 'drive,x_m,yaw_deg\nahead-level-r1,0.4,0\n' >"$folder/faulty.csv"
tune 1 --measured "$folder/faulty.csv" --parameter soil.n=1..1.2
holds 'y_m' "$folder/err"
echo "as expected"
