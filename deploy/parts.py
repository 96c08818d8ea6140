#!/usr/bin/python3
"""Writes which parts are in the program and its package, as an SPDX 2.3 document: the Debian packages of the libraries and headers that
the build took, the npm packages in the dashboard, and the shipped data, all with their licences.

usage: parts.py SOURCE_FOLDER BUILD_FOLDER DOCUMENT

Nothing of this is a list that is kept by hand. Libraries are those that the program asks the system's loader for; static libraries and
headers are what Ninja noted as read; Debian's copyright files have their licences; dashboard/package-lock.json has the npm packages;
the table "Licences" of docs/reference/data.md has the data. SOURCE_DATE_EPOCH is the document's time.
"""
import base64
import datetime
import hashlib
import json
import logging
import os
import pathlib
import re
import subprocess
import sys
import time
import uuid

from debian.copyright import Copyright, NotMachineReadableError
from license_expression import get_spdx_licensing

logging.getLogger("debian.copyright").setLevel(logging.ERROR)  # it tells of http in place of https
SPDX = get_spdx_licensing()
KNOWN = {key.lower(): key for key in SPDX.known_symbols if not key.startswith("LicenseRef")}
# Where Debian's names of licences are not SPDX's.
NAMES = {"expat": "MIT", "mpl-2": "MPL-2.0", "apache-2": "Apache-2.0", "apache license 2.0": "Apache-2.0"}


def output_of(*command, folder=None):
    return subprocess.run([str(part) for part in command], cwd=folder, check=True, capture_output=True, text=True).stdout


def reference(*names):
    return re.sub(r"[^A-Za-z0-9.-]+", "-", "-".join(names)).strip("-")


class Document:
    def __init__(self, version):
        self.texts = {}
        self.packages = []
        self.relations = []
        self.program = self.add("DESCRIBES", "slipway", version, "Apache-2.0", of="SPDXRef-DOCUMENT")

    def add(self, relation, name, version, licence, of=None, **more):
        identity = "SPDXRef-" + reference(name)
        if all(package["SPDXID"] != identity for package in self.packages):
            package = {"SPDXID": identity, "name": name, "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
                       "licenseDeclared": licence}
            self.packages.append({**package, **({"versionInfo": version} if version else {}), **more})
        elif any(package["SPDXID"] == identity and package.get("versionInfo", version) != version for package in self.packages):
            sys.exit(f"{name} comes in two versions, one of them {version}: its parts need names of their own")
        self.relations.append({"spdxElementId": of or self.program, "relationshipType": relation, "relatedSpdxElement": identity})
        return identity

    def own_licence(self, name, text):
        """A licence that SPDX does not list, with its text."""
        key = "LicenseRef-" + reference(name)
        self.texts[key] = text
        return key

    def written(self, made):
        # Where an expression got simpler, a licence may have gone out of it.
        used = {key for package in self.packages for key in SPDX.license_keys(package["licenseDeclared"])}
        self.texts = {key: self.texts[key] for key in sorted(self.texts) if key in used}
        # A document of other parts gets another name.
        about = hashlib.sha256(json.dumps([self.packages, self.relations, self.texts], sort_keys=True).encode()).hexdigest()
        return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": "slipway",
                "documentNamespace": uuid.uuid5(uuid.NAMESPACE_OID, about).urn,
                "creationInfo": {"created": made.strftime("%Y-%m-%dT%H:%M:%SZ"),
                                 "creators": ["Tool: deploy/parts.py", "Organization: The Slipway maintainers"]},
                "packages": self.packages, "relationships": self.relations,
                "hasExtractedLicensingInfos": [{"licenseId": key, "extractedText": text} for key, text in self.texts.items()]}


def spdx_name(debian_name):
    name = NAMES.get(debian_name.lower(), debian_name)
    versioned = re.fullmatch(r"([AL]?GPL-\d)(\.\d)?(\+?)", name)
    if versioned:
        name = versioned[1] + (versioned[2] or ".0") + ("-or-later" if versioned[3] else "-only")
    return KNOWN.get(name.lower())


def expression(document, source, synopsis, texts):
    """A licence as Debian's copyright format writes it ("GPL-2+ and Expat, or Artistic") as an expression of SPDX."""
    for mark in (r", *or ", r", *and ", r" or ", r" and "):
        parts = re.split(mark, synopsis)
        if len(parts) > 1:
            joined = " OR " if "or" in mark else " AND "
            return "(" + joined.join(expression(document, source, part.strip(), texts) for part in parts) + ")"
    return spdx_name(synopsis) or document.own_licence(f"{source}-{synopsis}", texts.get(synopsis) or synopsis)


