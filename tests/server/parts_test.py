#!/usr/bin/env python3
"""Jobs in parts, worked on by workers that were started by hand beside a service that has none: the same bytes for any number
of them, dismissals, missing parts, pilots, and leases that are handed back. On a database, or on a file where no PostgreSQL server is installed.

usage: parts_test.py SLIPWAY SOURCE_DIR [--both]
"""
import array
import contextlib
import hashlib
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

for beside in ("contract", "postgres"):
    sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / beside))
from running_service import SLIPWAY, SOURCE, STOP_967, Server, plan  # noqa: E402
from postgres_server import SCRIPT, PostgresServer  # noqa: E402

ASYNC = {"Prefer": "respond-async"}
SIDE = 1200  # cells of the map: four pieces


def make_data(folder):
    """The shipped data with a terrain of several pieces; the folder."""
    data = folder / "data"
    shutil.copytree(SOURCE / "data", data, ignore=shutil.ignore_patterns("drive-campaigns", "gap-practice", "validation"))
    with open(folder / "dem.img", "wb") as file:
        for row in range(SIDE):
            array.array("f", [((row * 7919 + column * 104729) % 97) / 97.0 + row / 12.0 for column in range(SIDE)]).tofile(file)
    (folder / "dem.hdr").write_text(f"ENVI\nsamples = {SIDE}\nlines = {SIDE}\nbands = 1\ndata type = 4\ninterleave = bsq\nbyte order = 0\n"
                                    f"map info = {{Arbitrary, 1, 1, 0, {SIDE}, 1, 1, 0}}\n")
    subprocess.run([SLIPWAY, "terrain", "import", str(folder / "dem.img"), "--name", "big", "--crs", "+proj=eqc +R=3396190 +units=m",
                    "--data", str(data)], check=True, capture_output=True)
    return data


def prediction(number):
    return {"terrain": "gale", "rover": "msl-class", "draws": 8,
            "path": [STOP_967, {"x_m": STOP_967["x_m"] + 4.0 + number, "y_m": STOP_967["y_m"] - 3.0}]}


# Many times to and fro, which takes minutes of processor time.
LONG = {**prediction(1), "draws": 1000,
        "path": [{"x_m": STOP_967["x_m"] - 13.0 * (k % 2), "y_m": STOP_967["y_m"] - 60.0 * (k % 2)} for k in range(40)]}


