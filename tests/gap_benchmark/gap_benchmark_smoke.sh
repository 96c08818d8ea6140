#!/bin/sh
# Two small campaigns by another simulator, diagnosed and scored.
#   gap_benchmark_smoke.sh SEALED_CAMPAIGNS SLIPWAY SOURCE_FOLDER
set -eu
sealed_campaigns="$1"
slipway="$2"
data="$3/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

"$sealed_campaigns" "$folder/first" --set smoke --seed 7
"$sealed_campaigns" "$folder/again" --set smoke --seed 7
diff -r "$folder/first" "$folder/again"
# The other wheel law too is the same for the same seed; it has no terms of the arc's stresses to hide.
for once in other other-again; do
  "$sealed_campaigns" "$folder/$once" --set each --only tether --fidelity L3 --seed 7
done
diff -r "$folder/other" "$folder/other-again"
grep -q '"fidelity":"L3"' "$folder/other/answers.json"
status=0
"$sealed_campaigns" "$folder/none" --set each --only multipass --fidelity L3 2>"$folder/err" || status=$?
[ "$status" = 2 ] && grep -q '^multipass .* L3 has another law' "$folder/err" && [ ! -e "$folder/none" ]
# Drives that a diagnosis asks for are made and added; the others stay as they are.
printf 's01,15,90,0.05,0.3,-40\ns01,5,0,-0.025,0,20\n' >"$folder/asked.csv"
printf 'none,0,0,0.05,0,20\n' >"$folder/none.csv"
for more in none asked; do
  "$sealed_campaigns" "$folder/$more-more" --set each --only gearbox_friction --seed 7 --drives 5 --more "$folder/$more.csv"
done
for file in "$folder"/none-more/s01/D*.csv; do cmp "$file" "$folder/asked-more/s01/$(basename "$file")"; done
[ "$(ls "$folder"/none-more/s01/D*.csv | wc -l)" = 5 ] && [ "$(ls "$folder"/asked-more/s01/D*.csv | wc -l)" = 7 ]
grep -q '"tilt_15"' "$folder/asked-more/s01/campaign.json"
status=0
"$sealed_campaigns" "$folder/bad-more" --set each --more "$folder/asked-more/answers.json" 2>"$folder/err" || status=$?
[ "$status" = 2 ] && grep -q 'is no file of drives' "$folder/err"
"$slipway" gap-benchmark "$folder/first" --data "$data" --json --keep "$folder/kept" >"$folder/scores.json"
python3 - "$folder" <<'CHECK'
import csv, json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
scores = json.loads((folder / "scores.json").read_text())
answers = json.loads((folder / "first" / "answers.json").read_text())
assert scores["format"] == "gap-benchmark/1"
assert [c["campaign"] for c in scores["campaigns"]] == sorted(answers) == ["s01", "s02"], scores["campaigns"]
for case in scores["campaigns"]:
    kept = json.loads((folder / "kept" / (case["campaign"] + ".json")).read_text())
    assert kept["verdict"] == case["verdict"]
    hidden = " + ".join(sorted(answers[case["campaign"]]["effects"])) or "nothing"
    assert case["hidden"] == hidden, case
assert scores["figures"]["all"]["campaigns"] == 2
# The key's traces are of the campaign that hides the friction, and the diagnosis names the channel in which it acts.
traces = list(csv.DictReader((folder / "first" / "traces.csv").open()))
assert {row["campaign"] for row in traces} == {"s02"}, traces[:1]
assert all(float(row["current_mean_square"]) > 0 == float(row["slip_mean_square"]) for row in traces)
friction = scores["campaigns"][1]
assert friction["channel_right"] is True and 0 <= friction["slice_overlap"] <= 1, friction
assert "channel_right" not in scores["campaigns"][0]
CHECK
# A folder without a key is diagnosed and not scored; one without campaigns is a question that can't be asked.
rm "$folder/first/answers.json"
status=0
"$slipway" gap-benchmark "$folder/first" --data "$data" --only s01 >/dev/null 2>"$folder/err" || status=$?
[ "$status" = 2 ] && grep -q answers.json "$folder/err"
status=0
"$slipway" gap-benchmark "$folder/kept" --data "$data" >/dev/null 2>"$folder/err" || status=$?
[ "$status" = 2 ]
echo "as expected"
