#!/usr/bin/env python3
"""Marks the ground that Cuadriga drove: cells of 1 m whose centre lies within 6 m of a logged window.

usage: make_units.py WINDOWS_CSV OUT_GEOJSON

Each run of cells along a row is a rectangle, in map metres (EPSG:32630). Nothing but the standard library is needed.
"""
import csv
import json
import math
import pathlib
import sys

WEST_M, SOUTH_M, SIDE = 366966.344, 4064291.333, 200  # of the elevation model; cells of 1 m
REACH_M = 6.0


def driven_cells(path):
    cells = set()
    with open(path) as file:
        for row in csv.DictReader(file):
            x, y = float(row["utm30n_e_m"]) - WEST_M, float(row["utm30n_n_m"]) - SOUTH_M
            for up in range(int(y - REACH_M), int(y + REACH_M) + 1):
                for right in range(int(x - REACH_M), int(x + REACH_M) + 1):
                    inside = 0 <= up < SIDE and 0 <= right < SIDE
                    if inside and math.hypot(right + 0.5 - x, up + 0.5 - y) <= REACH_M:
                        cells.add((up, right))
    return cells


def rectangles(cells):
    for up in range(SIDE):
        right = 0
        while right < SIDE:
            if (up, right) not in cells:
                right += 1
                continue
            first = right
            while (up, right) in cells:
                right += 1
            yield first, up, right, up + 1


def main():
    features = []
    for left, low, right, high in rectangles(driven_cells(sys.argv[1])):
        ring = [[round(WEST_M + x, 3), round(SOUTH_M + y, 3)]
                for x, y in ((left, low), (right, low), (right, high), (left, high), (left, low))]
        features.append({"type": "Feature", "properties": {"unit": "driven"},
                         "geometry": {"type": "Polygon", "coordinates": [ring]}})
    pathlib.Path(sys.argv[2]).write_text(json.dumps({"type": "FeatureCollection", "features": features}, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    main()
