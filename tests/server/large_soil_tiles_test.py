#!/usr/bin/env python3
"""Soils of a terrain of more than six million cells are drawn at every zoom that the service names.

usage: large_soil_tiles_test.py SLIPWAY SOURCE_DIR
"""
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "contract"))
from running_service import DATA, SLIPWAY, Server  # noqa: E402

SIDE = 2600  # cells: 6.76 million
MARS = "+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m +no_defs"


def write_grid(path, row):
    head = f"ncols {SIDE}\nnrows {SIDE}\nxllcorner 0\nyllcorner 0\ncellsize 1\n"
    path.write_text(head + (row + "\n") * SIDE)


def pixels(png):
    """Rows of pixels of a PNG whose rows are not interlaced, as the bytes of each pixel."""
    width, height, bits, colour = struct.unpack(">IIBB", png[16:26])
    per_pixel = {3: 1, 6: 4, 2: 3}[colour] * bits
    body, at = b"", 8
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IDAT":
            body += png[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride, step = zlib.decompress(body), (width * per_pixel + 7) // 8, max(1, per_pixel // 8)
    rows, above = [], bytes(stride)
    for r in range(height):
        filtered, line = raw[r * (stride + 1)], bytearray(raw[r * (stride + 1) + 1:(r + 1) * (stride + 1)])
        for i in range(stride):
            left, up = (line[i - step] if i >= step else 0), above[i]
            corner = above[i - step] if i >= step else 0
            guess = left + up - corner
            nearest = min((left, up, corner), key=lambda value: abs(guess - value))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, nearest)[filtered]) % 256
        above = bytes(line)
        if bits < 8:
            unpacked = [(byte >> shift) & ((1 << bits) - 1) for byte in above for shift in range(8 - bits, -1, -bits)]
            rows.append([bytes([value]) for value in unpacked[:width]])
        else:
            rows.append([above[i:i + step] for i in range(0, stride, step)])
    return rows


class LargeSoilTiles(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.here = pathlib.Path(self.folder.name)
        self.data = self.here / "data"
        self.data.mkdir()
        for name in ("rovers", "soils"):
            shutil.copytree(pathlib.Path(DATA, name), self.data / name)
        # The western half is one class, the eastern another.
        write_grid(self.here / "level.asc", " ".join(["0"] * SIDE))
        write_grid(self.here / "classes.asc", " ".join(["1"] * (SIDE // 2) + ["2"] * (SIDE - SIDE // 2)))
        for name in ("level", "classes"):
            subprocess.run(["gdal_translate", "-q", "-a_srs", MARS, "-ot", "Float32" if name == "level" else "Byte",
                            self.here / f"{name}.asc", self.here / f"{name}.tif"], check=True)
        (self.here / "legend.csv").write_text("value,label,soil\n1,firm,jlu_mars_2_dense\n2,loose,mars_dune\n")
        subprocess.run([SLIPWAY, "terrain", "import", self.here / "level.tif", "--data", self.data, "--name", "wide", "--soil",
                        self.here / "classes.tif", "--legend", self.here / "legend.csv", "--assumption", "made for a test"],
                       check=True, capture_output=True)
        self.server = Server(self.here, data=self.data)

    def tearDown(self):
        self.server.stop()
        self.folder.cleanup()

    def test_every_zoom_shows_both_classes_where_they_are(self):
        status, _, body = self.server.ask("GET", "/v1/terrains/wide")
        self.assertEqual(status, 200, body)
        layer = next(layer for layer in json.loads(body)["layers"] if layer["name"] == "soil")
        self.assertEqual(layer["min_z"], 0)
        for z, metres_per_px in enumerate(json.loads(body)["tiles"]["metres_per_px"]):
            side_m = 256 * metres_per_px
            for share in (0.25, 0.75):
                x, y = int(share * SIDE / side_m), int(0.5 * SIDE / side_m)
                with self.subTest(z=z, share=share):
                    status, headers, png = self.server.ask("GET", f"/v1/terrains/wide/tiles/soil/{z}/{x}/{y}.png")
                    self.assertEqual((status, headers["Content-Type"]), (200, "image/png"), png[:300])
                    row = pixels(png)[int((0.5 * SIDE / side_m - y) * 256)]
                    here = row[int((share * SIDE / side_m - x) * 256)]
                    for column, pixel in enumerate(row):
                        at_m = (x + (column + 0.5) / 256) * side_m
                        if at_m < SIDE and abs(at_m - SIDE / 2) > side_m / 64:
                            self.assertEqual(pixel == here, (at_m < SIDE / 2) == (share < 0.5), at_m)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
