#!/usr/bin/env python3
"""Makes the ground of this folder: a square of 1,024 m near the lunar south pole that is nobody's, from a seed.

usage: make_terrain.py FOLDER [SEED]

Writes FOLDER/elevation.asc (ESRI ASCII grid, metres) and FOLDER/units.geojson (map metres). README of the recipe: PROVENANCE.md.
Nothing but the standard library is needed, and the same seed gives the same bytes.
"""
import json
import math
import pathlib
import random
import sys

SIDE, CELL_M = 512, 2.0
WEST_M, SOUTH_M = 8000.0, 12000.0  # of the polar stereographic map: 14.9 km from the pole, at 89.5 deg south
TILT = (0.03, -0.05)  # of the regional slope, rise per metre towards east and north
LARGEST_M, SMALLEST_M = 240.0, 8.0  # diameters of craters
AT_1_KM = 3.2e-2  # craters over 1 km per km^2, if the power of -2 went on to there: a choice, fitted to no count


def noise(key, x, y):
    """Value noise of unit lattice in [-1, 1]."""
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)

    def corner(a, b):
        n = (a * 374761393 + b * 668265263 + key * 974711) & 0xFFFFFFFF
        n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
        return ((n ^ (n >> 16)) & 0xFFFFFF) / 0x7FFFFF - 1.0

    low = corner(i, j) + u * (corner(i + 1, j) - corner(i, j))
    high = corner(i, j + 1) + u * (corner(i + 1, j + 1) - corner(i, j + 1))
    return low + v * (high - low)


def craters(seed):
    """Places, diameters and freshness of craters: their numbers fall with the square of the diameter."""
    draw = random.Random(seed)
    area_km2 = (SIDE * CELL_M / 1000.0) ** 2
    count = int(AT_1_KM * area_km2 * ((1000.0 / SMALLEST_M) ** 2 - (1000.0 / LARGEST_M) ** 2))
    share = (SMALLEST_M / LARGEST_M) ** 2
    made = []
    for _ in range(count):
        diameter = SMALLEST_M / math.sqrt(1.0 - draw.random() * (1.0 - share))
        made.append((WEST_M + draw.random() * SIDE * CELL_M, SOUTH_M + draw.random() * SIDE * CELL_M, diameter, draw.random()))
    return sorted(made, key=lambda crater: -crater[2])  # small ones lie on large ones


def heights(made):
    """Row by row from the north."""
    z = [[0.0] * SIDE for _ in range(SIDE)]
    for row in range(SIDE):
        y = SOUTH_M + (SIDE - row - 0.5) * CELL_M
        for column in range(SIDE):
            x = WEST_M + (column + 0.5) * CELL_M
            rise = TILT[0] * (x - WEST_M) + TILT[1] * (y - SOUTH_M)
            for octave, (length_m, height_m) in enumerate(((400.0, 12.0), (150.0, 3.5), (50.0, 0.9), (15.0, 0.2), (5.0, 0.05))):
                rise += height_m * noise(octave, x / length_m, y / length_m)
            z[row][column] = rise
    for x, y, diameter, freshness in made:
        add_crater(z, x, y, 0.5 * diameter, freshness)
    return z


def add_crater(z, x, y, radius, freshness):
    """A paraboloid with a raised rim that falls with the cube of the distance; old ones are shallower."""
    depth = 2.0 * radius * (0.04 + 0.13 * freshness)
    rim = 0.2 * depth
    reach = 2.5 * radius
    first = max(0, int(SIDE - (y + reach - SOUTH_M) / CELL_M)), max(0, int((x - reach - WEST_M) / CELL_M))
    last = min(SIDE, int(SIDE - (y - reach - SOUTH_M) / CELL_M) + 1), min(SIDE, int((x + reach - WEST_M) / CELL_M) + 1)
    for row in range(first[0], last[0]):
        for column in range(first[1], last[1]):
            away = math.hypot(WEST_M + (column + 0.5) * CELL_M - x, SOUTH_M + (SIDE - row - 0.5) * CELL_M - y) / radius
            if away < 1.0:
                z[row][column] += (rim + depth) * away * away - depth
            elif away < 2.5:
                z[row][column] += rim * (away ** -3 - 2.5 ** -3) / (1.0 - 2.5 ** -3)


def units(made):
    """Plain between craters, and the inside of each crater of 30 m and more, which is unknown ground."""
    def feature(unit, ring):
        return {"type": "Feature", "properties": {"unit": unit},
                "geometry": {"type": "Polygon", "coordinates": [[[round(x, 2), round(y, 2)] for x, y in ring]]}}

    east, north = WEST_M + SIDE * CELL_M, SOUTH_M + SIDE * CELL_M
    found = [feature("plain", [(WEST_M, SOUTH_M), (east, SOUTH_M), (east, north), (WEST_M, north), (WEST_M, SOUTH_M)])]
    for x, y, diameter, _ in made:
        if diameter < 30.0:
            continue
        ring = [(x + 0.55 * diameter * math.cos(math.tau * k / 24), y + 0.55 * diameter * math.sin(math.tau * k / 24)) for k in range(24)]
        found.append(feature("crater", ring + ring[:1]))
    return {"type": "FeatureCollection", "features": found}


def main():
    folder, seed = pathlib.Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    made = craters(seed)
    with open(folder / "elevation.asc", "w") as out:
        out.write(f"ncols {SIDE}\nnrows {SIDE}\nxllcorner {WEST_M}\nyllcorner {SOUTH_M}\ncellsize {CELL_M}\nNODATA_value -9999\n")
        for row in heights(made):
            out.write(" ".join(f"{height:.3f}" for height in row) + "\n")
    (folder / "units.geojson").write_text(json.dumps(units(made), separators=(",", ":")) + "\n")
    print(len(made), "craters")


if __name__ == "__main__":
    main()