def debian_licence(document, package, source):
    path = pathlib.Path("/usr/share/doc", package, "copyright")
    with open(path, encoding="utf-8") as file:
        try:
            found = Copyright(file, strict=False)
        except NotMachineReadableError:
            return document.own_licence(source, path.read_text(encoding="utf-8"))
    files = [p for p in found.all_files_paragraphs() if p.license and not all(name.startswith("debian/") for name in p.files)]
    texts = {p.license.synopsis: p.license.text for p in [*files, *found.all_license_paragraphs()] if p.license.text}
    every = sorted({expression(document, source, p.license.synopsis, texts) for p in files})
    return str(SPDX.parse(" AND ".join(every)).simplify())


def owners(paths):
    """The Debian package of each file. Debian knows the files of /usr/lib as those of /lib or the other way round, and alternatives by
    what they point to."""
    candidates = {}
    for path in paths:
        for name in (path, os.path.realpath(path)):
            for place in (name, "/usr" + name, name.removeprefix("/usr")):
                candidates.setdefault(place, path)
    # It fails where a candidate is nobody's, as most are.
    known = subprocess.run(["dpkg", "-S", *candidates], capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"}).stdout
    found = {}
    for row in known.splitlines():
        package, _, path = row.partition(": ")
        if path in candidates:
            found[candidates[path]] = package.split(",")[0].split(":")[0]
    missing = sorted(set(paths) - set(found))
    if missing:
        raise SystemExit(f"parts: no Debian package has {', '.join(missing)}")
    return found


def add_debian(document, relation, paths):
    files = {}
    for path, package in owners(paths).items():
        files.setdefault(package, []).append(pathlib.Path(path).name)
    for package in sorted(files):
        about = output_of("dpkg-query", "-W", "-f", "${Version} ${Architecture} ${source:Package}\n", package)
        version, architecture, source = about.splitlines()[0].split()
        more = {"comment": "used: " + ", ".join(sorted(files[package]))} if relation != "GENERATED_FROM" else {}
        locator = f"pkg:deb/debian/{package}@{version.replace('+', '%2B').replace(':', '%3A')}?arch={architecture}"
        document.add(relation, package, version, debian_licence(document, package, source), supplier="Organization: Debian", externalRefs=[
            {"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": locator}], **more)


def add_libraries(document, build):
    program = build / "server/slipway"
    needed = re.findall(r"^ *NEEDED +(\S+)", output_of("objdump", "-p", program), re.MULTILINE)
    loaded = dict(re.findall(r"^\s*(\S+) => (/\S+)", output_of("ldd", program), re.MULTILINE))
    add_debian(document, "DYNAMIC_LINK", sorted(loaded[name] for name in needed))
    inputs = output_of("ninja", "-t", "inputs", "server/slipway", folder=build).split()
    add_debian(document, "STATIC_LINK", sorted(name for name in inputs if re.fullmatch(r"/usr/.*\.a", name)))
    made = [name for name in inputs if re.search(r"\.(o|gch)$", name)]
    headers = re.findall(r"^ +(/usr/\S+)", output_of("ninja", "-t", "deps", *made, folder=build), re.MULTILINE)
    add_debian(document, "GENERATED_FROM", sorted(set(headers)))


def add_dashboard(document, source):
    lock = json.loads((source / "dashboard/package-lock.json").read_text())
    for place, row in sorted(lock["packages"].items()):
        if not place or row.get("dev"):
            continue
        name = place.rpartition("node_modules/")[2]
        kind, _, digest = row["integrity"].partition("-")
        document.add("CONTAINS", name, row["version"], str(SPDX.parse(row["license"])),
                     checksums=[{"algorithm": kind.upper(), "checksumValue": base64.b64decode(digest).hex()}],
                     externalRefs=[{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                    "referenceLocator": f"pkg:npm/{name.replace('@', '%40')}@{row['version']}"}])


def add_data(document, source):
    table = (source / "docs/reference/data.md").read_text().partition("## Licences")[2]
    for row in re.findall(r"^\| (`.*)\|$", table, re.MULTILINE):
        what, origin, licence = (re.sub(r"\]\([^)]*\)|[`\[]", "", cell).strip() for cell in row.split(" | "))
        name = re.match(r"(?:of this project, )?([A-Za-z0-9. -]+?)(?= \(|$)", licence)
        document.add("CONTAINS", f"data: {what}", None, (name and spdx_name(name[1])) or "NOASSERTION",
                     comment=f"source: {origin}; licence: {licence}")


def main():
    source, build, target = (pathlib.Path(argument) for argument in sys.argv[1:4])
    cache = dict(re.findall(r"^([A-Z_]+):[A-Z]+=(.*)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE))
    document = Document(f"{cache['CMAKE_PROJECT_VERSION']}-{cache['SLIPWAY_PACKAGE_REVISION']}")
    add_libraries(document, build)
    add_dashboard(document, source)
    add_data(document, source)
    made = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", time.time())), datetime.timezone.utc)
    target.write_text(json.dumps(document.written(made), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


main()
