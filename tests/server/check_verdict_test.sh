#!/bin/sh
# slipway check, predict and plan end with the status of their verdict; the old form of check says what it is called now.
#   check_verdict_test.sh SLIPWAY SOURCE_FOLDER
set -eu
slipway="$1"
data="$2/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
. "$(dirname "$0")/../command_expectations.sh"

level="--path 8142640,-276640 8142638,-276640.2"
# Bars that any drive keeps, that none keeps, and that a few draws can't decide.
most="--max-immobilised 1 --max-stop 1 --no-go-stop 1"
kept="--max-embedding 1 $most"
expect 0 "$slipway" check --data "$data" $level $kept
grep -q '^GO: every limit holds' "$folder/out" || { echo "no GO"; cat "$folder/out"; exit 1; }
expect 3 "$slipway" check --data "$data" $level --max-slip 0.001 --why
grep -q '^NO-GO: on the mean soils slip' "$folder/out"
expect 4 "$slipway" check --data "$data" $level $most --max-embedding 0.0001 --draws 40
grep -q '^UNKNOWN: embedded in 0 % of the draws' "$folder/out" || { cat "$folder/out"; exit 1; }
# The bar that is gone says what has taken its place.
echo '{"terrain": "gale", "rover": "msl-class", "path": [{"x_m": 8142640, "y_m": -276640}, {"x_m": 8142638, "y_m": -276640}],
  "bars": {"max_expected_stops": 1}}' > "$folder/bar.json"
expect 2 "$slipway" check --data "$data" --request "$folder/bar.json"
grep -q 'max_stop is the probability of a halt' "$folder/err"

# A path beyond the limit of tilt.
expect 3 "$slipway" predict --data "$data" --path 8142640,-276640 8142600,-276645 --max-tilt-deg 2 --draws 8
grep -q '^NO-GO: on the mean soils tilt' "$folder/out"
expect 3 "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142630,-276641 --max-slip 0.001 --draws 2 --json

# A command sequence, a set of rules, and what can't be used.
expect verdict "$slipway" check --data "$data" --start 8142640,-276640,180 --command drive=2 turn=20 arc=2,5 --rules slip_70 --json
grep -q '"max_slip":0.7' "$folder/out"
expect 2 "$slipway" check --data "$data" --start 8142640,-276640 --command hop=2 --rules no_such
grep -q '/commands/0' "$folder/err"
grep -q '/rules' "$folder/err"
grep -q '/start' "$folder/err"

# A plan's commands give a check the same figures, from either file; options stand over what a file says.
expect verdict "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142632,-276642 --routes 1 --draws 24 \
  --max-tilt-deg 22 --commands "$folder/route.json" --json
cp "$folder/out" "$folder/plan.json"
expect verdict "$slipway" check --data "$data" --commands "$folder/route.json" --json
cp "$folder/out" "$folder/check.json"
expect verdict "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142632,-276642 --routes 1 --draws 24 \
  --max-tilt-deg 22 --commands "$folder/route.csv"
grep -q '^# terrain: gale$' "$folder/route.csv"
grep -q '^command,value,radius_m$' "$folder/route.csv"
expect verdict "$slipway" check --data "$data" --commands "$folder/route.csv" --draws 24 --max-tilt-deg 22 --json
python3 - "$folder/plan.json" "$folder/check.json" "$folder/out" <<'END'
import json, sys
plan, *checks = (json.load(open(path)) for path in sys.argv[1:])
route = plan["routes"]["features"][0]["properties"]
for check in checks:
    assert check["outcomes"] == route["outcomes"], (check["outcomes"], route["outcomes"])
    for key, value in check["summary"].items():
        assert plan["summary"][0].get(key, value) == value, (key, value, plan["summary"][0][key])
    assert check["request"]["commands"] == plan["summary"][0]["commands"]
    assert check["request"]["limits"]["max_tilt_deg"] == 22
END
expect verdict "$slipway" check --data "$data" --commands "$folder/route.json" --max-tilt-deg 21 --json
grep -q '"max_tilt_deg":21' "$folder/out"
grep -q '"draws":24' "$folder/out"
expect 2 "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142632,-276642 --routes 1 --draws 2 \
  --commands "$folder/no.csv" --route 2
