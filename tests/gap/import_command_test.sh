#!/bin/sh
# A practice campaign as a team would have it - other names, units, axes and clocks - comes back as it was.
#   import_command_test.sh SLIPWAY SOURCE_FOLDER
set -eu
slipway="$1"
data="$2/data"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

python3 - "$data/gap-practice/p01" "$folder/team" <<'MAKE'
import csv, json, math, pathlib, shutil, sys
source, team = map(pathlib.Path, sys.argv[1:])
team.mkdir()
campaign = json.loads((source / "campaign.json").read_text())
drives = [campaign["drives"][k] for k in (0, 20, 33)]  # on level ground, up a slope and across one
known = {key: value for key, value in campaign.items() if key not in ("format", "name", "drives")}
used = {drive["terrain"] for drive in drives}
known["terrains"] = {name: terrain for name, terrain in known["terrains"].items() if name in used}
for terrain in known["terrains"].values():
    shutil.copy(source / terrain["dem"], team / terrain["dem"])
(team / "known.json").write_text(json.dumps(known))
wheels = {"lf": "FL", "lm": "ML", "lr": "RL", "rf": "FR", "rm": "MR", "rr": "RR"}
for drive in drives:
    rows = list(csv.DictReader((source / drive["file"]).open()))
    with (team / (drive["id"] + "-log.csv")).open("w") as out:
        names = ["stamp_ms", "north", "east", "down", "roll_rad", "pitch_up_rad", "heading", "spare, of whom", "heading_rad"]
        names += [f"{channel}_{w}" for w in wheels.values() for channel in ("spin", "mA", "T_K")]
        print(";".join(names), file=out)
        for row in rows:
            v = {key: float(value) for key, value in row.items() if value != ""}
            cells = [f"{1000.0 * v['t_s'] + 1.7e12:.3f}", f"{v['y_m'] + 200:.9f}", f"{v['x_m'] + 100:.9f}",
                     f"{-v['z_m']:.9f}", f"{math.radians(v['roll_deg']):.12f}", f"{-math.radians(v['pitch_deg']):.12f}",
                     f"{90.0 - v['yaw_deg']:.9f}", "ok, go", f"{math.radians(90.0 - v['yaw_deg']):.9f}"]
            for w in wheels:
                cells += [f"{-math.radians(v[w + '_rate_deg_s']):.12f}", f"{1000.0 * v[w + '_current_a']:.9f}",
                          f"{v[w + '_motor_temp_c'] + 273.15:.9f}"]
            print(";".join(cells), file=out)
mapping = ['format = "drive-import/1"', 'name = "yard"', 'known = "known.json"', 'separator = ";"',
           "[frame]", 'axes = "ned"', "origin_m = [200.0, 100.0, 0.0]",
           "[clock]", 'from = "stamp_ms"', 'unit = "ms"', "[wheels]"]
mapping += [f'{own} = "{theirs}"' for own, theirs in wheels.items()]
mapping += ["[columns]", 'x_m = {from = "north"}', 'y_m = {from = "east"}', 'z_m = {from = "down"}',
            'roll_deg = {from = "roll_rad", unit = "rad"}', 'pitch_deg = {from = "pitch_up_rad", unit = "rad"}',
            'yaw_deg = {from = "heading"}',
            '"{w}_rate_deg_s" = {from = "spin_{w}", unit = "rad/s", sign = -1}',
            '"{w}_current_a" = {from = "mA_{w}", unit = "mA"}', '"{w}_motor_temp_c" = {from = "T_K_{w}", unit = "K"}']
for drive in drives:
    commanded = drive["commanded"]
    mapping += ["[[drives]]", f'id = "{drive["id"]}"', f'file = "{drive["id"]}-log.csv"',
                f'terrain = "{drive["terrain"]}"', f'speed_m_s = {commanded["speed_m_s"]}',
                f'curvature_1_m = {commanded["curvature_1_m"]}']
(team / "yard.toml").write_text("\n".join(mapping) + "\n")
MAKE

