"""A running `slipway serve` and requests to it, for the tests that look from outside with nothing of its code.

Every script here is called with: SLIPWAY SOURCE_DIR
"""
import http.client
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SLIPWAY, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
DATA = str(SOURCE / "data")
STOP_967 = {"x_m": 8142579.733, "y_m": -276648.736}
STOP_997 = {"x_m": 8142566.402, "y_m": -276711.667}
JSON = {"Content-Type": "application/json"}


def plan(**changes):
    return {"terrain": "gale", "rover": "msl-class", "start": STOP_967, "goal": STOP_997, **changes}


def thinned_data(folder, every):
    """A copy of the shipped data whose practice campaigns have every n-th drive alone, {campaign: n}; the folder."""
    shutil.copytree(DATA, folder, ignore=shutil.ignore_patterns("validation"))
    for campaign, n in every.items():
        path = folder / "gap-practice" / campaign / "campaign.json"
        described = json.loads(path.read_text())
        described["drives"] = described["drives"][::n]
        path.chmod(0o644)
        path.write_text(json.dumps(described))
    return folder


VERDICTS = (0, 3, 4)  # GO, NO-GO or no route, UNKNOWN: the question was answered


def answered(command, **options):
    """Runs a command that must answer, whatever the verdict."""
    done = subprocess.run(command, capture_output=True, **options)
    if done.returncode not in VERDICTS:
        raise subprocess.CalledProcessError(done.returncode, command, done.stdout, done.stderr)
    return done


def command_line(pid):
    return pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")


def with_preload():
    """This environment, with the library loaded first that a test names in SLIPWAY_PRELOAD."""
    preload = os.environ.get("SLIPWAY_PRELOAD")
    return {**os.environ, "LD_PRELOAD": preload} if preload else None


def processor_s_of(pid):
    stat = pathlib.Path(f"/proc/{pid}/stat").read_text()
    return sum(map(int, stat.rsplit(")", 1)[1].split()[11:13])) / os.sysconf("SC_CLK_TCK")


class Server:
    """`slipway serve` on a free port, in a folder of its own."""

    def __init__(self, folder, *options, data=DATA):
        self.folder = folder
        jobs = [] if "--jobs" in options else ["--jobs", str(folder / "jobs.sqlite")]
        self.process = subprocess.Popen(
            [SLIPWAY, "serve", "--data", str(data), "--port", "0", *jobs, *options],
            stdout=subprocess.PIPE, text=True, env=with_preload())
        line = self.process.stdout.readline()
        match = re.search(r"http://127\.0\.0\.1:(\d+)", line)
        if not match:
            raise RuntimeError(f"the server said: {line!r}")
        self.port = int(match.group(1))
        self.url = f"http://127.0.0.1:{self.port}"

    def ask(self, method, path, body=None, headers=None, timeout=120):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        if body is not None and not isinstance(body, (bytes, str)):
            body = json.dumps(body)
        connection.request(method, path, body, {**(JSON if body is not None else {}), **(headers or {})})
        response = connection.getresponse()
        data = response.read()
        connection.close()
        return response.status, dict(response.getheaders()), data

    def end_of(self, location, seconds=300):
        deadline = time.time() + seconds
        while time.time() < deadline:
            status, headers, body = self.ask("GET", location)
            job = json.loads(body)
            if job["state"] not in ("accepted", "running"):
                return job
            time.sleep(0.05)
        raise TimeoutError(location)

    def answer(self, path, request):
        status, headers, body = self.ask("POST", path, request, {"Prefer": "respond-async"})
        assert status == 201, (status, body[:2000])
        job = self.end_of(headers["Location"])
        assert job["state"] == "successful", job
        return self.ask("GET", headers["Location"] + "/result")[2]

    def worker_pids(self):
        """Of the processes that do the service's work."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            try:
                parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
                if parent == self.process.pid and b"worker" in command_line(entry.name):
                    found.append(int(entry.name))
            except (OSError, ValueError, IndexError):
                continue
        return found

    def processor_s(self):
        """Processor time that the service and its workers have used."""
        return self.service_s() + sum(map(processor_s_of, self.worker_pids()))

    def service_s(self):
        """The same of the service alone."""
        return processor_s_of(self.process.pid)

    def rss_mb(self, key):
        text = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(key + r":\s+(\d+) kB", text).group(1)) / 1024

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        self.process.stdout.close()

    def stop(self):
        self.process.terminate()
        status = self.process.wait(timeout=20)
        self.process.stdout.close()
        return status


class WithServer(unittest.TestCase):
    """Tests that share one server."""
    OPTIONS = ()

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.folder.name)
        cls.server = Server(folder, *cls.OPTIONS, data=cls.data(folder))

    @classmethod
    def data(cls, folder):
        """The data of the server; whoever makes them makes them in this folder."""
        return DATA

    @classmethod
    def tearDownClass(cls):
        status = cls.server.stop()
        cls.folder.cleanup()
        assert status == 0, f"the server ended with {status}"
