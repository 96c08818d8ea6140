#!/usr/bin/env python3
"""Each terrain that ships is read, says where it is from, and has routes planned on it.

usage: shipped_terrains_test.py SLIPWAY DATA_FOLDER
"""
import filecmp
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SLIPWAY, DATA = sys.argv[1:3]
ROUTES = {
    "gale": ("msl-class", "8142640,-276640", "8142610,-276643", "Mars"),
    "uma_rescue_area": ("cuadriga", "367062,4064380", "367080,4064375", "Earth"),
    "ames_yard": ("mer-class", "582705,4141830", "582725,4141870", "Earth"),
    "lunar_south_pole_synthetic": ("mer-class", "8300,12300", "8400,12400", "Moon"),
}


def run(*words):
    return subprocess.run([SLIPWAY, *words, "--data", DATA], capture_output=True, text=True)


class ShippedTerrains(unittest.TestCase):
    def test_all_of_them_are_in_this_test_and_without_fault(self):
        done = run("data", "check")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        names = [site["name"] for site in json.loads(run("terrain", "--json").stdout)["terrains"]]
        self.assertEqual(sorted(names), sorted(ROUTES))
        for name in names:
            text = pathlib.Path(DATA, "terrains", name, "PROVENANCE.md").read_text()
            self.assertRegex(text, "MIT|CC0|Apache", name)

    def test_a_route_is_planned_on_each(self):
        for name, (rover, start, goal, body) in ROUTES.items():
            with self.subTest(name):
                done = run("plan", "--terrain", name, "--rover", rover, "--start", start, "--goal", goal, "--routes", "1", "--draws", "8",
                           "--json")
                self.assertIn(done.returncode, (0, 3, 4), done.stderr)
                answer = json.loads(done.stdout)
                self.assertGreaterEqual(len(answer["routes"]["features"]), 1, answer.get("fewer_because"))
                self.assertEqual(answer["provenance"]["body"], body)

    def test_the_generators_write_what_ships(self):
        moon, malaga = (pathlib.Path(DATA, "terrains", name) for name in ("lunar_south_pole_synthetic", "uma_rescue_area"))
        with tempfile.TemporaryDirectory() as folder:
            here = pathlib.Path(folder)
            subprocess.run([sys.executable, "-B", moon / "make_terrain.py", here, "1"], check=True, capture_output=True)
            self.assertTrue(filecmp.cmp(here / "units.geojson", moon / "soil_units.geojson", shallow=False))
            # The heights: as the program reads the shipped file at the middle of a cell.
            row = (here / "elevation.asc").read_text().splitlines()[6 + 100].split()
            x, y = 8000 + 2 * 200 + 1, 12000 + 2 * (511 - 100) + 1
            point = json.loads(run("terrain", "--name", "lunar_south_pole_synthetic", "--at", f"{x},{y}").stdout)
            self.assertAlmostEqual(point["height_m"], float(row[200]), places=2)
            windows = pathlib.Path(DATA, "validation/cuadriga_windows.csv")
            subprocess.run([sys.executable, "-B", malaga / "make_units.py", windows, here / "driven.geojson"], check=True)
            self.assertTrue(filecmp.cmp(here / "driven.geojson", malaga / "soil_units.geojson", shallow=False))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
