#!/bin/sh
# From an elevation map to a plan with the command line alone, and what a bad map, an interruption and a name that is
# taken leave behind: nothing.
#   terrain_import_test.sh SLIPWAY DATA_FOLDER
set -eu
slipway="$1"
data="$2"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT

. "$(dirname "$0")/../command_expectations.sh"

mars="+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m +no_defs"
degrees="+proj=longlat +R=3396190 +no_defs"

# grid FILE SIDE WEST SOUTH CELL: a slope towards the south of one in twenty cells, in an ASCII grid.
grid() {
  awk -v n="$2" -v x="$3" -v y="$4" -v c="$5" 'BEGIN {
    printf "ncols %d\nnrows %d\nxllcorner %s\nyllcorner %s\ncellsize %s\n", n, n, x, y, c
    for (r = 0; r < n; ++r) { for (k = 0; k < n; ++k) printf "%.3f ", (n - r) / 20; printf "\n" } }' >"$1"
}
# The data folder holds what it held: no part of an import stays.
nothing_left() { [ "$(ls -A "$folder/data/terrains")" = "$1" ] || { echo "left behind:"; ls -A "$folder/data/terrains"; exit 1; }; }

mkdir "$folder/data"
cp -r "$data/rovers" "$data/soils" "$folder/data/"
import="$slipway terrain import --data $folder/data"
grid "$folder/Site 1.asc" 80 0 0 1

# Without a system the map is refused with the command that states one; with it, it is a terrain.
expect 2 $import "$folder/Site 1.asc"
holds 'no coordinate reference system' "$folder/err"
holds 'gdal_translate -a_srs' "$folder/err"
nothing_left ""
expect 0 $import "$folder/Site 1.asc" --crs "$mars" --licence CC0-1.0 --json
holds '"name":"site_1"' "$folder/out"
holds '"rows":80' "$folder/out"
nothing_left "site_1"
holds 'Licence: CC0-1.0' "$folder/data/terrains/site_1/PROVENANCE.md"
holds "$(sha256sum "$folder/Site 1.asc" | cut -d' ' -f1)" "$folder/data/terrains/site_1/PROVENANCE.md"
holds "$(sha256sum "$folder/data/terrains/site_1/elevation.tif" | cut -d' ' -f1)" "$folder/out"
expect 0 "$slipway" data check --data "$folder/data"
expect 0 "$slipway" terrain --data "$folder/data" --name site_1 --at 40,40
holds '"slope_deg":2.86' "$folder/out"

# The name is taken: refused, and replaced only where that is asked for.
expect 2 $import "$folder/Site 1.asc" --crs "$mars"
holds 'there is a terrain' "$folder/err"
expect 0 $import "$folder/Site 1.asc" --crs "$mars" --replace --title "The yard"
holds '"title":"The yard"' "$folder/data/terrains/site_1/terrain.json"
nothing_left "site_1"
expect 2 $import "$folder/Site 1.asc" --crs "$mars" --name "No/Name" --gravity 99
holds '--name' "$folder/err"
holds '--gravity' "$folder/err"

# What is wrong with both maps is told together.
echo 'no raster' >"$folder/classes.tif"
expect 2 $import "$folder/Site 1.asc" --name both --soil "$folder/classes.tif"
holds 'no coordinate reference system' "$folder/err"
holds 'classes.tif is not a readable raster' "$folder/err"

# marked FILE: it has two cells that mark a missing height; the command that is told mends it.
marked() {
  expect 2 $import "$1" --crs "$mars" --name holes
  holds "has 2 cells whose height no ground has" "$folder/err"
  remedy="$(sed -n 's/.*say so in the file: \(gdal_translate .*tif.\{0,1\}\)\.$/\1/p' "$folder/err")"
  (cd "$folder" && eval "$remedy -q" && mv *_m.tif mended.tif)
  expect 0 $import "$folder/mended.tif" --crs "$mars" --name holes --replace
  holds '0.03 % unknown' "$folder/out"
  rm -r "$folder/data/terrains/holes"
}

# Cells that mark a missing height, where the file does not say that they do: a wall or a pit of thousands of metres.
for mark in -9999 -32768 65535; do
  grid "$folder/holes.asc" 80 0 0 1
  awk -v mark="$mark" 'NR == 40 { $7 = mark; $8 = mark } { print }' "$folder/holes.asc" >"$folder/marked.asc"
  marked "$folder/marked.asc"
