#!/usr/bin/env python3
"""Plans between random places of the bundled map of Marias Pass: what comes out, how long it takes, how much
memory.

    bench/random_pairs.py SLIPWAY [PAIRS [SEED]]        200 pairs and seed 1 where nothing is given

Each pair is two places at least 30 m apart, uniform over the map less a border of 8 m. A plan counts as

    explained     it has as many routes as were asked for, or says why not (`fewer_because`), or the request is
                  refused with a fault that names its place
    unexplained   anything else: a crash, an empty answer without a reason

Exits with 1 where a plan is unexplained.
"""

import json
import math
import os
import random
import subprocess
import sys
import tempfile
import time

WEST, EAST, SOUTH, NORTH = 8142406.0, 8142754.0, -276792.0, -276455.0
BORDER_M = 8.0
MIN_APART_M = 30.0
ROUTES = 3


def pair(numbers):
    while True:
        ends = [(numbers.uniform(WEST + BORDER_M, EAST - BORDER_M),
                 numbers.uniform(SOUTH + BORDER_M, NORTH - BORDER_M)) for _ in range(2)]
        if math.dist(*ends) >= MIN_APART_M:
            return ends


def plan(slipway, start, goal):
    """The answer or None, the words on stderr, wall and CPU seconds, megabytes."""
    places = ["{:.2f},{:.2f}".format(*end) for end in (start, goal)]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as errors:
        begin = time.monotonic()
        child = subprocess.Popen([slipway, "plan", "--start", places[0], "--goal", places[1], "--routes",
                                  str(ROUTES), "--json"], stdout=out, stderr=errors)
        _, status, usage = os.wait4(child.pid, 0)
        wall = time.monotonic() - begin
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        errors.seek(0)
        try:
            answer = json.loads(out.read())
        except ValueError:
            answer = None
        return answer, errors.read().decode(), wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024.0


def judged(answer, words):
    if answer is None:
        return "refused" if "/start" in words or "/goal" in words else "unexplained"
    if len(answer["routes"]) >= ROUTES:
        return "all routes"
    if not answer["fewer_because"]:
        return "unexplained"
    return "fewer routes" if answer["routes"] else "no route"


def quantile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]


def main():
    slipway = sys.argv[1]
    pairs = int(sys.argv[2]) if len(sys.argv) > 2 else 200
    numbers = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    counts, walls, cpus, sizes = {}, [], [], []
    for k in range(pairs):
        start, goal = pair(numbers)
        answer, words, wall, cpu, size = plan(slipway, start, goal)
        outcome = judged(answer, words)
        counts[outcome] = counts.get(outcome, 0) + 1
        why = "" if outcome == "all routes" else " ".join(answer["fewer_because"] if answer else words.split())
        print("{:3} {:5.0f} m  {:12} {:5.1f} s wall {:5.1f} s CPU {:4.0f} MB  {}".format(
            k + 1, math.dist(start, goal), outcome, wall, cpu, size, why), flush=True)
        if outcome != "refused":
            walls.append(wall)
            cpus.append(cpu)
            sizes.append(size)
    print("{} pairs: {}".format(pairs, ", ".join("{} {}".format(n, what) for what, n in sorted(counts.items()))))
    planned = pairs - counts.get("refused", 0)
    if planned:
        print("of the {} that are not refused: {:.1f} % with {} routes".format(
            planned, 100.0 * counts.get("all routes", 0) / planned, ROUTES))
        for name, values, unit in (("wall", walls, "s"), ("CPU", cpus, "s"), ("memory", sizes, "MB")):
            print("{}: median {:.1f}, 95th percentile {:.1f}, largest {:.1f} {}".format(
                name, quantile(values, 0.5), quantile(values, 0.95), max(values), unit))
    return 1 if counts.get("unexplained") else 0


if __name__ == "__main__":
    sys.exit(main())
