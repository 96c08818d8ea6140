#!/usr/bin/env python3
"""Files, drive campaigns and terrains that clients send to a running service.

usage: uploads_test.py SLIPWAY SOURCE_DIR
"""
import hashlib
import http.client
import io
import json
import os
import pathlib
import socket
import sys
import tarfile
import tempfile
import time
import unittest
import zipfile
from xml.etree import ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "contract"))
from running_service import SLIPWAY, SOURCE, Server  # noqa: E402
import subprocess  # noqa: E402

PRACTICE = SOURCE / "data" / "gap-practice" / "p04"
ELEVATION = SOURCE / "data" / "terrains" / "gale" / "elevation.tif"


def tar_of(files, mode="w:gz", links=()):
    """An archive of {name: bytes}, with symbolic links {name: target}."""
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode=mode) as archive:
        for name, content in files.items():
            entry = tarfile.TarInfo(name)
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
        for name, target in links:
            entry = tarfile.TarInfo(name)
            entry.type, entry.linkname = tarfile.SYMTYPE, target
            archive.addfile(entry)
    return out.getvalue()


def campaign_files():
    return {path.name: path.read_bytes() for path in PRACTICE.iterdir() if path.is_file()}


def appended_drive(name):
    """A drive of the practice campaign as a request has it, under another id."""
    drive = json.loads((PRACTICE / "campaign.json").read_text())["drives"][0]
    csv = (PRACTICE / drive.pop("file")).read_text()
    drive.pop("repeat_of", None)
    return {**drive, "id": name, "csv": csv}


