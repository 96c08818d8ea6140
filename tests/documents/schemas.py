#!/usr/bin/env python3
"""Holds the schemas of docs/reference against the program that reads the files, and the tables of keys in the pages against the schemas.

    schemas.py SLIPWAY SOURCE_FOLDER [--write]

Every shipped file must fit its schema. Then documents are made in which one thing is changed: a key left out, renamed, of another
type, at, within and beyond each end of its range, at its default. The schema and the reader must agree on every one, and a default
must give what leaving the key out gives. A table of keys stands in a page behind `<!-- keys of: rover.schema.json#/$defs/wheel -->`;
--write writes them anew."""
import copy
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import urllib.request
import warnings

import jsonschema

slipway, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SCHEMAS = {path.name: json.loads(path.read_text()) for path in sorted((root / "docs/reference").glob("*.schema.json"))}
# Values that stand in for every value in turn, and for texts; those at the ends of the key's range are added.
ODD, ODD_NAMES = [None, True, "", "x", [], {}, [1]], ["Name", "../up.tif", "-o"]
# What a reader refuses that no schema can say: what lies beside the file, and what holds between its values.
BEYOND = re.compile(
    "there is no file|unknown (soil|rover|terrain|effect|parameter)|another legend has this name|must be the (file's name|name of its)"
    "|is another wheel's|positive on the left|height_m = [\\d.]+, must be in|com_m lies outside|leave the body|one moment is above"
    "|no wheel on the|rocker must carry wheels|is switched on twice|must be a whole number up to|is not positive"
    "|is given twice|is above max_temp_c|needs both thermal_|log-normal|contradict|another quantity|c1 and c2 (are|do not)|add up to 1|as many values|must rise|span the level"
    "|weights of pressure|either all alternatives|in_patches is for|patches_spread is for|must be at least max_stop"
    "|k_c / b \\+ k_phi|there is no drive of this id|is the drive itself|is no class"
    "|/parameters/\\S+ \\S+ = \\S+ must be in")
faults = []


def shipped(pattern):
    return [(path, json.loads(path.read_text())) for path in sorted((root / "data").glob(pattern))]


def followed(node, name):
    """The schema behind a reference, and the file that it stands in."""
    while "$ref" in node:
        file, _, pointer = node["$ref"].partition("#")
        name, below = file or name, SCHEMAS[file or name]
        for step in pointer.split("/")[1:]:
            below = below[step]
        merged = {**below, **{key: value for key, value in node.items() if key != "$ref"}}
        if "properties" in below and "properties" in node:
            merged["properties"] = {**below["properties"], **node["properties"]}
        node = merged
    return node, name


def keys_of(node, name, seen=None):
    """Every (key, schema) that a schema of a file knows."""
    seen = set() if seen is None else seen
    if isinstance(node, list):
        for value in node:
            yield from keys_of(value, name, seen)
    elif isinstance(node, dict):
        if "$ref" in node:
            node, name = followed(node, name)
        if (name, json.dumps(node)) in seen:
            return
        seen.add((name, json.dumps(node)))
        for key, value in node.get("properties", {}).items():
            yield key, followed(value, name)[0]
        for key, value in node.items():
            if key != "$defs":
                yield from keys_of(list(value.values()) if key == "properties" else value, name, seen)


def ends_of(known):
    """By key, the values at, within and beyond the ends of its ranges, and its defaults."""
    values, defaults = {}, {}
    for key, schema in known:
        if "default" in schema:
            defaults.setdefault(key, []).append(schema["default"])
        for text in re.findall(r'"(?:minimum|maximum|exclusiveMinimum)": (-?[\d.e+-]+)', json.dumps(schema)):
            end = float(text)
            step = 0.01 * abs(end) or 0.01
            values.setdefault(key, set()).update((end, end - step, end + step))
        if "maxLength" in schema:
            values.setdefault(key, set()).update(("x" * schema["maxLength"], "x" * (schema["maxLength"] + 1)))
    return values, defaults


def places(node, path=()):
    """Every path of a document; of lists the first element only."""
    if path:
        yield path
    if isinstance(node, dict):
        for key, value in node.items():
            yield from places(value, path + (key,))
    elif isinstance(node, list) and node:
        yield from places(node[0], path + (0,))


def value_at(document, path):
    for step in path:
        document = document[step]
    return document


