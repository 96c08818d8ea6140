#!/usr/bin/env python3
"""Maps and vectors over HTTP: the file is the command's, and what can't be is refused before it is a job.

usage: map_contract.py SLIPWAY SOURCE_DIR
"""
import json
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

from running_service import DATA, SLIPWAY, STOP_967, WithServer

SLIP = {"terrain": "gale", "rover": "msl-class", "kind": "slip_worst"}
PATH = [{"x_m": 8142640.0, "y_m": -276640.0}, {"x_m": 8142610.0, "y_m": -276643.0}]


class Maps(WithServer):
    def job(self, path, request):
        status, headers, body = self.server.ask("POST", path, request, {"Prefer": "respond-async"})
        self.assertEqual(status, 201, body[:2000])
        job = self.server.end_of(headers["Location"])
        self.assertEqual(job["state"], "successful", job)
        return headers["Location"]

    def test_a_map_is_the_file_that_the_command_writes(self):
        location = self.job("/v1/maps", SLIP)
        answer = json.loads(self.server.ask("GET", location + "/result")[2])
        self.assertEqual((answer["format"], answer["rows"], answer["columns"]), ("map/1", 337, 348))
        self.assertIn("<qgis", answer["style_qml"])
        status, headers, tif = self.server.ask("GET", location + "/map.tif")
        self.assertEqual(status, 200)
        self.assertTrue(headers["Content-Type"].startswith("image/tiff"))
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "map.tif")
            subprocess.run([SLIPWAY, "map", "slip_worst", "--terrain", "gale", "--rover", "msl-class", "--data", DATA, "--out", out],
                           check=True, capture_output=True)
            self.assertEqual(out.read_bytes(), tif)
        again = self.server.ask("GET", location + "/map.tif", headers={"If-None-Match": headers["ETag"]})
        self.assertEqual(again[0], 304)
        self.assertEqual(self.server.ask("GET", location + "/stations")[0], 404)
        self.assertEqual(self.server.ask("GET", location + "/vectors.gpkg")[0], 404)

    def test_ranges_of_a_map_are_its_bytes(self):
        location = self.job("/v1/maps", {**SLIP, "kind": "cost_to_go", "to": STOP_967})
        place = location + "/map.tif"
        _, headers, whole = self.server.ask("GET", place)
        size = len(whole)
        self.assertEqual((headers["Accept-Ranges"], int(headers["Content-Length"])), ("bytes", size))
        status, headers, body = self.server.ask("HEAD", place)
        self.assertEqual((status, int(headers["Content-Length"]), body), (200, size, b""))
        for asked, first, last in [("0-0", 0, 0), ("100-299", 100, 299), ("-8", size - 8, size - 1), (f"{size - 5}-", size - 5, size - 1),
                                   (f"0-{size}", 0, size - 1)]:
            status, headers, body = self.server.ask("GET", place, headers={"Range": f"bytes={asked}", "If-Range": headers["ETag"]})
            self.assertEqual((status, headers["Content-Range"]), (206, f"bytes {first}-{last}/{size}"), asked)
            self.assertEqual(body, whole[first:last + 1], asked)
        status, headers, body = self.server.ask("GET", place, headers={"Range": f"bytes={size}-"})
        self.assertEqual((status, headers["Content-Range"], json.loads(body)["status"]), (416, f"bytes */{size}", 416))
        for several in ({"Range": "bytes=0-1,4-5"}, {"Range": "bytes=0-1", "If-Range": '"another"'}):
            status, _, body = self.server.ask("GET", place, headers=several)
            self.assertEqual((status, body), (200, whole))

    @unittest.skipUnless(shutil.which("gdalinfo") and shutil.which("ogrinfo"), "GDAL's tools are not installed")
    def test_gdal_opens_answers_in_place(self):
        raster = self.job("/v1/maps", SLIP)
        told = subprocess.run(["gdalinfo", "-stats", f"/vsicurl/{self.server.url}{raster}/map.tif"], capture_output=True, text=True)
        for words in ("Size is 348, 337", "LAYOUT=COG", "STATISTICS_MAXIMUM=1"):
            self.assertIn(words, told.stdout, told.stderr)
        lines = self.job("/v1/predictions", {"terrain": "gale", "rover": "msl-class", "path": PATH, "draws": 16})
        told = subprocess.run(["ogrinfo", "-so", f"/vsicurl/{self.server.url}{lines}/vectors.gpkg", "stations"],
                              capture_output=True, text=True)
        self.assertRegex(told.stdout, r"Feature Count: [1-9]", told.stderr)

    def test_what_can_not_be_is_refused_before_it_is_a_job(self):
        for change, pointer in [({"kind": "slip"}, "/heading_deg"), ({"kind": "height"}, "/kind"), ({"draws": 3}, "/draws"),
                                ({"kind": "reachable", "from": STOP_967}, "/budget"), ({"to": STOP_967}, "/to"),
                                ({"extent": {"west_m": 1, "south_m": 1, "east_m": 0, "north_m": 2}}, "/extent")]:
            status, _, body = self.server.ask("POST", "/v1/maps", {**SLIP, **change})
            self.assertEqual(status, 422, (change, body[:500]))
            self.assertIn(pointer, [fault["pointer"] for fault in json.loads(body)["faults"]], change)
        status, _, body = self.server.ask("POST", "/v1/maps", {**SLIP, "extent": {"west_m": 0, "south_m": 0, "east_m": 9, "north_m": 9}})
        self.assertEqual(json.loads(body)["faults"][0]["pointer"], "/extent")

    def test_vectors_of_a_prediction(self):
        location = self.job("/v1/predictions", {"terrain": "gale", "rover": "msl-class", "path": PATH, "draws": 16})
        status, headers, package = self.server.ask("GET", location + "/vectors.gpkg")
        self.assertEqual((status, headers["Content-Type"]), (200, "application/geopackage+sqlite3"))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "a.gpkg")
            path.write_bytes(package)
            with sqlite3.connect(path) as file:
                layers = {row[0] for row in file.execute("select table_name from gpkg_contents where data_type = 'features'")}
                styles = dict(file.execute("select f_table_name, styleQML from layer_styles where useAsDefault"))
                rules = {row[0] for row in file.execute("select rule from rules")}
                checks = file.execute("select count(*) from checks where why = 'interval'").fetchone()[0]
        self.assertEqual(layers, {"routes", "stations", "rules", "checks"})
        self.assertEqual(set(styles), {"routes", "stations", "rules"})
        self.assertTrue(all("<renderer-v2" in style for style in styles.values()))
        self.assertLessEqual({"slip_check", "tilt", "embedding"}, rules)
        self.assertEqual(checks, 6)  # 30.15 m, one each 5 m
        metres, degrees = (json.loads(self.server.ask("GET", f"{location}/vectors.geojson?coordinates={c}")[2]) for c in ("map", "lonlat"))
        self.assertIn("these are no degrees", metres["coordinates"])
        self.assertAlmostEqual(degrees["features"][0]["geometry"]["coordinates"][0][0], 137.37, delta=0.01)
        self.assertEqual(self.server.ask("GET", location + "/vectors.geojson?coordinates=feet")[0], 422)
        self.assertEqual(self.server.ask("GET", location + "/map.tif")[0], 404)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