class Uploads(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.server = Server(self.path, "--upload-mb", "2")

    def tearDown(self):
        self.server.stop()
        self.folder.cleanup()

    def send(self, content, name, kind="application/octet-stream", **headers):
        return self.server.ask("POST", f"/v1/uploads?name={name}", content, {"Content-Type": kind, **headers})

    def sent(self, content, name):
        status, headers, body = self.send(content, name)
        self.assertEqual(status, 201, body)
        upload = json.loads(body)
        self.assertEqual(headers["Location"], "/v1/uploads/" + upload["id"])
        return upload["id"]

    def ask(self, path, request, status=200):
        got, headers, body = self.server.ask("POST", path, request, {"Prefer": "wait=30"})
        self.assertEqual(got, status, body[:2000])
        return json.loads(body)

    def names(self, what):
        key = {"terrains": "terrains", "drive-campaigns": "campaigns"}[what]
        return [one["name"] for one in json.loads(self.server.ask("GET", "/v1/" + what)[2])[key]]

    def faults(self, path, request):
        return [(f["pointer"], f["message"]) for f in self.ask(path, request, 422)["faults"]]

    def test_a_file_is_kept_once_by_its_hash(self):
        content = b"value,label,soil\n" * 3
        first = self.sent(content, "legend.csv")
        self.assertEqual(first, hashlib.sha256(content).hexdigest())
        self.assertEqual(self.sent(content, "other.csv"), first)
        listed = json.loads(self.server.ask("GET", "/v1/uploads")[2])["uploads"]
        self.assertEqual([(u["id"], u["name"], u["bytes"]) for u in listed], [(first, "legend.csv", len(content))])
        self.assertEqual(self.server.ask("DELETE", "/v1/uploads/" + first)[0], 204)
        self.assertEqual(self.server.ask("GET", "/v1/uploads/" + first)[0], 404)
        self.assertEqual(self.server.ask("DELETE", "/v1/uploads/" + first)[0], 404)

    def test_what_can_not_be_kept_is_refused(self):
        self.assertEqual(self.send(b"x" * 2_000_001, "a.bin")[0], 413)
        self.assertEqual(self.send(b"x", "a.bin", "text/plain")[0], 415)
        for name in ("", "../a", ".hidden", "a%2Fb", "a" * 101, "upload.json"):
            self.assertEqual(self.send(b"x", name)[0], 422, name)
        self.assertEqual(self.send(b"", "empty.bin")[0], 422)
        self.assertEqual(self.server.ask("POST", "/v1/uploads", b"x", {"Content-Type": "text/csv"})[0], 422)
        self.assertEqual(json.loads(self.server.ask("GET", "/v1/uploads")[2])["uploads"], [])

    def bodies_under_way(self):
        return [path.name for path in self.server.folder.glob("uploads/files/.body-*")]

    def test_a_body_in_chunks_and_one_that_is_given_up(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=30)
        pieces = [b"a" * 100_000, b"b" * 300_000]
        connection.request("POST", "/v1/uploads?name=c.bin", iter(pieces), {"Content-Type": "application/zip"},
                           encode_chunked=True)
        upload = json.loads(connection.getresponse().read())
        self.assertEqual(upload["id"], hashlib.sha256(b"".join(pieces)).hexdigest())
        connection.close()
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=30)
        connection.request("POST", "/v1/uploads?name=c.bin", iter([b"a" * 500_000] * 5),
                           {"Content-Type": "application/zip"}, encode_chunked=True)
        self.assertEqual(connection.getresponse().status, 413)
        connection.close()
        with socket.create_connection(("127.0.0.1", self.server.port)) as client:
            client.sendall(b"POST /v1/uploads?name=d.bin HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/csv\r\n"
                           b"Content-Length: 1000000\r\n\r\n" + b"x" * 500_000)
            time.sleep(0.5)
            # It has a name only where there are no files without one.
            self.assertEqual(len(self.bodies_under_way()), 1 if "SLIPWAY_PRELOAD" in os.environ else 0)
        time.sleep(0.5)
        self.assertEqual(self.bodies_under_way(), [])
        self.assertEqual([u["name"] for u in json.loads(self.server.ask("GET", "/v1/uploads")[2])["uploads"]],
                         ["c.bin"])
        self.assertEqual(self.server.ask("GET", "/healthz")[0], 200)
        # A file without a name is gone with its connection.
        held = [os.readlink(f) for f in pathlib.Path(f"/proc/{self.server.process.pid}/fd").iterdir() if f.exists()]
        self.assertEqual([path for path in held if "uploads" in path], [])

    def test_a_campaign_is_sent_appended_to_and_used(self):
        taken = self.ask("/v1/drive-campaigns", {"upload": self.sent(tar_of(campaign_files()), "p04.tar.gz")})
        self.assertTrue(taken["name"].startswith("dc-"))
        self.assertEqual(len(taken["drives"]), 16)
        self.assertIn(taken["name"], self.names("drive-campaigns"))
        # The same files in another archive, in a folder of their own, are the same campaign.
        files = {"p04/" + name: content for name, content in campaign_files().items()}
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, content in files.items():
                archive.writestr(name, content)
        again = self.ask("/v1/drive-campaigns", {"upload": self.sent(packed.getvalue(), "p04.zip")})
        self.assertEqual(again["name"], taken["name"])

        more = self.ask("/v1/drive-campaigns", {"follows": taken["name"], "drives": [appended_drive("D900")]})
        self.assertEqual(more["follows"], taken["name"])
        self.assertEqual([d["id"] for d in more["drives"]][-2:], [taken["drives"][-1]["id"], "D900"])
        self.assertNotEqual(more["name"], taken["name"])

        for path, request in (("/v1/watches", {"reference": more["name"], "drives": [appended_drive("N1")]}),
                              ("/v1/soil-estimates", {"campaign": more["name"]}),
                              ("/v1/diagnoses", {"campaign": more["name"], "reference": taken["name"]})):
            status, headers, body = self.server.ask("POST", path, request, {"Prefer": "respond-async"})
            self.assertEqual(status, 201, body)
            self.server.ask("DELETE", headers["Location"])

        self.server.stop()
        self.server = Server(self.path)
        self.assertIn(more["name"], self.names("drive-campaigns"))
        self.assertEqual(self.server.ask("DELETE", "/v1/drive-campaigns/" + taken["name"])[0], 204)
        self.assertNotIn(taken["name"], self.names("drive-campaigns"))
        self.assertIn(more["name"], self.names("drive-campaigns"), "what follows it has files of its own")
        self.assertEqual(self.server.ask("DELETE", "/v1/drive-campaigns/p04")[0], 403)
        self.assertEqual(self.server.ask("DELETE", "/v1/drive-campaigns/..%2F..")[0], 404)

    def test_every_fault_of_a_campaign_is_told(self):
        hostile = tar_of({"../evil": b"x", "/abs": b"x", "twice": b"1", "campaign.json": b"{}"}, "w",
                         [("link", "/etc/passwd")])
        found = self.faults("/v1/drive-campaigns", {"upload": self.sent(hostile, "bad.tar")})
        for words in ("../evil", "/abs", "link"):
            self.assertTrue(any(words in message for _, message in found), found)
        self.assertFalse((self.path / "uploads" / "evil").exists())
        files = campaign_files()
        document = json.loads(files["campaign.json"])
        document["gravity_m_s2"] = -1
        document["drives"][0]["file"] = "nowhere.csv"
        files["campaign.json"] = json.dumps(document).encode()
        files[document["drives"][1]["file"]] = b"t_s,x_m\n0,zero\n"
        found = self.faults("/v1/drive-campaigns", {"upload": self.sent(tar_of(files), "faulty.tgz")})
        for words in ("gravity_m_s2", "nowhere.csv", "zero"):
            self.assertTrue(any(words in message for _, message in found), (words, found))
        self.assertEqual([p for p, _ in self.faults("/v1/drive-campaigns", {"upload": "0" * 64, "drives": []})],
                         ["/drives", "/upload"])
        self.assertEqual([p for p, _ in self.faults("/v1/drive-campaigns", {})], ["/upload"])
        self.assertEqual([p for p, _ in self.faults("/v1/drive-campaigns", {"upload": self.sent(b"no", "no.tar")})],
                         ["/upload"])
        self.assertEqual(sorted(p.name for p in (self.path / "uploads" / "drive-campaigns").iterdir()), [])

    def test_a_campaign_whose_files_were_altered_is_not_used(self):
        name = self.ask("/v1/drive-campaigns", {"upload": self.sent(tar_of(campaign_files()), "p04.tgz")})["name"]
        file = next((self.path / "uploads" / "drive-campaigns" / name / "campaign").glob("D*.csv"))
        file.write_text(file.read_text().replace("1", "2"))
        status, headers, body = self.server.ask("POST", "/v1/watches",
                                                {"reference": name, "drives": [appended_drive("N1")]})
        self.assertEqual((status, json.loads(body)["type"]), (500, "/errors#damaged_store"), body)

    def test_a_terrain_is_sent_used_and_removed(self):
        elevation = self.sent(ELEVATION.read_bytes(), "dem.tif")
        made = self.ask("/v1/terrains", {"name": "site", "elevation": elevation, "licence": "CC0-1.0",
                                         "source": "a test"})
        self.assertEqual((made["name"], made["body"], made["source_sha256"]), ("site", "Mars", elevation))
        self.assertIn("site", self.names("terrains"))
        extent = made["extent"]
        x, y = 0.5 * (extent["west_m"] + extent["east_m"]), 0.5 * (extent["south_m"] + extent["north_m"])
        request = {"terrain": "site", "rover": "mer-class", "path": [{"x_m": x, "y_m": y}, {"x_m": x + 5, "y_m": y}]}
        self.ask("/v1/predictions", request)
        self.assertEqual(self.server.ask("GET", f"/v1/terrains/site/point?x_m={x}&y_m={y}")[0], 200)
        self.assertEqual(self.faults("/v1/terrains", {"name": "gale", "elevation": elevation})[0][0], "/name")
        legend = self.sent(b"label,soil\nx,no_such_soil\n", "legend.csv")
        found = self.faults("/v1/terrains", {"name": "Site 2", "elevation": "f" * 64, "legend": legend,
                                             "gravity_m_s2": 0, "colour": 1})
        self.assertEqual(sorted(p for p, _ in found), ["/colour", "/elevation", "/gravity_m_s2", "/legend", "/name"])
        self.ask("/v1/terrains", {"name": "no_map", "elevation": legend}, 422)
        self.assertEqual(self.server.ask("DELETE", "/v1/terrains/site")[0], 204)
        self.assertNotIn("site", self.names("terrains"))
        self.assertEqual(self.ask("/v1/predictions", request, 422)["faults"][0]["pointer"], "/terrain")
        self.assertEqual(self.server.ask("DELETE", "/v1/terrains/gale")[0], 403)

    def test_a_map_that_was_altered_after_its_import_is_not_read(self):
        elevation = self.sent(ELEVATION.read_bytes(), "dem.tif")
        extent = self.ask("/v1/terrains", {"name": "site", "elevation": elevation})["extent"]
        x, y = 0.5 * (extent["west_m"] + extent["east_m"]), 0.5 * (extent["south_m"] + extent["north_m"])
        request = {"terrain": "site", "rover": "mer-class", "path": [{"x_m": x, "y_m": y}, {"x_m": x + 5, "y_m": y}]}
        self.ask("/v1/predictions", request)
        file = self.path / "uploads" / "terrains" / "site" / "elevation.tif"
        whole = file.read_bytes()
        file.write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
        for start_anew in (False, True):
            if start_anew:
                self.server.stop()
                self.server = Server(self.path)
            for method, path, sent in (("POST", "/v1/predictions", {**request, "seed": 3}),
                                       ("GET", f"/v1/terrains/site/point?x_m={x}&y_m={y}", None),
                                       ("GET", "/v1/terrains/site", None)):
                status, _, body = self.server.ask(method, path, sent)
                self.assertEqual((status, json.loads(body)["type"]), (500, "/errors#damaged_store"), body)
                self.assertIn("elevation.tif of the terrain site is not what was imported: import", body.decode())
        self.ask("/v1/terrains", {"name": "site", "elevation": elevation})
        self.ask("/v1/predictions", request)

    def test_a_hostile_text_does_not_become_a_large_answer(self):
        files = campaign_files()
        table = next(name for name in files if name.endswith(".csv"))
        archive = self.sent(tar_of({**files, table: b"a" * 3_000_000}), "p04.tgz")
        status, headers, body = self.server.ask("POST", "/v1/drive-campaigns", {"upload": archive},
                                                {"Prefer": "respond-async"})
        self.assertEqual(status, 201, body)
        self.assertEqual(self.server.end_of(headers["Location"])["state"], "failed")
        for address in (headers["Location"], headers["Location"] + "/result"):
            self.assertLess(len(self.server.ask("GET", address)[2]), 200_000)

    def test_a_name_that_is_no_text_leaves_answers_json(self):
        name = "a\udcff"  # Python's words for a byte that is no UTF-8
        made = io.BytesIO()
        with tarfile.open(fileobj=made, mode="w:gz", format=tarfile.GNU_FORMAT) as archive:
            entry = tarfile.TarInfo(name)
            entry.size = 2
            archive.addfile(entry, io.BytesIO(b"{}"))
        status, headers, body = self.server.ask(
            "POST", "/v1/drive-campaigns", {"upload": self.sent(made.getvalue(), "a.tgz")}, {"Prefer": "respond-async"})
        self.assertEqual(status, 201, body)
        self.assertEqual(self.server.end_of(headers["Location"])["state"], "failed")
        problem = json.loads(self.server.ask("GET", headers["Location"])[2].decode("utf-8"))["problem"]
        self.assertIn("a\ufffd", problem["detail"])

    def test_no_name_of_a_system_makes_the_service_open_a_file(self):
        elevation, legend = self.sent(ELEVATION.read_bytes(), "dem.tif"), self.sent(b"label,soil\n1,mars_dune\n", "legend.csv")
        there = self.path / "definitions"
        there.write_text("<1> +proj=eqc +R=3396190 +units=m <>\n")
        request = {"name": "t", "elevation": elevation}
        for text in (f"+init={there}:1", f"+init={there}.not:1", "+init=../../definitions:1", "+init=/dev/stdin:1", str(there),
                     f"+proj=eqc +R=3396190 +nadgrids={there}", f"file://{there}", "https://example.org/crs.wkt",
                     f'PROJCS["x",EXTENSION["PROJ4","+init={there}:1"]]'):
            (pointer, message), = self.faults("/v1/terrains", {**request, "crs": text})
            self.assertEqual(pointer, "/crs", text)
            self.assertIn("+proj=eqc +R=3396190", message, "the remedy")
        told = set()
        for name in (f"+init={there}:1", f"+init={there}.not:1", "+init=/dev/stdin:1", "+init=../../definitions:1"):
            units = {"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": name}}, "features": []}
            soil = self.sent(json.dumps(units).encode(), "units.geojson")
            refused = self.ask("/v1/terrains", {**request, "soil": soil, "legend": legend}, 422)
            told.add(json.dumps(refused["faults"]))
        self.assertEqual(len(told), 1, "a file that exists is not told from one that does not")
        self.assertNotIn("t", self.names("terrains"))
        self.ask("/v1/terrains", {**request, "crs": "+proj=eqc +R=3396190 +units=m +no_defs", "gravity_m_s2": 3.71})

    def test_a_cell_that_is_too_small_is_refused(self):
        for size in ("1e-300", "1e-9"):
            grid = f"ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize {size}\n" + "1 2 3\n" * 3
            refused = self.ask("/v1/terrains", {"name": "tiny", "elevation": self.sent(grid.encode(), "tiny.asc"),
                                                "crs": "+proj=eqc +R=3396190 +units=m"}, 422)
            self.assertIn("must be at least 0.001 m", json.dumps(refused))
            self.assertIn("gdal_translate -a_ullr", json.dumps(refused))

    def test_a_title_is_text_in_every_picture(self):
        title = '<script>alert(1)</script>"&amp;'
        elevation = self.sent(ELEVATION.read_bytes(), "dem.tif")
        extent = self.ask("/v1/terrains", {"name": "site", "title": title, "elevation": elevation})["extent"]
        x, y = 0.5 * (extent["west_m"] + extent["east_m"]), 0.5 * (extent["south_m"] + extent["north_m"])
        request = {"terrain": "site", "rover": "mer-class", "path": [{"x_m": x, "y_m": y}, {"x_m": x + 5, "y_m": y}]}
        job = self.server.ask("POST", "/v1/checks", request, {"Prefer": "respond-async"})[1]["Location"]
        self.assertEqual(self.server.end_of(job)["state"], "successful")
        answers = {page: self.server.ask("GET", job + page) for page in ("/map", "/report")}
        for page, (status, headers, body) in answers.items():
            self.assertEqual(status, 200, page)
            self.assertNotIn(b"<script", body, page)
            self.assertIn("default-src 'none'", headers["Content-Security-Policy"], page)
            self.assertEqual(headers["X-Content-Type-Options"], "nosniff", page)
        texts = [e.text for e in ElementTree.fromstring(answers["/map"][2]).iter("{http://www.w3.org/2000/svg}text")]
        self.assertIn(title, texts)

    def server_with_tokens(self):
        """The headers of two operators, a viewer and an administrator."""
        self.server.stop()
        entries, tokens = "", {}
        for name, role in (("ann", "operator"), ("bob", "operator"), ("eve", "viewer"), ("root", "admin")):
            done = subprocess.run([SLIPWAY, "token", name, "--role", role], capture_output=True, text=True, check=True)
            tokens[name] = {"Authorization": "Bearer " + done.stderr.strip().splitlines()[-1]}
            entries += done.stdout
        (self.path / "tokens.toml").write_text(entries)
        self.server = Server(self.path, "--tokens", str(self.path / "tokens.toml"))
        return tokens

    def test_a_name_belongs_to_who_made_it(self):
        who = self.server_with_tokens()
        ask = lambda method, path, by, body=None: self.server.ask(method, path, body, {"Prefer": "wait=60", **who[by]})
        sent = json.loads(self.send(ELEVATION.read_bytes(), "dem.tif", **who["ann"])[2])["id"]
        make = lambda by, **more: ask("POST", "/v1/terrains", by, {"name": "site", "elevation": sent, **more})
        version = lambda: next(t["version"] for t in json.loads(ask("GET", "/v1/terrains", "eve")[2])["terrains"]
                               if t["name"] == "site")
        # What bob makes of ann's map is bob's.
        self.assertEqual(make("bob")[0], 200)
        first = version()
        status, _, body = make("ann", gravity_m_s2=1.62)
        self.assertEqual((status, json.loads(body)["faults"][0]["pointer"]), (409, "/name"), body)
        self.assertEqual((version(), ask("DELETE", "/v1/terrains/site", "ann")[0]), (first, 403))
        self.assertEqual(make("bob", gravity_m_s2=1.62)[0], 200)
        second = version()
        self.assertEqual(make("root")[0], 200)
        self.assertEqual(len({first, second, version()}), 2, "the same files are the same version")
        self.assertEqual(make("bob")[0], 409, "it is the administrator's now")

        archive = json.loads(self.send(tar_of(campaign_files()), "p04.tgz", **who["ann"])[2])["id"]
        name = json.loads(ask("POST", "/v1/drive-campaigns", "bob", {"upload": archive})[2])["name"]
        more = ask("POST", "/v1/drive-campaigns", "ann", {"follows": name, "drives": [appended_drive("D900")]})[2]
        self.assertEqual(ask("DELETE", "/v1/drive-campaigns/" + name, "ann")[0], 403)
        self.assertEqual(ask("DELETE", "/v1/drive-campaigns/" + name, "bob")[0], 204)
        self.assertEqual(ask("DELETE", "/v1/drive-campaigns/" + json.loads(more)["name"], "ann")[0], 204)

    def test_a_job_is_not_done_on_other_ground_than_it_was_asked_about(self):
        elevation = self.sent(ELEVATION.read_bytes(), "dem.tif")
        extent = self.ask("/v1/terrains", {"name": "site", "elevation": elevation})["extent"]
        x, y = 0.5 * (extent["west_m"] + extent["east_m"]), 0.5 * (extent["south_m"] + extent["north_m"])
        request = {"terrain": "site", "rover": "mer-class", "path": [{"x_m": x, "y_m": y}, {"x_m": x + 5, "y_m": y}]}
        before = self.ask("/v1/predictions", request)["provenance"]["terrain_version"]
        checked = self.server.ask("POST", "/v1/checks", request, {"Prefer": "respond-async"})[1]["Location"]
        self.assertEqual(self.server.end_of(checked)["state"], "successful")
        whole = self.server.ask("GET", checked + "/report")
        self.assertIn(b"<svg", whole[2].split(b"expected on each stretch")[0])
        self.server.stop()
        self.server = Server(self.path, "--no-workers")
        batch = {"kind": "prediction", "requests": [request, {**request, "terrain": "gale"}]}
        places = [self.server.ask("POST", path, asked, {"Prefer": "respond-async"})[1]["Location"]
                  for path, asked in (("/v1/predictions", request), ("/v1/batches", batch))]
        self.server.stop()
        described = self.path / "uploads" / "terrains" / "site" / "terrain.json"
        described.write_text(described.read_text().replace("3.71", "1.62"))
        self.server = Server(self.path)
        for place in places:
            self.assertEqual(self.server.end_of(place)["state"], "failed")
            status, _, body = self.server.ask("GET", place + "/result")
            self.assertEqual(status, 409, body)
            self.assertIn(before, json.loads(body)["detail"])
        # What was answered stays; it is not drawn on ground that it is not about.
        for picture in ("/map", "/vectors.gpkg", "/vectors.geojson?coordinates=lonlat"):
            status, _, body = self.server.ask("GET", checked + picture)
            self.assertEqual(status, 409, picture)
            self.assertIn(before, json.loads(body)["detail"])
        self.assertEqual(self.server.ask("GET", checked + "/result")[0], 200)
        status, _, body = self.server.ask("GET", checked + "/report")
        self.assertEqual((status, b"There is no map here: the terrain &quot;site&quot; was replaced" in body), (200, True), body[:3000])
        self.assertNotEqual(self.ask("/v1/predictions", request)["provenance"]["terrain_version"], before)

    def test_what_somebody_else_sent_stays(self):
        tokens = self.server_with_tokens()
        self.assertEqual(self.send(b"x", "a.csv", "text/csv")[0], 401)
        self.assertEqual(self.send(b"x", "a.csv", "text/csv", **tokens["eve"])[0], 403)
        status, headers, body = self.send(b"x", "a.csv", "text/csv", **tokens["ann"])
        self.assertEqual(status, 201, body)
        self.assertEqual(self.server.ask("DELETE", headers["Location"], headers=tokens["bob"])[0], 403)
        self.assertEqual(self.server.ask("DELETE", headers["Location"], headers=tokens["root"])[0], 204)

    def test_uploads_can_be_switched_off_and_bounded(self):
        self.server.stop()
        self.server = Server(self.path, "--uploads", "")
        self.assertEqual(self.send(b"{}", "a.json", "application/json")[0], 404)
        self.assertEqual(self.ask("/v1/terrains", {"name": "a", "elevation": "f" * 64}, 422)["faults"], [])
        self.server.stop()
        self.server = Server(self.path, "--keep-uploads-mb", "0.001")
        self.assertEqual(self.send(b"x" * 2000, "a.csv", "text/csv")[0], 507)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