def changed(document, known, kept):
    """(what was changed, the document) for every change; kept: places whose value is not changed."""
    values, defaults = ends_of(known)
    for path in list(places(document)):
        name = "/".join(map(str, path))

        def change(what, edit):
            other = copy.deepcopy(document)
            edit(value_at(other, path[:-1]), path[-1])
            return f"{name} {what}", other

        if isinstance(path[-1], str):
            yield change("left out", lambda holder, key: holder.pop(key))
            yield change("renamed", lambda holder, key: holder.__setitem__(key + "_x", holder.pop(key)))
        if kept(path):
            continue
        key = next((step for step in reversed(path) if isinstance(step, str)), "")
        for value in defaults.get(key, []):
            yield change("at its default", lambda holder, key: holder.__setitem__(key, value))
        names = ODD_NAMES if isinstance(value_at(document, path), str) else []
        for value in ODD + names + sorted(values.get(key, []), key=str):
            yield change(f"= {value!r}", lambda holder, key: holder.__setitem__(key, value))


def validator_of(name):
    # Debian 12 has jsonschema 4.10, whose only way to resolve references is out of use in later ones.
    warnings.simplefilter("ignore", DeprecationWarning)
    store = {"file:///" + other: schema for other, schema in SCHEMAS.items()}
    return jsonschema.Draft202012Validator(SCHEMAS[name], resolver=jsonschema.RefResolver("file:///" + name, SCHEMAS[name], store=store))


class Checked:
    """What of one schema is checked: its cases, and what shipped files and documents of every key there are."""

    def __init__(self, kind, files, bases, kept=lambda path: False):
        self.name, self.schema = f"{kind}.schema.json", SCHEMAS[f"{kind}.schema.json"]
        jsonschema.Draft202012Validator.check_schema(self.schema)
        self.validator = validator_of(self.name)
        for path, document in files:
            for error in self.validator.iter_errors(document):
                faults.append(f"{path.relative_to(root)}: {error.message[:300]}")
        known = list(keys_of(self.schema, self.name))
        used = {step for base in bases.values() for path in places(base) for step in path}
        used |= {step for base in bases.values() for row in every_object(base) for step in row}
        for key in sorted({key for key, _ in known} - used):
            faults.append(f"{self.name}: no document of this test has the key {key}")
        self.cases, seen = [], set()
        for name, base in bases.items():
            changes = [change for change in changed(base, known, kept) if change[0] not in seen]
            seen |= {what for what, _ in changes}  # what was changed in one document need not be in the next
            self.cases += [(f"{name}: {what}", document) for what, document in [("as it is", base), *changes]]

    def judge(self, read):
        """read: the reader's faults of a case, by its number and whether the schema takes it."""
        agreed = good = 0
        for number, (what, document) in enumerate(self.cases):
            fits = self.validator.is_valid(document)
            reasons = [reason for reason in read(number, fits) if not BEYOND.search(reason)]
            good += fits
            if fits == (not reasons):
                agreed += 1
            else:
                told = f"the schema says {'good' if fits else 'bad'}, the reader says {reasons or 'good'}"
                faults.append(f"{self.name}: {what}: {told}"[:500])
        print(f"{self.name}: {agreed} documents on which schema and reader agree, {good} of them good")
        if agreed < 100:
            faults.append(f"{self.name}: hardly a document was read")


def every_object(node):
    if isinstance(node, dict):
        yield node
    for value in node.values() if isinstance(node, dict) else node if isinstance(node, list) else []:
        yield from every_object(value)


def data_folder(folder, *kinds):
    for kind in kinds:
        shutil.copytree(root / "data" / kind, folder / kind)


def ask(*command):
    return json.loads(subprocess.run([slipway, *command], capture_output=True, text=True).stdout)


def judged_by_data_check(checked, kind, put):
    """The files of a kind are put into one data folder; put(folder, name, document) writes one."""
    with tempfile.TemporaryDirectory() as made:
        data = pathlib.Path(made)
        data_folder(data, "rovers", "soils")
        for number, (_, document) in enumerate(checked.cases):
            put(data, f"t{number}", copy.deepcopy(document))
        refused = {}
        for file in ask("data", "check", "--data", data, "--json")["left_out"]:
            refused.setdefault(file["name"], []).extend(fault["pointer"] + " " + fault["message"] for fault in file["faults"])
        checked.judge(lambda number, fits: refused.get(f"t{number}", []))
        if kind in ("rovers", "soils"):
            as_default(checked, {row.pop("name"): row for row in ask(kind, "--data", data, "--json")[kind]})


