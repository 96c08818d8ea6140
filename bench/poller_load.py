#!/usr/bin/env python3
"""Dashboards that poll: so many kept connections, each with so many requests a second with If-None-Match, while jobs run.

usage: poller_load.py SLIPWAY SOURCE_DIR [--pollers 1000] [--each-s 5] [--seconds 60] [--jobs 2]

The pollers are one Python process: its own time is in what it measures, and above some 5,000 requests a second it is what is slow.
"""
import argparse
import asyncio
import json
import pathlib
import sys
import tempfile
import time

parser = argparse.ArgumentParser()
parser.add_argument("slipway")
parser.add_argument("source")
parser.add_argument("--pollers", type=int, default=1000)
parser.add_argument("--each-s", type=float, default=5.0)
parser.add_argument("--seconds", type=float, default=60.0)
parser.add_argument("--jobs", type=int, default=2)
options = parser.parse_args()
sys.argv = [sys.argv[0], options.slipway, options.source]
sys.path.insert(0, str(pathlib.Path(options.source) / "tests" / "contract"))
from running_service import Server, plan  # noqa: E402


class Poller(asyncio.Protocol):
    def __init__(self, request):
        self.request, self.taken_s, self.errors, self.sent_at = request, [], 0, None

    def connection_made(self, transport):
        self.transport = transport

    def ask(self):
        if self.sent_at is None:
            self.sent_at = time.perf_counter()
            self.transport.write(self.request)

    def data_received(self, data):
        if b"\r\n\r\n" not in data or self.sent_at is None:
            return
        self.taken_s.append(time.perf_counter() - self.sent_at)
        self.errors += not data.startswith((b"HTTP/1.1 200", b"HTTP/1.1 304"))
        self.sent_at = None

    def connection_lost(self, error):
        self.errors += self.sent_at is not None
        self.sent_at = 0.0


async def load(port, path, tag):
    loop = asyncio.get_running_loop()
    request = f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nIf-None-Match: {tag}\r\n\r\n".encode()
    pollers = [(await loop.create_connection(lambda: Poller(request), "127.0.0.1", port))[1] for _ in range(options.pollers)]
    interval, began = 1.0 / options.each_s, loop.time()

    def again(poller, turn):
        if loop.time() - began >= options.seconds:
            return
        poller.ask()
        loop.call_at(began + (turn + 1) * interval + offsets[poller], again, poller, turn + 1)

    offsets = {poller: interval * k / len(pollers) for k, poller in enumerate(pollers)}
    for poller in pollers:
        loop.call_at(began + offsets[poller], again, poller, 0)
    await asyncio.sleep(options.seconds + 1.0)
    taken = sorted(t for poller in pollers for t in poller.taken_s)
    return taken, sum(poller.errors for poller in pollers)


def main():
    with tempfile.TemporaryDirectory() as folder:
        server = Server(pathlib.Path(folder))
        locations = [server.ask("POST", "/v1/plans", plan(draws=1000, seed=k), {"Prefer": "respond-async"})[1]["Location"]
                     for k in range(max(1, options.jobs))]
        tag = server.ask("GET", locations[0])[1]["ETag"]
        taken, errors = asyncio.run(load(server.port, locations[0], tag))
        print(json.dumps({"pollers": options.pollers, "answered": len(taken), "per_s": round(len(taken) / options.seconds), "errors": errors,
                          "p50_ms": round(1e3 * taken[len(taken) // 2], 2), "p99_ms": round(1e3 * taken[int(0.99 * len(taken))], 2),
                          "longest_ms": round(1e3 * taken[-1], 1), "service_mb": round(server.rss_mb("VmHWM"), 1)}))
        server.stop()


if __name__ == "__main__":
    main()
