#!/usr/bin/env python3
"""Holds the #include lines against the architecture: which room may see which, which folder of a room may see which,
and which file may see which vendor."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])

# room -> the other rooms that it may include. docs/architecture.md draws the same.
MAY_SEE = {
    "core": set(),
    "sky": {"core"},
    "dem": {"core"},
    "sim": {"core"},
    "steps": {"core", "sky", "sim"},
    "planner": {"core", "sky", "dem", "sim"},
    "gap": {"core", "sim"},
    "campaign": {"core", "sky", "dem", "sim", "steps", "planner", "gap"},
    "api": {"core", "sky", "dem", "sim", "steps", "planner", "gap", "campaign"},
    "server": {"core", "sky", "dem", "sim", "steps", "planner", "gap", "campaign", "api"},
    "research": {"core", "sky", "dem", "sim", "steps", "planner", "gap", "campaign", "api", "server"},
}

# room -> its folders from the bottom up: a file may include its own folder and those before it. A set of folders stands
# for neighbours that do not see each other. "." is the room itself; a room that is not listed has no folders.
FOLDERS = {
    "dem": ["crs", ".", "horizon", "import", "write"],
    "sim": ["soil", "wheel", "rover", "effects", {"quasi_static", "single_wheel"}, "prediction", "dynamic"],
    "planner": ["problem", "search", "timing", "judge", "maps", "."],
    "gap": ["estimate", "diagnosis/model", "diagnosis/search", "diagnosis/follow", "diagnosis/decide", "diagnosis/result", {"diagnosis/held_out", "diagnosis/describe"}, "diagnosis"],
    "api": ["json", "chart", "files", "files/campaign", "files/drive_table", "steps", "uploads", "requests", "jobs",
            "documents", {"documents/soil", "documents/diagnosis"}, "export", "terrain_views", "report", "maps", "."],
    "server": ["http", "operations", "routes", "cli/terminal", "cli/inquiry", "cli/commands", {"cli", "."}],
    "research": ["benchmark", "sealed_set", "documents", "validation/report", "validation/laboratory",
                 {"validation/cuadriga", "validation/mars", "validation/simulators", "validation/worlds"}, "validation", "cli"],
}
MOST_SOURCES = 30  # .cc files in one folder

# vendor header -> the only files of ours that may include it.
FENCES = [
    (r"(gdal|ogr|cpl)[\w]*\.h", r"dem/((crs|import|write)/)?gdal_\w+\.(cc|h)"),
    (r"proj\.h", r"dem/crs/gdal_projection_fence\.cc"),
    (r"ompl/.*", r"planner/search/ompl_\w+\.(cc|h)"),
    (r"(cvode|sundials|nvector|sunlinsol|sunmatrix)/.*", r"sim/dynamic/cvode_\w+\.cc"),
    (r"(kinsol)/.*", r"sim/quasi_static/kinsol_\w+\.cc"),
    (r"xsimd/.*", r"(sim/wheel/wheel_(law|kernel_arch)\.h|bench/packed_exponentials\.cc)"),
    (r"boost/container/static_vector\.hpp", r"sim/wheel/per_wheel\.h"),
    (r"boost/(?!container/static_vector).*", r"(sim/quasi_static/traction_limit|gap/diagnosis/decide/adequacy)\.cc"),
    (r"ceres/.*", r"gap/estimate/ceres_\w+\.cc"),
    (r"nlohmann/.*", r"api/json/\w+\.cc"),
    (r"toml\.hpp", r"api/json/toml_\w+\.cc"),
    (r"sqlite3\.h", r"api/jobs/sqlite_\w+\.cc"),
    (r"libpq-fe\.h", r"api/jobs/postgres_\w+\.cc"),
    (r"archive(_entry)?\.h", r"api/uploads/libarchive_\w+\.cc"),
    (r"openssl/.*", r"core/openssl_\w+\.cc"),
    (r"httplib\.h", r"server/http/\w+\.cc"),
    (r"CLI/.*", r"(server|research)/cli/(inquiry/|commands/)?\w+\.cc"),
    (r"prometheus/.*", r"server/operations/metrics\.cc"),
    (r"spdlog/.*", r"server/operations/log\.cc"),
    (r"(Simbody|SimTK\w*)\.h|simbody/.*", r"(?!)"),  # a judge in tests alone
]

# Folders that say nothing about what is in them.
FORBIDDEN_NAMES = {"utils", "util", "common", "helpers", "helper", "manager"}


def folder_of(path):
    """The folder of a file inside its room, "." for the room itself."""
    parts = path.split("/")[1:-1]
    return "/".join(parts) or "."


def storeys(room):
    """folder -> its storey, counted from the bottom."""
    found = {}
    for storey, names in enumerate(FOLDERS.get(room, ["."])):
        for name in names if isinstance(names, set) else {names}:
            found[name] = storey
    return found


def check_room(room, faults):
    """The include lines of a room, counted; what is wrong with them goes to the faults."""
    storey = storeys(room)
    sources = {}
    includes = 0
    for path in sorted((root / room).rglob("*")):
        relative = path.relative_to(root).as_posix()
        if FORBIDDEN_NAMES & set(re.split(r"[/_.]", relative)):
            faults.append(f"{relative}: a name that says nothing")
        if path.suffix not in {".cc", ".h"}:
            continue
        if re.search(r"_test\.(cc|h)$", relative):
            faults.append(f"{relative}: only files in tests/ end in _test")
        folder = folder_of(relative)
        if folder not in storey:
            faults.append(f"{relative}: folder {folder} of {room} is not in this test's list")
            continue
        if path.suffix == ".cc":
            sources[folder] = sources.get(folder, 0) + 1
        text = path.read_text()
        if path.suffix == ".h" and "#pragma once" not in text:
            faults.append(f"{relative}: no #pragma once")
        for line, content in enumerate(text.splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', content)
            if not match:
                continue
            includes += 1
            quote, header = match.groups()
            if quote == '"':
                check_own(room, relative, line, header, storey, faults)
            for vendor, place in FENCES:
                if re.fullmatch(vendor, header) and not re.fullmatch(place, relative):
                    faults.append(f"{relative}:{line}: {header} belongs behind {place}")
    for folder, count in sources.items():
        if count > MOST_SOURCES:
            faults.append(f"{room}/{folder}: {count} sources, at most {MOST_SOURCES}: this folder is a drawer")
    return includes


def check_own(room, relative, line, header, storey, faults):
    """An include line that names a file of ours."""
    other = header.split("/")[0]
    if not (root / header).is_file():
        faults.append(f"{relative}:{line}: {header} is not in the tree; write paths from its top")
    elif other != room and other not in MAY_SEE[room]:
        faults.append(f"{relative}:{line}: {room} must not see {header}")
    elif other == room:
        mine, seen = folder_of(relative), folder_of(header)
        if mine != seen and storey.get(seen, len(storey)) >= storey[mine]:
            faults.append(f"{relative}:{line}: {mine} must not see {header}, which is not below it")


def main():
    faults = []
    includes = sum(check_room(room, faults) for room in MAY_SEE)
    if includes < 1000:
        faults.append(f"only {includes} include lines were found: this test looks at the wrong tree")
    print(f"{includes} include lines checked")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