def as_default(checked, read):
    """Leaving a key out gives what its default gives."""
    by_name = {what: read.get(f"t{number}") for number, (what, _) in enumerate(checked.cases)}
    compared = 0
    for what, row in by_name.items():
        left_out = by_name.get(what.removesuffix("at its default") + "left out") if what.endswith("at its default") else None
        if row and left_out:
            compared += 1
            if row != left_out:
                faults.append(f"{checked.name}: {what} is another than left out")
    if compared < 5:
        faults.append(f"{checked.name}: only {compared} defaults were compared")


def the_name(path):
    return path == ("name",)


def every_parameter():
    """Of a soil, a value for every number."""
    return {key: row["maximum"] / 4 for key, row in SCHEMAS["soils.schema.json"]["$defs"]["parameters"]["properties"].items()}


def put_named(folder):
    def put(data, name, document):
        if document.get("name") == "as_the_file":
            document["name"] = name
        (data / folder).mkdir(exist_ok=True)
        (data / folder / f"{name}.json").write_text(json.dumps(document))
    return put


def put_soils(data, name, document):
    soils = document.get("soils")
    if isinstance(soils, list) and soils and isinstance(soils[0], dict) and soils[0].get("name") == "as_the_file":
        soils[0]["name"] = name
    (data / "soils" / f"{name}.json").write_text(json.dumps(document))


def put_terrain(data, name, document):
    if document.get("name") == "gale":
        document["name"] = name
    (data / "terrains" / name).mkdir(parents=True)
    (data / "terrains" / name / "terrain.json").write_text(json.dumps(document))


def terrain_schema():
    document = json.loads((root / "data/terrains/gale/terrain.json").read_text())
    document["relief"].update(min_rock_m=0.1, max_rock_m=0.5)
    soil = document["soil"]
    another = {"name": "another", "legend": copy.deepcopy(soil["legend"]), "assumption": "made for this test", "confidence": 0.5}
    soil.update(other_legends=[another], confidence=0.5)
    legends = [soil["legend"], soil["other_legends"][0]["legend"]]
    for legend in legends:
        del legend[2:]
        legend[0]["rock_share"] = 0.1
    polygons = copy.deepcopy(document)
    del polygons["soil"]["raster"]
    polygons["soil"].update(polygons="gale_terrain_units.geojson", property="unit", coordinates="longitude_latitude")
    for legend in [polygons["soil"]["legend"], polygons["soil"]["other_legends"][0]["legend"]]:
        for row in legend:
            del row["value"]
    both, neither = copy.deepcopy(document), copy.deepcopy(document)
    both["soil"]["polygons"] = "gale_terrain_units.geojson"
    del neither["soil"]["raster"]
    checked = Checked("terrain", shipped("terrains/*/terrain.json"), {"raster": document, "polygons": polygons}, the_name)
    checked.cases += [("both maps", both), ("neither map", neither)]
    judged_by_data_check(checked, "terrains", put_terrain)


EVERY_CLEAT = {"height_m": 0.005, "count": 12, "thrust": 0.5, "braking": 0.5, "by_slip": 0.5, "surcharge": 0.5, "shear_share": 0.5,
               "shear_by_spacing": 0.5}
EVERY_MASS = {"wheel_kg": 5, "rocker_kg": 5, "bogie_kg": 3, "body_inertia_kg_m2": [20, 30, 40]}
EVERY_OF_MOTOR = {"damping_nms_rad": 1e-6, "resistance_ohm": 1.5, "max_current_a": 4, "rotor_inertia_kg_m2": 1e-7,
                  "thermal_resistance_k_w": 7, "thermal_time_constant_s": 1000, "min_temp_c": -60, "max_temp_c": 110}
EVERY_JOINT = {"differential_stiffness_nm_per_deg": 1000, "differential_damping_nms_per_deg": 10, "rocker_stop_deg": 30}