done
# The mark of a scaled band is what is stored, not the height that it makes.
for scale in 0.1 0.5; do
  gdal_translate -q -ot Int16 -a_scale $scale -a_offset -200 "$folder/holes.asc" "$folder/plain.tif"
  awk 'NR == 40 { $7 = -32768; $8 = -32768 } { print }' "$folder/holes.asc" >"$folder/marked.asc"
  gdal_translate -q -ot Int16 -a_scale $scale -a_offset -200 "$folder/marked.asc" "$folder/with a mark.tif"
  marked "$folder/with a mark.tif"
done
expect 0 $import "$folder/plain.tif" --crs "$mars" --name holes --replace
rm -r "$folder/data/terrains/holes"
awk 'NR > 5 { for (k = 1; k <= NF; ++k) $k += 3396000 } { print }' "$folder/holes.asc" >"$folder/radii.asc"
expect 2 $import "$folder/radii.asc" --crs "$mars" --name holes
holds "distances from the body's centre" "$folder/err"

# Degrees are refused with the remedy, and mended by --fix.
grid "$folder/deg.asc" 80 137 -4 0.00002
expect 2 $import "$folder/deg.asc" --crs "$degrees"
holds 'pixels in degrees' "$folder/err"
holds '--fix mends' "$folder/err"
expect 0 $import "$folder/deg.asc" --crs "$degrees" --fix
holds 'reprojected' "$folder/out"

# Coordinates in feet say nothing about heights: what these were taken for is told, with what mends it.
grid "$folder/feet.asc" 80 0 0 3.280839895
gdal_translate -q -a_srs "$(echo "$mars" | sed 's/units=m/units=ft/')" "$folder/feet.asc" "$folder/feet.tif"
expect 0 $import "$folder/feet.tif" --fix
holds 'heights 0.05 to 4.00 m' "$folder/out"
holds 'taken as metres, though' "$folder/out"
(cd "$folder" && gdal_edit.py -units ft feet.tif)
expect 0 $import "$folder/feet.tif" --fix --replace
holds 'heights 0.02 to 1.22 m' "$folder/out"
rm -r "$folder/data/terrains/feet"

# What the numbers of a map mean: what was read is told, with what nobody stated and the corners.
gdal_translate -q -ot Int16 -a_srs "$mars" "$folder/holes.asc" "$folder/site.tif"
echo '<PAMDataset><PAMRasterBand band="1"><Scale>0.5</Scale></PAMRasterBand></PAMDataset>' >"$folder/site.tif.aux.xml"
expect 0 $import "$folder/site.tif" --name meant
holds 'heights 0.00 to 2.00 m' "$folder/out"
holds 'heights: band 1, metres, scale 0.5 and offset 0 from site.tif.aux.xml, no nodata value, vertical datum not stated' "$folder/out"
holds 'on trust: heights are metres: no unit is stated' "$folder/out"
holds 'corners, deg: north-west 0.000000 E, 0.001350 N; north-east' "$folder/out"
holds 'scale 0.5 and offset 0 from site.tif.aux.xml' "$folder/data/terrains/meant/PROVENANCE.md"
[ "$(head -c 4 "$folder/data/terrains/meant/picture.png" | tail -c 3)" = PNG ] || { echo "no picture of the terrain"; exit 1; }
echo '<PAMDataset><PAM' >"$folder/site.tif.aux.xml"
expect 2 $import "$folder/site.tif" --name meant --replace
holds "site.tif.aux.xml lies beside the map and can't be read" "$folder/err"
# remedy START: the command that is told, which begins so; it is run beside the map.
remedy() {
  told="$(sed -n -e 's/ (--fix mends it.)$//' -e "s/.*\($1.*\)\$/\1/p" "$folder/err" | head -n 1)"
  (cd "$folder" && eval "$told" >/dev/null)
}
remedy 'mv site'
expect 0 $import "$folder/site.tif" --name meant --replace
holds 'heights 0.00 to 4.00 m' "$folder/out"

