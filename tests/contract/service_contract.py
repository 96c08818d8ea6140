#!/usr/bin/env python3
"""What the service promises as a process: its starts, its end, its jobs and who may read it.

usage: service_contract.py SLIPWAY SOURCE_DIR
"""
import json
import pathlib
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from running_service import DATA, SLIPWAY, Server, WithServer, plan


class ServiceContract(WithServer):
    def test_a_job_that_was_accepted_survives_a_kill(self):
        with tempfile.TemporaryDirectory() as folder:
            server = Server(pathlib.Path(folder))
            jobs = []
            for seed in range(3):
                status, headers, _ = server.ask("POST", "/v1/plans", plan(seed=seed, routes=2, draws=8), {"Prefer": "respond-async"})
                self.assertEqual(status, 201)
                jobs.append(headers["Location"])
            time.sleep(0.3)
            server.kill()
            again = Server(pathlib.Path(folder))
            try:
                for location in jobs:
                    self.assertEqual(again.end_of(location)["state"], "successful")
            finally:
                again.stop()

    def test_a_start_that_fails_takes_no_job_from_the_service_that_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            server = Server(pathlib.Path(folder))
            try:
                _, headers, _ = server.ask("POST", "/v1/plans", plan(draws=400, routes=3), {"Prefer": "respond-async"})
                location = headers["Location"]
                deadline = time.time() + 60
                while json.loads(server.ask("GET", location)[2])["state"] == "accepted" and time.time() < deadline:
                    time.sleep(0.02)
                command = [SLIPWAY, "serve", "--data", DATA, "--jobs", str(server.folder / "jobs.sqlite"), "--port", str(server.port)]
                for _ in range(6):
                    failed = subprocess.run(command, capture_output=True, text=True, timeout=60)
                    self.assertEqual(failed.returncode, 1)
                    self.assertIn("can't listen", failed.stderr)
                # One that does start, on another port, leaves the running job to whom it belongs.
                other = Server(server.folder)
                job = json.loads(other.ask("GET", location)[2])
                self.assertEqual((job["state"], job["attempt"]), ("running", 1))
                self.assertEqual(other.stop(), 0)
                job = server.end_of(location)
                self.assertEqual((job["state"], job["attempt"]), ("successful", 1), job)
            finally:
                server.stop()
            nowhere = pathlib.Path(folder) / "elsewhere" / "jobs.sqlite"
            with socket.socket() as taken:
                taken.bind(("127.0.0.1", 0))
                taken.listen()
                failed = subprocess.run([SLIPWAY, "serve", "--data", DATA, "--port", str(taken.getsockname()[1]), "--jobs", str(nowhere)], capture_output=True)
            self.assertEqual(failed.returncode, 1)
            self.assertFalse(nowhere.parent.exists(), "a failed start makes no store")

    def test_a_name_that_is_not_the_servers_is_refused(self):
        for host, expected in (("evil.example.org", 421), (f"evil.example.org:{self.server.port}", 421), ("localhost", 200),
                               (f"LOCALHOST:{self.server.port}", 200), ("10.1.2.3", 200), ("[::1]:80", 200), ("localhost:", 200), ("[::1].evil.example.org", 421),
                               ("localhost:x", 421), ("localhost:99999", 421), ("", 400), ("[localhost]", 421), ("10.1.2.3.evil.example.org", 421)):
            status, _, body = self.server.ask("GET", "/v1/rovers", headers={"Host": host})
            self.assertEqual(status, expected, host)
            if expected == 421:
                self.assertIn(b"foreign_host", body)
        # The address in the request line counts, whatever Host says.
        for target, expected in (("http://evil.example.org/healthz", 421), ("http://localhost@evil.example.org/healthz", 421),
                                 (f"http://localhost:{self.server.port}/healthz", 200)):
            self.assertEqual(self.server.ask("GET", target, headers={"Host": "localhost"})[0], expected, target)
        with tempfile.TemporaryDirectory() as folder:
            server = Server(pathlib.Path(folder), "--allow-host", "rover-desk")
            try:
                self.assertEqual(server.ask("GET", "/v1/rovers", headers={"Host": "rover-desk:80"})[0], 200)
                self.assertEqual(server.ask("GET", "/v1/rovers", headers={"Host": "rover"})[0], 421)
            finally:
                server.stop()

    def test_a_kind_or_charset_that_is_not_known_is_refused(self):
        status, _, body = self.server.ask("GET", "/v1/jobs?kind=';--")
        self.assertEqual(status, 422, body)
        self.assertIn("prediction", json.loads(body)["faults"][0]["message"])
        for charset, expected in (("utf-16", 415), ('"utf-16"', 415), ("UTF-8", 422), ('"utf-8"', 422)):
            headers = {"Content-Type": f"application/json; charset={charset}"}
            self.assertEqual(self.server.ask("POST", "/v1/predictions", b"{}", headers)[0], expected, charset)

    def test_web_pages_of_the_listed_origins_may_read(self):
        page = {"Origin": "http://localhost:5173"}
        self.assertNotIn("Access-Control-Allow-Origin", self.server.ask("GET", "/v1/rovers", headers=page)[1])
        with tempfile.TemporaryDirectory() as folder:
            server = Server(pathlib.Path(folder), "--allow-origin", page["Origin"], "--allow-origin", "https://ops.example.org")
            try:
                for origin, allowed in ((page["Origin"], True), ("https://ops.example.org", True), ("https://evil.example.org", False)):
                    status, headers, _ = server.ask("GET", "/v1/rovers", headers={"Origin": origin})
                    self.assertEqual((status, headers.get("Access-Control-Allow-Origin")), (200, origin if allowed else None))
                    self.assertIn("Origin", headers["Vary"])
                status, headers, _ = server.ask("OPTIONS", "/v1/plans", headers={
                    **page, "Access-Control-Request-Method": "POST", "Access-Control-Request-Headers": "content-type,prefer"})
                self.assertEqual((status, headers["Access-Control-Allow-Origin"]), (204, page["Origin"]))
                self.assertIn("POST", headers["Access-Control-Allow-Methods"])
                for name in ("Content-Type", "Prefer", "If-None-Match"):
                    self.assertIn(name, headers["Access-Control-Allow-Headers"])
                status, headers, _ = server.ask("POST", "/v1/plans", {}, page)
                self.assertEqual((status, headers["Access-Control-Allow-Origin"]), (422, page["Origin"]))
                # Refused before a route was found.
                status, headers, _ = server.ask("POST", "/v1/plans", "start=1", {**page, "Content-Type": "text/plain"})
                self.assertEqual((status, headers["Access-Control-Allow-Origin"]), (415, page["Origin"]))
                status, headers, _ = server.ask("POST", "/v1/plans", plan(routes=1, draws=1), page)
                self.assertIn("Location", headers["Access-Control-Expose-Headers"])
            finally:
                server.stop()
        for origin in ("*", "ops.example.org", "https://ops.example.org/"):
            refused = subprocess.run([SLIPWAY, "serve", "--data", DATA, "--port", "0", "--jobs", "", "--allow-origin", origin], capture_output=True, text=True, timeout=20)
            self.assertEqual(refused.returncode, 2)
            self.assertIn("/allow-origin", refused.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
