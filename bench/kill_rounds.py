#!/usr/bin/env python3
"""Rounds of jobs during which the service or one of its workers is killed; counts what was lost, doubled or failed.

usage: kill_rounds.py SLIPWAY SOURCE_DIR [--rounds 50] [--jobs 20] [--seed 1]
"""
import argparse
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
options = parser.parse_args()
sys.argv = [sys.argv[0], options.slipway, options.source]
sys.path.insert(0, str(pathlib.Path(options.source) / "tests" / "contract"))
from running_service import STOP_967, Server  # noqa: E402


def request(k):
    path = [STOP_967, {"x_m": STOP_967["x_m"] + 4.0 + k, "y_m": STOP_967["y_m"] - 3.0}]
    return {"terrain": "gale", "rover": "msl-class", "path": path, "draws": 64, "seed": k}


def strike(server, chance):
    """Kills the service, a worker, or all workers. Whether the service must be started again."""
    what = chance.choice(("service", "worker", "workers"))
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


def main():
    chance = random.Random(options.seed)
    lost = altered = failed = late = restarts = 0
    expected = {}
    slowest = 0.0
    with tempfile.TemporaryDirectory() as folder:
        server = Server(pathlib.Path(folder))
        for number in range(options.rounds):
            accepted = []
            for k in range(options.jobs):
                status, headers, _ = server.ask("POST", "/v1/predictions", request(k), {"Prefer": "respond-async"})
                if status == 201:
                    accepted.append((k, headers["Location"]))
                time.sleep(chance.uniform(0.0, 0.05))
            time.sleep(chance.uniform(0.0, 1.0))
            if strike(server, chance):
                restarts += 1
                server = Server(pathlib.Path(folder))
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
        server.stop()
    print(json.dumps({"rounds": options.rounds, "restarts": restarts, "lost": lost, "late": late, "failed": failed,
                      "altered": altered, "slowest_s": round(slowest, 1)}))
    return 0 if lost + altered + failed + late == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