# A collar that nobody declares is warned of, with the value that --nodata takes; --strict refuses it.
awk 'NR > 5 { for (k = 1; k <= NF; ++k) $k = NR < 16 || k < 11 ? 0 : $k - 4500 } { print }' "$folder/holes.asc" >"$folder/collar.asc"
expect 2 $import "$folder/collar.asc" --crs "$mars" --name meant --replace --strict
holds 'have the one height 0 m, with a cliff of up to 4' "$folder/err"
holds 'row [0-9]*, column [0-9]*' "$folder/err"
expect 0 $import "$folder/collar.asc" --crs "$mars" --name meant --replace
holds 'warning: 1500 cells' "$folder/out"
expect 0 $import "$folder/collar.asc" --crs "$mars" --name meant --replace --strict \
  $(sed -n 's/.*import the map with \(--nodata [^ ]*\)$/\1/p' "$folder/out" | head -n 1)
holds '23.44 % unknown' "$folder/out"

# Pictures are no heights; a unit says that numbers of 8 bits are some, and colours are decoded as is told.
gdal_translate -q -ot Byte -a_srs "$mars" "$folder/holes.asc" "$folder/grey.tif"
expect 2 $import "$folder/grey.tif" --name meant --replace
holds '8 bits without a unit' "$folder/err"
expect 0 $import "$folder/grey.tif" --name meant --replace --unit m
holds 'steps of 1 m' "$folder/out"
gdal_translate -q -b 1 -b 1 -b 1 -co PHOTOMETRIC=RGB -colorinterp red,green,blue "$folder/grey.tif" "$folder/rgb.tif"
expect 2 $import "$folder/rgb.tif" --name meant --replace
holds 'it is a picture, not heights' "$folder/err"
remedy 'gdal_calc.py -A rgb'
expect 2 $import "$folder/rgb_m.tif" --name meant --replace  # decoded, these colours are no ground of this world
holds 'whose height no ground has, the first with -3[12]' "$folder/err"
# Of several bands one is asked for, unless it says itself that it is the one.
gdal_translate -q -b 1 -b 1 "$folder/site.tif" "$folder/bands.tif"
expect 2 $import "$folder/bands.tif" --name meant --replace --fix
holds 'has 2 bands' "$folder/err"
expect 0 $import "$folder/bands.tif" --name meant --replace --band 2
holds 'heights: band 2 (as asked for)' "$folder/out"

# Distances from the centre, and a projection without a scale.
expect 2 $import "$folder/radii.asc" --crs "$mars" --name meant --replace
gdal_translate -q -a_srs "$mars" "$folder/radii.asc" "$folder/radii.tif"
expect 2 $import "$folder/radii.tif" --name meant --replace
remedy 'gdal_calc.py -A radii'
expect 0 $import "$folder/radii_m.tif" --name meant --replace
cp "$folder/out" "$folder/by_remedy"
expect 0 $import "$folder/radii.tif" --name meant --replace --fix
holds "$(sed -n 's/.*\(heights -[0-9.]* to -[0-9.]* m\).*/\1/p' "$folder/by_remedy")" "$folder/out"
gdal_translate -q -a_srs 'PROJCS["none",GEOGCS["m",DATUM["m",SPHEROID["m",3396190,0]],PRIMEM["r",0],UNIT["degree",0.0174532925199433]],PROJECTION["Mercator_1SP"],PARAMETER["central_meridian",0],PARAMETER["scale_factor",0],PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]]' \
  "$folder/holes.asc" "$folder/none.tif" 2>"$folder/told"
expect 2 $import "$folder/none.tif" --name meant --replace --fix
holds 'with a scale factor of 0' "$folder/err"
sed -i 's/ (this one has the factor 1.*//' "$folder/err"
remedy 'gdal_translate -a_srs'
expect 0 $import "$folder/none_m.tif" --name meant --replace --fix
rm -r "$folder/data/terrains/meant"

# A soil map: its classes are told where there is no legend, and a legend's faults all at once.
awk 'BEGIN { print "ncols 80\nnrows 80\nxllcorner 0\nyllcorner 0\ncellsize 1"
  for (r = 0; r < 80; ++r) { for (k = 0; k < 80; ++k) printf "%d ", k < 40 ? 1 : 2; printf "\n" } }' >"$folder/classes.asc"