grep -q 'the plan has 1 route' "$folder/err"
cat > "$folder/bad.csv" <<'END'
# terrain: gale
# start_x_m: 8142640
# start_y_m: north
command,value,radius_m
hop,2,
drive,-3,
arc,2,
turn,30,4
END
expect 2 "$slipway" check --data "$data" --commands "$folder/bad.csv"
for place in 'line 3' 'line 5, column 1' 'line 6, column 2' 'line 7, column 3' 'line 8, column 3' 'start_yaw_deg'; do
  grep -q "$place" "$folder/err" || { echo "no fault at $place"; cat "$folder/err"; exit 1; }
done
printf '{"terrain": "gale", "rover": "msl-class",\n "start": {"x_m": 8142640, "y_m": -276640, "yaw_deg": 180},\n "commands": [{"drive_m": 2},\n  {"drive_m": "far"}]}' > "$folder/bad.json"
expect 2 "$slipway" check --data "$data" --commands "$folder/bad.json"
grep -q 'line 4, column 15 (/commands/1/drive_m)' "$folder/err" || { cat "$folder/err"; exit 1; }
# Nobody plans a way to where the rover is.
expect 2 "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142640,-276640
grep -q '/goal at .* is where /start is' "$folder/err"

expect 2 "$slipway" check some_campaign --model some_model
grep -q 'slipway test-model' "$folder/err" "$folder/out"

# The page for a meeting, the stations as CSV, and areas by corners and by a file.
expect verdict "$slipway" check --data "$data" $level --draws 40 --why --report "$folder/check.html" --csv "$folder/check.csv"
grep -q 'class="banner ' "$folder/check.html"
grep -q 'What would change it' "$folder/out"
grep -q 'Without a look at where it is' "$folder/out"
grep -q 'Commanded by the way its wheels roll' "$folder/check.html"
head -1 "$folder/check.csv" | grep -q '^distance_m,x_m,y_m,height_m,yaw_deg,.*,slip_p95,.*,energy_wh$' || { head -1 "$folder/check.csv"; exit 1; }
[ "$(wc -l < "$folder/check.csv")" -gt 4 ]
expect verdict "$slipway" predict --data "$data" $level --draws 2 --csv "$folder/predict.csv"
[ "$(head -1 "$folder/predict.csv")" = "$(head -1 "$folder/check.csv")" ]
expect 3 "$slipway" check --data "$data" $level $kept --draws 2 --keep-out "8142638.5,-276641 8142639,-276641 8142639,-276639"
grep -q 'would enter a keep-out at' "$folder/out"
cat > "$folder/area.geojson" <<'END'
{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
  "coordinates": [[[8142639.5, -276630], [8142650, -276630], [8142650, -276650], [8142639.5, -276650], [8142639.5, -276630]]]}}]}
END
expect 3 "$slipway" check --data "$data" $level $kept --draws 2 --keep-in "$folder/area.geojson"
grep -q 'would leave a keep-in at' "$folder/out"
expect 2 "$slipway" check --data "$data" $level --keep-out "$folder/no_such.geojson"
grep -q '/keep_out/0' "$folder/err"
expect 3 "$slipway" predict --data "$data" $level --draws 2 --keep-out "8142638.5,-276641 8142639,-276641 8142639,-276639"

# Every limit, check and bar has an option, and a plan its weights: the answer has the request as it was understood.
expect verdict "$slipway" check --data "$data" $level --draws 2 --max-current-a 4 --max-sinkage-m 0.05 --min-clearance-m 0.1 \
  --embedding-slip 0.8 --embedding-turns 5 --embedding-sinkage-share 0.5 --json
for member in '"max_current_a":4' '"max_sinkage_m":0.05' '"min_clearance_m":0.1' '"embedding_slip":0.8' '"embedding_turns":5' \
  '"embedding_sinkage_share":0.5'; do
  grep -q "$member" "$folder/out" || { echo "no $member"; exit 1; }
done
expect verdict "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142630,-276641 --draws 2 --routes 1 --weight slip=8 \
  --keep-in "8142600,-276600 8142700,-276600 8142700,-276700 8142600,-276700" --json
grep -q '"slip":8' "$folder/out"
grep -q '"keep_in":\[\[\[8142600,-276600\]' "$folder/out"
cp "$folder/out" "$folder/a.json"
expect 2 "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142630,-276641 --weight no_such=8
grep -q '/weights/no_such' "$folder/err"

