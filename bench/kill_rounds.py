#!/usr/bin/env python3
"""Rounds of jobs during which the service, its workers or its database are killed; counts what was lost, doubled or failed.

usage: kill_rounds.py SLIPWAY SOURCE_DIR [--rounds 50] [--jobs 20] [--seed 1] [--postgresql]

With --postgresql the jobs are in a database server that the script starts, and whose postmaster is killed too.
"""
import argparse
import contextlib
import json
import os
import pathlib
import random
import signal
import sys
import tempfile
import time

parser = argparse.ArgumentParser()
parser.add_argument("slipway")
parser.add_argument("source")
parser.add_argument("--rounds", type=int, default=50)
parser.add_argument("--jobs", type=int, default=20)
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--postgresql", action="store_true")
options = parser.parse_args()
sys.argv = [sys.argv[0], options.slipway, options.source]
sys.path.insert(0, str(pathlib.Path(options.source) / "tests" / "contract"))
sys.path.insert(0, str(pathlib.Path(options.source) / "tests" / "postgres"))
from running_service import STOP_967, Server  # noqa: E402
from postgres_server import PostgresServer, skip_without_server  # noqa: E402


def request(k):
    path = [STOP_967, {"x_m": STOP_967["x_m"] + 4.0 + k, "y_m": STOP_967["y_m"] - 3.0}]
    return {"terrain": "gale", "rover": "msl-class", "path": path, "draws": 64, "seed": k}


def strike(server, database, chance):
    """Kills the service, a worker, all workers or the database. Whether the service must be started again."""
    what = chance.choice(("service", "worker", "workers") + (("database",) * 2 if database else ()))
    if what == "database":
        database.kill()
        time.sleep(chance.uniform(0.0, 2.0))
        database.start()
        return False
    if what == "service":
        server.kill()
        return True
    workers = server.worker_pids()
    for pid in chance.sample(workers, 1 if what == "worker" and workers else len(workers)):
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
    return False


def accept(server, k, key):
    """The job's place, asked for again and again under one key until the service has accepted it."""
    while True:
        try:
            status, headers, _ = server.ask("POST", "/v1/predictions", request(k), {"Prefer": "respond-async", "Idempotency-Key": key})
        except OSError:
            continue
        if status == 201:
            return headers["Location"]
        time.sleep(0.2)


def main():
    if options.postgresql:
        skip_without_server()
    chance = random.Random(options.seed)
    lost = altered = failed = late = doubled = restarts = 0
    expected = {}
    slowest = 0.0
    with contextlib.ExitStack() as held:
        folder = held.enter_context(tempfile.TemporaryDirectory())
        database = held.enter_context(PostgresServer()) if options.postgresql else None
        store = ["--jobs", database.address, "--lease-s", "5"] if database else []
        server = Server(pathlib.Path(folder), *store)
        for number in range(options.rounds):
            accepted = []
            struck_at = chance.randrange(options.jobs)
            for k in range(options.jobs):
                accepted.append((k, accept(server, k, f"{number}-{k}")))
                time.sleep(chance.uniform(0.0, 0.05))
                if k == struck_at and strike(server, database, chance):
                    restarts += 1
                    server = Server(pathlib.Path(folder), *store)
            doubled += len({location for _, location in accepted}) != len(accepted)
            began = time.time()
            for k, location in accepted:
                try:
                    job = server.end_of(location, 60 - (time.time() - began))
                except TimeoutError:
                    late += 1
                    continue
                except (KeyError, ValueError):
                    lost += 1
                    continue
                failed += job["state"] != "successful"
                answer = server.ask("GET", location + "/result")[2]
                altered += expected.setdefault(k, answer) != answer
            slowest = max(slowest, time.time() - began)
            print(f"round {number + 1}: {len(accepted)} accepted, all ended after {time.time() - began:.1f} s", flush=True)
        if database:
            kept = int(database.query("SELECT count(*) FROM slipway_jobs"))
            doubled += max(kept - options.rounds * options.jobs, 0)
            lost += max(options.rounds * options.jobs - kept, 0)
        server.stop()
    print(json.dumps({"rounds": options.rounds, "restarts": restarts, "lost": lost, "doubled": doubled, "late": late, "failed": failed,
                      "altered": altered, "slowest_s": round(slowest, 1)}))
    return 0 if lost + doubled + altered + failed + late == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
