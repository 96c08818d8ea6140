#!/usr/bin/env python3
"""Routes and stations as GIS tools read them, and places in degrees.

usage: vectors_test.py SLIPWAY DATA_FOLDER
"""
import json
import math
import pathlib
import sqlite3
import struct
import subprocess
import sys
import tempfile
import unittest

SLIPWAY, DATA = sys.argv[1:3]
PATH = [(8142640.0, -276640.0), (8142610.0, -276643.0)]
DEGREE_M = 3396190.0 * math.pi / 180.0  # of the terrain's equidistant cylindrical map of Mars
at = lambda places: [f"{x!r},{y!r}" for x, y in places]
in_degrees = lambda places: [(x / DEGREE_M, y / DEGREE_M) for x, y in places]


def run(*words):
    return subprocess.run([SLIPWAY, *words, "--data", DATA], capture_output=True, text=True)


class VectorsOut(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        here = pathlib.Path(cls.folder.name)
        cls.names = {name: str(here / name) for name in ("a.gpkg", "map.geojson", "degrees.geojson", "again.gpkg", "s.csv")}
        done = run("predict", "--path", *at(PATH), "--draws", "16", "--gpkg", cls.names["a.gpkg"], "--geojson", cls.names["map.geojson"],
                   "--csv", cls.names["s.csv"], "--json")
        assert done.returncode in (0, 3, 4), done.stderr
        cls.answer = json.loads(done.stdout)
        done = run("predict", "--lonlat", "--path", *at(in_degrees(PATH)), "--draws", "16", "--gpkg", cls.names["again.gpkg"],
                   "--geojson", cls.names["degrees.geojson"], "--json")
        assert done.returncode in (0, 3, 4), done.stderr
        cls.in_degrees = json.loads(done.stdout)
        cls.rows = len(pathlib.Path(cls.names["s.csv"]).read_text().splitlines()) - 1

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_places_in_degrees_ask_the_same_question(self):
        for there, here in zip(self.in_degrees["request"]["path"], PATH):
            self.assertAlmostEqual(there["x_m"], here[0], places=4)
            self.assertAlmostEqual(there["y_m"], here[1], places=4)

    def test_a_geopackage_has_both_layers_in_the_bodys_system(self):
        with sqlite3.connect(self.names["a.gpkg"]) as file:
            layers = dict(file.execute("select table_name, srs_id from gpkg_contents where data_type = 'features'").fetchall())
            self.assertEqual(set(layers), {"routes", "stations", "rules", "checks"})
            styles = dict(file.execute("select f_table_name, styleQML from layer_styles where useAsDefault").fetchall())
            self.assertEqual(set(styles), {"routes", "stations", "rules"})
            limits = dict(file.execute("select rule, \"limit\" from rules").fetchall())
            self.assertEqual(limits["slip_check"], self.answer["request"]["limits"]["max_slip"])
            places = [row[0] for row in file.execute("select distance_m from checks where why = 'interval'")]
            self.assertEqual(places, [5.0 * i for i in range(1, 7)])  # of 30.15 m
            (definition,) = file.execute("select definition from gpkg_spatial_ref_sys where srs_id = ?", (layers["routes"],)).fetchone()
            self.assertIn("3396190", definition)
            self.assertEqual(file.execute("select count(*) from stations").fetchone()[0], self.rows)
            verdict, length, geometry = file.execute("select verdict, length_m, geom from routes").fetchone()
        self.assertEqual(verdict, self.answer["decision"]["verdict"])
        properties = self.answer["routes"]["features"][0]["properties"]
        self.assertAlmostEqual(length, properties["length_m"])
        envelope = {0: 0, 1: 32, 2: 48, 3: 48, 4: 64}[geometry[3] >> 1 & 7]
        _, kind, points = struct.unpack_from("<BII", geometry, 8 + envelope)
        self.assertIn(kind, (1002, 0x80000002))
        self.assertEqual(points, self.rows)
        self.assertEqual(struct.unpack_from("<dd", geometry, 8 + envelope + 9), PATH[0])

    def test_geojson_says_what_its_numbers_are(self):
        metres, degrees = (json.loads(pathlib.Path(self.names[name]).read_text()) for name in ("map.geojson", "degrees.geojson"))
        self.assertIn("these are no degrees", metres["coordinates"])
        self.assertIn("3396190", metres["crs"]["properties"]["name"])
        self.assertEqual(degrees["crs"]["properties"]["name"], "urn:ogc:def:crs:IAU_2015::49900")
        self.assertIn("not the Earth", degrees["coordinates"])
        for document in (metres, degrees):
            kinds = [feature["properties"]["layer"] for feature in document["features"]]
            self.assertEqual((kinds.count("route"), kinds.count("station")), (1, self.rows))
        for there, here in zip(degrees["features"], metres["features"]):
            line = here["geometry"]["coordinates"]
            first, second = (f["geometry"]["coordinates"] for f in (there, here))
            if here["geometry"]["type"] == "LineString":
                first, second = first[0], second[0]
            self.assertAlmostEqual(first[0] * DEGREE_M, second[0], places=2)
            self.assertAlmostEqual(first[1] * DEGREE_M, second[1], places=2)

    def test_the_answer_itself_keeps_its_map_metres(self):
        first = self.in_degrees["routes"]["features"][0]["geometry"]["coordinates"][0]
        self.assertAlmostEqual(first[0], PATH[0][0], places=2)

    def test_the_ground_at_a_point_in_degrees(self):
        (lonlat,) = at(in_degrees(PATH[:1]))
        there, here = (json.loads(run("terrain", *words).stdout) for words in (["--at", lonlat, "--lonlat"], ["--at", at(PATH)[0]]))
        self.assertEqual(there["height_m"], here["height_m"])

    def test_swapped_places_and_degrees_are_named(self):
        swapped = run("predict", "--path", at([PATH[0][::-1]])[0], at(PATH)[1])
        self.assertNotEqual(swapped.returncode, 0)
        self.assertIn("x and y are swapped", swapped.stderr)
        degrees = at(in_degrees(PATH))
        told = run("predict", "--path", *degrees).stderr
        self.assertIn("longitude and latitude in degrees", told)
        self.assertIn("--lonlat", told)
        told = run("predict", "--path", *(",".join(reversed(place.split(","))) for place in degrees)).stderr
        self.assertIn("latitude and longitude in degrees, in this order", told)
        metres = run("predict", "--lonlat", "--path", *at(PATH))
        self.assertEqual(metres.returncode, 2)
        self.assertIn("these are map metres", metres.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
