#!/usr/bin/env python3
"""Writes maps on which a search has it hard, as GeoTIFF of Float32 heights, made otherwise than those of fractal_map.

usage: hard_maps.py KIND OUT.tif [--side 4096] [--cell-m 1] [--seed 1]

    spectral    noise of a falling spectrum (Hurst exponent 0.7) with a slope of 11 degrees as the root mean square
    craters     craters of 6 to 600 m, as many of a size as there are on old ground, over gentle noise
    maze        a maze of walls 1.5 m high over gentle noise, one way between any two of its rooms of 64 m, gaps of 7 m
    rooms       the same walls, but each with a gap: very many ways
    gap         a wall from edge to edge in the middle, whose only gap of 7 m is at 97 % of its length

Needs numpy and GDAL's Python module.
"""
import argparse
import math

import numpy
from osgeo import gdal, osr

parser = argparse.ArgumentParser()
parser.add_argument("kind", choices=["spectral", "craters", "maze", "rooms", "gap"])
parser.add_argument("out")
parser.add_argument("--side", type=int, default=4096)
parser.add_argument("--cell-m", type=float, default=1.0)
parser.add_argument("--seed", type=int, default=1)
arguments = parser.parse_args()
N, CELL = arguments.side, arguments.cell_m
numbers = numpy.random.default_rng(arguments.seed)
WALL_M, GAP_M = 1.5, 7.0


def noise(slope_deg, hurst, longest_m=2000.0):
    """Heights whose slope has this root mean square."""
    y = numpy.fft.fftfreq(N, CELL)[:, None].astype(numpy.float32)
    x = numpy.fft.rfftfreq(N, CELL)[None, :].astype(numpy.float32)
    frequency = numpy.hypot(x, y)
    frequency[0, 0] = 1.0
    size = numpy.maximum(frequency, 1.0 / longest_m) ** (-1.0 - hurst)
    size[frequency > 1.0 / (4.0 * CELL)] = 0.0  # a DEM holds no waves of two cells
    size[0, 0] = 0.0
    phase = numbers.random((N, N // 2 + 1), dtype=numpy.float32) * numpy.float32(2.0 * math.pi)
    heights = numpy.fft.irfft2(size * numpy.exp(1j * phase), (N, N)).astype(numpy.float32)
    found = math.sqrt(sum(float(numpy.mean(numpy.diff(heights, axis=a) ** 2)) for a in (0, 1))) / CELL
    return heights * numpy.float32(math.tan(math.radians(slope_deg)) / found)


def craters():
    heights = noise(4.0, 0.8)
    for diameter in numpy.geomspace(600.0, 6.0, 24):
        for _ in range(max(1, int(0.06 * (N * CELL / diameter) ** 2 * 0.1))):
            x, y = numbers.uniform(0, N, 2)
            reach = int(1.0 * diameter / CELL) + 2
            rows = slice(max(0, int(y) - reach), min(N, int(y) + reach + 1))
            columns = slice(max(0, int(x) - reach), min(N, int(x) + reach + 1))
            r = 2.0 * CELL / diameter * numpy.hypot(numpy.arange(N)[rows][:, None] - y, numpy.arange(N)[columns][None, :] - x)
            fresh = numbers.uniform(0.3, 1.0)
            bowl = diameter * fresh * numpy.where(r < 1.0, 0.2 * (r * r - 1.0) + 0.04, 0.04 * numpy.exp(-4.0 * (r - 1.0)))
            heights[rows, columns] += bowl.astype(numpy.float32)
    return heights


def walls(segments, heights):
    """Adds walls of 3 m width along (x0, y0, x1, y1), in metres from the north-west."""
    half = 1.5
    for x0, y0, x1, y1 in segments:
        rows = slice(max(0, int((y0 - half) / CELL)), min(N, int(math.ceil((y1 + half) / CELL))))
        columns = slice(max(0, int((x0 - half) / CELL)), min(N, int(math.ceil((x1 + half) / CELL))))
        heights[rows, columns] += WALL_M
    return heights


def maze(ways):
    room = 64.0
    count = int(N * CELL // room)
    parent = list(range(count * count))

    def root(cell):
        while parent[cell] != cell:
            parent[cell] = parent[parent[cell]]
            cell = parent[cell]
        return cell

    doors = [(r, c, down) for r in range(count) for c in range(count) for down in (False, True)
             if (r + 1 < count if down else c + 1 < count)]
    segments = []
    for k in numbers.permutation(len(doors)):
        r, c, down = doors[k]
        here, there = root(r * count + c), root((r + 1) * count + c if down else r * count + c + 1)
        gap = numbers.uniform(6.0, room - 6.0 - GAP_M)
        x0, y0 = (c * room, (r + 1) * room) if down else ((c + 1) * room, r * room)
        parts = [(0.0, room)] if here == there and ways == "one" else [(0.0, gap), (gap + GAP_M, room)]
        parent[here] = there
        for begin, end in parts:
            segments.append((x0 + begin, y0, x0 + end, y0) if down else (x0, y0 + begin, x0, y0 + end))
    return walls(segments, noise(3.0, 0.8))


def gap():
    middle, far = 0.5 * N * CELL, 0.97 * N * CELL
    return walls([(middle, 0.0, middle, far), (middle, far + GAP_M, middle, N * CELL)], noise(5.0, 0.8))


heights = {"spectral": lambda: noise(11.0, 0.7), "craters": craters, "maze": lambda: maze("one"),
           "rooms": lambda: maze("many"), "gap": gap}[arguments.kind]()
system = osr.SpatialReference()
system.ImportFromEPSG(32631)
out = gdal.GetDriverByName("GTiff").Create(arguments.out, N, N, 1, gdal.GDT_Float32, ["TILED=YES"])
out.SetGeoTransform([500000.0 - 0.5 * N * CELL, CELL, 0.0, 4000000.0, 0.0, -CELL])
out.SetProjection(system.ExportToWkt())
out.GetRasterBand(1).WriteArray(heights.astype(numpy.float32))
out = None
