#!/usr/bin/env python3
"""Worker processes of a running service: deaths, dismissals, lanes, urgencies, keys and quotas.

usage: workers_test.py SLIPWAY SOURCE_DIR
"""
import json
import os
import pathlib
import signal
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "contract"))
from running_service import Server, command_line, plan  # noqa: E402

ASYNC = {"Prefer": "respond-async"}
LONG = plan(draws=1000)  # a minute or so: it must still run when a test acts on it


def comes_true(condition, seconds=60):
    deadline = time.time() + seconds
    while time.time() < deadline:
        if condition():
            return True
        time.sleep(0.05)
    return False


class Workers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.server = None

    def tearDown(self):
        if self.server:
            self.server.stop()
        self.folder.cleanup()

    def serve(self, *options):
        self.server = Server(pathlib.Path(self.folder.name), *options)
        return self.server

    def submit(self, request, path="/v1/plans", **headers):
        status, answer, body = self.server.ask("POST", path, request, {**ASYNC, **headers})
        self.assertEqual(status, 201, body[:500])
        return answer["Location"]

    def job(self, location):
        return json.loads(self.server.ask("GET", location)[2])

    def waits_until_running(self, location):
        self.assertTrue(comes_true(lambda: self.job(location)["state"] == "running"), self.job(location))

    def dismiss(self, location):
        self.assertEqual(self.server.ask("DELETE", location)[0], 200)

    def test_a_killed_worker_costs_one_attempt_and_is_told(self):
        self.serve()
        location = self.submit(LONG)
        self.waits_until_running(location)
        killed = self.server.worker_pids()
        self.assertEqual(len(killed), 3)
        for pid in killed:
            os.kill(pid, signal.SIGKILL)
        self.assertTrue(comes_true(lambda: self.job(location)["attempt"] == 2), self.job(location))
        job = self.job(location)
        self.assertIn("signal 9", job["interrupted"])
        self.assertFalse(set(self.server.worker_pids()) & set(killed))
        self.assertEqual(self.server.ask("GET", "/healthz")[0], 200)
        self.dismiss(location)
        self.server.answer("/v1/plans", plan(draws=32))

    def test_no_worker_outlives_its_service(self):
        server = self.serve()
        location = self.submit(LONG)
        self.waits_until_running(location)
        left = server.worker_pids()
        server.kill()
        gone = lambda pid: not pathlib.Path(f"/proc/{pid}").exists() or b"worker" not in command_line(pid)
        self.assertTrue(comes_true(lambda: all(gone(pid) for pid in left), 15))
        self.serve()
        self.waits_until_running(location)
        self.assertNotIn("interrupted", self.job(location), "who killed the service did not kill the work")
        self.dismiss(location)

    def test_a_dismissal_reaches_the_worker_within_two_seconds(self):
        self.serve()
        location = self.submit(LONG)
        self.waits_until_running(location)
        next_one = self.submit(LONG)
        another = self.submit(LONG)
        self.waits_until_running(next_one)  # two workers take plans
        began = time.time()
        self.dismiss(location)
        self.waits_until_running(another)
        self.assertLess(time.time() - began, 2.0)
        for left in (next_one, another):
            self.dismiss(left)

    def test_a_plan_does_not_wait_behind_diagnoses(self):
        self.serve()
        diagnoses = [self.submit({"campaign": "p01"}, "/v1/diagnoses") for _ in range(3)]
        self.waits_until_running(diagnoses[0])
        location = self.submit(plan(draws=32))
        self.waits_until_running(location)
        self.assertEqual(self.job(diagnoses[1])["state"], "accepted")
        for left in diagnoses:
            self.dismiss(left)

    def test_urgency_and_place_in_the_queue(self):
        self.serve()
        running = [self.submit(LONG) for _ in range(2)]
        for location in running:
            self.waits_until_running(location)
        usual, last, first = [self.submit(LONG, Priority=f"u={u}") for u in (3, 7, 0)]
        self.assertEqual([self.job(location)["queue"]["ahead"] for location in (first, usual, last)], [0, 1, 2])
        tags = [self.server.ask("GET", last)[1]["ETag"]]
        self.dismiss(usual)
        tags.append(self.server.ask("GET", last)[1]["ETag"])
        self.assertNotEqual(*tags)
        for left in (*running, first, last):
            self.dismiss(left)

    def test_a_key_makes_a_repeated_request_one_job(self):
        self.serve()
        first = self.submit(LONG, **{"Idempotency-Key": "drive-42"})
        self.assertEqual(self.submit(LONG, **{"Idempotency-Key": "drive-42"}), first)
        self.assertNotEqual(self.submit(LONG, **{"Idempotency-Key": "drive-43"}), first)
        for key, request in (("drive-42", plan(draws=64)), ("two words", LONG), ("k" * 256, LONG)):
            status, _, body = self.server.ask("POST", "/v1/plans", request, {**ASYNC, "Idempotency-Key": key})
            self.assertEqual(status, 422, key)
            self.assertEqual(json.loads(body)["faults"][0]["pointer"], "/Idempotency-Key")
        for job in json.loads(self.server.ask("GET", "/v1/jobs")[2])["jobs"]:
            self.dismiss("/v1/jobs/" + job["id"])

    def test_one_address_cannot_fill_the_queue(self):
        self.serve("--most-jobs", "3", "--most-jobs-per-address", "2")
        own = [self.submit(LONG) for _ in range(2)]
        status, headers, body = self.server.ask("POST", "/v1/plans", LONG, ASYNC)
        self.assertEqual((status, json.loads(body)["type"]), (429, "/errors#over_quota"))
        self.assertIn("Retry-After", headers)
        for left in own:
            self.dismiss(left)
        self.dismiss(self.submit(LONG))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
