#!/usr/bin/env python3
"""Holds docs/reference/terrain.schema.json against the program that reads terrain.json.

    terrain_schema.py SLIPWAY SOURCE_FOLDER

The shipped terrains must fit the schema. Then documents are made of them in which one thing is changed: a key left out,
renamed, of another type, at and beyond each end of its range. The schema and the reader must agree on every one."""
import copy
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import jsonschema

slipway, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
schema = json.loads((root / "docs/reference/terrain.schema.json").read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
gale = root / "data/terrains/gale"

# Values that stand in for every value in turn; numbers at the ends of the ranges of the schema are added.
ODD = [None, True, "", "x", "Name", "../up.tif", ".hidden", "-o", "x" * 64, "x" * 65, "x" * 101, "x" * 201, "x" * 2001, [], {}, [1]]


def ends_of(node, found):
    """The numbers that the schema names as ends of ranges."""
    if isinstance(node, dict):
        for key, value in node.items():
            if key in ("minimum", "maximum", "exclusiveMinimum") and isinstance(value, (int, float)):
                found.add(value)
            ends_of(value, found)
    elif isinstance(node, list):
        for value in node:
            ends_of(value, found)
    return found


ENDS = sorted(number for end in ends_of(schema, set()) for number in (end, end - 0.01, end + 0.01))


def places(node, path=()):
    """Every path of a document; of lists the first element only."""
    if path:
        yield path
    if isinstance(node, dict):
        for key, value in node.items():
            yield from places(value, path + (key,))
    elif isinstance(node, list) and node:
        yield from places(node[0], path + (0,))


def at(document, path):
    for step in path:
        document = document[step]
    return document


def changed(document):
    """(what was changed, the document) for every change."""
    for path in list(places(document)):
        name = "/".join(map(str, path))

        def change(what, edit):
            other = copy.deepcopy(document)
            edit(at(other, path[:-1]), path[-1])
            return f"{name} {what}", other

        if isinstance(path[-1], str):
            yield change("left out", lambda holder, key: holder.pop(key))
            yield change("renamed", lambda holder, key: holder.__setitem__(key + "_x", holder.pop(key)))
        if path == ("name",):  # must be the folder's, which no schema can say
            continue
        for value in ODD + ENDS:
            yield change(f"= {value!r}", lambda holder, key: holder.__setitem__(key, value))


def whole(soil):
    """A document with every key."""
    document = json.loads((gale / "terrain.json").read_text())
    document["relief"].update(min_rock_m=0.1, max_rock_m=0.5)
    document["soil"] = soil
    soil["other_legends"] = [{"name": "another", "legend": copy.deepcopy(soil["legend"]), "assumption": "made for this test", "confidence": 0.5}]
    for legend in [soil["legend"]] + [other["legend"] for other in soil["other_legends"]]:
        del legend[2:]
        legend[0]["rock_share"] = 0.1
    soil["confidence"] = 0.5
    return document


raster = whole(json.loads((gale / "terrain.json").read_text())["soil"])
polygons = copy.deepcopy(raster)
del polygons["soil"]["raster"]
polygons["soil"].update(polygons="gale_terrain_units.geojson", property="unit", coordinates="longitude_latitude")
for legend in [polygons["soil"]["legend"], polygons["soil"]["other_legends"][0]["legend"]]:
    for row in legend:
        del row["value"]
both = copy.deepcopy(raster)
both["soil"]["polygons"] = "gale_terrain_units.geojson"
neither = copy.deepcopy(raster)
del neither["soil"]["raster"]

faults = []
for path in sorted((root / "data/terrains").glob("*/terrain.json")):
    for error in validator.iter_errors(json.loads(path.read_text())):
        faults.append(f"{path.relative_to(root)}: {error.message}")


def keys_of(node):
    """Every key that a schema knows."""
    if isinstance(node, dict):
        yield from node.get("properties", {})
        for value in node.values():
            yield from keys_of(value)
    elif isinstance(node, list):
        for value in node:
            yield from keys_of(value)


used = {step for document in (raster, polygons) for path in places(document) for step in path}
for key in sorted(set(keys_of(schema)) - used):
    faults.append(f"key {key} of the schema is in no document of this test")

cases = [("whole, raster", raster), ("whole, polygons", polygons), ("both maps", both), ("neither map", neither)]
cases += changed(raster) if not faults else []
cases += [case for case in changed(polygons) if case[0].startswith("soil/") and "other" not in case[0]]
with tempfile.TemporaryDirectory() as folder:
    data = pathlib.Path(folder)
    for kind in ("rovers", "soils"):
        shutil.copytree(root / "data" / kind, data / kind)
    for number, (_, document) in enumerate(cases):
        here = data / "terrains" / f"t{number}"
        here.mkdir(parents=True)
        if document.get("name") == "gale":
            document["name"] = here.name
        (here / "terrain.json").write_text(json.dumps(document))
    told = subprocess.run([slipway, "data", "check", "--data", data, "--json"], capture_output=True, text=True)
    read = json.loads(told.stdout)
refused = {}
for file in read["left_out"]:
    # Whether files and soils exist is no affair of the schema.
    own = [fault["message"] for fault in file["faults"]
           if "there is no file" not in fault["message"] and "unknown soil" not in fault["message"]]
    refused[file["name"]] = own
agreed = 0
for number, (what, document) in enumerate(cases):
    reasons = refused.get(f"t{number}", [])
    fits = validator.is_valid(document)
    if fits == (not reasons):
        agreed += 1
    elif "another legend has this name" not in " ".join(reasons):
        faults.append(f"{what}: the schema says {'good' if fits else 'bad'}, the reader says {reasons or 'good'}")
print(f"{agreed} documents on which schema and reader agree, {sum(validator.is_valid(d) for _, d in cases)} of them good")
for fault in faults:
    print(fault)
sys.exit(1 if faults or agreed < 1000 else 0)
