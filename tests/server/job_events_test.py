#!/usr/bin/env python3
"""Server-sent events of jobs: every change, no change twice, no cost of clients that have vanished.

usage: job_events_test.py SLIPWAY SOURCE_DIR
"""
import http.client
import json
import pathlib
import socket
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "contract"))
from running_service import STOP_967, Server, plan  # noqa: E402

LONG = plan(draws=1000)
NEAR = {"x_m": STOP_967["x_m"] + 10, "y_m": STOP_967["y_m"] - 10}


def events_in(text):
    """[(id, event, data)] of a whole stream, without comments."""
    found = []
    for block in text.split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.splitlines() if line and not line.startswith(":"))
        if fields:
            found.append((int(fields["id"]), fields["event"], json.loads(fields["data"])))
    return found


class JobEvents(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.server = Server(pathlib.Path(self.folder.name))

    def tearDown(self):
        self.server.stop()
        self.folder.cleanup()

    def submit(self, request, path="/v1/plans"):
        status, headers, body = self.server.ask("POST", path, request, {"Prefer": "respond-async"})
        self.assertEqual(status, 201, body)
        return headers["Location"]

    def stream(self, location, **headers):
        """The response, whose head has been read."""
        connection = http.client.HTTPConnection("127.0.0.1", self.server.port, timeout=120)
        connection.request("GET", location + "/events", headers=headers)
        return connection.getresponse()

    def test_a_listener_hears_every_stage_and_the_end(self):
        location = self.submit({"terrain": "gale", "rover": "msl-class", "path": [STOP_967, NEAR], "draws": 2000},
                               "/v1/predictions")
        response = self.stream(location)
        self.assertEqual((response.status, response.getheader("Content-Type")), (200, "text/event-stream"))
        self.assertIsNone(response.getheader("Content-Length"))
        events = events_in(response.read().decode())  # to the end of the stream
        ids = [number for number, _, _ in events]
        self.assertEqual(ids, sorted(set(ids)))
        self.assertEqual({name for _, name, _ in events}, {"job"})
        self.assertEqual(events[-1][2]["state"], "successful")
        progress = [job["progress"] for _, _, job in events]
        self.assertEqual(progress, sorted(progress))
        # Who comes back hears nothing twice: 204 tells a browser to stay away.
        again = self.stream(location, **{"Last-Event-ID": str(ids[-1])})
        self.assertEqual((again.status, again.read()), (204, b""))
        late = self.stream(location, **{"Last-Event-ID": str(ids[-1] - 1)})
        self.assertEqual([number for number, _, _ in events_in(late.read().decode())], [ids[-1]])
        self.assertEqual(self.stream("/v1/jobs/" + 32 * "0").status, 404)

    def test_a_dismissal_is_heard_at_once_and_a_stop_ends_streams(self):
        location = self.submit(LONG)
        response = self.stream(location)
        self.assertEqual(self.server.ask("DELETE", location)[0], 200)
        begun = time.time()
        self.assertEqual(events_in(response.read().decode())[-1][2]["state"], "dismissed")
        self.assertLess(time.time() - begun, 20)
        open_stream = self.stream(self.submit(LONG))
        self.assertEqual(self.server.stop(), 0)
        open_stream.read()
        self.server = Server(pathlib.Path(self.folder.name))

    def test_clients_that_vanish_cost_nothing(self):
        location = self.submit(LONG)
        clients = []
        for _ in range(100):
            client = socket.create_connection(("127.0.0.1", self.server.port))
            client.sendall(f"GET {location}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
            clients.append(client)
        for client in clients:
            self.assertTrue(client.recv(1000).startswith(b"HTTP/1.1 200"))
        for client in clients:
            client.close()
        self.assertEqual(self.server.ask("DELETE", location)[0], 200)
        self.server.ask("GET", "/healthz")
        sockets = [f for f in pathlib.Path(f"/proc/{self.server.process.pid}/fd").iterdir()
                   if f.is_symlink() and "socket" in str(f.readlink())]
        self.assertLess(len(sockets), 30)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
