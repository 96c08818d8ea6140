#!/usr/bin/env python3
"""The Debian packages on an empty Debian 12: installed, started, used, upgraded from a lower number with a store of an older
schema and jobs in it, removed, purged.

usage: package_test.py SOURCE_FOLDER BUILD_FOLDER        needs root, mmdebstrap and Debian's package sources
"""
import json
import os
import pathlib
import shutil
import socket
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request

SOURCE, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    PORT = free.getsockname()[1]
SKIPPED = 77
STORE = "var/lib/slipway/jobs.sqlite"
# What the schema of version 4 has and that of version 3 had not.
OF_VERSION_4 = ["cpu_s", "whole", "part", "parts", "parts_ended", "parts_failed", "parts_cpu_s"]
CHECK = {"terrain": "gale", "rover": "msl-class", "path": [{"x_m": 8142640, "y_m": -276640}, {"x_m": 8142630, "y_m": -276641}], "draws": 4}
PLAN = {"terrain": "gale", "rover": "msl-class", "start": {"x_m": 8142640, "y_m": -276640}, "goal": {"x_m": 8142600, "y_m": -276645}}


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    if done.returncode:
        raise AssertionError(f"{command} ended with {done.returncode}\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def sources():
    places = ("/etc/apt/sources.list.d/debian.sources", "/etc/apt/sources.list")
    return next(place for place in places if os.path.exists(place))


class Packages(unittest.TestCase):
    service = None

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="slipway-package-"))
        cls.root = cls.folder / "root"
        run("mmdebstrap", "--variant=apt", "--include=ca-certificates", "bookworm", cls.root, sources())
        # This machine's ways to Debian's packages are the root's.
        shutil.copytree("/etc/apt", cls.root / "etc/apt", dirs_exist_ok=True)
        shutil.copy("/etc/resolv.conf", cls.root / "etc/resolv.conf")
        for revision in ("1", "2"):
            run("sh", SOURCE / "deploy/package.sh", revision, env={**os.environ, "BUILD": str(BUILD)})
        debs = cls.root / "tmp/debs"
        debs.mkdir()
        for deb in (SOURCE / "build/packages").glob("*.deb"):
            shutil.copy(deb, debs)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def inside(self, *command):
        """Runs a command in the root as its administrator, with /proc and /dev as a machine has them."""
        mounts = 'mount -t proc proc "$0/proc"; mount --bind /dev "$0/dev"; root="$0"; exec chroot "$root" "$@"'
        return run("unshare", "-m", "sh", "-ec", mounts, self.root, *command)

    def apt(self, *command):
        return self.inside("env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-q", "-y", "--no-install-recommends", *command)

    def install(self, revision):
        debs = sorted((self.root / "tmp/debs").glob(f"*-{revision}_*.deb"))
        self.assertEqual(len(debs), 2, debs)
        self.apt("install", *(f"/tmp/debs/{deb.name}" for deb in debs))

    def start(self):
        mounts = 'mount -t proc proc "$0/proc"; mount --bind /dev "$0/dev"; exec chroot --userspec=slipway:slipway "$0" "$@"'
        self.log = open(self.folder / "service.log", "ab")
        self.service = subprocess.Popen(
            ["unshare", "-m", "sh", "-ec", mounts, str(self.root), "/usr/bin/slipway", "serve", "--config", "/etc/slipway/slipway.toml",
             "--port", str(PORT)], stdout=self.log, stderr=self.log)
        for _ in range(300):
            try:
                if self.ask("GET", "/readyz")[0] == 200:
                    return
            except OSError:
                pass
            self.assertIsNone(self.service.poll(), (self.folder / "service.log").read_text()[-3000:])
            time.sleep(0.1)
        self.fail("the service does not answer")

    def tearDown(self):
        if self.service is not None and self.service.poll() is None:
            self.service.kill()

    def stop(self):
        self.service.terminate()
        self.assertEqual(self.service.wait(30), 0, (self.folder / "service.log").read_text()[-3000:])
        self.log.close()

    @staticmethod
    def ask(method, path, document=None, wait=False):
        headers = {"Content-Type": "application/json", "Prefer": "wait=30" if wait else "respond-async"}
        body = None if document is None else json.dumps(document).encode()
        request = urllib.request.Request(f"http://127.0.0.1:{PORT}{path}", body, headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as refused:
            return refused.code, refused.headers, refused.read()

    def test_a_package_is_installed_used_upgraded_removed_and_purged(self):
        self.apt("update")
        self.install(1)
        self.assertIn("slipway:", self.inside("getent", "passwd", "slipway"))
        self.assertIn("can be used", self.inside("slipway", "data", "check"))
        self.start()
        status, headers, first = self.ask("POST", "/v1/checks", CHECK, wait=True)
        self.assertEqual(status, 200, first[:500])
        answered = headers["Content-Location"]
        status, headers, _ = self.ask("POST", "/v1/plans", PLAN)
        self.assertEqual(status, 201)
        waiting = headers["Location"]
        self.stop()
        # As an older program left it.
        store = sqlite3.connect(self.root / STORE)
        store.executescript("DROP INDEX jobs_parts; DROP TRIGGER parts_go;" + "".join(f"ALTER TABLE jobs DROP COLUMN {c};" for c in OF_VERSION_4)
                            + "PRAGMA user_version = 3;")
        store.close()
        config = self.root / "etc/slipway/slipway.toml"
        config.write_text(config.read_text() + "keep-days = 30\n")
        self.install(2)
        self.assertIn("keep-days = 30", config.read_text(), "an upgrade keeps what was changed")
        self.start()
        status, _, kept = self.ask("GET", answered)
        self.assertEqual((status, kept), (200, first), "answers of the older schema are the same bytes")
        self.assertTrue(list((self.root / "var/lib/slipway").glob("jobs.sqlite.version-3*")), "the older store was copied")
        self.assertEqual(self.ask("POST", "/v1/checks", CHECK, wait=True)[2], first)
        for _ in range(600):
            state = json.loads(self.ask("GET", waiting)[2])["state"]
            if state not in ("accepted", "running"):
                break
            time.sleep(0.2)
        self.assertEqual(state, "successful", "what was accepted before the upgrade is done after it")
        self.stop()
        self.apt("remove", "slipway-service", "slipway")
        self.assertFalse((self.root / "usr/bin/slipway").exists())
        self.assertTrue((self.root / STORE).exists(), "what was answered is kept")
        self.assertTrue(config.exists())
        self.apt("purge", "slipway-service", "slipway")
        self.assertFalse((self.root / "var/lib/slipway").exists())
        self.assertFalse((self.root / "etc/slipway").exists())
        self.assertEqual(self.inside("sh", "-c", "getent passwd slipway || true"), "")
        left = run("find", ".", "-xdev", "-path", "./*slipway*", "-not", "-path", "./tmp/*", cwd=self.root).split()
        self.assertEqual(left, [], "nothing is left")


if __name__ == "__main__":
    if os.geteuid() != 0 or shutil.which("mmdebstrap") is None:
        print("skipped: needs root and mmdebstrap")
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1], verbosity=2)
