#!/bin/sh
# Sun and Earth out of SPICE kernels on the command line: as by the formulas over Mars, in every command that has a
# departure, and with every fault named.
#   sky_of_kernels_test.sh SLIPWAY DATA_FOLDER
set -eu
slipway="$1"
data="$2"
here="$(dirname "$0")"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$here/../command_expectations.sh"

kernel="$folder/made.bsp"
python3 -B "$here/made_kernel.py" "$kernel" 5920 40 # 17 March to 26 April 2016
at="--at 2016-03-22T09:00:00Z"

# Over Mars the kernel has what the formulas have.
expect 0 "$slipway" sky --lonlat 137.4,-4.6 $at --json
cp "$folder/out" "$folder/formulas.json"
expect 0 "$slipway" sky --lonlat 137.4,-4.6 $at --sky "$kernel" --json
python3 - "$folder/formulas.json" "$folder/out" <<'PYTHON'
import json, sys
formulas, kernel = (json.load(open(path)) for path in sys.argv[1:])
assert kernel["body"] == "Mars"
for body in ("sun", "earth"):
    for angle in ("azimuth_deg", "elevation_deg"):
        off = abs(formulas[body][angle] - kernel[body][angle])
        assert off < 0.03, f"{angle} of {body} is off by {off:.4f} deg"
assert abs(formulas["sun_distance_au"] - kernel["sun_distance_au"]) < 0.001
PYTHON

# A table of the Moon's sky, which a request takes as it is.
expect 0 "$slipway" sky --lonlat 12.3,-88.6 --body Moon $at --until 2016-03-24T10:30:00Z --sky "$kernel" --table "$folder/sky.json"
holds '^Table: 51 moments from 2016-03-22 09:00 UTC to 2016-03-24 10:30 UTC' "$folder/out"
holds '"sun_distance_au":0.9' "$folder/sky.json"
moon="--terrain lunar_south_pole_synthetic --data $data"
expect 0 "$slipway" sky $moon $at --sky "$kernel"
holds '^Moon at .* au from the sun' "$folder/out"
drive="--start 8500,12500 --goal 8530,12520 --depart 2016-03-22T09:00:00Z..2016-03-23T09:00:00Z --day min_sun_deg=-5 --draws 40"
expect verdict "$slipway" plan $moon $drive --sky "$folder/sky.json" --commands "$folder/by_table.json"
expect verdict "$slipway" plan $moon $drive --sky "$kernel" --commands "$folder/by_kernel.json"
cat >"$folder/constants.tpc" <<'CONSTANTS'
KPL/PCK
\begindata
BODY301_POLE_RA = ( 269.9949 0.0031 )
BODY301_POLE_DEC = ( 66.5392 0.0130 )
BODY301_PM = ( 138.3213 13.17635815 )
CONSTANTS
expect 0 "$slipway" sky --lonlat 12.3,0 --body Moon $at --sky "$kernel" --json
cp "$folder/out" "$folder/built_in.json"
expect 0 "$slipway" sky --lonlat 12.3,0 --body Moon $at --sky "$kernel" "$folder/constants.tpc" --json
cmp -s "$folder/out" "$folder/built_in.json" && { echo "the constants of a kernel are passed over"; exit 1; }

# Windows are those of the formulas, to some seconds, in every command; a file of commands says where it starts.
drive="--path 8142566,-276711 8142566,-276696 --data $data"
day="--depart 2016-03-22T00:00:00Z..2016-03-23T00:00:00Z --day min_sun_deg=20 --day min_earth_deg=10"
for command in predict check; do
  expect verdict "$slipway" $command $drive $day --sky "$kernel"
  holds 'Depart between 2016-03-22 08:59 UTC and 2016-03-22 16:39 UTC' "$folder/out"
done
stops="--start 8142566,-276711 --goal 8142566,-276696 --data $data"
expect verdict "$slipway" sol $stops $day --sky "$kernel"
expect verdict "$slipway" plan $stops --commands "$folder/route.json"
expect verdict "$slipway" check --data "$data" --commands "$folder/route.json" $day --sky "$kernel"
holds 'Depart between' "$folder/out"
expect verdict "$slipway" predict --lonlat --path 137.37,-4.667 137.3701,-4.667 --data "$data" $day --sky "$kernel"

# What is missing is named, with what the kernel has; nothing is written then.
expect 2 "$slipway" sky --lonlat 137.4,-4.6 --at 2027-01-01T00:00:00Z --sky "$kernel"
holds 'at 2027-01-01 00:01 TDB: they have it from 2016-03-17 12:00 TDB to 2016-04-26 12:00 TDB' "$folder/err"
expect 2 "$slipway" check $drive --depart 2016-04-26T00:00:00Z..2016-04-27T00:00:00Z --sky "$kernel"
holds 'invalid_request: --sky: the kernels don.t have the barycentre of Mars' "$folder/err"
expect verdict "$slipway" check $drive --depart 2016-04-26T00:00:00Z..2016-04-26T11:00:00Z --sky "$kernel"
expect 2 "$slipway" check $drive $day --sky "$kernel" "$folder/none.bsp"
holds 'none.bsp: there is no such file' "$folder/err"
head -c 5000 "$kernel" >"$folder/cut.bsp"
expect 2 "$slipway" check $drive $day --sky "$folder/cut.bsp"
holds 'cut.bsp, byte 5000' "$folder/err"
expect 2 "$slipway" check $drive $day --sky "$folder/sky.json" "$folder/sky.json"
holds 'a table is one file' "$folder/err"
expect 2 "$slipway" plan --goal 8142566,-276696 --data "$data" $day --sky "$kernel"
holds 'give --start' "$folder/err"
expect 2 "$slipway" sky --lonlat 1,2 --body Earth $at --sky "$kernel"
holds 'not for the Earth' "$folder/err"
expect 2 "$slipway" sky --lonlat 1,2 --body Moon $at --until 2016-03-22T08:00:00Z --sky "$kernel" --table "$folder/none.json"
holds 'until is before --at' "$folder/err"
expect 2 "$slipway" sky --lonlat 1,2 --body Mars $at --until 2016-04-20T08:00:00Z --sky "$kernel" --table "$folder/none.json"
holds 'ask for fewer days' "$folder/err"
[ ! -e "$folder/none.json" ] || { echo "a table was written of a question with faults"; exit 1; }
echo "as expected"
