#!/bin/sh
# What every command owes to a person or a script: files before words, nothing ignored, nothing half written, and an
# exit status that says so.
#   command_test.sh SLIPWAY DATA_FOLDER
set -eu
slipway="$1"
data="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

wheel="$slipway wheel --data $data --rover mer-class --soil jlu_mars_2_dense --load 100"
swept="$wheel --sweep slip=0:0.4:0.1"
stops="--start 8142579.73,-276648.74 --goal 8142566.40,-276711.67"
path="--path 8142640,-276640 8142610,-276643"

# Standard output that can't be written: not 0, and the files are there all the same.
expect 0 $swept --csv "$folder/whole.csv" --plot "$folder/whole.svg"
status=0
$swept --csv "$folder/full.csv" --plot "$folder/full.svg" >/dev/full 2>"$folder/err" || status=$?
[ "$status" = 1 ] || { echo "exit status $status with a full disk behind standard output"; exit 1; }
holds "standard output can't be written" "$folder/err"
status=0
$swept --csv "$folder/closed.csv" >&- 2>"$folder/err" || status=$?
[ "$status" = 1 ] || { echo "exit status $status with standard output closed"; exit 1; }
for made in full closed; do cmp "$folder/whole.csv" "$folder/$made.csv"; done
cmp "$folder/whole.svg" "$folder/full.svg"
for question in soils rovers effects "terrain" "data check" "campaign list" "validate --list" "current map --figure 10" "--help"; do
  status=0
  case "$question" in --help) ;; effects | "validate --list") ;; *) question="$question --data $data" ;; esac
  "$slipway" $question >/dev/full 2>/dev/null || status=$?
  [ "$status" = 1 ] || { echo "exit status $status of $question with a full standard output"; exit 1; }
done

# The parameters of an effect are explained in words: unit, default, range and meaning.
expect 0 "$slipway" effects
holds 'slipway effects NAME explains' "$folder/out"
expect 0 "$slipway" effects grousers
holds '^height_m  *m  *0.01  *0  *0.05  *0  *height of a grouser' "$folder/out"
[ "$(grep -c 'described by' "$folder/out")" = 1 ] || { echo "more than one effect is explained"; exit 1; }
expect 0 "$slipway" effects grousers --json
holds '^{"effects":\[{"name":"grousers"' "$folder/out"
expect 2 "$slipway" effects grouser
holds '/effect: unknown effect "grouser"; did you mean "grousers"' "$folder/err"

# A file has its old content until the new one is whole: here no file may grow beyond nothing.
echo "what was there" >"$folder/kept.csv"
(ulimit -f 0; $swept --csv "$folder/kept.csv" >/dev/null 2>&1) && { echo "a file grew past its limit"; exit 1; }
holds 'what was there' "$folder/kept.csv"
expect 1 $swept --csv "$folder/no/such/folder.csv"
ln -s "$folder/target.csv" "$folder/link.csv"
echo old >"$folder/target.csv"
expect 0 $swept --csv "$folder/link.csv"
[ -L "$folder/link.csv" ] && cmp "$folder/whole.csv" "$folder/target.csv"
expect 0 $swept --csv /dev/null
[ -c /dev/null ] || { echo "/dev/null was replaced by a file"; exit 1; }

# A file with faults is told and left out; what does not need it works.
cp -r "$data" "$folder/data"
expect 0 "$slipway" data check --data "$folder/data"
holds 'can be used' "$folder/out"
echo '{"format":"rover/1","mass_kg":-3}' >"$folder/data/rovers/broken.json"
expect 2 "$slipway" data check --data "$folder/data"
holds 'rovers/broken.json#/mass_kg' "$folder/out"
expect 0 "$slipway" rovers --data "$folder/data"
holds 'rover broken is left out' "$folder/err"
expect 2 "$slipway" wheel --data "$folder/data" --rover broken --soil jlu_mars_2_dense --load 100
holds 'rovers/broken.json is left out' "$folder/err"
echo '{}' >"$folder/data/soils/broken.json"
expect 0 "$slipway" rovers --data "$folder/data"
holds '^2 files of the data folder are left out: rover broken, ' "$folder/err"
[ "$(grep -c 'left out' "$folder/err")" = 1 ] || { cat "$folder/err"; exit 1; }
rm "$folder/data/soils/broken.json"
expect 2 "$slipway" plam
holds 'did you mean "plan"' "$folder/err"
expect 2 "$slipway" check --path 0,0 1,1 --max-slope 20
holds 'unknown option --max-slope, did you mean --max-slip' "$folder/err"
expect 2 "$slipway" check --data "$folder/data" --path 8142566,-276711 8142566,-276696 --max-slip 40
holds '40 % is 0.4' "$folder/err"
rm "$folder/data/rovers/broken.json"
echo 'II*' >"$folder/data/terrains/gale/elevation.tif"
expect 2 "$slipway" data check --data "$folder/data" --json
holds '"terrains":\["ames_yard","lunar' "$folder/out"  # and not gale
expect 0 "$slipway" rovers --data "$folder/data"
rm -r "$folder/data"

