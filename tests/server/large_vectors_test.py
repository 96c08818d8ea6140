#!/usr/bin/env python3
"""Sixteen clients read the vectors of a long drive, slowly and at once: of 6 km, with SLIPWAY_FULL_SIZE of the longest, 20 km.

usage: large_vectors_test.py SLIPWAY SOURCE_DIR
"""
import hashlib
import http.client
import json
import os
import pathlib
import sqlite3
import sys
import tempfile
import threading
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "contract"))
from running_service import Server  # noqa: E402

SIDE = 300
READERS = 16
LANES = 68 if "SLIPWAY_FULL_SIZE" in os.environ else 20  # of 275 m
GRID = f"ncols {SIDE}\nnrows {SIDE}\nxllcorner 0\nyllcorner 0\ncellsize 1\n" + ("0 " * SIDE + "\n") * SIDE
MARS = "+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m +no_defs"


class LargeVectors(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)
        self.server = Server(self.folder)
        self.addCleanup(self.server.stop)

    def longest_drive(self):
        """The address of the answer to a long drive on level ground."""
        sent = json.loads(self.server.ask("POST", "/v1/uploads?name=flat.asc", GRID.encode(), {"Content-Type": "application/octet-stream"})[2])
        flat = {"name": "flat", "elevation": sent["id"], "crs": MARS, "gravity_m_s2": 3.71}
        self.server.answer("/v1/terrains", flat)
        lanes = [(x, 20.0 + 3.8 * k) for k in range(LANES) for x in ((10.0, 285.0), (285.0, 10.0))[k % 2]]
        path = [{"x_m": x, "y_m": y} for x, y in lanes]
        request = {"terrain": "flat", "rover": "msl-class", "path": path, "draws": 1}
        status, headers, body = self.server.ask("POST", "/v1/predictions", request, {"Prefer": "respond-async"})
        self.assertEqual(status, 201, body[:2000])
        self.assertEqual(self.server.end_of(headers["Location"])["state"], "successful")
        return headers["Location"]

    def read(self, path, told):
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=120)
        connection.request("GET", path)
        response = connection.getresponse()
        digest, size = hashlib.sha256(), 0
        while piece := response.read(500_000):
            digest.update(piece)
            size += len(piece)
            time.sleep(0.05)
        told.append((response.status, size, digest.hexdigest()))
        connection.close()

    def given_back(self, down_to_mb):
        deadline = time.time() + 10
        while self.server.rss_mb("VmRSS") > down_to_mb and time.time() < deadline:
            time.sleep(0.1)
        return self.server.rss_mb("VmRSS") <= down_to_mb

    def test_sixteen_readers_take_little_memory_and_get_all(self):
        job = self.longest_drive()
        for _ in range(20):
            self.server.ask("GET", "/v1/jobs")
        before = self.server.rss_mb("VmRSS")
        for name in ("vectors.geojson", "vectors.geojson?coordinates=lonlat", "vectors.gpkg"):
            told, most = [], 0
            readers = [threading.Thread(target=self.read, args=(f"{job}/{name}", told)) for _ in range(READERS)]
            for reader in readers:
                reader.start()
            while any(reader.is_alive() for reader in readers):
                most = max(most, self.server.rss_mb("VmRSS"))
                time.sleep(0.02)
            self.assertEqual((len(told), len(set(told)), told[0][0]), (READERS, 1, 200))
            print(f"{name}: {told[0][1] / 1e6:.1f} MB to each of {READERS} readers took {most - before:.0f} MB of memory")
            self.assertGreater(told[0][1], 0.2e6 * LANES)
            self.assertLess(most - before, 50)
            self.assertTrue(self.given_back(before + 20), "the memory is given back")
        package = self.folder / "it.gpkg"
        package.write_bytes(self.server.ask("GET", job + "/vectors.gpkg")[2])
        with sqlite3.connect(package) as file:
            rows = file.execute("select count(*) from stations").fetchone()[0]
        table = self.server.ask("GET", job + "/result", headers={"Accept": "text/csv"})[2]
        self.assertEqual(rows, table.count(b"\n") - 1)
        status, headers, part = self.server.ask("GET", job + "/vectors.gpkg", headers={"Range": "bytes=0-15"})
        self.assertEqual((status, part), (206, b"SQLite format 3\0"))
        left = [path.name for path in self.folder.iterdir() if "drawn" in path.name]
        self.assertEqual(left, [], "what is drawn has no name")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
