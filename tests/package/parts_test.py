#!/usr/bin/python3
"""The list of parts (deploy/parts.py) has what SPDX 2.3 demands, every library that the program is linked with, and no licence that is
neither one of SPDX's nor written out.

usage: parts_test.py SOURCE_FOLDER BUILD_FOLDER
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from license_expression import get_spdx_licensing

SOURCE, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
# Of each kind of object in SPDX 2.3's document: what it must have.
MANDATORY = {"document": {"spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo"},
             "creationInfo": {"created", "creators"},
             "packages": {"name", "SPDXID", "downloadLocation"},
             "relationships": {"spdxElementId", "relationshipType", "relatedSpdxElement"},
             "hasExtractedLicensingInfos": {"licenseId", "extractedText"},
             "externalRefs": {"referenceCategory", "referenceType", "referenceLocator"},
             "checksums": {"algorithm", "checksumValue"}}


def written(**environment):
    with tempfile.TemporaryDirectory() as folder:
        document = pathlib.Path(folder, "parts.json")
        subprocess.run(["/usr/bin/python3", "-B", SOURCE / "deploy/parts.py", SOURCE, BUILD, document], check=True,
                       env={**os.environ, "SOURCE_DATE_EPOCH": "1795970918", **environment})
        return document.read_bytes()


class Parts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bytes = written()
        cls.document = json.loads(cls.bytes)
        cls.packages = cls.document["packages"]

    def has(self, kind, row):
        self.assertLessEqual(MANDATORY[kind], set(row), row)

    def test_what_spdx_demands_is_there(self):
        self.has("document", self.document)
        self.assertEqual((self.document["spdxVersion"], self.document["dataLicense"], self.document["SPDXID"]),
                         ("SPDX-2.3", "CC0-1.0", "SPDXRef-DOCUMENT"))
        self.assertRegex(self.document["documentNamespace"], "^urn:uuid:[0-9a-f-]{36}$")
        self.has("creationInfo", self.document["creationInfo"])
        self.assertEqual(self.document["creationInfo"]["created"], "2026-11-29T16:48:38Z")
        for creator in self.document["creationInfo"]["creators"]:
            self.assertRegex(creator, "^(Tool|Organization|Person): ")
        for kind in ("packages", "relationships", "hasExtractedLicensingInfos"):
            for row in self.document[kind]:
                self.has(kind, row)
        for package in self.packages:
            self.assertRegex(package["SPDXID"], "^SPDXRef-[A-Za-z0-9.-]+$")
            for kind in ("externalRefs", "checksums"):
                for row in package.get(kind, []):
                    self.has(kind, row)
            for row in package.get("checksums", []):
                self.assertEqual((row["algorithm"], len(row["checksumValue"])), ("SHA512", 128), package["name"])

    def test_every_relation_is_between_things_that_are_there(self):
        names = [package["SPDXID"] for package in self.packages] + ["SPDXRef-DOCUMENT"]
        self.assertEqual(len(names), len(set(names)), "an identifier is given twice")
        described = set()
        for row in self.document["relationships"]:
            self.assertIn(row["spdxElementId"], names)
            self.assertIn(row["relatedSpdxElement"], names)
            self.assertIn(row["relationshipType"], {"DESCRIBES", "DYNAMIC_LINK", "STATIC_LINK", "GENERATED_FROM", "CONTAINS"})
            described.add(row["relatedSpdxElement"])
        self.assertEqual(described, set(names) - {"SPDXRef-DOCUMENT"})

    def test_every_licence_is_one_of_spdx_or_written_out(self):
        spdx = get_spdx_licensing()
        used = set()
        for package in self.packages:
            licence = package["licenseDeclared"]
            if licence == "NOASSERTION":
                self.assertTrue(package["name"].startswith("data: "), package)
                self.assertIn("licence: ", package["comment"], "what is known is said in words")
                continue
            for key in spdx.license_keys(licence):
                if key.startswith("LicenseRef-"):
                    used.add(key)
                else:
                    self.assertIn(key, spdx.known_symbols, package["name"])
        rows = {row["licenseId"]: row["extractedText"] for row in self.document["hasExtractedLicensingInfos"]}
        self.assertEqual(used, set(rows))
        self.assertEqual([key for key, text in rows.items() if not text.strip()], [])

    def related(self, kind):
        of_kind = {row["relatedSpdxElement"] for row in self.document["relationships"] if row["relationshipType"] == kind}
        return [package for package in self.packages if package["SPDXID"] in of_kind]

    def test_every_library_of_the_program_is_there(self):
        dynamic = subprocess.run(["readelf", "-d", BUILD / "server/slipway"], check=True, capture_output=True, text=True,
                                 env={**os.environ, "LC_ALL": "C"}).stdout
        needed = re.findall(r"\(NEEDED\) +Shared library: \[(.*)\]", dynamic)
        self.assertIn("libc.so.6", needed)
        listed = [file for part in self.related("DYNAMIC_LINK") for file in part["comment"].removeprefix("used: ").split(", ")]
        self.assertEqual(sorted(needed), sorted(listed))
        self.assertIn("libceres-dev", [part["name"] for part in self.related("STATIC_LINK")])
        headers = [part["name"] for part in self.related("GENERATED_FROM")]
        for name in ("libeigen3-dev", "nlohmann-json3-dev", "libcli11-dev", "libxsimd-dev", "libexpected-dev", "libtoml11-dev"):
            self.assertIn(name, headers)

    def test_the_dashboards_packages_and_every_folder_of_data_are_there(self):
        contained = [part["name"] for part in self.related("CONTAINS")]
        for name in json.loads((SOURCE / "dashboard/package.json").read_text())["dependencies"]:
            self.assertIn(name, contained)
        self.assertNotIn("vite", contained, "what builds the dashboard is no part of it")
        data = " ".join(name for name in contained if name.startswith("data: "))
        for folder in (SOURCE / "data").iterdir():
            for part in folder.iterdir() if folder.name in ("terrains", "steps", "drive-campaigns") else [folder]:
                if part.name != "PROVENANCE.md":
                    self.assertRegex(data, rf"\b{re.escape(part.name)}\b", "docs/reference/data.md has its licence")

    def test_the_same_build_has_the_same_list_elsewhere_and_in_another_language(self):
        self.assertEqual(written(TZ="Asia/Kathmandu", LC_ALL="C.UTF-8"), self.bytes)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