# An option that would be ignored is refused, with its name.
ignored() {
  option="$1"
  shift
  expect 2 "$@"
  cat "$folder/out" "$folder/err" >"$folder/both"
  holds "$option" "$folder/both"
}
printf 'load_n,slip_ratio,torque_nm\n60,0.1,1\n60,0.3,2\n60,0.5,3\n' >"$folder/wheel.csv"
estimate="$slipway estimate wheel $folder/wheel.csv --data $data"
sizes="--wheel-radius 0.125 --wheel-width 0.16"
ignored '--wheel requires --rover' $estimate $sizes --wheel nosuch
ignored '/wheel' $estimate --rover mer-class --wheel nosuch
ignored '--motor-temp-c requires --rover' $estimate $sizes --motor-temp-c -40
ignored 'loss-scale' $estimate $sizes --loss-scale 2
ignored 'seed' "$slipway" estimate drives "$data/gap-practice/p01" --data "$data" --seed 2
ignored 'loss-scale' "$slipway" tune opportunity_sol_2143 --data "$data" --measured x --parameter soil.n=0.8..1.2 --loss-scale 2
ignored '--at' "$slipway" terrain --data "$data" --name nosuch
ignored '--soil' "$slipway" current map --data "$data" --figure 10 --soil nonsense
ignored '--x' "$slipway" current map --data "$data" --figure 10 --x slip
ignored '/grousers/count' $wheel --grousers 0.01,24,7
ignored '/motor_temp_c' "$slipway" current invert --data "$data" --current 0.7 --gravity 9.81 --motor-temp-c -40
ignored '/motor_temp_c' $wheel --motor-temp-c -40
# Of two flags that say the same number one would be dropped.
ignored '/effects/0/name' $wheel --grousers 0.01,24 --effect grousers
ignored '/slip' $wheel --slip 0.2 --sweep slip=0:0.4:0.1
ignored '/slip' $wheel --slip 0.2 --sweep slope_deg=0:4:1
ignored '/load' $wheel --sweep load_n=10,20
ignored '/load' $wheel --sweep sinkage_m=0.01,0.02
ignored '/gravity' $wheel --gravity 9.81 --set gravity_m_s2=3.71
ignored '/radius' $wheel --radius 0.1 --set wheel.radius_m=0.2
ignored '/set/soil.n' $wheel --set soil.n=1 --sweep soil.n=0.9,1
ignored '/set/soil.n' $wheel --set soil.n=1 --set soil.n=0.9
ignored '/effect' $wheel --effect digging:rim_share=0.1 --set effects.digging.rim_share=0.2
ignored '/effect' $wheel --effect digging --effect digging
printf 'slip,load_n\n0.1,50\n' >"$folder/rows.csv"
ignored '/load' $wheel --rows "$folder/rows.csv"
ignored 'cleat_shear_radius' $wheel --effect cleat_shear_radius
ignored '/slip_radius' $wheel --slip-radius tip
ignored '/in_a_track' $wheel --in-a-track
ignored 'multipass' $wheel --effect multipass
whole="$slipway wheel --data $data --rover mer-class --soil jlu_mars_2_dense --whole-rover"
ignored '/load_n' $whole --slope 5 --load 100
ignored '/slip_angle_deg' $whole --slope 5 --slip-angle-deg 10
ignored '/slope_deg' $whole
ignored 'excludes' $whole --slope 5 --slip 0.2
expect 0 $whole --sweep slope_deg=0:8:4
expect 5 $whole --slope 40
ignored '/effects/0/name' $estimate $sizes --grousers 0.01,24 --effect grousers
ignored '/wheel-radius' $estimate $sizes --wheel-radius 0.13
ignored '/wheels/0/name' $estimate $sizes --wheel-radius 0.13@rough
ignored '/set/c1@wet' $estimate $sizes --set c1@wet=0.3
ignored '/soils/0/name' $estimate $sizes --soil wet=ding_2011
ignored '/free/0' $estimate $sizes --free c9
ignored '/merge-stiffness' $estimate $sizes --merge-stiffness --free n
ignored '/url' "$slipway" health
ignored '/url' "$slipway" health --data "$data"

