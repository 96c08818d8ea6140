#!/usr/bin/env python3
"""Maps as files: what is written, what is left behind, what is taken up again, and what is refused.

usage: map_test.py SLIPWAY DATA_FOLDER
"""
import array
import json
import math
import pathlib
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

SLIPWAY, DATA = sys.argv[1:3]
GALE = ["--terrain", "gale", "--rover", "msl-class"]
AT = "8142579.73,-276648.74"
COG_VALIDATOR = ["/usr/bin/python3", "-m", "osgeo_utils.samples.validate_cloud_optimized_geotiff", "-q", "--full-check=yes"]
DEGREE_M = 3396190.0 * math.pi / 180.0  # of the terrain's equidistant cylindrical map of Mars


def run(*words, data=DATA):
    return subprocess.run([SLIPWAY, *words, "--data", data], capture_output=True, text=True)


class Maps(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.here = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def made(self, kind, name, *words):
        done = run("map", kind, *GALE, "--out", str(self.here / name), "--json", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def files(self):
        return sorted(path.name for path in self.here.iterdir())

    def test_slip_of_the_whole_terrain_with_its_style(self):
        answer = self.made("slip_worst", "slip.tif")
        self.assertEqual(self.files(), ["slip.qml", "slip.tif"])
        self.assertEqual((answer["format"], answer["rows"], answer["columns"]), ("map/1", 337, 348))
        found = answer["statistics"]
        self.assertGreater(found["nodata_cells"], 0.5 * found["cells"])  # most of Gale's soil is not mapped
        self.assertGreater(found["lowest"], 0.0)
        self.assertEqual(found["highest"], 1.0)
        self.assertEqual(answer["metadata"]["SLIPWAY_ROVER"], "msl-class")
        elevation = pathlib.Path(DATA, "terrains/gale/elevation.tif")
        digest = subprocess.run(["sha256sum", str(elevation)], capture_output=True, text=True).stdout.split()[0]
        self.assertEqual(answer["metadata"]["SLIPWAY_ELEVATION_SHA256"], digest)
        head = (self.here / "slip.tif").read_bytes()[:300]  # what gdalinfo calls LAYOUT=COG
        self.assertIn(b"LAYOUT=IFDS_BEFORE_DATA", head)
        self.assertIn(b"KNOWN_INCOMPATIBLE_EDITION=NO", head)
        self.assertIn("singlebandpseudocolor", (self.here / "slip.qml").read_text())

    @unittest.skipUnless(shutil.which("gdalinfo") and shutil.which("ogrinfo"), "GDAL's tools are not installed")
    def test_gdals_own_tools_read_what_was_meant(self):
        self.made("verdict", "verdict.tif", "--distance", "20", "--extent", "8142540,-276680,8142600,-276640")
        told = subprocess.run(["gdalinfo", str(self.here / "verdict.tif")], capture_output=True, text=True).stdout
        for words in ("LAYOUT=COG", "Block=512x512", "Color Table", "NoData Value=0", "SLIPWAY_DISTANCE_M=20", "NO-GO"):
            self.assertIn(words, told)
        self.made("slip_worst", "slip.tif")
        self.made("cost_to_go", "cost.tif", "--to", AT)
        for name in ("verdict.tif", "slip.tif", "cost.tif"):
            judged = subprocess.run([*COG_VALIDATOR, str(self.here / name)], capture_output=True, text=True)
            self.assertEqual((judged.returncode, judged.stdout), (0, ""), judged.stderr)
        self.assertEqual(run("map", "contours", *GALE, "--out", str(self.here / "c.gpkg")).returncode, 0)
        told = subprocess.run(["ogrinfo", "-so", str(self.here / "c.gpkg"), "contours"], capture_output=True, text=True).stdout
        self.assertIn("height_m: Real", told)

    def test_unknown_ground_has_a_value_only_where_its_belief_is_asked_for(self):
        nothing = self.made("stop_risk", "a.tif", "--extent", "8142480,-276700,8142500,-276680")
        believed = self.made("stop_risk", "b.tif", "--extent", "8142480,-276700,8142500,-276680", "--on-unknown", "belief")
        self.assertGreater(nothing["statistics"]["nodata_cells"], 0)
        self.assertLess(believed["statistics"]["nodata_cells"], nothing["statistics"]["nodata_cells"])
        self.assertGreaterEqual(believed["statistics"]["lowest"], 0.0)
        self.assertGreater(believed["statistics"]["highest"], 0.0)

    def test_classes_have_names_for_gdal_and_qgis(self):
        answer = self.made("belief", "belief.tif")
        names = [each["name"] for each in answer["classes"]]
        self.assertEqual(names[0], "unknown ground")
        self.assertEqual(sum(each["cells"] for each in answer["classes"]), 337 * 348)
        self.assertEqual(self.files(), ["belief.qml", "belief.tif", "belief.tif.aux.xml"])
        for name in names:
            self.assertIn(name, (self.here / "belief.qml").read_text())
            self.assertIn(f"<Category>{name}</Category>", (self.here / "belief.tif.aux.xml").read_text())
        # Another map of this name has no such classes.
        self.made("slip_best", "belief.tif")
        self.assertEqual(self.files(), ["belief.qml", "belief.tif"])

    def test_any_number_of_threads_gives_the_same_bytes(self):
        for threads in ("1", "3"):
            self.made("slip_worst", f"{threads}.tif", "--threads", threads)
        self.assertEqual((self.here / "1.tif").read_bytes(), (self.here / "3.tif").read_bytes())

    def test_ways(self):
        cost = self.made("cost_to_go", "cost.tif", "--to", AT)
        self.assertEqual(cost["statistics"]["lowest"], 0.0)
        cells = {}
        for budget in ("20000", "80000"):
            answer = self.made("reachable", "reachable.tif", "--from", AT, "--budget-j", budget)
            cells[budget] = {each["value"]: each["cells"] for each in answer["classes"]}
            self.assertEqual(sum(cells[budget].values()), 337 * 348)
        self.assertGreater(cells["80000"][1] + cells["80000"][2], cells["20000"][1] + cells["20000"][2])
        self.assertGreater(cells["80000"][3], 0)

    def test_contours(self):
        for name in ("c.gpkg", "c.geojson", "d.geojson"):
            words = ["--lonlat"] if name.startswith("d") else []
            done = run("map", "contours", *GALE, "--every", "5", "--out", str(self.here / name), *words)
            self.assertEqual(done.returncode, 0, done.stderr)
        with sqlite3.connect(self.here / "c.gpkg") as file:
            heights = [row[0] for row in file.execute("select height_m from contours")]
        self.assertTrue(heights and all(height % 5 == 0 for height in heights))
        lines = json.loads((self.here / "c.geojson").read_text())["features"]
        self.assertEqual(len(lines), len(heights))
        self.assertEqual(lines[0]["properties"]["layer"], "contour")
        x, y, height = json.loads((self.here / "d.geojson").read_text())["features"][0]["geometry"]["coordinates"][0]
        self.assertAlmostEqual(x, 137.37, delta=0.05)
        self.assertAlmostEqual(y, -4.66, delta=0.05)

    def test_what_can_not_be_is_refused_with_its_place(self):
        for words, said in [
            (["slip", "--out", "a.tif"], "heading_deg"),
            (["slip_best", "--heading", "3", "--out", "a.tif"], "heading_deg"),
            (["verdict", "--out", "a.png"], ".tif"),
            (["cost_to_go", "--out", "a.tif"], "/to"),
            (["reachable", "--from", AT, "--out", "a.tif"], "budget"),
            (["cost_to_go", "--to", ",".join(reversed(AT.split(","))), "--out", "a.tif"], "swapped"),
            (["cost_to_go", "--to", f"{8142579.73 / DEGREE_M},{-276648.74 / DEGREE_M}", "--out", "a.tif"], "degrees"),
            (["belief", "--extent", "0,0,10,10", "--out", "a.tif"], "/extent"),
            (["slip_worst", "--distance", "3", "--out", "a.tif"], "distance_m"),
            (["slip_worst", "--every", "3", "--out", "a.tif"], "--every"),
            (["contours", "--heading", "3", "--out", "a.gpkg"], "--heading"),
            (["cost_to_go", "--to", AT, "--resume", "--out", "a.tif"], "--resume"),
            (["reachable", "--from", AT, "--budget-j", "9", "--weight", "slip=1", "--out", "a.tif"], "weights"),
            (["verdict", "--on-unknown", "belief", "--out", "a.tif"], "unknown_ground"),
            (["slip_worst", "--keep-out", "0,0 1,0 1,1", "--out", "a.tif"], "keep_out"),
        ]:
            words = [str(self.here / word) if word.startswith("a.") else word for word in words]
            done = run("map", words[0], *GALE, *words[1:])
            self.assertNotEqual(done.returncode, 0, words)
            self.assertIn(said, done.stderr, words)
            self.assertEqual(self.files(), [])

    def test_an_interruption_leaves_nothing_and_a_killed_map_goes_on(self):
        data = self.here / "data"
        shutil.copytree(DATA, data, ignore=shutil.ignore_patterns("drive-campaigns", "gap-practice", "validation"))
        side = 3000
        dem = self.here / "dem"
        with open(f"{dem}.img", "wb") as file:
            for row in range(side):
                array.array("f", [((row * 7919 + column * 104729) % 97) / 97.0 + row / 12.0 for column in range(side)]).tofile(file)
        pathlib.Path(f"{dem}.hdr").write_text(
            f"ENVI\nsamples = {side}\nlines = {side}\nbands = 1\ndata type = 4\ninterleave = bsq\nbyte order = 0\n"
            "map info = {Arbitrary, 1, 1, 0, 3000, 1, 1, 0}\n")
        done = run("terrain", "import", f"{dem}.img", "--name", "big", "--crs", "+proj=eqc +R=3396190 +units=m", data=str(data))
        self.assertEqual(done.returncode, 0, done.stderr)
        words = [SLIPWAY, "map", "slip", "--heading", "30", "--terrain", "big", "--rover", "msl-class", "--unknown-soil",
                 "jlu_mars_2_dense", "--threads", "1", "--data", str(data), "--out"]
        whole, cut = self.here / "out" / "whole.tif", self.here / "out" / "cut.tif"
        whole.parent.mkdir()
        left = lambda: sorted(path.name for path in whole.parent.iterdir())
        # Interrupted: nothing is left, with and without a signal of its own.
        for end in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([*words, str(cut)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(1.0)
            self.assertIsNone(process.poll())
            process.send_signal(end)
            asked = time.monotonic()
            self.assertNotEqual(process.wait(), 0)
            self.assertLess(time.monotonic() - asked, 5.0)
            self.assertEqual(left(), [])
        # Killed: what was finished is not computed again, and the bytes are those of one run.
        process = subprocess.Popen([*words, str(cut), "--resume"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        part = pathlib.Path(f"{cut}.part")
        while process.poll() is None and not (part.exists() and part.stat().st_size > 5 * 512 * 512 * 4):
            time.sleep(0.01)
        process.kill()
        self.assertEqual(process.wait(), -signal.SIGKILL)
        self.assertTrue(part.exists())
        done = subprocess.run([*words, str(cut), "--resume"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("not computed again", done.stdout)
        self.assertEqual(left(), ["cut.qml", "cut.tif"])
        self.assertEqual(subprocess.run([*words, str(whole)], capture_output=True).returncode, 0)
        self.assertEqual(whole.read_bytes(), cut.read_bytes())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
