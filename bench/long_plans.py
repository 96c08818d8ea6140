#!/usr/bin/env python3
"""How plans over kilometres scale with the map's side, the distance and the number of routes: wall time, processor time and
the largest memory by the operating system's account (wait4), of one command each.

usage: long_plans.py SLIPWAY FRACTAL_MAP SOURCE_DIR [--folder DIR] [--side 16384] [--only side|distance|routes]

FRACTAL_MAP makes the maps (bench/fractal_map.cc); those that DIR already has are kept.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

parser = argparse.ArgumentParser()
parser.add_argument("slipway")
parser.add_argument("fractal_map")
parser.add_argument("source_dir", type=pathlib.Path)
parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "slipway_long_plans")
parser.add_argument("--side", type=int, default=16384)
parser.add_argument("--only", choices=["side", "distance", "routes"])
arguments = parser.parse_args()


def terrain(side):
    """The name of a fractal map of this side, made where the folder does not have it."""
    name = f"fractal{side}"
    folder = arguments.folder / "terrains" / name
    folder.mkdir(parents=True, exist_ok=True)
    for shared in ("rovers", "soils", "rules"):
        link = arguments.folder / shared
        if not link.exists():
            link.symlink_to((arguments.source_dir / "data" / shared).resolve())
    (folder / "terrain.json").write_text(json.dumps({"format": "terrain/1", "name": name, "title": name,
                                                     "elevation": "elevation.tif", "gravity_m_s2": 3.71}))
    if not (folder / "elevation.tif").exists():
        subprocess.run([arguments.fractal_map, folder / "part.tif", str(side), "1", "1", "8"], check=True)
        os.replace(folder / "part.tif", folder / "elevation.tif")
    return name


def measured(command):
    """Exit status, output, wall seconds, processor seconds and largest memory in MB of a command."""
    begun = time.monotonic()
    with tempfile.TemporaryFile() as output:
        child = subprocess.Popen(command, stdout=output, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        wall = time.monotonic() - begun
        output.seek(0)
        return child.returncode, output.read(), wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def plan(side, distance, routes):
    """One plan from south-west to north-east through the map's middle, as a row of the table."""
    half = 0.5 * distance / 2 ** 0.5
    x, y = 500000.0, 4000000.0 - 0.5 * side
    command = [arguments.slipway, "plan", "--data", str(arguments.folder), "--terrain", terrain(side),
               "--start", f"{x - half},{y - half}", "--goal", f"{x + half},{y + half}", "--routes", str(routes), "--json"]
    status, output, wall, cpu, memory = measured(command)
    found = []
    if output.startswith(b"{") and b'"summary"' in output:
        found = json.loads(output)["summary"]
    lengths = " ".join(f"{route['length_m']:.0f}" for route in found)
    print(f"{side:6d} {distance:7.0f} {routes:6d} {len(found):5d} {wall:7.1f} {cpu:7.1f} {memory:9.0f}  {lengths}", flush=True)
    return status


print("  side distance routes found  wall s   cpu s  memory MB  lengths m")
if arguments.only in (None, "side"):
    for side in (2048, 4096, 8192, 16384):
        if side <= arguments.side:
            plan(side, 1200, 3)
if arguments.only in (None, "distance"):
    for distance in (600, 1200, 2500, 5000, 8000, 12000):
        if distance * 1.1 < arguments.side:
            plan(arguments.side, distance, 3)
if arguments.only in (None, "routes"):
    for routes in (1, 2, 3, 5, 8):
        plan(arguments.side, min(2500, 0.5 * arguments.side), routes)
sys.exit(0)