class Parts:
    """The tests; what is kept is in `store`."""

    @classmethod
    def setUpClass(cls):
        cls.held = contextlib.ExitStack()
        cls.folder = pathlib.Path(cls.held.enter_context(tempfile.TemporaryDirectory()))
        cls.data = make_data(cls.folder)
        cls.store = cls.open_store()
        cls.shared = ["--jobs", cls.store, "--artefacts", str(cls.folder / "artefacts")]
        cls.server = Server(cls.folder, *cls.shared, "--no-workers", data=cls.data)

    @classmethod
    def tearDownClass(cls):
        status = cls.server.stop()
        cls.held.close()
        assert status == 0, f"the server ended with {status}"

    def worker(self, *options, before=()):
        process = subprocess.Popen([*before, SLIPWAY, "worker", "--data", str(self.data), *self.shared, "--artefact-cache", str(self.folder / "cache"), *options],
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def pilots_end(self, *pilots):
        for pilot in pilots:
            self.assertEqual(pilot.wait(timeout=240), 0, pilot.stderr.read())

    def submit(self, path, request):
        status, headers, body = self.server.ask("POST", path, request, ASYNC)
        self.assertEqual(status, 201, body[:500])
        return headers["Location"]

    def job(self, location):
        return json.loads(self.server.ask("GET", location)[2])

    def parts(self, location):
        return json.loads(self.server.ask("GET", location + "/parts")[2])["jobs"]

    def becomes(self, condition, seconds=60):
        deadline = time.time() + seconds
        while not condition():
            self.assertLess(time.time(), deadline)
            time.sleep(0.05)

    def test_a_map_has_the_same_bytes_from_one_worker_two_and_none(self):
        request = {"terrain": "big", "rover": "msl-class", "kind": "slip_worst", "unknown_ground": "belief"}
        alone = self.folder / "alone.tif"
        done = subprocess.run([SLIPWAY, "map", "slip_worst", "--terrain", "big", "--rover", "msl-class", "--on-unknown", "belief",
                               "--out", str(alone), "--data", str(self.data)], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        for count in (1, 2):
            location = self.submit("/v1/maps", request)
            self.pilots_end(*(self.worker("--until-empty") for _ in range(count)))
            job = self.job(location)
            self.assertEqual(job["state"], "successful", job)
            self.assertEqual(job["parts"], {"count": 4, "ended": 4, "failed": 0})
            parts = self.parts(location)
            self.assertEqual([part["part"] for part in parts], [0, 1, 2, 3])
            self.assertGreater(job["cpu_s"], 0.99 * sum(part["cpu_s"] for part in parts))
            self.assertEqual(self.server.ask("GET", location + "/map.tif")[2], alone.read_bytes())
        kept = [path for path in (self.folder / "artefacts").rglob("*") if path.is_file()]
        self.assertTrue(kept and all(hashlib.sha256(path.read_bytes()).hexdigest() == path.name for path in kept))
        self.assertTrue(any((self.folder / "cache").iterdir()), "who puts the parts together has read them")
        self.assertEqual(subprocess.run([SLIPWAY, "jobs", "--jobs", self.store, "--open"], capture_output=True, text=True).stdout, "0\n")

    def test_a_batch_answers_as_its_requests_do_though_workers_die(self):
        requests = [prediction(number) for number in range(6)]
        single = [self.submit("/v1/predictions", {**request, "seed": seed}) for request in requests for seed in (5, 6)]
        self.pilots_end(self.worker("--until-empty"))
        expected = b"".join(self.server.ask("GET", location + "/result")[2] + b"\n" for location in single)
        location = self.submit("/v1/batches", {"kind": "prediction", "requests": requests, "seeds": {"first": 5, "count": 2}})
        victim = self.worker("--lease-s", "5")
        self.becomes(lambda: self.job(location).get("parts", {}).get("ended", 0) >= 1)
        victim.kill()
        self.pilots_end(self.worker("--until-empty"), self.worker("--until-empty"))
        self.assertEqual(self.job(location)["state"], "successful", self.job(location))
        self.assertEqual(self.server.ask("GET", location + "/answers")[2], expected)
        self.assertEqual(json.loads(self.server.ask("GET", location + "/result")[2])["answers"], 12)
        listed = json.loads(self.server.ask("GET", "/v1/jobs")[2])["jobs"]
        self.assertFalse([job for job in listed if "whole" in job], "parts are not listed")

    def test_a_dismissal_stops_the_parts(self):
        location = self.submit("/v1/batches", {"kind": "plan", "requests": [plan(draws=1000)] * 3})
        worker = self.worker()
        self.becomes(lambda: any(part["state"] == "running" for part in self.parts(location)))
        self.assertEqual(self.server.ask("DELETE", location)[0], 200)
        self.assertEqual({part["state"] for part in self.parts(location)}, {"dismissed"})
        quick = self.submit("/v1/predictions", prediction(0))
        began = time.time()
        self.assertEqual(self.server.end_of(quick, 30)["state"], "successful")
        self.assertLess(time.time() - began, 10.0, "the worker had stopped at once")
        worker.terminate()
        self.pilots_end(worker)

    def test_a_part_that_cannot_be_done_is_named(self):
        location = self.submit("/v1/batches", {"kind": "prediction", "requests": [prediction(0), LONG, prediction(2)]})
        self.pilots_end(self.worker("--until-empty", "--job-minutes", "0.1"))
        job = self.job(location)
        self.assertEqual((job["state"], job["parts"]["failed"]), ("failed", 1), job)
        problem = job["problem"]
        self.assertEqual(problem["type"], "/errors#job_too_large")
        self.assertIn("1 of 3 parts of the work are missing", problem["detail"])
        self.assertEqual([fault["pointer"] for fault in problem["faults"]], ["/parts/1"])

    def test_a_part_that_kills_its_worker_each_time_fails_with_its_reason_and_no_other_does(self):
        # The system ends each worker that spends a second of processor time, which the long part alone takes.
        location = self.submit("/v1/batches", {"kind": "prediction", "requests": [prediction(0), LONG, prediction(2)]})
        limit = ["sh", "-c", 'ulimit -t 1; exec "$@"', "sh"]
        deadline = time.time() + 200
        while self.job(location)["state"] in ("accepted", "running"):
            self.assertLess(time.time(), deadline, self.job(location))
            self.worker("--until-empty", "--lease-s", "5", before=limit).wait()
        job = self.job(location)
        self.assertEqual((job["state"], job["parts"]), ("failed", {"count": 3, "ended": 3, "failed": 1}), job)
        problem = job["problem"]
        self.assertIn("1 of 3 parts of the work are missing", problem["detail"])
        self.assertEqual([fault["pointer"] for fault in problem["faults"]], ["/parts/1"])
        self.assertIn("the worker died 5 times", problem["faults"][0]["message"])
        self.assertEqual([part["state"] for part in self.parts(location)], ["successful", "failed", "successful"])

    def test_a_worker_that_is_asked_to_end_hands_its_job_back(self):
        location = self.submit("/v1/plans", plan(draws=1000))
        worker = self.worker()
        self.becomes(lambda: self.job(location)["state"] == "running")
        worker.send_signal(signal.SIGTERM)
        self.assertEqual(worker.wait(timeout=10), 0)
        job = self.job(location)
        self.assertEqual((job["state"], job["attempt"]), ("accepted", 1))
        self.assertNotIn("interrupted", job, "nobody died")
        self.server.ask("DELETE", location)

    def test_a_batch_with_faults_names_each(self):
        status, _, body = self.server.ask("POST", "/v1/batches", {"kind": "prediction", "requests": [prediction(0), {**prediction(1), "seed": 1}],
                                                                 "seeds": {"first": 1, "count": 2}, "more": 1})
        self.assertEqual(status, 422)
        self.assertEqual({fault["pointer"] for fault in json.loads(body)["faults"]}, {"/requests/1/seed", "/more"})
        wrong = {**prediction(0), "rover": "none-such"}
        status, _, body = self.server.ask("POST", "/v1/batches", {"kind": "prediction", "requests": [prediction(0), wrong]})
        self.assertEqual((status, json.loads(body)["faults"][0]["pointer"]), (422, "/requests/1/rover"))


ON_A_DATABASE = subprocess.run([SCRIPT, "available"]).returncode == 0


@unittest.skipIf(ON_A_DATABASE and "--both" not in sys.argv, "takes as long again, and is done with --both or without a database")
class PartsOnAFile(Parts, unittest.TestCase):
    @classmethod
    def open_store(cls):
        return str(cls.folder / "jobs.sqlite")


@unittest.skipUnless(ON_A_DATABASE, "SKIPPED: no PostgreSQL server is installed")
class PartsOnADatabase(Parts, unittest.TestCase):
    @classmethod
    def open_store(cls):
        return cls.held.enter_context(PostgresServer()).address


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
