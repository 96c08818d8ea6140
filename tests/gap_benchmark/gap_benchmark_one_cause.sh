#!/bin/sh
# One cause, hidden by another simulator with another equation, is told as it should be.
#   gap_benchmark_one_cause.sh SEALED_CAMPAIGNS SLIPWAY SOURCE_FOLDER FOUND REASON SET...
# FOUND: what the diagnosis names, with " + unknown" where something is left over, or unknown; REASON: a part of its sentence; SET: what sealed_campaigns makes.
set -eu
sealed_campaigns="$1" slipway="$2" source="$3" found="$4" reason="$5"
shift 5
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

"$sealed_campaigns" "$folder/made" "$@"
"$slipway" gap-benchmark "$folder/made" --data "$source/data" --csv "$folder/scores.csv" --keep "$folder/found" >"$folder/table.md"
python3 - "$folder" "$found" "$reason" <<'CHECK'
import csv, json, sys
folder, found, reason = sys.argv[1:]
(row,) = csv.DictReader(open(folder + "/scores.csv"))
right = "partial" if found.endswith(" + unknown") else "exact"
assert (row["found"], row[right], row["names_right"], row["wrong_name"]) == (found, "1", "1", "0"), row
said = json.load(open(folder + "/found/s01.json"))["reason"]
assert reason in said, said
CHECK
