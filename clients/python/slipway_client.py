"""A client of Slipway's HTTP API that needs nothing but Python 3.9's standard library.

    from slipway_client import Slipway
    slipway = Slipway("http://127.0.0.1:8080", token=None)
    plan = slipway.plan({"terrain": "gale", "rover": "msl-class", "start": {...}, "goal": {...}})
    print(plan["summary"][0]["verdict"])

Requests and answers are the documents of the OpenAPI description (GET /openapi.json) as dictionaries.
"""
from __future__ import annotations

import http.client
import json
import time
import urllib.parse
import uuid
from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple, TypedDict, Union

Document = Dict[str, Any]
OnProgress = Callable[["JobStatus"], None]

RETRIED_STATUSES = (429, 503)
ENDED = ("successful", "failed", "dismissed")


class Fault(TypedDict):
    """What is wrong at one place of a request."""

    pointer: str
    message: str


class Queue(TypedDict, total=False):
    """Of a job that waits."""

    ahead: int
    estimated_wait_s: float


class JobStatus(TypedDict, total=False):
    """A job's status; see schema Job of the description."""

    id: str
    kind: str
    state: str
    stage: str
    progress: float
    attempt: int
    urgency: int
    interrupted: str
    queue: Queue
    created: str
    started: str
    ended: str
    problem: Document


class SlipwayError(Exception):
    """A refusal of the service, as its problem document says it (RFC 9457)."""

    def __init__(self, problem: Document, status: int):
        self.status = status
        self.name: str = str(problem.get("type", "")).rpartition("#")[2]
        self.detail: str = str(problem.get("detail", problem.get("title", "")))
        self.faults: List[Fault] = list(problem.get("faults", []))
        lines = [f"{self.name or status}: {self.detail}"]
        lines += [f"  {fault['pointer'] or '(the whole request)'}: {fault['message']}" for fault in self.faults]
        super().__init__("\n".join(lines))


