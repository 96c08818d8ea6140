#!/usr/bin/env python3
"""Pilots in a real Slurm cluster of two nodes: a batch is done once, and with the bytes of one worker, though a node is lost with
jobs in hand and the controller is killed just after it accepted more pilots.

usage: pilots_test.py SLIPWAY SOURCE_DIR [--requests 60]
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

parser = argparse.ArgumentParser()
parser.add_argument("slipway")
parser.add_argument("source")
parser.add_argument("--requests", type=int, default=60)
options = parser.parse_args()
source = pathlib.Path(options.source)
sys.argv = [sys.argv[0], options.slipway, options.source]
for beside in ("contract", "postgres"):
    sys.path.insert(0, str(source / "tests" / beside))
from running_service import DATA, STOP_967, Server  # noqa: E402
from postgres_server import PostgresServer, skip_without_server  # noqa: E402

CLUSTER = str(source / "tests" / "slurm" / "cluster.sh")
PILOT = source / "deploy" / "slurm"


def request():
    path = [STOP_967, {"x_m": STOP_967["x_m"] + 8.0, "y_m": STOP_967["y_m"] - 6.0}]
    return {"kind": "prediction", "requests": [{"terrain": "gale", "rover": "msl-class", "path": path, "draws": 64}],
            "seeds": {"first": 1, "count": options.requests}}


def submit(server):
    status, headers, body = server.ask("POST", "/v1/batches", request(), {"Prefer": "respond-async"})
    assert status == 201, body
    return headers["Location"]


def main():
    if subprocess.run([CLUSTER, "available"]).returncode != 0:
        print("SKIPPED pilots_test.py: needs root, slurmctld, slurmd, slurm-client and munge")
        return 77
    skip_without_server()
    with tempfile.TemporaryDirectory() as folder, PostgresServer() as database:
        cluster = tempfile.mkdtemp(prefix="slipway-slurm-", dir="/tmp")
        server = Server(pathlib.Path(folder), "--jobs", database.address, "--no-workers")
        worker = [options.slipway, "worker", "--data", DATA, "--jobs", database.address, "--until-empty"]
        alone = submit(server)
        subprocess.run(worker, check=True)
        subprocess.run([CLUSTER, "start", cluster, "2", "2"], check=True)
        environment = {**os.environ, "SLURM_CONF": cluster + "/slurm.conf", "SLIPWAY": str(pathlib.Path(options.slipway).resolve()),
                       "SLIPWAY_JOBS": database.address, "SLIPWAY_WORKER_OPTIONS": f"--data {DATA} --lease-s 10"}
        began = time.time()
        location = submit(server)
        top_up = subprocess.Popen([str(PILOT / "top_up.sh"), "-n", "4", "-s", "1", "--", "--chdir", cluster], env=environment)
        try:
            state = lambda: json.loads(server.ask("GET", location)[2])
            while state().get("parts", {}).get("ended", 0) < options.requests // 5:
                time.sleep(0.1)
            subprocess.run([CLUSTER, "lose_node", cluster, "n2"], check=True)
            name = subprocess.run(["squeue", "-h", "-o", "%j"], env=environment, capture_output=True, text=True).stdout.split()[0]
            subprocess.run(["sbatch", "--parsable", "-J", name, "--array=0-3", "--chdir", cluster, str(PILOT / "pilot.sh")], env=environment, check=True)
            subprocess.run([CLUSTER, "lose_controller", cluster], check=True)
            job = server.end_of(location, 240)
            seconds = time.time() - began
            ended = top_up.wait(timeout=60)
        finally:
            top_up.kill()
            top_up.wait()
            subprocess.run([CLUSTER, "stop", cluster])
        same = server.ask("GET", location + "/answers")[2] == server.ask("GET", alone + "/answers")[2]
        deaths = database.query("SELECT sum(deaths) FROM slipway_jobs")
        workers = database.query(f"SELECT count(DISTINCT worker) FROM slipway_jobs WHERE whole = '{location.split('/')[-1]}'")
        server.stop()
    print(json.dumps({"parts": job["parts"], "state": job["state"], "same_bytes_as_one_worker": same, "lost_with_the_node": int(deaths),
                      "pilots_that_worked": int(workers), "seconds": round(seconds, 1), "cpu_s": job["cpu_s"]}))
    good = job["state"] == "successful" and job["parts"] == {"count": options.requests, "ended": options.requests, "failed": 0}
    return 0 if good and same and ended == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
