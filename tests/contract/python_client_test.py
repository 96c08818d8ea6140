#!/usr/bin/env python3
"""The Python client against a running service, with and without tokens, and what operators ask.

usage: python_client_test.py SLIPWAY SOURCE_DIR
"""
import json
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from running_service import SLIPWAY, SOURCE, STOP_967, STOP_997, Server, WithServer, plan

sys.path.insert(0, str(SOURCE / "clients" / "python"))
from slipway_client import Slipway, SlipwayError  # noqa: E402

PATH = {"terrain": "gale", "rover": "msl-class", "path": [STOP_967, STOP_997], "draws": 8}


class Client(WithServer):
    def setUp(self):
        self.slipway = Slipway(self.server.url)

    def test_a_drive_is_planned_predicted_and_checked(self):
        seen = []
        answer = self.slipway.plan(plan(routes=1, draws=8), on_progress=seen.append)
        self.assertEqual(answer["format"], "plan/1")
        self.assertEqual(seen[-1]["state"], "successful")
        self.assertEqual(self.slipway.predict(PATH)["format"], "prediction/1")
        self.assertIn(self.slipway.check(PATH)["verdict"], ("go", "no_go", "unknown"))

    def test_an_answer_has_its_pictures_and_its_table(self):
        job = self.slipway.submit("/v1/checks", PATH)
        self.assertEqual(job.wait(timeout_s=120)["state"], "successful")
        self.assertIn("<svg", job.map_svg())
        self.assertIn("<!DOCTYPE html>", job.report_html())
        self.assertEqual(job.geojson()["type"], "FeatureCollection")
        table = "".join(job.stations_csv())
        self.assertEqual(len(table.splitlines()) - 1, job.result()["routes"]["features"][0]["properties"]["stations"]["count"])
        self.assertIn(job.id, [each["id"] for each in self.slipway.jobs()])

    def test_a_long_drive_has_a_small_answer_and_a_whole_table(self):
        zigzag = [{"x_m": STOP_967["x_m"] + (30 if k % 2 else 0), "y_m": STOP_967["y_m"] - 0.2 * k} for k in range(200)]
        job = self.slipway.submit("/v1/predictions", {**PATH, "path": zigzag, "draws": 1})
        job.wait(timeout_s=120)
        answer = job.result()
        stations = answer["routes"]["features"][0]["properties"]["stations"]
        table = "".join(job.stations_csv())
        self.assertLess(stations["count"], stations["thinned_from"])
        self.assertEqual(len(table.splitlines()) - 1, stations["thinned_from"])
        self.assertLess(len(json.dumps(answer)), 6e6)
        self.assertIn("<svg", job.map_svg())
        self.assertEqual(job.map_svg(), job.map_svg())

    def test_a_refusal_names_every_fault(self):
        with self.assertRaises(SlipwayError) as caught:
            self.slipway.predict({**PATH, "rover": "none", "draws": -1})
        self.assertEqual((caught.exception.status, caught.exception.name), (422, "invalid_request"))
        self.assertEqual({fault["pointer"] for fault in caught.exception.faults}, {"/rover", "/draws"})

    def test_the_same_key_is_one_job(self):
        first, second = (self.slipway.submit("/v1/predictions", PATH, key="once") for _ in range(2))
        self.assertEqual(first.id, second.id)

    def test_a_job_can_be_dismissed(self):
        job = self.slipway.submit("/v1/plans", plan(draws=1000))
        self.assertEqual(job.dismiss()["state"], "dismissed")
        with self.assertRaises(SlipwayError):
            job.result()

    def test_a_broken_connection_is_tried_again(self):
        """A server that hangs up twice before it hands on to the real one."""
        listener = socket.create_server(("127.0.0.1", 0))

        def answer():
            for _ in range(2):
                listener.accept()[0].close()
            client, _ = listener.accept()
            with socket.create_connection(("127.0.0.1", self.server.port)) as real:
                real.sendall(client.recv(65536))
                client.sendall(real.recv(65536))
            client.close()

        thread = threading.Thread(target=answer)
        thread.start()
        status, _, _ = Slipway(f"http://127.0.0.1:{listener.getsockname()[1]}").request("GET", "/healthz")
        thread.join()
        listener.close()
        self.assertEqual(status, 200)

    def test_the_catalogue_is_listed(self):
        self.assertIn("gale", [terrain["name"] for terrain in self.slipway.terrains()])
        self.assertTrue(self.slipway.rovers() and self.slipway.soils() and self.slipway.drive_campaigns())

    def test_operators_see_what_goes_on(self):
        deadline = time.time() + 30
        while not self.slipway.is_ready() and time.time() < deadline:
            time.sleep(0.05)
        self.assertTrue(self.slipway.is_ready())
        self.slipway.predict(PATH)
        metrics = self.slipway.get("/metrics").decode()
        self.assertRegex(metrics, r'slipway_http_requests_total\{method="POST",route="/v1/predictions",status="201"\} [1-9]')
        self.assertRegex(metrics, r'slipway_jobs\{kind="prediction",state="successful"\} [1-9]')
        _, headers, _ = self.slipway.request("GET", "/healthz", headers={"X-Request-Id": "mine-7"})
        self.assertEqual(headers["x-request-id"], "mine-7")


