#!/bin/sh
# A cause that is taken out of the library is not taken for nothing, nor for the drives' own scatter.
#   gap_benchmark_withheld.sh SEALED_CAMPAIGNS SLIPWAY SOURCE_FOLDER EFFECT SET...
# EFFECT: what is withheld; SET: what sealed_campaigns makes, of which the first campaign is diagnosed.
set -eu
sealed_campaigns="$1" slipway="$2" source="$3" effect="$4"
shift 4
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

"$sealed_campaigns" "$folder/made" "$@"
"$slipway" diagnose "$folder/made/s01" --data "$source/data" --without "$effect" --json >"$folder/found.json"
python3 - "$folder/found.json" <<'CHECK'
import json, sys
found = json.load(open(sys.argv[1]))
assert (found["verdict"], found["effects"]) == ("unknown", []), found["reason"]
assert found["residual"], "nothing says what is unexplained"
CHECK
