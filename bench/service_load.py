#!/usr/bin/env python3
"""The service among rude, many and busy clients. Prints one JSON line for each part; status 1 where one misses what it must hold.

usage: service_load.py SLIPWAY SOURCE_DIR [--closed-loop PROGRAM] [PART ...]

parts (all where none is named):
  crowds       200 connections that send a head slowly, 200 that send a body slowly, 200 that say nothing and 200 that idle between
               two requests, from one address and then from many: others are answered within 50 ms (p99), nobody is locked out,
               408 comes within 6 s for heads and bodies
  streams      100 event streams whose clients vanish: under 5 % of a core afterwards
  submitters   32 clients that submit for 60 s: 150 accepted a second, or refused with Retry-After; every 201 has its row
  closed_loop  64 connections that ask again at once, without jobs: 20,000 requests a second (PROGRAM: build/.../bench/closed_loop)
  mixed        10 minutes of pollers, submitters, streams that come and go, large answers, rude clients: memory and descriptors flat
"""
import argparse
import asyncio
import json
import os
import pathlib
import random
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time

parser = argparse.ArgumentParser()
parser.add_argument("slipway")
parser.add_argument("source")
parser.add_argument("parts", nargs="*")
parser.add_argument("--closed-loop")
parser.add_argument("--crowd", type=int, default=200)
parser.add_argument("--submit-s", type=float, default=60.0)
parser.add_argument("--mixed-s", type=float, default=600.0)
options = parser.parse_args()
sys.argv = [sys.argv[0], options.slipway, options.source]
sys.path.insert(0, str(pathlib.Path(options.source) / "tests" / "contract"))
from running_service import STOP_967, Server, plan  # noqa: E402

ASYNC = {"Prefer": "respond-async"}
HEAD = b"POST /v1/plans HTTP/1.1\r\nHost: 127.0.0.1\r\n"
WITH_BODY = HEAD + b"Content-Type: application/json\r\nContent-Length: 100000\r\n\r\n"
GET = b"GET /v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"


def prediction(seed=1):
    path = [STOP_967, {"x_m": STOP_967["x_m"] + 4.0, "y_m": STOP_967["y_m"] - 3.0}]
    return {"terrain": "gale", "rover": "msl-class", "path": path, "draws": 2, "seed": seed}


def descriptors(server):
    return len(os.listdir(f"/proc/{server.process.pid}/fd"))


def share_of(times, share):
    return sorted(times)[min(int(share * len(times)), len(times) - 1)] if times else float("inf")


async def connect(port, many=None):
    """A connection, from the loopback address of this number where one is given."""
    source = None if many is None else (f"127.1.{many // 250}.{1 + many % 250}", 0)
    return await asyncio.open_connection("127.0.0.1", port, local_addr=source)


async def answer_of(reader):
    """Status, headers and body of one answer."""
    head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1")
    status, headers = int(head.split(" ", 2)[1]), {}
    for line in head.split("\r\n")[1:]:
        name, _, value = line.partition(": ")
        headers[name.lower()] = value
    length = 0 if status == 304 else int(headers.get("content-length", 0))
    return status, headers, await reader.readexactly(length) if length else b""


async def slow(port, many, first, drip, statuses):
    """Sends the first bytes, then one byte each half second; how long it took until it was refused."""
    try:
        reader, writer = await connect(port, many)
        began = time.perf_counter()
        writer.write(first)

        async def go_on():
            while True:
                await asyncio.sleep(0.5)
                writer.write(drip)
                await writer.drain()

        dripping = asyncio.ensure_future(go_on())
        try:
            status = (await asyncio.wait_for(answer_of(reader), 20))[0]
        finally:
            dripping.cancel()
        statuses.append((status, time.perf_counter() - began))
        writer.close()
    except (OSError, asyncio.IncompleteReadError, asyncio.TimeoutError) as error:
        statuses.append((type(error).__name__, float("inf")))


async def silent(port, many, seconds):
    try:
        _, writer = await connect(port, many)
        await asyncio.sleep(seconds)
        writer.close()
    except OSError:
        pass


async def idle(port, many, seconds, outcome):
    """Asks, says nothing for a while, and asks again on the same connection."""
    try:
        reader, writer = await connect(port, many)
        for pause in (seconds, 0):
            writer.write(GET)
            outcome.append((await answer_of(reader))[0])
            await asyncio.sleep(pause)
        writer.close()
    except (OSError, asyncio.IncompleteReadError) as error:
        outcome.append(type(error).__name__)


async def others(port, until, taken, failed):
    """A client that behaves, with a new connection for every tenth request."""
    reader = writer = None
    asked = 0
    while time.perf_counter() < until:
        try:
            began = time.perf_counter()
            if reader is None or asked % 10 == 0:
                if writer:
                    writer.close()
                reader, writer = await connect(port)
            writer.write(GET)
            status = (await answer_of(reader))[0]
            asked += 1
            taken.append(time.perf_counter() - began)
            if status != 200:
                failed.append(status)
        except (OSError, asyncio.IncompleteReadError) as error:
            failed.append(type(error).__name__)
            reader = None
        await asyncio.sleep(0.02)