# Two answers, and two routes, side by side.
expect verdict "$slipway" plan --data "$data" --start 8142640,-276640 --goal 8142630,-276641 --draws 2 --routes 1 --weight slip=4 --json
cp "$folder/out" "$folder/b.json"
expect 0 "$slipway" compare-plans "$folder/a.json" "$folder/b.json"
grep -q 'Request /weights/slip: a 8, b 4' "$folder/out"
grep -q 'Request /keep_in: a ' "$folder/out"
grep -q '^embedding ' "$folder/out"
expect 0 "$slipway" compare-plans "$folder/a.json" "$folder/a.json" --routes 1 1 --json
grep -q '"changed_in_request":\[\]' "$folder/out"
expect 2 "$slipway" compare-plans "$folder/a.json" "$folder/area.geojson"
grep -q '/b' "$folder/err"
expect 2 "$slipway" compare-plans "$folder/a.json" "$folder/no_such.json"

# With drives of the past as evidence the same drive has other odds, and the answer says how many drives count.
expect verdict "$slipway" check --data "$data" $level --as-of-sol 978 --draws 64 --json
grep -q '"past_drives":6' "$folder/out"

# A drive under way: its telemetry tells of the ground ahead, the rest begins where it is, and bad rows have their lines.
printf 'driven_m,x_m,y_m,current_a\n0,8142640,-276640,\n2.4,8142638,-276640.3,6.1\n5.0,8142636,-276640.5,6.8\n' > "$folder/so_far.csv"
expect verdict "$slipway" check --data "$data" --path 8142632,-276640.5 --drive-so-far "$folder/so_far.csv" --why
grep -q 'driven so far' "$folder/out"
grep -q '^given *4.0 m ' "$folder/out" || { echo "the rest is not 4 m"; cat "$folder/out"; exit 1; }
expect verdict "$slipway" plan --data "$data" --goal 8142630,-276641 --drive-so-far "$folder/so_far.csv" --draws 20 --routes 1 --json
grep -q '"start":{"x_m":8142636,"y_m":-276640.5}' "$folder/out"
printf 'driven_m,x_m\n0,8142640\nfar,8142638\n' > "$folder/bad.csv"
expect 2 "$slipway" check --data "$data" $level --drive-so-far "$folder/bad.csv"
grep -q 'there is no column y_m' "$folder/err"
grep -q 'line 3, column 1 (driven_m)' "$folder/err"
expect 2 "$slipway" check --data "$data" $level --drive-so-far "$folder/no_such.csv"

# Whole soils of a file stand in for those of the data folder, for one question.
python3 - "$data/soils/mars_sites.json" "$folder/beliefs.json" <<'END'
import json, sys
soils = json.load(open(sys.argv[1]))
soils["soils"] = [{**soils["soils"][0], "name": "unknown_ground"}]
json.dump(soils, open(sys.argv[2], "w"))
END
expect verdict "$slipway" check --data "$data" $level --draws 2 --beliefs "$folder/beliefs.json" --json
grep -q '"beliefs":\[{"name":"unknown_ground"' "$folder/out"
# What a scout drive would be worth, where anything goes wrong at all.
expect 4 "$slipway" check --data "$data" --path 8142640,-276640 8142600,-276645 --draws 100
grep -q 'What would change it: drive .* and measure the slip there' "$folder/out"
expect 3 "$slipway" check --data "$data" --path 8142640,-276640 8142630,-276641 --max-slip 0.001 --json
grep -q '"worth_sols":' "$folder/out"
echo "verdicts and exit statuses agree"

# Answers that are read: at most 15 lines, the verdict and its reason first, nothing that contradicts it.
for command in "check $level" "predict $level" "check $level --max-sinkage-m 0.001" "check $level --max-slip 0.02" \
  "plan --start 8142640,-276640 --goal 8142632,-276642" "plan --start 8142640,-276640 --goal 8142632,-276642 --max-tilt-deg 4"; do
  expect verdict "$slipway" $command --data "$data"
  [ "$(wc -l < "$folder/out")" -le 15 ] || { echo "more than 15 lines of: $command"; cat "$folder/out"; exit 1; }
  head -1 "$folder/out" | grep -Eq '^(GO|NO-GO|UNKNOWN): ' || { echo "no verdict first: $command"; cat "$folder/out"; exit 1; }
  for words in 'alike' 'both sides' 'margin' 'caution' 'arrives' 'not converged' 'To be commanded'; do
    ! grep -q "$words" "$folder/out" || { echo "\"$words\" in: $command"; cat "$folder/out"; exit 1; }
  done
  if head -1 "$folder/out" | grep -q '^GO' && grep -q 'What would change it' "$folder/out"; then
    echo "advice on a GO: $command"
    exit 1
  fi
done
