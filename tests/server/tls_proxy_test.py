#!/usr/bin/env python3
"""The shipped nginx example in front of a running service: TLS, names, tokens.

usage: tls_proxy_test.py SLIPWAY SOURCE_DIR
"""
import pathlib
import shutil
import socket
import ssl
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "contract"))
from running_service import SLIPWAY, SOURCE, Server  # noqa: E402

sys.path.insert(0, str(SOURCE / "clients" / "python"))
import slipway_client  # noqa: E402

NGINX = shutil.which("nginx", path="/usr/sbin:/usr/bin:/sbin:/bin")


def free_port():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


class TlsProxy(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(self.folder.name)
        made = subprocess.run([SLIPWAY, "token", "ann"], capture_output=True, text=True, check=True)
        self.token = made.stderr.splitlines()[-1]
        (folder / "tokens.toml").write_text(made.stdout)
        self.server = Server(folder, "--tokens", str(folder / "tokens.toml"), "--allow-host", "rover-server", "--max-connections-per-address", "0")
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", "-subj", "/CN=localhost",
                        "-addext", "subjectAltName=DNS:localhost,DNS:rover-server", "-keyout", str(folder / "key.pem"), "-out", str(folder / "cert.pem")],
                       check=True, capture_output=True)
        self.port = free_port()
        site = (SOURCE / "deploy" / "nginx" / "slipway.conf").read_text()
        for placeholder, value in (("127.0.0.1:8080", f"127.0.0.1:{self.server.port}"), ("listen 443", f"listen 127.0.0.1:{self.port}"),
                                   ("SERVER_NAME;", "rover-server localhost;"), ("CERTIFICATE_FILE", str(folder / "cert.pem")),
                                   ("KEY_FILE", str(folder / "key.pem"))):
            self.assertIn(placeholder, site)
            site = site.replace(placeholder, value)
        (folder / "site.conf").write_text(site)
        (folder / "nginx.conf").write_text(f"daemon off; pid {folder}/nginx.pid; error_log stderr; events {{}}\n"
                                           f"http {{ access_log off; client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy;\n"
                                           f"fastcgi_temp_path {folder}/f; uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s; include {folder}/site.conf; }}\n")
        folder.chmod(0o755)
        self.nginx = subprocess.Popen([NGINX, "-p", str(folder), "-c", str(folder / "nginx.conf"), "-e", "stderr"])
        deadline = time.time() + 20
        while time.time() < deadline:
            try:
                socket.create_connection(("127.0.0.1", self.port), timeout=1).close()
                break
            except OSError:
                time.sleep(0.05)
        self.trusted = ssl.create_default_context(cafile=str(folder / "cert.pem"))

    def tearDown(self):
        self.nginx.terminate()
        self.nginx.wait(timeout=20)
        self.server.stop()
        self.folder.cleanup()

    def client(self, token):
        client = slipway_client.Slipway(f"https://localhost:{self.port}", token=token, patience_s=0)
        connect = client._connection_type
        client._connection_type = lambda host, port, timeout: connect(host, port, timeout=timeout, context=self.trusted)
        return client

    def test_a_service_behind_tls_is_asked_with_a_token(self):
        self.assertIn("gale", [terrain["name"] for terrain in self.client(self.token).terrains()])
        with self.assertRaises(slipway_client.SlipwayError) as refused:
            self.client(None).terrains()
        self.assertEqual(refused.exception.status, 401)
        _, headers, _ = self.client(None).request("GET", "/healthz")
        self.assertIn("strict-transport-security", headers)
        self.assertTrue(headers["x-request-id"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