"$slipway" import "$folder/team/yard.toml" --data "$data" --out "$folder/yard" --plot "$folder/yard.svg" >"$folder/words"
grep -q 'lf_current_a *mA_FL *mA *0.001' "$folder/words"
grep -q 'not asked for: .*spare, of whom' "$folder/words"
grep -q 'axes are ned' "$folder/words"
if grep -e 'check units' -e '^warning: ' "$folder/words"; then exit 1; fi
grep -q '<svg' "$folder/yard.svg"
python3 - "$data/gap-practice/p01" "$folder/yard" <<'CHECK'
import csv, json, pathlib, sys
source, made = map(pathlib.Path, sys.argv[1:])
campaign = json.loads((made / "campaign.json").read_text())
assert campaign["format"] == "drive-campaign/1" and campaign["name"] == "yard"
truth = {drive["id"]: drive for drive in json.loads((source / "campaign.json").read_text())["drives"]}
columns = "t_s x_m y_m z_m roll_deg pitch_deg yaw_deg lf_rate_deg_s rr_current_a lm_motor_temp_c".split()
for drive in campaign["drives"]:
    rows = list(csv.DictReader((made / drive["file"]).open()))
    expected = list(csv.DictReader((source / truth[drive["id"]]["file"]).open()))
    assert len(rows) == len(expected)
    for row, other in zip(rows, expected):
        for name in columns:
            assert abs(float(row[name]) - float(other[name])) < 2e-6 * (1 + abs(float(other[name]))), (name, row[name], other[name])
CHECK

# The import is refused with these words among the faults, and nothing is left behind.
#   refused MAPPING WORDS...
refused() {
  mapping="$1"
  shift
  status=0
  "$slipway" import "$mapping" --data "$data" --out "$folder/refused" >/dev/null 2>"$folder/err" || status=$?
  if [ "$status" != 2 ] || [ -e "$folder/refused" ]; then echo "$mapping is not refused: $status"; exit 1; fi
  for words in "$@"; do
    grep -q -e "$words" "$folder/err" || { echo "not told: $words"; cat "$folder/err"; exit 1; }
  done
}

# Every fault at once.
sed -e 's/unit = "mA"/unit = "knots"/; s/from = "heading"/from = "headnig"/; s/\[clock\]/[clock]\nzone = "UTC"/' \
  "$folder/team/yard.toml" >"$folder/team/wrong.toml"
refused "$folder/team/wrong.toml" knots zone
sed -e 's/from = "heading"/from = "headnig"/; s/from = "mA_{w}"/from = "amps_{w}"/' "$folder/team/yard.toml" >"$folder/team/wrong.toml"
refused "$folder/team/wrong.toml" 'headnig.*heading' amps_RR

# A wrong separator is one fault of a file, whatever it holds.
sed -e 's/separator = ";"/separator = "tab"/' "$folder/team/yard.toml" >"$folder/team/wrong.toml"
refused "$folder/team/wrong.toml" 'separated by ";", must be separated by tabs: change the key separator of the mapping'
[ "$(grep -c '^  .*must be separated by tabs' "$folder/err")" = 3 ]
if grep -e heading_ -e 'no column' "$folder/err"; then exit 1; fi
# Without the key it is found.
sed -e '/separator = ";"/d' "$folder/team/yard.toml" >"$folder/team/found.toml"
"$slipway" import "$folder/team/found.toml" --data "$data" --out "$folder/found" >"$folder/words"
grep -q 'separated by semicolons' "$folder/words"
cmp "$folder/found/D001.csv" "$folder/yard/D001.csv"

# Two columns of one name: which of them is meant can't be told.
cp -r "$folder/team" "$folder/twins"
for log in "$folder"/twins/D*-log.csv; do sed -i '1s/;heading_rad/;heading/' "$log"; done
refused "$folder/twins/yard.toml" '(heading): 2 columns have this name'

# What the campaign's own reader refuses is placed in the log as well.
cp -r "$folder/team" "$folder/hot"
hot="$(ls "$folder"/hot/D*-log.csv | head -n 1)"
awk -F ';' -v OFS=';' 'NR == 7 { $12 = 5000 } 1' "$hot" >"$hot.part" && mv "$hot.part" "$hot"
refused "$folder/hot/yard.toml" "$(basename "$hot"), line 7 (T_K_FL): .*change the key unit of columns.\"{w}_motor_temp_c\""

