#!/usr/bin/env python3
"""How long one and two workers take for a batch on a PostgreSQL store, and whether its answers are the same.

usage: parts_scaling.py SLIPWAY SOURCE_DIR [--requests 40] [--draws 512] [--workers 1 2]
"""
import argparse
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile
import time

parser = argparse.ArgumentParser()
parser.add_argument("slipway")
parser.add_argument("source")
parser.add_argument("--requests", type=int, default=40)
parser.add_argument("--draws", type=int, default=512)
parser.add_argument("--workers", type=int, nargs="+", default=[1, 2])
options = parser.parse_args()
sys.argv = [sys.argv[0], options.slipway, options.source]
for folder_of in ("contract", "postgres"):
    sys.path.insert(0, str(pathlib.Path(options.source) / "tests" / folder_of))
from running_service import DATA, STOP_967, Server  # noqa: E402
from postgres_server import PostgresServer, skip_without_server  # noqa: E402


def main():
    skip_without_server()
    path = [STOP_967, {"x_m": STOP_967["x_m"] - 13.0, "y_m": STOP_967["y_m"] - 30.0}]
    batch = {"kind": "prediction", "requests": [{"terrain": "gale", "rover": "msl-class", "path": path, "draws": options.draws}],
             "seeds": {"first": 1, "count": options.requests}}
    answers = set()
    with tempfile.TemporaryDirectory() as folder, PostgresServer() as database:
        server = Server(pathlib.Path(folder), "--jobs", database.address, "--no-workers")
        for count in options.workers:
            status, headers, body = server.ask("POST", "/v1/batches", batch, {"Prefer": "respond-async"})
            assert status == 201, body
            began = time.time()
            # One core each, as in a cluster.
            workers = [subprocess.Popen(["taskset", "-c", str(k % 2), options.slipway, "worker", "--data", DATA, "--jobs",
                                         database.address, "--until-empty"]) for k in range(count)]
            job = server.end_of(headers["Location"], 1200)
            seconds = time.time() - began
            assert job["state"] == "successful", job
            for worker in workers:
                worker.wait()
            answers.add(hashlib.sha256(server.ask("GET", headers["Location"] + "/answers")[2]).hexdigest())
            print(json.dumps({"workers": count, "parts": job["parts"]["count"], "seconds": round(seconds, 1), "cpu_s": job["cpu_s"]}), flush=True)
        server.stop()
    print(json.dumps({"different_answers": len(answers)}))
    return 0 if len(answers) == 1 else 1


if __name__ == "__main__":
    sys.exit(main())