def rover_schema():
    mer = json.loads((root / "data/rovers/mer-class.json").read_text())
    motor = {**mer["drive"], **EVERY_OF_MOTOR}
    mer.update(name="as_the_file", masses=EVERY_MASS, wheel_slices=3, grousers=EVERY_CLEAT, drive=motor, steering=motor,
               pull_below_axle=0.5, wheel_weight=0.5,
               effects=[{"name": "slip_sinkage", "on": True, "parameters": {"n1": 0.2}}])
    mer["power"].update(constant_w=10, upright_array_m2=0.3, array_clean=0.9, heating_w=5, heating_below_c=-60)
    mer["wheels"][0].update(software_radius_m=0.12, grousers=EVERY_CLEAT, drive="driven")
    mer["suspension"].update(EVERY_JOINT, bogie_stop_deg=30)
    four = json.loads((root / "docs/guide/examples/four_wheeled.json").read_text())
    four["name"] = "as_the_file"
    four["suspension"].update(EVERY_JOINT)
    rigid = {**four, "suspension": {"type": "rigid"}}
    files = shipped("rovers/*.json") + [(root / "docs/guide/examples/four_wheeled.json", four)]
    checked = Checked("rover", files, {"rocker_bogie": mer, "averaging": four, "rigid": rigid}, the_name)
    judged_by_data_check(checked, "rovers", put_named("rovers"))


def soils_schema():
    example = root / "docs/guide/examples/bevameter_soil.json"
    # What a soil may leave out is given here, and left out again by the changes.
    soil = {**json.loads(example.read_text())["soils"][0], "assumed": ["n"], "shear_modulus_x_m": 0.02, "density_kg_m3": 1500.0,
            "c1": 0.18, "c2": 0.32, "correlation_length_m": 5.0, "slip_error": 0.5,
            "std": {"stiffness_ratio": 0.25, "n": 0.05, "cohesion_pa": 300.0, "friction_angle_deg": 2.0, "shear_modulus_ratio": 0.25}}
    head = {key: soil[key] for key in ("summary", "source", "assumed", "correlation_length_m")}
    head["name"] = "as_the_file"
    laws = {**every_parameter(), **soil, **head, "std": {**soil["std"], "c1": 0.1, "c2": 0.1}, "pressure_law": {"name": "bekker"},
            "shear_law": {"name": "wong", "residual_ratio": 0.7}, "correlation": [{"first": "n", "second": "cohesion", "value": 0.3}],
            "spread_shares": {"everywhere": 0.4, "unit": 0.4, "patch": 0.2}}
    reece = {**soil, **head, "pressure_law": {"name": "reece", "k_c": 40, "k_phi": 900}, "shear_law": {"name": "hyperbolic"}}
    del reece["k_c"], reece["k_phi"]
    patches = [{"soil": "dry_sand", "weight": 0.5}, {"soil": "sandy_loam", "weight": 0.5, "in_patches": True}]
    mixed = {**soil, **head, "alternatives": patches,
             "alternatives_by": "unit", "alternatives_spread": 0.5, "patches_spread": 0.5}
    apart = {**soil, **head, "alternatives": [{"soil": "dry_sand", "pressure_weight": 0.5, "strength_weight": 0.7}, {"soil": "sandy_loam"}]}
    columns = {"slope_deg": [-20, 0, 20], "slip": [-0.05, 0, 0.5], "cross_slope_deg": [0, 20], "side_slip_deg": [0, 12]}
    curve = {**head, "std": {"slip_ratio": 0.05}, "slip_curve": columns}
    bases = {name: {"format": "soils/1", "soils": [base]} for name, base in
             {"laws": laws, "reece": reece, "mixed": mixed, "apart": apart, "curve": curve}.items()}
    files = shipped("soils/*.json") + [(example, json.loads(example.read_text()))]
    judged_by_data_check(Checked("soils", files, bases, lambda path: path == ("soils", 0, "name")), "soils", put_soils)


def rules_schema():
    parts = {part: SCHEMAS["rules.schema.json"]["properties"][part]["properties"].items() for part in ("limits", "checks", "bars")}
    head = {"format": "rules/1", "name": "as_the_file", "summary": "made for this test", "source": "this test"}
    defaults = {part: {key: row["default"] for key, row in rows if "default" in row} for part, rows in parts.items()}
    whole = {**head, **{part: {key: row.get("default", 1) for key, row in rows} for part, rows in parts.items()}}
    judged_by_data_check(Checked("rules", shipped("rules/*.json"), {"whole": whole}, the_name), "rules", put_named("rules"))
    with tempfile.TemporaryDirectory() as made:
        data = pathlib.Path(made)
        data_folder(data, "rovers", "soils", "terrains/uma_rescue_area")
        put_named("rules")(data, "none", head)
        request = ask("check", "--data", data, "--terrain", "uma_rescue_area", "--rover", "cuadriga", "--rules", "none", "--draws", "10",
                      "--json", "--path", "367100,4064310", "367102,4064310")["request"]
    for part in parts:
        if request[part] != defaults[part]:
            faults.append(f"rules.schema.json: defaults of {part} are {defaults[part]}, the program's are {request[part]}")


