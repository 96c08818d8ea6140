#!/bin/sh
# Drives with a reference: what has changed since, and a watch over drives in which a cause sets in.
#   watch_command_test.sh SEALED_CAMPAIGNS SLIPWAY SOURCE_FOLDER quick|full
# quick leaves out the tracks of another physics, the gentle slopes, a diagnosis of all drives beside the watch's own, and a
# reference in mA.
set -eu
sealed_campaigns="$1"
slipway="$2"
data="$3/data"
size="$4"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

# A gearbox that begins to drag after ten healthy drives, by another simulator with another wheel law.
"$sealed_campaigns" "$folder/set" --set each --only gearbox_friction --fidelity L2c --size 1 --seed 11 \
  --since 10 --references yes
status=0
"$slipway" watch "$folder/set/s01" --reference "$folder/set/references/s01" --data "$data" --json \
  --report "$folder/report" >"$folder/watch.json" || status=$?
[ "$status" = 6 ]
"$sealed_campaigns" "$folder/healthy" --set each --only com_offset --fidelity L2 --size 1 --seed 100 --since 999 --references yes
"$slipway" watch "$folder/healthy/s01" --reference "$folder/healthy/references/s01" --data "$data" --no-diagnosis \
  --report "$folder/healthy.html" >"$folder/words"
grep -q 'nothing has changed' "$folder/words"
grep -q '<figure id="evidence">' "$folder/healthy.html"
if [ "$size" = full ]; then
# Tracks of another physics are no change since: `multipass` had a log evidence of 316 here before a reference taught them.
"$sealed_campaigns" "$folder/tracks" --set each --only com_offset --fidelity L3 --size 1 --seed 1 --since 999 --references yes
"$slipway" diagnose "$folder/tracks/s01" --reference "$folder/tracks/references/s01" --data "$data" --json >"$folder/tracks.json"
python3 - "$folder/tracks.json" <<'TRACKS'
import json, sys
said = json.load(open(sys.argv[1]))
assert not said["effects"] and all(m["probability"] < 0.3 for m in said["marginals"] if m["name"] == "multipass"), said["reason"]
TRACKS
# Learnt on slopes up to 5 deg alone, by a simulator with another physics: steep ones are no change.
"$sealed_campaigns" "$folder/gentle" --set each --only wheel_radius --fidelity L3 --size 1 --seed 2302 --since 9 --references yes
"$slipway" watch "$folder/gentle/references/s01" --learn 20 --data "$data" --no-diagnosis >"$folder/words"
grep -q 'nothing has changed' "$folder/words"
"$slipway" diagnose "$folder/set/s01" --reference "$folder/set/references/s01" --data "$data" --report "$folder/since" >"$folder/since.txt"
# What the reference taught is a table of short lines.
grep -q '^channel  *learnt, rms  *left open, rms  *unit$' "$folder/since.txt"
if sed -n '/what has changed since/,/^would overturn/p' "$folder/since.txt" | grep '^.\{150\}'; then exit 1; fi
fi
python3 - "$folder" "$size" <<'CHECK'
import json, pathlib, sys, xml.dom.minidom
folder = pathlib.Path(sys.argv[1])
watch = json.loads((folder / "watch.json").read_text())
assert watch["format"] == "watch/1" and watch["changed"] is True
ids = [drive["id"] for drive in watch["drives"]]
assert 11 <= ids.index(watch["alarm"]["drive"]) <= 14, watch["alarm"]
assert abs(ids.index(watch["alarm"]["since"]) - 10) <= 1, watch["alarm"]
onset = watch["alarm"]["onset"]
assert ids.index(onset["first"]) <= ids.index(watch["alarm"]["since"]) <= ids.index(onset["last"]), onset
assert ids.index(onset["first"]) <= 10 <= ids.index(onset["last"]) and 0.9 <= onset["share"] <= 1, onset
shares = [drive["onset_share"] for drive in watch["drives"] if "onset_share" in drive]
assert abs(sum(shares) - 1) < 1e-3 and len(shares) == ids.index(watch["alarm"]["drive"]) + 1, shares
assert watch["causes_are"] == "first_pointer" and watch["answer"] == "diagnosis"
page = (folder / "report" / "report.html").read_text()
for words in ('<figure id="evidence">', '<figure id="ladder">', "A first pointer, which is no diagnosis", "the diagnosis counts", "The diagnosis of the drives from"):
    assert words in page, words
xml.dom.minidom.parseString(page.replace("<!DOCTYPE html>", ""))
assert json.loads((folder / "report" / "watch.json").read_text()) == watch
assert abs(sum(cause["share"] for cause in watch["causes"]) - 1) < 1e-3
# The diagnosis begins at the last start that is at least a third as probable as the most probable one.
begins = ids.index(watch["alarm"]["diagnosed_since"])
assert ids.index(watch["alarm"]["since"]) <= begins <= ids.index(watch["alarm"]["drive"]), watch["alarm"]
assert shares[begins] >= max(shares) / 3 - 1e-6 and all(share < max(shares) / 3 for share in shares[begins + 1:]), shares
diagnosis = watch["diagnosis"]
assert diagnosis["format"] == "diagnosis/1" and diagnosis["reference"]["drives"] > 30
named = sum(c["probability"] for c in diagnosis["candidates"] if "gearbox_friction" in c["effects"])
assert named > 0.3, diagnosis["candidates"]
assert {c["channel"] for c in diagnosis["reference"]["discrepancy"]} >= {"slip", "current"}
if sys.argv[2] == "full":
    since = json.loads((folder / "since" / "diagnosis.json").read_text())
    assert {c["channel"] for c in since["reference"]["discrepancy"]} >= {"slip", "current"}
