#!/usr/bin/env python3
"""Every comparison of `slipway validate` but those named here, against what the page of validation says of them.

usage: quick_comparisons.py SLIPWAY DATA_FOLDER PAGE [LEFT_OUT ...]

Figures may differ by one in their last printed digit: fits on another processor end there. The whole page, byte for byte, is
held by the test `validation_full` on the kind of machine that wrote it.
"""
import pathlib
import re
import subprocess
import sys


def printed(slipway, *words):
    done = subprocess.run([slipway, "validate", *words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"exit status {done.returncode} of: slipway validate {' '.join(words)}\n{done.stderr}")
    return done.stdout


def sections(text):
    """What stands behind each heading, the heading with it, by heading."""
    found = {}
    for part in ("\n" + text).split("\n### ")[1:]:
        heading, _, body = part.partition("\n")
        found[heading] = body.split("\n<!-- end: printed by", 1)[0].strip()
    return found


NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def agree(said, now):
    """Whether two texts are the same but for the last digits of figures that have some behind the point."""
    if NUMBER.sub("#", said) != NUMBER.sub("#", now):
        return False
    for a, b in zip(NUMBER.findall(said), NUMBER.findall(now)):
        digits = len(a.partition("e")[0].partition(".")[2])
        last = 10.0 ** -digits * (10.0 ** int(a.partition("e")[2]) if "e" in a else 1.0)
        if a != b and (digits == 0 or abs(float(a) - float(b)) > 1.01 * last):
            return False
    return True


def main():
    slipway, data, page, *left_out = sys.argv[1:]
    names = [line.split()[0] for line in printed(slipway, "--list").splitlines() if line.strip()]
    unknown = sorted(set(left_out) - set(names))
    if unknown:
        sys.exit(f"no comparisons: {', '.join(unknown)}; there are: {', '.join(names)}")
    quick = [name for name in names if name not in left_out]
    said = sections(pathlib.Path(page).read_text())
    if len(said) != len(names):
        sys.exit(f"{page} has {len(said)} comparisons, slipway validate has {len(names)}")
    now = sections(printed(slipway, "--data", data, *(word for name in quick for word in ("--only", name))))
    if len(now) != len(quick):
        sys.exit(f"{len(quick)} comparisons were asked for, {len(now)} were printed")
    others = [heading for heading, body in now.items() if not agree(said.get(heading, ""), body)]
    for heading in others:
        print(f"{page} says otherwise of: {heading}\n{now[heading]}")
    print(f"{len(now)} of {len(names)} comparisons, {len(others)} of them otherwise than on the page")
    return 1 if others else 0


if __name__ == "__main__":
    sys.exit(main())
