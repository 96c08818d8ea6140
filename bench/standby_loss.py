#!/usr/bin/env python3
"""A service on a PostgreSQL primary with a synchronous standby: the standby is lost for a while, then the primary for good.

usage: standby_loss.py SLIPWAY SOURCE_DIR [--jobs 1000] [--refusals 3]

While only the standby is lost, every submission must be refused with 503 and Retry-After within seconds, and asked for again
afterwards under its key be one job. When the primary and its data are destroyed in the midst of submissions and the standby is
promoted, service and workers go on by themselves: every job that was acknowledged must be there and end well, once.
"""
import argparse
import json
import pathlib
import shutil
import sys
import tempfile
import threading
import time

parser = argparse.ArgumentParser()
parser.add_argument("slipway")
parser.add_argument("source")
parser.add_argument("--jobs", type=int, default=1000)
parser.add_argument("--refusals", type=int, default=3, help="submissions while the standby is lost")
options = parser.parse_args()
sys.argv = [sys.argv[0], options.slipway, options.source]
for folder_of in ("contract", "postgres"):
    sys.path.insert(0, str(pathlib.Path(options.source) / "tests" / folder_of))
from running_service import STOP_967, Server  # noqa: E402
from postgres_server import PostgresServer, skip_without_server  # noqa: E402

MAX_REFUSAL_S = 9.0


def ask(server, number):
    """Status, headers and seconds of one submission under the number's key."""
    path = [STOP_967, {"x_m": STOP_967["x_m"] + 4.0 + number % 7, "y_m": STOP_967["y_m"] - 3.0}]
    request = {"terrain": "gale", "rover": "msl-class", "path": path, "draws": 8}
    began = time.time()
    status, headers, _ = server.ask("POST", "/v1/predictions", request,
                                    {"Prefer": "respond-async", "Idempotency-Key": f"job-{number}"})
    return status, headers, time.time() - began


def accept(server, number):
    while True:
        try:
            status, headers, _ = ask(server, number)
            if status == 201:
                return headers["Location"]
        except OSError:
            pass
        time.sleep(0.2)


def lose_standby(server, standby):
    """What was refused, and the longest refusal; the jobs of the keys afterwards."""
    standby.kill("crash")
    answers = [ask(server, number) for number in range(options.refusals)]
    refused = sum(status == 503 and "Retry-After" in headers for status, headers, _ in answers)
    standby.start()
    return refused, max(seconds for *_, seconds in answers), [accept(server, number) for number in range(options.refusals)]


def lose_primary(server, primary, standby, acknowledged):
    """Submits all jobs, destroys the primary in their midst; the seconds without a server that takes jobs."""
    def submit(numbers):
        for number in numbers:
            acknowledged[number] = accept(server, number)

    threads = [threading.Thread(target=submit, args=(range(options.refusals + k, options.jobs - 1, 4),)) for k in range(4)]
    for thread in threads:
        thread.start()
    while len(acknowledged) < options.jobs // 2:
        time.sleep(0.01)
    began = time.time()
    primary.kill("crash")
    shutil.rmtree(pathlib.Path(primary.folder) / "data")
    before = len(acknowledged)
    standby.promote()
    # One job was kept back: the others may all have been accepted before.
    acknowledged[options.jobs - 1] = accept(server, options.jobs - 1)
    silent_s = time.time() - began
    for thread in threads:
        thread.join()
    return before, silent_s


def main():
    skip_without_server()
    with tempfile.TemporaryDirectory() as folder, PostgresServer() as primary, PostgresServer(primary) as standby:
        both = f"postgresql://slipway@{primary.place},{standby.place}/slipway"
        server = Server(pathlib.Path(folder), "--jobs", both, "--lease-s", "5", "--most-jobs", "100000",
                        "--most-jobs-per-address", "100000", "--keep-jobs", "100000")
        refused, refusal_s, locations = lose_standby(server, standby)
        acknowledged = dict(enumerate(locations))
        before, silent_s = lose_primary(server, primary, standby, acknowledged)
        began = time.time()
        ends = []
        for location in acknowledged.values():
            try:
                ends.append(server.end_of(location, 600)["state"])
            except KeyError:
                ends.append("lost")
        kept = int(standby.query("SELECT count(*) FROM slipway_jobs"))
        server.stop()
    result = {"refused_with_503": refused, "longest_refusal_s": round(refusal_s, 1), "acknowledged": len(acknowledged),
              "acknowledged_before_the_loss": before, "seconds_without_a_primary": round(silent_s, 1), "lost": ends.count("lost"),
              "doubled": kept - len(acknowledged), "not_successful": len(ends) - ends.count("successful"),
              "ended_after_s": round(time.time() - began, 1)}
    print(json.dumps(result))
    good = refused == options.refusals and refusal_s < MAX_REFUSAL_S and kept == len(acknowledged) == options.jobs
    return 0 if good and ends.count("successful") == options.jobs else 1


if __name__ == "__main__":
    sys.exit(main())