class Job:
    """Work that the service has accepted."""

    def __init__(self, slipway: "Slipway", location: str):
        self.slipway = slipway
        self.location = location
        self.id = location.rpartition("/")[2]

    def status(self) -> JobStatus:
        return self.slipway.get_json(self.location)

    def wait(self, on_progress: Optional[OnProgress] = None, timeout_s: Optional[float] = None) -> JobStatus:
        """Waits for the end; TimeoutError where it does not come in time. The job goes on then."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        pause_s = 0.05
        while True:
            status = self.status()
            if on_progress:
                on_progress(status)
            if status["state"] in ENDED:
                return status
            if deadline is not None and time.monotonic() >= deadline:
                raise TimeoutError(f"job {self.id} is {status['state']} after {timeout_s} s")
            time.sleep(pause_s)
            pause_s = min(1.0, 1.5 * pause_s)

    def result(self) -> Document:
        """The answer; SlipwayError where the job failed, was dismissed or has not ended."""
        return self.slipway.get_json(self.location + "/result")

    def geojson(self) -> Document:
        return json.loads(self.slipway.get(self.location + "/result", accept="application/geo+json"))

    def map_svg(self) -> str:
        return self.slipway.get(self.location + "/map").decode()

    def report_html(self) -> str:
        return self.slipway.get(self.location + "/report").decode()

    def stations_csv(self) -> Iterator[str]:
        """The table of all stations, page by page: put together they are one table."""
        page = 1
        while True:
            _, headers, body = self.slipway.request("GET", f"{self.location}/stations?page={page}")
            yield body.decode()
            if 'rel="next"' not in headers.get("link", ""):
                return
            page += 1

    def dismiss(self) -> JobStatus:
        _, _, body = self.slipway.request("DELETE", self.location)
        return json.loads(body)


class Slipway:
    """A service at an address. Every request is tried again where the connection breaks or the service says that
    it is busy, up to `patience_s`; a request for work bears a key, so that it is never accepted twice."""

    def __init__(self, url: str, token: Optional[str] = None, timeout_s: float = 60.0, patience_s: float = 60.0):
        parts = urllib.parse.urlsplit(url)
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError(f"{url!r} is no http://HOST:PORT or https://HOST:PORT")
        self._connection_type = http.client.HTTPSConnection if parts.scheme == "https" else http.client.HTTPConnection
        self._host, self._port, self._prefix = parts.hostname, parts.port, parts.path.rstrip("/")
        self._token, self._timeout_s, self._patience_s = token, timeout_s, patience_s

    def request(self, method: str, path: str, body: Union[None, Document, bytes] = None,
                headers: Optional[Dict[str, str]] = None) -> Tuple[int, Dict[str, str], bytes]:
        """Status, headers by lower-case name, and body; SlipwayError for a refusal. Bytes are sent as they are,
        with a Content-Type among the headers."""
        data = body if body is None or isinstance(body, bytes) else json.dumps(body).encode()
        sent = dict(headers or {})
        if data is not None:
            sent.setdefault("Content-Type", "application/json")
        if self._token:
            sent["Authorization"] = f"Bearer {self._token}"
        deadline = time.monotonic() + self._patience_s
        while True:
            pause_s = 1.0
            try:
                status, received, answer = self._once(method, self._prefix + path, data, sent)
                if status < 400:
                    return status, received, answer
                if status not in RETRIED_STATUSES or time.monotonic() >= deadline:
                    raise SlipwayError(_problem_in(received, answer), status)
                pause_s = float(received.get("retry-after", "1"))
            except (ConnectionError, TimeoutError, http.client.HTTPException):
                if time.monotonic() >= deadline:
                    raise
            time.sleep(max(0.0, min(pause_s, deadline - time.monotonic())))

    def _once(self, method: str, path: str, data: Optional[bytes],
              headers: Dict[str, str]) -> Tuple[int, Dict[str, str], bytes]:
        connection = self._connection_type(self._host, self._port, timeout=self._timeout_s)
        try:
            connection.request(method, path, data, headers)
            response = connection.getresponse()
            received = {name.lower(): value for name, value in response.getheaders()}
            return response.status, received, response.read()
        finally:
            connection.close()

    def get(self, path: str, accept: str = "*/*") -> bytes:
        return self.request("GET", path, headers={"Accept": accept})[2]

    def get_json(self, path: str) -> Any:
        return json.loads(self.get(path, accept="application/json"))

    def submit(self, path: str, request: Document, urgency: Optional[int] = None, key: Optional[str] = None) -> Job:
        """Asks for work at an address such as "/v1/plans"; the same key gives the same job."""
        headers = {"Prefer": "respond-async", "Idempotency-Key": key or uuid.uuid4().hex}
        if urgency is not None:
            headers["Priority"] = f"u={urgency}"
        return Job(self, self.request("POST", path, request, headers)[1]["location"])

    def _answer(self, path: str, request: Document, on_progress: Optional[OnProgress]) -> Document:
        job = self.submit(path, request)
        job.wait(on_progress)
        return job.result()

    def send_file(self, content: bytes, name: str) -> str:
        """Sends a file's bytes; the id that requests name it by."""
        path = "/v1/uploads?name=" + urllib.parse.quote(name, safe="")
        return json.loads(self.request("POST", path, content, {"Content-Type": "application/octet-stream"})[2])["id"]

    def take_drive_campaign(self, upload: str, on_progress: Optional[OnProgress] = None) -> Document:
        """A drive campaign of an archive (tar, tar.gz or zip) that was sent."""
        return self._answer("/v1/drive-campaigns", {"upload": upload}, on_progress)

    def append_drives(self, campaign: str, drives: List[Document], on_progress: Optional[OnProgress] = None) -> Document:
        """The campaign with further drives, under a name of its own."""
        return self._answer("/v1/drive-campaigns", {"follows": campaign, "drives": drives}, on_progress)

    def import_terrain(self, request: Document, on_progress: Optional[OnProgress] = None) -> Document:
        """A terrain of maps that were sent; see schema TerrainRequest."""
        return self._answer("/v1/terrains", request, on_progress)

    def plan(self, request: Document, on_progress: Optional[OnProgress] = None) -> Document:
        return self._answer("/v1/plans", request, on_progress)

    def predict(self, request: Document, on_progress: Optional[OnProgress] = None) -> Document:
        return self._answer("/v1/predictions", request, on_progress)

    def check(self, request: Document, on_progress: Optional[OnProgress] = None) -> Document:
        return self._answer("/v1/checks", request, on_progress)

    def diagnose(self, request: Document, on_progress: Optional[OnProgress] = None) -> Document:
        return self._answer("/v1/diagnoses", request, on_progress)

    def estimate_soils(self, request: Document, on_progress: Optional[OnProgress] = None) -> Document:
        return self._answer("/v1/soil-estimates", request, on_progress)

    def sweep_wheel(self, request: Document) -> Document:
        return json.loads(self.request("POST", "/v1/wheel-sweeps", request)[2])

    def terrains(self) -> List[Document]:
        return self.get_json("/v1/terrains")["terrains"]

    def rovers(self) -> List[Document]:
        return self.get_json("/v1/rovers")["rovers"]

    def soils(self) -> List[Document]:
        return self.get_json("/v1/soils")["soils"]

    def drive_campaigns(self) -> List[Document]:
        return self.get_json("/v1/drive-campaigns")["campaigns"]

    def jobs(self, limit: int = 50) -> List[JobStatus]:
        return self.get_json(f"/v1/jobs?limit={limit}")["jobs"]

    def job(self, job_id: str) -> Job:
        return Job(self, f"/v1/jobs/{urllib.parse.quote(job_id, safe='')}")

    def is_ready(self) -> bool:
        try:
            return self._once("GET", self._prefix + "/readyz", None, {})[0] == 200
        except OSError:
            return False


def _problem_in(headers: Dict[str, str], body: bytes) -> Document:
    if "json" in headers.get("content-type", ""):
        return json.loads(body)
    return {"detail": body.decode(errors="replace")[:500]}