# What is no finite number, and a speed that no rover drives.
for bad in nan inf -inf NaN infinity 1e999; do
  ignored '--max-slip' "$slipway" plan --data "$data" $stops --max-slip "$bad"
  ignored '--speed-m-s' "$slipway" predict --data "$data" $path --speed-m-s "$bad"
  ignored '--radius' $wheel --radius "$bad"
  ignored '--gravity' "$slipway" current invert --data "$data" --current 0.7 --gravity "$bad"
  ignored 'must be x,y' "$slipway" plan --data "$data" --start "$bad,1" --goal 1,2
  ignored '/sweep/0' $wheel --sweep "slip=0:$bad:0.1"
  ignored '/parameter' "$slipway" tune opportunity_sol_2143 --data "$data" --measured x --parameter "soil.n=$bad..1"
  ignored '/bound' $estimate $sizes --bound "n=$bad:1"
done
ignored '/speed_m_s' "$slipway" predict --data "$data" $path --speed-m-s 1e-300

# A request on standard input is read to its limit and no further, and Ctrl-C ends the waiting for it.
status=0
head -c 400000000 /dev/zero 2>/dev/null | timeout 20 "$slipway" plan --data "$data" --request - 2>"$folder/err" || status=$?
[ "$status" = 2 ] || { echo "exit status $status of 400 MB"; exit 1; }
holds 'payload_too_large' "$folder/err"
mkfifo "$folder/silent"
sleep 30 >"$folder/silent" &
writer=$!
"$slipway" plan --data "$data" --request - <"$folder/silent" >/dev/null 2>"$folder/err" &
waiting=$!
sleep 1
kill -INT "$waiting"
(sleep 10; kill -9 "$waiting" 2>/dev/null) &
guard=$!
status=0
wait "$waiting" || status=$?
kill "$guard" "$writer" 2>/dev/null || true
[ "$status" = 1 ] || { echo "exit status $status of an interrupted request"; exit 1; }
holds 'cancelled' "$folder/err"

# A campaign with a hostile name: neither the terminal nor the report obeys it. No model is offered, and that of an
# earlier diagnosis is not left to be planned with.
cp -r "$data/gap-practice/p01" "$folder/hostile"
python3 - "$folder/hostile/campaign.json" <<'NAME'
import json, pathlib, sys
path = pathlib.Path(sys.argv[1])
campaign = json.loads(path.read_text())
campaign["name"] = "<script>alert(1)</script>\x1b[2J\x07\u009b31m [x](javascript:y)"
path.write_text(json.dumps(campaign))
NAME
mkdir -p "$folder/model/rovers" "$folder/model/soils"
echo '{"format": "corrected-model/1", "campaign": "an earlier one", "rover": {"nominal": "mer-class", "corrected": "mer-class-a1"}, "soils": [{"nominal": "nominal", "corrected": "nominal-a1"}]}' >"$folder/model/model.json"
echo '{}' >"$folder/model/rovers/mer-class-a1.json"
echo '{}' >"$folder/model/soils/nominal-a1.json"
echo '{}' >"$folder/model/rovers/mine.json"
status=0
"$slipway" diagnose "$folder/hostile" --data "$data" --report "$folder/report" --model "$folder/model" >/dev/full 2>"$folder/err" || status=$?
[ "$status" = 1 ] || { echo "exit status $status of a diagnosis that nobody could read"; exit 1; }
holds 'model of campaign an earlier one was taken out' "$folder/err"
[ "$(cd "$folder/model" && find . -type f)" = "./rovers/mine.json" ] || { echo "other files are in the model's folder:"; find "$folder/model"; exit 1; }
python3 - "$folder/report" <<'REPORT'
import pathlib, sys
folder = pathlib.Path(sys.argv[1])
for file in ("report.md", "report.html"):
    text = (folder / file).read_text()
    assert "alert(1)" in text, file
    assert "<script" not in text and "\x1b" not in text and "\x07" not in text, file