def campaign_schema():
    files = shipped("gap-practice/*/campaign.json") + shipped("drive-campaigns/*/campaign.json")
    base = copy.deepcopy(files[0][1])
    soil, terrain = base["soils"]["nominal"], next(iter(base["terrains"].values()))
    base["soils"]["nominal"] = {**every_parameter(), **soil}
    for key, row in SCHEMAS["rover.schema.json"]["properties"].items():
        if key.startswith(("belly", "body", "max_tilt", "cruise", "turn", "min_turn")):
            base["rover"][key] = row["maximum"] / 4
    std = SCHEMAS["campaign.schema.json"]["properties"]["parameter_std"]["properties"]
    base.update(parameter_std={key: row["maximum"] / 4 for key, row in std.items()},
                terrains={"t": {**terrain, "soil": {"raster": "soil.tif", "classes": {"1": "nominal"}}}, "u": terrain})
    base["rover"].update(masses=EVERY_MASS, wheel_slices=3, grousers=EVERY_CLEAT)
    base["rover"]["wheels"][0].update(software_radius_m=0.12, grousers=EVERY_CLEAT, drive="driven")
    base["rover"]["suspension"].update(EVERY_JOINT, bogie_stop_deg=30)
    base["rover"]["drive"].update(EVERY_OF_MOTOR)
    first = {**base["drives"][0], "terrain": "t", "repeat_of": "other", "final_only": False}
    first["commanded"]["crab_deg"] = 10
    other = {key: value for key, value in first.items() if key != "repeat_of"}
    other.update(id="other", file="other.csv")
    in_place = {**first["commanded"], "turn_in_place": True, "turn_rate_deg_s": 3}
    turning = {**base, "drives": [{**first, "commanded": in_place}, other]}
    base["drives"] = [first, other]
    named = {**base, "rover": "cuadriga"}
    # Values within a rover's parts and a soil are those of their own schemas.
    checked = Checked("campaign", files, {"whole": base, "turning": turning, "named": named},
                      lambda path: len(path) > 2 and path[0] in ("rover", "soils") and path[-1] not in ("c1", "cohesion_pa"))
    with tempfile.TemporaryDirectory() as made:
        data = pathlib.Path(made)
        data_folder(data, "rovers", "soils")
        for number, (_, document) in enumerate(checked.cases):
            (data / f"gap-practice/t{number}").mkdir(parents=True)
            (data / f"gap-practice/t{number}/campaign.json").write_text(json.dumps(document))
        service = subprocess.Popen([slipway, "serve", "--port", "0", "--jobs", "", "--data", data], stdout=subprocess.PIPE, text=True)
        try:
            url = re.search(r"http://127\.0\.0\.1:\d+", service.stdout.readline())[0]
            with urllib.request.urlopen(url + "/v1/drive-campaigns", timeout=30) as answer:
                good = {row["name"] for row in json.load(answer)["campaigns"]}
        finally:
            service.send_signal(signal.SIGTERM)
            service.wait(timeout=30)

        told_of = {}  # by place: the service does not say why, and what says it is slow

        def why(number):
            told = subprocess.run([slipway, "diagnose", data / f"gap-practice/t{number}", "--data", data], capture_output=True, text=True)
            lines = [line for line in told.stderr.splitlines() if line.startswith("  campaign.json#")]
            return [line for line in lines if "does not exist" not in line] or ["refused, and nobody says why"]

        def reasons(number, fits):
            if f"t{number}" in good or not fits:
                return [] if f"t{number}" in good else ["refused"]
            place = checked.cases[number][0].partition(" = ")[0]
            if place not in told_of:
                told_of[place] = why(number)
            return told_of[place]

        checked.judge(reasons)