async def crowd(port, from_many):
    count, heads, bodies, idles, taken, failed = options.crowd, [], [], [], [], []
    number = (lambda k: k) if from_many else (lambda k: None)
    until = time.perf_counter() + 12.0
    rude = [slow(port, number(k), HEAD, b"X", heads) for k in range(count)]
    rude += [slow(port, number(count + k), WITH_BODY, b" ", bodies) for k in range(count)]
    rude += [silent(port, number(2 * count + k), 12.0) for k in range(count)]
    rude += [idle(port, number(3 * count + k), 8.0, idles) for k in range(count)]
    await asyncio.gather(*rude, *(others(port, until, taken, failed) for _ in range(4)))
    timeouts = heads + bodies
    result = {"part": "crowds", "from": "many addresses" if from_many else "one address", "each": count,
              "answers_408": sum(status == 408 for status, _ in timeouts), "of": len(timeouts),
              "slowest_408_of_heads_s": round(max(seconds for _, seconds in heads), 2),
              "slowest_408_of_bodies_s": round(max(seconds for _, seconds in bodies), 2),
              "idle_answers": sum(status == 200 for status in idles), "others": len(taken), "others_failed": len(failed),
              "others_p50_ms": round(1e3 * share_of(taken, 0.5), 1), "others_p99_ms": round(1e3 * share_of(taken, 0.99), 1)}
    good = (result["answers_408"] == 2 * count and max(seconds for _, seconds in timeouts) <= 6.0 and not failed and
            result["idle_answers"] == 2 * count and result["others_p99_ms"] < 50.0)
    return result, good


def crowds(server):
    for from_many in (False, True):
        yield asyncio.run(crowd(server.port, from_many))


