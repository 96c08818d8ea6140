#!/usr/bin/env python3
"""Holds the #include lines against the architecture: which room may see which, and which file may see which vendor."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])

# room -> rooms it may include. docs/architecture.md draws the same.
MAY_SEE = {
    "core": {"core"},
    "dem": {"core", "dem"},
    "sim": {"core", "sim"},
    "planner": {"core", "dem", "sim", "planner"},
    "gap": {"core", "sim", "gap"},
    "campaign": {"core", "dem", "sim", "planner", "gap", "campaign"},
    "api": {"core", "dem", "sim", "planner", "gap", "campaign", "api"},
    "validation": {"core", "dem", "sim", "planner", "campaign", "gap", "api", "validation"},
    "server": {"core", "dem", "sim", "planner", "gap", "campaign", "api", "validation", "server"},
}

# vendor header -> the only files of ours that may include it.
FENCES = [
    (r"(gdal|ogr|cpl)[\w]*\.h", r"dem/gdal_\w+\.(cc|h)"),
    (r"ompl/.*", r"planner/ompl_\w+\.(cc|h)"),
    (r"(cvode|sundials|nvector|sunlinsol|sunmatrix|kinsol)/.*", r"sim/(cvode|kinsol)_\w+\.cc"),
    (r"xsimd/.*", r"(sim/wheel_(law|kernel_arch)\.h|bench/packed_exponentials\.cc)"),
    (r"boost/.*", r"sim/traction_limit\.cc"),
    (r"ceres/.*", r"gap/ceres_\w+\.cc"),
    (r"nlohmann/.*", r"api/json/\w+\.(cc|h)"),
    (r"sqlite3\.h", r"api/sqlite_\w+\.cc"),
    (r"httplib\.h", r"server/http_\w+\.cc"),
    (r"CLI/.*", r"server/cli_\w+\.cc"),
    (r"(Simbody|SimTK\w*)\.h|simbody/.*", r"(?!)"),  # a judge in tests alone
]

# Folders that say nothing about what is in them.
FORBIDDEN_NAMES = {"utils", "util", "common", "helpers", "helper", "manager"}

faults = []
includes = 0
for room in MAY_SEE:
    for path in sorted((root / room).rglob("*")):
        relative = path.relative_to(root).as_posix()
        if FORBIDDEN_NAMES & set(re.split(r"[/_.]", relative)):
            faults.append(f"{relative}: a name that says nothing")
        if path.suffix not in {".cc", ".h"}:
            continue
        text = path.read_text()
        for line, content in enumerate(text.splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', content)
            if not match:
                continue
            includes += 1
            quote, header = match.groups()
            if quote == '"':
                other = header.split("/")[0]
                if other not in MAY_SEE[room]:
                    faults.append(f"{relative}:{line}: {room} must not see {header}")
                elif not (root / header).is_file():
                    faults.append(f"{relative}:{line}: {header} is not in the tree; write paths from its top")
            for vendor, place in FENCES:
                if re.fullmatch(vendor, header) and not re.fullmatch(place, relative):
                    faults.append(f"{relative}:{line}: {header} belongs behind {place}")
        if path.suffix == ".h" and "#pragma once" not in text:
            faults.append(f"{relative}: no #pragma once")

# A header of api/json that shows nlohmann stays inside api/json.
private = {f"api/json/{p.name}" for p in (root / "api/json").glob("*.h") if "nlohmann/" in p.read_text()}
for room in MAY_SEE:
    for path in (root / room).rglob("*"):
        relative = path.relative_to(root).as_posix()
        if path.suffix in {".cc", ".h"} and not relative.startswith("api/json/"):
            for header in re.findall(r'#include "([^"]+)"', path.read_text()):
                if header in private:
                    faults.append(f"{relative}: {header} shows nlohmann and belongs inside api/json")

if includes < 100:
    faults.append(f"only {includes} include lines were found: this test looks at the wrong tree")
print(f"{includes} include lines checked")
for fault in faults:
    print(fault)
sys.exit(1 if faults else 0)
