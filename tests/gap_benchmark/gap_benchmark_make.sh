#!/bin/sh
# Two small campaigns of the program's own making, diagnosed and scored.
# With drives_needed, how many drives a right answer takes, too.
#   gap_benchmark_make.sh SLIPWAY SOURCE_FOLDER [drives_needed]
set -eu
slipway="$1"
data="$2/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

expect 0 "$slipway" gap-benchmark "$folder/first" --make smoke --seed 7 --data "$data" --json --keep "$folder/kept" \
    --oracle --without-each --csv "$folder/scores.csv" --withheld-csv "$folder/withheld.csv"
cp "$folder/out" "$folder/scores.json"
holds '^made \[2/2\] d02: 12 drives' "$folder/err"
python3 - "$folder" <<'CHECK'
import csv, json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
scores = json.loads((folder / "scores.json").read_text())
answers = json.loads((folder / "first" / "answers.json").read_text())
assert [c["campaign"] for c in scores["campaigns"]] == sorted(answers) == ["d01", "d02"], scores["campaigns"]
for case in scores["campaigns"]:
    name = case["campaign"]
    kept = json.loads((folder / "kept" / (name + ".json")).read_text())
    assert kept["verdict"] == case["verdict"] and case["fidelity"] == "L0"
    assert case["hidden"] == (" + ".join(sorted(answers[name]["effects"])) or "nothing"), case
    assert case["exact"], case  # both are plain
    assert ("oracle_closed_fraction" in case) == bool(answers[name]["effects"]), case
    # A campaign's folder has nothing but its measurements that could reveal its hidden effects.
    campaign = json.loads((folder / "first" / name / "campaign.json").read_text())
    assert set(campaign) == {"format", "name", "gravity_m_s2", "rover", "soils", "terrains", "measurement_std", "drives"}
    assert campaign["rover"]["drive"]["torque_constant_nm_per_a"] == 0.0224
    files = {d["file"] for d in campaign["drives"]} | {t["dem"] for t in campaign["terrains"].values()}
    assert {p.name for p in (folder / "first" / name).iterdir()} == files | {"campaign.json"}
    columns = next(csv.reader((folder / "first" / name / campaign["drives"][0]["file"]).open()))
    assert len(columns) == 7 + 5 * 6 + 1, columns
# With the hidden effects given, the diagnosis closes about the same share; with the effect withheld it names no other.
scored = {row["campaign"]: row for row in csv.DictReader((folder / "scores.csv").open())}
assert abs(float(scored["d02"]["oracle_closed_fraction"]) - float(scored["d02"]["closed_fraction"])) < 0.1, scored
with_answer = json.loads((folder / "kept" / "d02-oracle.json").read_text())
assert [e["name"] for e in with_answer["effects"]] == sorted(answers["d02"]["effects"]), with_answer["effects"]
assert [c["effects"] for c in with_answer["candidates"] if c["probability"] > 0] == [sorted(answers["d02"]["effects"])], with_answer["candidates"]
withheld = list(csv.DictReader((folder / "withheld.csv").open()))
assert [(w["campaign"], w["withheld"]) for w in withheld] == [("d02", e) for e in answers["d02"]["effects"]], withheld
assert withheld == [dict(w, **{"verdict": s["verdict"], "found": s["found"]}) for w, s in zip(withheld, scores["withheld"])]
CHECK

if [ "${3:-}" = drives_needed ]; then
# How many drives a right answer takes: of campaigns with effects of the library alone.
expect 0 "$slipway" gap-benchmark "$folder/first" --data "$data" --drives-needed --random-repeats 1 --json
python3 - "$folder/out" <<'CHECK'
import json, sys
needed = json.load(open(sys.argv[1]))
assert needed["format"] == "drives-needed/1" and needed["first_drives"] == 4
assert [c["campaign"] for c in needed["campaigns"]] == ["d02"], needed["campaigns"]
case = needed["campaigns"][0]
assert case["limit"] == 12 and len(case["random"]) == 1, case
assert 4 <= case["designed"] <= 12, case
CHECK
expect 0 "$slipway" gap-benchmark "$folder/first" --data "$data" --drives-needed --random-repeats 1 --only d01
holds '0 of 0 campaigns' "$folder/out"
fi

# The same seed, the same bytes; made in parts, too, and not made again.
expect 0 "$slipway" gap-benchmark "$folder/again" --make smoke --seed 7 --data "$data" --only d01 --threads 1
diff -r "$folder/first" "$folder/again"
rm "$folder/again/d02/campaign.json" "$folder/again/answers.json"
expect 0 "$slipway" gap-benchmark "$folder/again" --make smoke --seed 7 --data "$data" --only d01
holds '^made \[2/2\]' "$folder/err"
if grep -q '^made \[1/2\]' "$folder/err"; then echo "what was made was made again"; exit 1; fi
diff -r "$folder/first" "$folder/again"

# Other campaigns' folders are left alone; so are folders for sets that are not known.
expect 1 "$slipway" gap-benchmark "$folder/again" --make smoke --seed 8 --data "$data"
holds 'another folder' "$folder/err"
expect 1 "$slipway" gap-benchmark "$data/gap-practice" --make smoke --data "$data"
diff -r "$folder/first" "$folder/again"
expect 2 "$slipway" gap-benchmark "$folder/none" --make smock --data "$data"
holds 'smoke, each' "$folder/err"
[ ! -e "$folder/none" ] || { echo "a folder was made for a set that is not known"; exit 1; }
echo "as expected"