CHECK
# changed_copy COPY ENDING FACTOR OFFSET: healthy drives whose columns of this ending read FACTOR times as much and OFFSET more.
changed_copy() {
  cp -r "$folder/healthy/s01" "$folder/$1"
  python3 - "$folder/$1" "$2" "$3" "$4" <<'COPY'
import csv, json, pathlib, sys
folder, ending, factor, offset = pathlib.Path(sys.argv[1]), sys.argv[2], float(sys.argv[3]), float(sys.argv[4])
for drive in json.loads((folder / "campaign.json").read_text())["drives"]:
    path = folder / drive["file"]
    rows = list(csv.DictReader(path.read_text().splitlines()))
    for row in rows:
        for column in row:
            if column.endswith(ending) and row[column]:
                row[column] = str(factor * float(row[column]) + offset)
    with path.open("w", newline="") as out:
        writer = csv.DictWriter(out, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
COPY
}
# Drives off the map say nothing, and are no answer: the watch died of them once.
changed_copy off x_m 1 1e5
status=0
"$slipway" watch "$folder/off" --reference "$folder/healthy/references/s01" --data "$data" >"$folder/words" || status=$?
[ "$status" = 1 ] && grep -q 'nothing can be said: no drive has a window of use' "$folder/words"
status=0
"$slipway" watch "$folder/healthy/s01" --reference "$folder/off" --data "$data" >"$folder/words" 2>"$folder/err" || status=$?
[ "$status" = 2 ] && grep -q 'have no window of use' "$folder/err"
# Currents in mA: that nothing is missing can't be said, though drives could be taken to scatter by as much.
changed_copy ma _current_a 1000 0
pairs="ma:healthy/references/s01"
[ "$size" = quick ] || pairs="$pairs healthy/s01:ma"
for pair in $pairs; do
  set -- "${pair%:*}" "${pair#*:}"
  "$slipway" diagnose "$folder/$1" --reference "$folder/$2" --data "$data" --json >"$folder/units.json"
  python3 - "$folder/units.json" <<'UNITS'
import json, sys
said = json.load(open(sys.argv[1]))
assert said["verdict"] not in ("no_gap", "not_detected", "parameters") and "model" not in said, said["verdict"]
assert any("half of the currents are beyond" in note for note in said["notes"]), said["notes"]
UNITS
  "$slipway" watch "$folder/$1" --reference "$folder/$2" --data "$data" --no-diagnosis >"$folder/words" || [ $? = 6 ]
  grep -q '^note: .*half of the currents are beyond' "$folder/words"
done
# Repeats of one drive can't be held out of a fit, so that no name can be checked.
cp -r "$folder/set/s01" "$folder/one"
python3 - "$folder/one" <<'ONE'
import json, pathlib, shutil, sys
folder = pathlib.Path(sys.argv[1])
campaign = json.loads((folder / "campaign.json").read_text())
first = campaign["drives"][10]
campaign["drives"] = [first]
for k in range(6):
    shutil.copy(folder / first["file"], folder / f"again{k}.csv")
    campaign["drives"].append({**first, "id": f"again{k}", "file": f"again{k}.csv", "repeat_of": first["id"]})
(folder / "campaign.json").write_text(json.dumps(campaign))
ONE
"$slipway" diagnose "$folder/one" --reference "$folder/set/references/s01" --data "$data" --json >"$folder/one.json"
# Drives whose rows the reference has too, and a reference with other numbers of the rover, are told of.
cp -r "$folder/healthy/references/s01" "$folder/twin"
python3 - "$folder/twin/campaign.json" <<'TWIN'
import json, pathlib, sys
path = pathlib.Path(sys.argv[1])
campaign = json.loads(path.read_text())
campaign["drives"] = campaign["drives"][:12]
campaign["rover"]["wheels"][0]["radius_m"] *= 1.01
path.write_text(json.dumps(campaign))
TWIN
"$slipway" diagnose "$folder/twin" --reference "$folder/healthy/references/s01" --data "$data" --json >"$folder/twin.json"
python3 - "$folder" <<'NOTES'
import json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
one = json.loads((folder / "one.json").read_text())
assert one["verdict"] == "insufficient" and "or repeats of one" in one["reason"], one["reason"]
notes = " ".join(json.loads((folder / "twin.json").read_text())["notes"])
assert "12 of 12 drives have the very rows" in notes and "has other numbers in the reference" in notes, notes
NOTES
# Neither are drives their own reference, nor those of another rover.
status=0
"$slipway" diagnose "$folder/set/s01" --reference "$folder/set/s01" --data "$data" >/dev/null 2>"$folder/err" || status=$?
[ "$status" = 2 ] && grep -q "is among the reference's drives too: must be other drives" "$folder/err"
python3 - "$folder/set/references/s01/campaign.json" <<'OTHER'
import json, pathlib, sys
path = pathlib.Path(sys.argv[1])
campaign = json.loads(path.read_text())
campaign["rover"]["name"] = "other"
path.write_text(json.dumps(campaign))
OTHER
status=0
"$slipway" diagnose "$folder/set/s01" --reference "$folder/set/references/s01" --data "$data" >/dev/null 2>"$folder/err" || status=$?
[ "$status" = 2 ] && grep -q 'must be the same' "$folder/err"
echo "as expected"