async def open_stream(port, location):
    reader, writer = await connect(port)
    writer.write(f"GET {location}/events HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
    await reader.readuntil(b"\r\n\r\n")
    await reader.readuntil(b"\n\n")
    return writer


def streams(server):
    # A job that moves all the time, so that every event would have to be written to somebody who is gone.
    location = server.ask("POST", "/v1/plans", plan(draws=1000), ASYNC)[1]["Location"]

    async def vanish():
        writers = await asyncio.gather(*(open_stream(server.port, location) for _ in range(100)))
        await asyncio.sleep(1.0)
        for writer in writers:
            writer.transport.abort()

    before = descriptors(server)
    asyncio.run(vanish())
    time.sleep(2.0)
    began, spent = time.time(), server.service_s()
    time.sleep(5.0)
    share = (server.service_s() - spent) / (time.time() - began)
    state = json.loads(server.ask("GET", location)[2])["state"]
    server.ask("DELETE", location)
    result = {"part": "streams", "streams": 100, "job": state, "cpu_percent": round(100 * share, 1), "descriptors_left": descriptors(server) - before}
    yield result, share < 0.05 and result["descriptors_left"] <= 2


async def submitter(port, until, seed, outcome):
    reader, writer = await connect(port)
    while time.perf_counter() < until:
        seed += 1
        body = json.dumps(prediction(seed)).encode()
        writer.write(b"POST /v1/predictions HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nPrefer: respond-async\r\n"
                     b"Content-Length: %d\r\n\r\n" % len(body) + body)
        status, headers, _ = await answer_of(reader)
        if status == 201:
            outcome["accepted"].append(headers["location"].rsplit("/", 1)[1])
        elif status in (429, 503) and "retry-after" in headers:
            outcome["refused"] += 1
            await asyncio.sleep(0.2)
        else:
            outcome["other"].append(status)
        if headers.get("connection") == "close":
            writer.close()
            reader, writer = await connect(port)


def submitters(_):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        # Without workers, so that what is measured is acceptance.
        server = Server(folder, "--jobs", str(folder / "jobs.sqlite"), "--no-workers", "--most-jobs", "1000000",
                        "--most-jobs-per-address", "1000000", "--keep-jobs", "1000000")
        outcome = {"accepted": [], "refused": 0, "other": []}

        async def all_of_them():
            until = time.perf_counter() + options.submit_s
            await asyncio.gather(*(submitter(server.port, until, 1_000_000 * k, outcome) for k in range(32)))

        asyncio.run(all_of_them())
        memory = server.rss_mb("VmHWM")
        server.stop()
        with sqlite3.connect(folder / "jobs.sqlite") as store:
            kept = {row[0] for row in store.execute("SELECT id FROM jobs")}
        missing = len(set(outcome["accepted"]) - kept)
        result = {"part": "submitters", "clients": 32, "seconds": options.submit_s, "accepted": len(outcome["accepted"]),
                  "accepted_per_s": round(len(outcome["accepted"]) / options.submit_s), "refused_with_retry_after": outcome["refused"],
                  "other_answers": len(outcome["other"]), "without_row": missing, "rows": len(kept), "service_mb": round(memory, 1)}
        enough = result["accepted_per_s"] >= 150 or outcome["refused"] > 0
        yield result, enough and missing == 0 and not outcome["other"] and len(kept) == len(outcome["accepted"])


def closed_loop(server):
    if not options.closed_loop:
        print(json.dumps({"part": "closed_loop", "skipped": "give --closed-loop PROGRAM"}))
        return
    location = server.ask("POST", "/v1/predictions", prediction(), ASYNC)[1]["Location"]
    server.end_of(location)
    tag = server.ask("GET", location)[1]["ETag"]
    spent = server.service_s()
    done = subprocess.run([options.closed_loop, str(server.port), location, tag, "64", "10"], capture_output=True, text=True)
    result = {"part": "closed_loop", **json.loads(done.stdout)}
    result["service_us_each"] = round(1e6 * (server.service_s() - spent) / result["answered"], 1)
    yield result, done.returncode == 0 and result["per_s"] >= 20_000


async def mixture(server, seconds, samples):
    until, chance = time.perf_counter() + seconds, random.Random(1)
    taken, failed, statuses = [], [], []
    outcome = {"accepted": [], "refused": 0, "other": []}
    long_one = server.ask("POST", "/v1/predictions", prediction(), ASYNC)[1]["Location"]

    async def come_and_go():
        while time.perf_counter() < until:
            writer = None
            try:
                writer = await open_stream(server.port, long_one)
            except (OSError, asyncio.IncompleteReadError):
                pass
            await asyncio.sleep(chance.uniform(0.1, 1.0))
            if writer:
                writer.transport.abort()

    async def rude():
        while time.perf_counter() < until:
            await asyncio.gather(*(slow(server.port, None, chance.choice((HEAD, WITH_BODY)), b"x", statuses) for _ in range(10)))

    async def slow_submitter(k):
        while time.perf_counter() < until:
            await submitter(server.port, time.perf_counter() + 0.01, 1_000_000 * k + len(outcome["accepted"]), outcome)
            await asyncio.sleep(1.0)

    async def large_readers():
        while time.perf_counter() < until:
            for address in ("/v1/terrains/gale/hillshade.png", "/openapi.json", "/v1/jobs?limit=200"):
                reader, writer = await connect(server.port)
                writer.write(f"GET {address} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
                await answer_of(reader)
                writer.close()
            await asyncio.sleep(0.5)

    async def watch():
        while time.perf_counter() < until:
            await asyncio.sleep(min(10.0, seconds / 12))
            samples.append((server.rss_mb("VmRSS"), descriptors(server)))

    await asyncio.gather(watch(), rude(), large_readers(), *(come_and_go() for _ in range(20)), *(slow_submitter(k) for k in range(4)),
                         *(others(server.port, until, taken, failed) for _ in range(20)))
    return taken, failed, outcome


def mixed(_):
    with tempfile.TemporaryDirectory() as name:
        server = Server(pathlib.Path(name), "--keep-jobs", "200")
        samples = []
        taken, failed, outcome = asyncio.run(mixture(server, options.mixed_s, samples))
        server.stop()
    # The first sixth warms up; then the second half is held against the first.
    steady = samples[len(samples) // 6:]
    early, late = steady[:len(steady) // 2], steady[len(steady) // 2:]
    result = {"part": "mixed", "seconds": options.mixed_s, "requests": len(taken), "failed": len(failed), "jobs": len(outcome["accepted"]),
              "p99_ms": round(1e3 * share_of(taken, 0.99), 1), "mb_early": round(share_of([mb for mb, _ in early], 0.5), 1),
              "mb_late": round(share_of([mb for mb, _ in late], 0.5), 1), "mb_most": round(max(mb for mb, _ in samples), 1),
              "descriptors_early": share_of([fds for _, fds in early], 0.5), "descriptors_late": share_of([fds for _, fds in late], 0.5)}
    flat = result["mb_late"] <= 1.1 * result["mb_early"] + 5.0 and result["descriptors_late"] <= 1.2 * result["descriptors_early"] + 10
    yield result, flat and not failed


PARTS = {"crowds": crowds, "streams": streams, "submitters": submitters, "closed_loop": closed_loop, "mixed": mixed}


def main():
    unknown = set(options.parts) - set(PARTS)
    if unknown:
        parser.error(f"no such part: {', '.join(sorted(unknown))}")
    missed = 0
    for name in options.parts or PARTS:
        with tempfile.TemporaryDirectory() as folder:
            server = Server(pathlib.Path(folder)) if name not in ("submitters", "mixed") else None
            for result, good in PARTS[name](server):
                missed += not good
                print(json.dumps({**result, "holds": good, "load": round(os.getloadavg()[0], 1)}), flush=True)
            if server:
                server.stop()
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
