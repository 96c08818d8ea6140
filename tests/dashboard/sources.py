#!/usr/bin/env python3
"""The bundle that ships was built from the sources beside it: their hashes stand in dist/sources.sha256.

usage: sources.py DASHBOARD_FOLDER
"""
import hashlib
import pathlib
import re
import sys

folder = pathlib.Path(sys.argv[1])
written = {}
for line in (folder / "dist/sources.sha256").read_text().splitlines():
    digest, name = line.split("  ", 1)
    written[name] = digest
there = {"index.html", "package-lock.json", "package.json", "tsconfig.json", "vite.config.ts"}
there |= {path.relative_to(folder).as_posix() for path in (folder / "src").rglob("*") if path.is_file()}
there.discard("src/api/types.ts")  # what the compiler checks: nothing of it is in the bundle
faults = []
for name in sorted(there | set(written)):
    now = hashlib.sha256((folder / name).read_bytes()).hexdigest() if name in there else None
    if now != written.get(name):
        faults.append(f"dashboard/{name} is not what dashboard/dist was built from: run npm ci and npm run build in dashboard/")
# Nobody else is asked for the packages than who the installing machine has set.
for number, line in enumerate((folder / "package-lock.json").read_text().splitlines(), 1):
    if re.search(r'"resolved"', line):
        faults.append(f"dashboard/package-lock.json:{number}: names where a package came from")
gzipped = 0
import zlib  # noqa: E402

for path in (folder / "dist").rglob("*"):
    if path.is_file():
        gzipped += len(zlib.compress(path.read_bytes(), 9))
if gzipped >= 1_000_000:
    faults.append(f"the bundle has {gzipped} bytes compressed, must be below 1,000,000")
print(f"{len(there)} sources, {gzipped} bytes compressed")
for fault in faults:
    print(fault)
sys.exit(1 if faults else 0)
