#!/usr/bin/env python3
"""Two programs in turn at one plan of some 300 m with three routes on the Gale legend: seconds of the processor, and their ratio.

usage: plan_pairs.py [--pairs 3] OLD NEW SOURCE_DIR [FLAGS OF plan]
"""
import argparse
import os
import statistics
import subprocess
import sys

PLAN = ["--start", "8142640,-276730", "--goal", "8142440,-276500"]

parser = argparse.ArgumentParser()
parser.add_argument("old")
parser.add_argument("new")
parser.add_argument("source")
parser.add_argument("--pairs", type=int, default=3)
parser.add_argument("flags", nargs=argparse.REMAINDER)
options = parser.parse_args()


def processor_s(program):
    command = [program, "plan", *(options.flags or PLAN), "--data", os.path.join(options.source, "data"), "--json"]
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    if os.waitstatus_to_exitcode(status) not in (0, 3, 4):
        sys.exit(f"{' '.join(command)}: {status}")
    return used.ru_utime + used.ru_stime


pairs = [(processor_s(options.old), processor_s(options.new)) for _ in range(options.pairs)]
for old, new in pairs:
    print(f"{old:.2f} s, {new:.2f} s: {new / old:.2f}")
print(f"median ratio {statistics.median(new / old for old, new in pairs):.2f}")