assert (folder / "diagnosis.json").stat().st_size > 1000
REPORT
sed -i 's/"format"/"formatt"/' "$folder/hostile/campaign.json"
"$slipway" diagnose "$(printf "$folder/no\033[2Jwhere")" --data "$data" 2>"$folder/err" && exit 1
expect 2 "$slipway" wheel --data "$data" --soil "$(printf 'a\033[2Jb\302\233c\177d')"
for text in out err; do
  if LC_ALL=C grep -q "$(printf '[\001-\010\013-\037\177]')" "$folder/$text"; then echo "a control byte is in $text"; exit 1; fi
done

# A benchmark that is not whole does not end with 0.
mkdir "$folder/set"
cp "$data/gap-practice/answers.json" "$folder/set"
cp -r "$data/gap-practice/p01" "$folder/set"
cp -r "$data/gap-practice/p01" "$folder/set/p02"
expect 2 "$slipway" gap-benchmark "$folder/set" --data "$data" --only p01,nosuch
holds 'nosuch' "$folder/err"
echo file >"$folder/taken"
expect 1 "$slipway" gap-benchmark "$folder/set" --data "$data" --only p01 --keep "$folder/taken/kept"
holds 'taken' "$folder/err"
"$slipway" gap-benchmark "$folder/set" --data "$data" >"$folder/out" 2>"$folder/err" &
benchmark=$!
tries=0
until grep -q '^\[1/2\]' "$folder/err" || [ "$tries" -gt 600 ]; do sleep 0.2; tries=$((tries + 1)); done
kill -INT "$benchmark"
status=0
wait "$benchmark" || status=$?
[ "$status" = 1 ] || { echo "exit status $status of an interrupted benchmark"; cat "$folder/err"; exit 1; }
holds '1 of 2 campaigns' "$folder/err"
holds '1 campaigns' "$folder/out"

# Steps of measured slip out of kernels; nothing that is given is passed over.
kernels="$(dirname "$0")/../steps/data"
expect 0 "$slipway" import spice "$kernels/msl_surf_rover_tlm_0089_0179_v1.bsp" "$kernels/msl_surf_rover_tlm_0089_0179_v1.bc" "$kernels/MSL_76_SCLKSCET.00013.tsc" --out "$folder/steps.csv"
holds '^200 steps of sols 100 to 166, 200 of them with attitude' "$folder/out"
holds '^# slip-steps/1' "$folder/steps.csv"
[ "$(wc -l <"$folder/steps.csv")" = 202 ] || { echo "there are not 200 steps"; exit 1; }
expect 0 "$slipway" import spice "$kernels/msl_surf_rover_tlm_0089_0179_v1.bsp" --out "$folder/without.csv"
holds 'without attitudes a correction is told by its length' "$folder/out"
expect 2 "$slipway" import spice "$kernels/msl_surf_rover_tlm_0089_0179_v1.bsp" "$kernels/msl_surf_rover_tlm_0089_0179_v1.bc" --out "$folder/none.csv"
holds 'no clock kernel' "$folder/err"
head -c 5000 "$kernels/msl_surf_rover_tlm_0089_0179_v1.bsp" >"$folder/cut.bsp"
expect 2 "$slipway" import spice "$folder/cut.bsp" --out "$folder/none.csv"
holds 'cut.bsp, byte 5000' "$folder/err"
[ ! -e "$folder/none.csv" ] || { echo "a table was written of kernels with faults"; exit 1; }
ignored 'mapping' "$slipway" import yard.toml spice "$folder/cut.bsp" --out "$folder/none.csv"
ignored 'mapping' "$slipway" import

# Two campaigns in one folder, and files of others in it.
cat >"$folder/table.json" <<'TABLE'
{"format": "campaign-table/1", "name": "small", "summary": "arcs", "sources": [], "rover": "fido-class",
 "gravity_m_s2": 9.81, "seed": 3, "terrains": [{"name": "level", "soil": "dry_sand"}],
 "drives": [{"id": "arc", "legs": [{"length_m": 2.5, "curvature_1_m": 0.3}], "repeats": 3}]}
TABLE
mkdir "$folder/campaign"
echo mine >"$folder/campaign/thesis.part"
# This shell takes the place of a campaign at work: it holds the lock of the folder, so that no timing decides.
exec 9<"$folder/campaign"
flock 9
expect 1 "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/campaign"
holds 'another process works with' "$folder/err"
exec 9<&-
expect 0 "$slipway" campaign "$folder/table.json" --data "$data" --out "$folder/campaign"
holds mine "$folder/campaign/thesis.part"
sed 's/"id": "arc"/"id": "a", "deformed_terrain": true/; s/"name": "level"/"name": "a-deformed"/; s/, "repeats": 3//' "$folder/table.json" >"$folder/collide.json"
expect 2 "$slipway" campaign "$folder/collide.json" --data "$data" --out "$folder/collide"
holds 'a-deformed.tif' "$folder/err"
[ ! -e "$folder/collide" ] || { echo "a folder was made for a table with faults"; exit 1; }
# The day: a rule is not lost with an empty variable, and each fault is named.
shipped="$slipway check --path 8142566,-276711 8142566,-276696"
expect 2 $shipped --depart "" --day min_sun_deg=89
holds 'FROM..TO' "$folder/err"
expect 2 $shipped --depart 2016-03-22T09:00:00Z/2016-03-22T14:00:00Z
holds 'FROM..TO' "$folder/err"
expect 2 $shipped --depart 9990-03-22T09:00:00Z
holds 'from 1800 to 2150' "$folder/err"
expect 2 "$slipway" sky --lonlat 137.4,-4.6 --at ""
echo '[{' >"$folder/sky.json"
expect 2 $shipped --depart 2016-03-22T09:00:00Z --sky "$folder/sky.json"
holds sky.json "$folder/err"
# Every fault at once, in the words of the command line.
expect 2 $shipped --depart nonsense --day charge_percent=160 --day min_sun=3
for words in '^  --depart: .*FROM..TO' '/departure/charge_percent' '/departure/min_sun: .* air, '; do holds "$words" "$folder/err"; done
expect 2 $shipped --depart 1700-01-01T00:00:00Z --day charge_percent=160
for words in '/departure/charge_percent' 'not for the year 1700'; do holds "$words" "$folder/err"; done
echo '[{"at":"now"}]' >"$folder/sky.json"
expect 2 $shipped --depart 2016-03-22T09:00:00Z --sky "$folder/sky.json"
for words in 'must have 2 to' '/departure/sky/0/at' '/departure/sky/0/sun_azimuth_deg'; do holds "$words" "$folder/err"; done
expect 2 $shipped --depart 2016-03-22T09:00:00Z --day air=5
holds 'air.coldest_c=-80 --day air.warmest_c=-10' "$folder/err"
expect 0 $shipped --depart 2016-03-22T09:00:00Z --day air.coldest_c=-80 --day air.warmest_c=-10 --json
holds '"air":{"coldest_c":-80,"warmest_c":-10}' "$folder/out"
# An input that can't be used is one, whichever: a place off the map, a file that is not there.
expect 2 "$slipway" check --path 0,0 1,1
expect 2 "$slipway" plan --start 0,0 --goal 8142566,-276696
holds '/start: (0, 0) m is off the map' "$folder/err"
expect 2 $shipped --depart 2016-03-22T09:00:00Z --sky "$folder/none.json"
holds 'none.json' "$folder/err"
expect 2 "$slipway" plan --request "$folder/none.json"
expect 2 "$slipway" sky --terrain gale --place 0,0 --horizon
# Half a minute is less than any drive needs: to end sooner helps nothing where no departure keeps the rules of the day.
expect 0 $shipped
expect 3 $shipped --depart 2016-03-22T09:00:00Z --day arrive_by=2016-03-22T09:00:30Z
! grep -q 'end the drive at' "$folder/out" || { echo "a shorter drive is advised that the day forbids"; exit 1; }
# A start that is wrong is judged, and one that is none refused.
between="--start 8142566,-276711 --goal 8142566,-276696 --routes 1 --depart 2016-03-22T09:00:00Z"
expect 2 "$slipway" sol $between --start-error position_m=-1
holds '/start_error/position_m' "$folder/err"
expect 0 "$slipway" sol $between --start-error position_m=0.2 --start-error heading_deg=1
holds 'of 25 starts that are wrong by 0.2 m and 1 deg' "$folder/out"
# What is printed of a sol can be driven: the pose, each command from where to where, what is assumed of slip checks.
expect 0 "$slipway" sol $between --start-error position_m=0.2 --day arrive_by=2016-03-22T15:00:00Z --commands "$folder/sol.json"
for words in '^Start at (8142566.00, -276711.00) m of the map, heading [0-9.]* deg$' '^drive .* m  *0.00 m  *[0-9.]* m' \
  'the slip is checked every 5 m' '^Depart at 2016-03-22 09:00 UTC$' '^In time: .* before the limit of 2016-03-22 15:00 UTC$'; do
  holds "$words" "$folder/out"
done
! grep -q '\(T09:\|before 0.0 m\)' "$folder/out" || { cat "$folder/out"; exit 1; }
expect 0 "$slipway" check --commands "$folder/sol.json"
# A GO that holds only with a wait says so first.
expect 0 $shipped --depart 2016-03-22T01:00:00Z --day charge_percent=0
holds '^GO: from .* on the rover must wait for 0.28 h where it stands' "$folder/out"
echo "as expected"
