#!/bin/sh
# The command's exit status and files, as a person or a script meets them; killed in the middle and gone on with.
#   command_test.sh SLIPWAY DATA_FOLDER
set -eu
slipway="$1"
data="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

expect 0 "$slipway" campaign list --data "$data"
holds '^fido_table_1 *440' "$folder/out"
expect 0 "$slipway" campaign fido_table_1 --data "$data" --dry-run --only 'turn_left_245-tilt_20-*'
holds '^9 drives' "$folder/out"

cat >"$folder/table.json" <<'TABLE'
{"format": "campaign-table/1", "name": "small", "summary": "arcs on two tilts", "sources": [], "rover": "fido-class",
 "gravity_m_s2": 9.81, "seed": 3, "simulation": {"sample_interval_s": 0.25},
 "terrains": [{"name": "level", "soil": "dry_sand"}, {"name": "slope", "soil": "dry_sand", "tilt_deg": 6}],
 "drives": [{"id": "arc", "legs": [{"length_m": 1.5, "curvature_1_m": 0.3}], "repeats": 10, "plot": true},
            {"id": "turn", "legs": [{"turn_deg": 20}], "final_only": true}]}
TABLE
expect 0 "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/whole"
holds '^slope' "$folder/out"

# Killed at any moment, as often as it takes.
kills=0
for pause in 0.02 0.05 0.1 0.15 0.2 0.3; do
  "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/broken" --threads 2 >/dev/null 2>&1 &
  process=$!
  sleep "$pause"
  kill -9 "$process" 2>/dev/null && kills=$((kills + 1))
  wait "$process" 2>/dev/null || true
done
[ "$kills" -gt 0 ] || { echo "nothing was killed"; exit 1; }
expect 0 "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/broken" --threads 1
diff -r "$folder/whole" "$folder/broken"
# What is done is not done again.
touch -d '2001-01-01' "$folder/broken/drives/turn-level.json"
expect 0 "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/broken"
holds '^22 of 22 drives are done already' "$folder/err"
[ "$folder/table.json" -nt "$folder/broken/drives/turn-level.json" ] || { echo "a drive was made again"; exit 1; }

# In parts, and in one: the same campaign.
expect 0 "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/parts" --only 'arc-slope-*' turn-level
python3 - "$folder/parts" <<'CHECK'
import csv, json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
campaign = json.loads((folder / "campaign.json").read_text())
assert campaign["format"] == "drive-campaign/1", campaign["format"]
assert set(campaign) == {"format", "name", "gravity_m_s2", "rover", "soils", "terrains", "measurement_std", "drives"}
assert set(campaign["rover"]) == {"name", "mass_kg", "com_m", "wheels", "suspension", "drive"}, set(campaign["rover"])
assert len(campaign["drives"]) == 11
for drive in campaign["drives"]:
    terrain = campaign["terrains"][drive["terrain"]]
    assert (folder / terrain["dem"]).is_file() and terrain["soil"] in campaign["soils"]
    rows = list(csv.DictReader((folder / drive["file"]).open()))
    times = [float(row["t_s"]) for row in rows]
    assert all(a < b for a, b in zip(times, times[1:])) and len(rows) >= 2, drive["id"]
    assert (len(rows) == 2) == drive.get("final_only", False), drive["id"]
    assert None not in rows[0] and None not in rows[0].values(), "rows as wide as the header"
    if drive["commanded"]["turn_in_place"]:
        turned = float(rows[-1]["yaw_deg"]) - float(rows[0]["yaw_deg"])
        assert 5 < turned < 25, turned
    else:
        assert abs(drive["commanded"]["duration_s"] - 1.5 / drive["commanded"]["speed_m_s"]) < 5, drive
    assert drive["id"].endswith("-r1") or drive["id"] == "turn-level" or drive["repeat_of"] == "arc-slope-r1"
summary = json.loads((folder / "summary.json").read_text())
assert [t["drives"] for t in summary["terrains"]] == [1, 10] and summary["drives"] == 22, summary
CHECK
expect 0 "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/parts" --json
cmp "$folder/out" "$folder/whole/summary.json"
diff -r "$folder/whole" "$folder/parts"

# Faults together, with their places; another table in the same folder; no folder; a pattern that fits nothing.
sed 's/"seed": 3/"seed": 4/' "$folder/table.json" >"$folder/other.json"
expect 1 "$slipway" campaign "$folder/other.json" --data "$data" --out "$folder/whole"
holds 'no-resume' "$folder/err"
expect 0 "$slipway" campaign "$folder/other.json" --data "$data" --out "$folder/parts" --no-resume
cmp -s "$folder/parts/arc-level-r1.csv" "$folder/whole/arc-level-r1.csv" && { echo "the seed says nothing"; exit 1; }
sed 's/"dry_sand", "tilt_deg": 6/"dry_sandd", "tilt_deg": 61/; s/1.5/-1.5/' "$folder/table.json" >"$folder/faulty.json"
expect 2 "$slipway" campaign "$folder/faulty.json" --data "$data" --out "$folder/faulty"
for pointer in /terrains/1/soil /terrains/1/tilt_deg /drives/0/legs/0/length_m; do holds "$pointer" "$folder/err"; done
[ ! -e "$folder/faulty" ] || { echo "a folder was made for a table with faults"; exit 1; }
expect 2 "$slipway" campaign "$folder/table.json" --data "$data"
expect 2 "$slipway" campaign "$folder/table.json" --data "$data" --dry-run --only 'bend-*'
expect 1 "$slipway" campaign no_such_table --data "$data" --dry-run
holds 'opportunity_sol_2143' "$folder/err"
echo "as expected"