# Stamps since 1970 stay as they are; a clock or a unit that is taken for another is told.
sed -e 's/unit = "ms"/unit = "ms"\nzero = "recorded"/' "$folder/team/yard.toml" >"$folder/team/epoch.toml"
"$slipway" import "$folder/team/epoch.toml" --data "$data" --out "$folder/epoch" >/dev/null
grep -q '^1700000002,' "$folder"/epoch/D*1.csv
sed -e 's/unit = "ms"/unit = "s"/' "$folder/team/yard.toml" >"$folder/team/units.toml"
"$slipway" import "$folder/team/units.toml" --data "$data" >"$folder/words"
[ "$(grep -c '^warning: ' "$folder/words")" = 1 ]
grep -q 'change the key clock.unit of units.toml to "ms"' "$folder/words"
if grep 'check units' "$folder/words"; then exit 1; fi
# Angles in rad that are taken for degrees: the ground is tilted by more, and the heading is not that of the way.
sed -e 's/, unit = "rad"//; s/from = "heading"/from = "heading_rad"/' "$folder/team/yard.toml" >"$folder/team/angles.toml"
"$slipway" import "$folder/team/angles.toml" --data "$data" >"$folder/words"
grep -q '^warning: .*tilted by .* change the key unit of columns.roll_deg and columns.pitch_deg of angles.toml to "rad"' "$folder/words"
grep -q '^warning: .*heading is more than .* columns.yaw_deg of angles.toml' "$folder/words"
tail -n 1 "$folder/words" | grep -q '^warning: '

# A sign that is forgotten turns pitch, roll or all currents: each has its warning, and nothing else does.
for turned in 'pitch_deg = {from = "pitch_up_rad", unit = "rad"' 'roll_deg = {from = "roll_rad", unit = "rad"' \
  '"{w}_current_a" = {from = "mA_{w}", unit = "mA"'; do
  python3 - "$folder/team/yard.toml" "$folder/team/turned.toml" "$turned" <<'TURN'
import pathlib, sys
text = pathlib.Path(sys.argv[1]).read_text()
assert text.count(sys.argv[3]) == 1
pathlib.Path(sys.argv[2]).write_text(text.replace(sys.argv[3], sys.argv[3] + ", sign = -1"))
TURN
  rm -rf "$folder/turned"
  "$slipway" import "$folder/team/turned.toml" --data "$data" --out "$folder/turned" >"$folder/words"
  [ "$(grep -c '^warning: ' "$folder/words")" = 1 ]
  key="$(echo "${turned%% =*}" | tr -d '"')"
  grep '^warning: ' "$folder/words" | grep -qF "change the key sign of columns.\"$key\" of turned.toml"
done
# Rates in rad/s that are taken for deg/s.
sed -e 's/unit = "rad\/s", //' "$folder/team/yard.toml" >"$folder/team/rates.toml"
"$slipway" import "$folder/team/rates.toml" --data "$data" >"$folder/words"
grep -q '^warning: .*less than 0.0175 of the commanded rate.*columns."{w}_rate_deg_s" of rates.toml to "rad/s"' "$folder/words"
# Currents and temperatures that no motor has are refused where they stand, and nothing is written.
sed -e 's/unit = "mA"/unit = "A"/; s/unit = "K"/unit = "C"/' "$folder/team/yard.toml" >"$folder/team/units.toml"
refused "$folder/team/units.toml" 'log.csv, line 2 (T_K_FL): lf_motor_temp_c' \
  'log.csv, line 2 (mA_FL): lf_current_a = .* A, can.t be beyond .*key unit of columns."{w}_current_a" of units.toml (it is A)'

# Faults of the mapping, of the logs and of what was known before are told in one round, each where it stands.
cp -r "$folder/team" "$folder/rounds"
sed -i -e 's/unit = "mA"/unit = "knots"/; s/from = "heading"/from = "headnig"/' "$folder/rounds/yard.toml"
sed -i 's/"mass_kg": 174.0/"mass_kg": -174.0/' "$folder/rounds/known.json"
last="$(ls "$folder"/rounds/D*-log.csv | tail -n 1)"
sed -i '4s/^[^;]*;[^;]*/&x/' "$last"
refused "$folder/rounds/yard.toml" 'yard.toml#/columns/{w}_current_a/unit' 'unknown column "headnig"' \
  "$(basename "$last"), line 4 (north)" 'known.json, line 1, column [0-9]* (/rover/mass_kg): mass_kg = -174'
if grep 'campaign.json' "$folder/err"; then exit 1; fi

# Bad times, one fault for each kind of them.
first="$(ls "$folder"/team/D*-log.csv | head -n 1)"
sed -e '2s/^[^;]*//; 5s/^[^;]*/1699999999000/; 9s/^[^;]*//' -i "$first"
refused "$folder/team/yard.toml" 'line 5 (stamp_ms): 1699999999000 follows 17' \
  'line 2 (stamp_ms): the time is missing; so it is in line 9' '2 faults'
echo 'name = [' >"$folder/team/wrong.toml"
refused "$folder/team/wrong.toml" 'wrong.toml, line'
if grep JSON "$folder/err"; then exit 1; fi
echo "as expected"