def known_schema():
    """What slipway import takes of known.json is read as campaign.json, whose keys are checked above."""
    campaign = SCHEMAS["campaign.schema.json"]
    of_mapping = {"format", "name", "drives"}
    known = SCHEMAS["known.schema.json"]
    if any(set(known[part]) != set(campaign[part]) - of_mapping for part in ("properties", "required")):
        faults.append("known.schema.json: its keys are not those of campaign.schema.json without format, name and drives")
    document = {key: value for key, value in shipped("gap-practice/p01/campaign.json")[0][1].items() if key not in of_mapping}
    mapping = ['format = "drive-import/1"', 'name = "x"', 'known = "known.json"', "[clock]", 'from = "t"', "[columns]",
               'x_m = {from = "x"}', 'y_m = {from = "y"}', 'z_m = {from = "z"}', "[[drives]]", 'id = "d"', 'file = "d.txt"',
               'terrain = "tilt_00"', "speed_m_s = 0.05"]
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        for raster in (root / "data/gap-practice/p01").glob("*.tif"):
            shutil.copy(raster, folder)
        (folder / "x.toml").write_text("\n".join(mapping))
        (folder / "d.txt").write_text("t,x,y,z\n" + "".join(f"{t},{0.05 * t},0,0\n" for t in range(60)))
        for key in (None, *known["required"]):
            (folder / "known.json").write_text(json.dumps({k: v for k, v in document.items() if k != key}))
            told = subprocess.run([slipway, "import", folder / "x.toml", "--data", root / "data"], capture_output=True, text=True)
            if (told.returncode == 0) != (key is None) or (key and f"known.json#/{key}" not in told.stderr):
                faults.append(f"known.json without {key}: {told.stderr[:300]}")


def range_of(row):
    """In words, the values that a key may have."""
    low = row.get("minimum", row.get("exclusiveMinimum"))
    if low is not None or "maximum" in row:
        return f"{'[' if 'minimum' in row else '('}{low:g}, {row['maximum']:g}]"
    if "enum" in row or "const" in row:
        return ", ".join(f"`{json.dumps(value)}`" for value in row.get("enum") or [row["const"]])
    if row.get("type") == "array":
        return f"list of {row['minItems']}" if row.get("minItems", 0) == row.get("maxItems") else "list"
    return row.get("type", "")


def table_of(reference):
    """The rows of a page's table of keys: of a schema's properties, and of those of the alternatives within it."""
    schema, name = followed({"$ref": reference}, "")
    rows, required = {}, set()
    for node in [schema, *(below for below in schema.get("oneOf", []) if "$ref" not in below)]:
        required.update(node.get("required", []))
        for key, value in node.get("properties", {}).items():
            row = followed(value, name)[0]
            rows.setdefault(key, {"description": row.get("description", ""), "range": [], "row": row})["range"].append(range_of(row))
    lines = ["| key | range | where it is left out | what it is |", "|---|---|---|---|"]
    for key, told in rows.items():
        row = told["row"]
        default = f"`{json.dumps(row['default'])}`" if "default" in row else "refused" if key in required else ""
        span = told["range"][0] if len(schema.get("properties", {})) else ", ".join(told["range"])
        lines.append(f"| `{key}` | {span} | {default} | {told['description']} |".replace("|  |", "| |"))
    return "\n".join(lines) + "\n"


def pages(write):
    """Tables of keys, and whole files, in the pages."""
    found = 0
    for page in sorted((root / "docs").rglob("*.md")):
        text = page.read_text()

        def settle(match):
            nonlocal found
            found += 1
            table = table_of(match[1])
            if table != match[2] and not write:
                faults.append(f"{page.relative_to(root)}: the keys of {match[1]} are others (--write)")
            return f"<!-- keys of: {match[1]} -->\n{table}"

        example_of = page.stem + ".schema.json"
        for block in re.findall(r"^```json\n(.*?)^```$", text, re.MULTILINE | re.DOTALL) if example_of in SCHEMAS else []:
            for error in validator_of(example_of).iter_errors(json.loads(block)):
                faults.append(f"{page.relative_to(root)}: its example: {error.message[:300]}")
        settled = re.sub(r"<!-- keys of: (\S+) -->\n((?:\|[^\n]*\n)*)", settle, text)
        if write and settled != text:
            page.write_text(settled)
    if found < 5:
        faults.append(f"only {found} tables of keys were found in the pages")


pages("--write" in sys.argv[3:])
for check in (terrain_schema, rover_schema, soils_schema, rules_schema, campaign_schema, known_schema):
    check()
for fault in faults[:100]:
    print(fault)
print(f"{len(faults)} faults")
sys.exit(1 if faults else 0)
