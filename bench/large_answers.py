#!/usr/bin/env python3
"""What the largest legal prediction costs the service: memory, time, and how long others wait meanwhile.

usage: large_answers.py SLIPWAY SOURCE_DIR
"""
import json
import pathlib
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(sys.argv[2]) / "tests" / "contract"))
from running_service import STOP_967, Server  # noqa: E402

READERS = 16


def at_once(server, location, address):
    """So many readers of one address; the longest that a poll of the job took meanwhile."""
    sizes, before, began = set(), server.rss_mb("VmRSS"), time.time()
    readers = [threading.Thread(target=lambda: sizes.add(len(server.ask("GET", location + address)[2]))) for _ in range(READERS)]
    for reader in readers:
        reader.start()
    longest_s = 0.0
    while any(reader.is_alive() for reader in readers):
        asked = time.time()
        server.ask("GET", location)
        longest_s = max(longest_s, time.time() - asked)
        time.sleep(0.01)
    return {"address": address, "readers": READERS, "bytes": max(sizes), "seconds": round(time.time() - began, 2),
            "longest_poll_ms": round(1e3 * longest_s, 1), "mb_on_top": round(server.rss_mb("VmHWM") - before, 1)}


def main():
    corners = [{"x_m": STOP_967["x_m"] + (9.9 if k % 2 else 0.0), "y_m": STOP_967["y_m"] - 0.02 * k} for k in range(2000)]
    request = {"terrain": "gale", "rover": "msl-class", "path": corners, "draws": 2}
    with tempfile.TemporaryDirectory() as folder:
        server = Server(pathlib.Path(folder))
        began = time.time()
        location = server.ask("POST", "/v1/predictions", request, {"Prefer": "respond-async"})[1]["Location"]
        assert server.end_of(location)["state"] == "successful"
        print(json.dumps({"request_bytes": len(json.dumps(request)), "job_s": round(time.time() - began, 1)}))
        for address in ("/map", "/result", "/stations?page=1"):
            print(json.dumps(at_once(server, location, address)))
        server.stop()


if __name__ == "__main__":
    main()