cat >"$folder/classes.prj" <<EOF
PROJCS["eqc",GEOGCS["mars",DATUM["mars",SPHEROID["mars",3396190,0]],PRIMEM["Reference meridian",0],UNIT["degree",0.0174532925199433]],PROJECTION["Equirectangular"],PARAMETER["standard_parallel_1",0],PARAMETER["central_meridian",0],PARAMETER["false_easting",0],PARAMETER["false_northing",0],UNIT["metre",1]]
EOF
expect 2 "$slipway" terrain import --data "$folder/data" "$folder/Site 1.asc" --crs "$mars" --soil "$folder/classes.asc" --name soils
holds 'the map holds 1, 2' "$folder/err"
printf 'value,label,soil\n1,smooth,jlu_mars_2_densely\nx,rough,\n' >"$folder/bad.csv"
expect 2 "$slipway" terrain import --data "$folder/data" "$folder/Site 1.asc" --crs "$mars" --soil "$folder/classes.asc" --name soils --legend "$folder/bad.csv"
holds 'bad.csv, line 3' "$folder/err"
printf 'value,label,soil\n1,smooth,jlu_mars_2_densely\n2,rough,\n' >"$folder/bad.csv"
expect 2 "$slipway" terrain import --data "$folder/data" "$folder/Site 1.asc" --crs "$mars" --soil "$folder/classes.asc" --name soils --legend "$folder/bad.csv"
holds 'did you mean "jlu_mars_2_dense"' "$folder/err"
printf 'value,label,soil\n1,smooth,jlu_mars_2_dense\n2,rough,jlu_mars_1_dense\n' >"$folder/legend.csv"
expect 0 "$slipway" terrain import --data "$folder/data" "$folder/Site 1.asc" --crs "$mars" --soil "$folder/classes.asc" --name soils --legend "$folder/legend.csv" --assumption "as the survey says"
expect 0 "$slipway" data check --data "$folder/data"
expect 0 "$slipway" terrain --data "$folder/data" --name soils --at 20,40
holds 'jlu_mars_2_dense' "$folder/out"

# And a plan on it.
expect verdict "$slipway" plan --data "$folder/data" --terrain soils --start 15,15 --goal 30,35 --routes 1 --draws 32 --json
holds '"terrain":"soils"' "$folder/out"

# Of large cells it is said what they can't show; small ones need no such word.
grid "$folder/coarse.asc" 40 0 0 463
expect 0 $import "$folder/coarse.asc" --crs "$mars"
expect verdict "$slipway" plan --data "$folder/data" --terrain coarse --start 5000,5000 --goal 7000,9000 --routes 1 --draws 8
holds 'Beyond this map: between heights 463 m apart the ground is taken as a plane' "$folder/out"
expect verdict "$slipway" plan --data "$folder/data" --terrain soils --start 15,15 --goal 30,35 --routes 1 --draws 8
if grep -q 'Beyond this map' "$folder/out"; then echo "cells of 1 m are not large"; exit 1; fi

# A link could lead out of the folder: it is not followed, and that is said.
mv "$folder/data/terrains/coarse/elevation.tif" "$folder/coarse.tif"
ln -s "$folder/coarse.tif" "$folder/data/terrains/coarse/elevation.tif"
"$slipway" data check --data "$folder/data" >"$folder/out" 2>"$folder/err" || true
cat "$folder/err" >>"$folder/out"
holds 'elevation.tif is a symbolic link, which is not followed' "$folder/out"
rm -r "$folder/data/terrains/coarse"

# Interrupted, by Ctrl-C and by the system: nothing is left, and the name is free.
grid "$folder/large.asc" 1500 0 0 1
for signal in INT TERM; do
  "$slipway" terrain import --data "$folder/data" "$folder/large.asc" --crs "$mars" --name large 2>"$folder/err" >/dev/null &
  process=$!
  tries=0
  until ls -A "$folder/data/terrains" | grep -q large || [ $tries -ge 200 ]; do tries=$((tries + 1)); sleep 0.02; done
  # A shell without job control starts what is in the background deaf to INT: the program listens all the same.
  kill -$signal $process
  status=0
  wait $process || status=$?
  [ "$status" = 1 ] || { echo "exit status $status of an import that SIG$signal ended"; cat "$folder/err"; exit 1; }
  nothing_left "$(printf 'deg\nsite_1\nsoils')"
done
# Killed outright: what it left is no terrain, and the next import of the name removes it.
mkdir "$folder/data/terrains/.large.999999999-0.slipway-part"
echo '{' >"$folder/data/terrains/.large.999999999-0.slipway-part/terrain.json"
expect 0 "$slipway" data check --data "$folder/data"
expect 0 $import "$folder/large.asc" --crs "$mars"
nothing_left "$(printf 'deg\nlarge\nsite_1\nsoils')"
echo "every import did what it owes"