class WithTokens(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(self.folder.name)
        self.tokens = {}
        entries = ""
        for name, role in (("wall", "viewer"), ("ann", "operator"), ("bob", "operator"), ("root", "admin")):
            made = subprocess.run([SLIPWAY, "token", name, "--role", role], capture_output=True, text=True, check=True)
            self.tokens[name] = made.stderr.splitlines()[-1]
            entries += made.stdout
        (folder / "tokens.toml").write_text(entries)
        (folder / "service.toml").write_text(f'audit = "{folder}/audit.jsonl"\nmost-jobs = 9\n')
        self.server = Server(folder, "--tokens", str(folder / "tokens.toml"), "--config", str(folder / "service.toml"))
        self.audit = folder / "audit.jsonl"

    def tearDown(self):
        self.server.stop()
        self.folder.cleanup()

    def by(self, name):
        return Slipway(self.server.url, token=self.tokens.get(name), patience_s=0)

    def status_of(self, call):
        try:
            call()
        except SlipwayError as refused:
            return refused.status
        return 200

    def test_each_may_do_what_the_role_allows(self):
        self.assertEqual(self.status_of(lambda: self.by("nobody").jobs()), 401)
        self.assertEqual(self.server.ask("GET", "/v1/jobs")[1]["WWW-Authenticate"], 'Bearer realm="slipway"')
        self.assertEqual(self.server.ask("GET", "/healthz")[0], 200)
        self.assertEqual(self.status_of(lambda: self.by("wall").submit("/v1/plans", plan(draws=1000))), 403)
        job = self.by("ann").submit("/v1/plans", plan(draws=1000))
        self.assertEqual(self.by("wall").job(job.id).status()["id"], job.id)
        self.assertEqual(self.status_of(lambda: self.by("bob").job(job.id).dismiss()), 403)
        self.assertEqual(self.by("root").job(job.id).dismiss()["state"], "dismissed")
        own = self.by("bob").submit("/v1/plans", plan(draws=1000))
        self.assertEqual(own.dismiss()["state"], "dismissed")
        lines = [json.loads(line) for line in self.audit.read_text().splitlines()]
        asked = [(line["who"], line["method"], line["status"]) for line in lines]
        self.assertIn(("ann", "POST", 201), asked)
        self.assertIn(("bob", "DELETE", 403), asked)
        self.assertIn(("root", "DELETE", 200), asked)
        self.assertEqual(next(line["location"] for line in lines if line["who"] == "ann"), job.location)
        self.assertNotIn(self.tokens["ann"], self.audit.read_text())

    def test_commands_send_the_token_of_their_environment(self):
        command = [SLIPWAY, "rovers", "--url", self.server.url]
        self.assertIn("token", subprocess.run(command, capture_output=True, text=True).stderr)
        allowed = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "SLIPWAY_TOKEN": self.tokens["wall"]})
        self.assertEqual(allowed.returncode, 0, allowed.stderr)


class Start(unittest.TestCase):
    def refused(self, *options):
        done = subprocess.run([SLIPWAY, "serve", "--port", "0", "--jobs", "", *options], capture_output=True, text=True, timeout=60)
        self.assertNotEqual(done.returncode, 0)
        return done.stderr

    def test_an_address_beyond_this_machine_needs_tokens(self):
        self.assertIn("--tokens", self.refused("--address", "0.0.0.0"))

    def test_a_setting_that_is_none_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "service.toml"
            path.write_text("prot = 8080\n")
            self.assertIn("prot", self.refused("--config", str(path)))
            self.assertIn("nowhere.toml", self.refused("--config", str(pathlib.Path(folder) / "nowhere.toml")))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
