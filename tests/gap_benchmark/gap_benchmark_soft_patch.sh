#!/bin/sh
# A patch of soft ground that stopped the rover, by another simulator with another equation: it is found, and not taken for drives
# whose soils differ or for anything else.
#   gap_benchmark_soft_patch.sh SEALED_CAMPAIGNS SLIPWAY SOURCE_FOLDER
set -eu
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

"$1" "$folder/made" --set each --only soft_patch --fidelity L2 --size 2 --seed 1
"$2" gap-benchmark "$folder/made" --data "$3/data" --csv "$folder/scores.csv" >"$folder/table.md"
python3 - "$folder/scores.csv" <<'CHECK'
import csv, sys
(row,) = csv.DictReader(open(sys.argv[1]))
assert (row["hidden"], row["found"], row["exact"]) == ("soft_patch", "soft_patch", "1"), row
CHECK
