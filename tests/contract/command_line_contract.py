#!/usr/bin/env python3
"""What the command line promises, alone and beside a running service.

usage: command_line_contract.py SLIPWAY SOURCE_DIR
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

from running_service import DATA, SLIPWAY, STOP_967, STOP_997, VERDICTS, WithServer, answered


class CommandLineContract(WithServer):
    def test_a_current_is_mapped_and_inverted_on_the_command_line(self):
        run = lambda *words: subprocess.run([SLIPWAY, "current", *words, "--data", DATA], capture_output=True, text=True)
        for figure in ("9", "10", "11"):
            done = run("map", "--figure", figure)
            self.assertIn(done.returncode, VERDICTS, done.stderr)
            self.assertTrue(done.stdout.startswith("panel,soil,model,"))
            self.assertEqual(done.stdout, run("map", "--figure", figure).stdout)
        done = run("invert", "--current", "0.7", "--gravity", "9.81", "--json")
        self.assertEqual(json.loads(done.stdout)["verdict"], "go", done.stdout)
        self.assertEqual(run("map", "--figure", "7").returncode, 2)
        self.assertEqual(run("map", "--x", "k_s=1:2").returncode, 2)
        self.assertIn("/soil", run("invert", "--current", "1", "--soil", "sand").stderr)

    def test_the_command_line_asks_a_server_and_prints_a_table(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = os.path.join(folder, "routes.svg")
            at = lambda p: f"{p['x_m']},{p['y_m']}"
            done = subprocess.run([SLIPWAY, "plan", "--url", self.server.url, "--start", at(STOP_967), "--goal", at(STOP_997), "--map", picture, "--why"],
                                  capture_output=True, text=True)
            self.assertIn(done.returncode, VERDICTS, done.stderr)
            self.assertRegex(done.stdout, r"(?m)^1 .* m ")
            self.assertRegex(done.stdout, r"(?m)^(GO|NO-GO|UNKNOWN): .*\n")
            self.assertIn("Route 1 (proposed by ", done.stdout)
            text = pathlib.Path(picture).read_text()
            self.assertTrue(text.startswith("<svg") and "data:image/png;base64," in text)
        wrong = subprocess.run([SLIPWAY, "plan", "--data", DATA, "--start", "0,0", "--goal", at(STOP_997)], capture_output=True, text=True)
        self.assertNotEqual(wrong.returncode, 0)
        self.assertIn("/start", wrong.stderr)
        for command in ("terrain", "rovers", "soils"):
            self.assertEqual(subprocess.run([SLIPWAY, command, "--data", DATA], capture_output=True).returncode, 0)
        for command in ("serve", "plan", "predict", "wheel", "current", "current map", "current invert", "diagnose", "watch", "import", "import spice", "steps score", "steps learn", "check", "estimate", "estimate wheel", "terrain", "terrain import", "data check", "rovers", "soils"):
            shown = subprocess.run([SLIPWAY, *command.split(), "--help"], capture_output=True, text=True)
            self.assertEqual(shown.returncode, 0)
            self.assertIn("Example:", shown.stdout)

    def test_a_path_is_driven_at_the_dynamic_level_with_a_dead_wheel(self):
        path = [f"{p['x_m']},{p['y_m']}" for p in (STOP_967, {"x_m": STOP_967["x_m"] - 3.0, "y_m": STOP_967["y_m"]})]
        options = ["--data", DATA, "--path", *path, "--rung", "dynamic", "--failed", "rf=off", "--draws", "4"]
        shown = answered([SLIPWAY, "predict", *options, "--why"], text=True).stdout
        self.assertIn("Verified by dynamics", shown)
        self.assertIn("Dynamic less balance", shown)
        document = json.loads(answered([SLIPWAY, "predict", *options, "--json"]).stdout)
        self.assertEqual(document["summary"]["dynamic"]["fidelity"], "dynamic")
        self.assertEqual(document["request"]["failed_wheels"], {"rf": "off"})
        with tempfile.TemporaryDirectory() as folder:
            plots = [str(pathlib.Path(folder) / name) for name in ("here.svg", "there.svg")]
            for plot, where in zip(plots, ([], ["--url", self.server.url])):
                answered([SLIPWAY, "predict", *options, *where, "--plot", plot])
            here, there = (pathlib.Path(plot).read_text() for plot in plots)
            self.assertEqual(here, there)
            xml.dom.minidom.parseString(here)
            for words in (" of 3.00 m", "torque, N m", "motor current, A", "sinkage, mm"):
                self.assertTrue(words in here, words)
            refused = subprocess.run([SLIPWAY, "predict", "--data", DATA, "--path", *path, "--plot", plots[0]], capture_output=True, text=True)
            self.assertEqual(refused.returncode, 2)
            self.assertIn("/plot", refused.stderr)
        unknown = subprocess.run([SLIPWAY, "predict", "--data", DATA, "--path", *path, "--failed", "fr=off"], capture_output=True, text=True)
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("/failed_wheels/fr", unknown.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
