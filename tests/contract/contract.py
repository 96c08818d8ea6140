#!/usr/bin/env python3
"""What the running program promises over HTTP, checked from outside with nothing of its code.

usage: contract.py SLIPWAY SOURCE_DIR
"""
import json
import os
import pathlib
import socket
import sys
import tempfile
import time
import unittest

from running_service import DATA, SLIPWAY, SOURCE, STOP_967, STOP_997, WithServer, answered, plan, thinned_data

SHORT = {"terrain": "gale", "rover": "msl-class", "path": [STOP_967, STOP_997], "draws": 4}


class Contract(WithServer):
    OPTIONS = ("--override-persons", "1")

    @classmethod
    def data(cls, folder):
        # Enough drives to find what they lack, few enough to be quick.
        return thinned_data(folder / "data", {"p03": 2, "p05": 4})

    def refused(self, path, body, status, *pointers, headers=None):
        got, head, data = self.server.ask("POST", path, body, headers)
        self.assertEqual(got, status, data[:500])
        self.assertEqual(head["Content-Type"], "application/problem+json")
        problem = json.loads(data)
        self.assertEqual(problem["status"], status)
        named = [fault["pointer"] for fault in problem.get("faults", [])]
        for pointer in pointers:
            self.assertIn(pointer, named, problem)
        self.assertEqual(self.server.ask("GET", "/healthz")[0], 200, "the server is alive")
        return problem

    def test_every_address_of_the_description_answers(self):
        served = self.server.ask("GET", "/openapi.json")[2]
        self.assertEqual(served, (SOURCE / "api/openapi.json").read_bytes(), "what openapi_lint reads is what is served")
        description = json.loads(served)
        for path, methods in description["paths"].items():
            asks = methods.get("get", {}).get("parameters", [])
            if "get" in methods and "{" not in path and not any(p.get("in") == "query" and p.get("required") for p in asks):
                status, headers, body = self.server.ask("GET", path)
                self.assertEqual(status, 200, path)
                if headers["Content-Type"] == "application/json":
                    json.loads(body)

    def test_the_examples_of_the_description_are_answered(self):
        description = json.loads(self.server.ask("GET", "/openapi.json")[2])
        replayed = 0
        for path, methods in description["paths"].items():
            if path in ("/v1/terrains", "/v1/drive-campaigns"):
                continue  # of files that must be sent first: see uploads_test.py
            if path == "/v1/diagnoses":
                continue  # asked by the test of the shipped campaigns
            content = methods.get("post", {}).get("requestBody", {}).get("content", {})
            for example in content.get("application/json", {}).get("examples", {}).values():
                if "value" not in example:
                    continue
                if "201" in methods["post"]["responses"]:  # a job
                    answer = self.server.answer(path, example["value"])
                else:
                    status, _, answer = self.server.ask("POST", path, example["value"])
                    self.assertEqual(status, 200, answer[:500])
                self.assertTrue(json.loads(answer)["format"].endswith("/1"))
                replayed += 1
        self.assertGreaterEqual(replayed, 3)

    def test_a_wheel_sweep_is_the_same_here_on_the_command_line_and_as_csv(self):
        request = {"rover": "mer-class", "soil": "jlu_mars_2_dense", "load_n": 100,
                   "sweep": [{"parameter": "slip", "from": -0.4, "to": 0.8, "step": 0.2}]}
        status, _, body = self.server.ask("POST", "/v1/wheel-sweeps", request)
        self.assertEqual(status, 200, body[:500])
        rows = json.loads(body)["rows"]
        self.assertEqual([row["slip"] for row in rows], [-0.4, -0.2, 0, 0.2, 0.4, 0.6, 0.8])
        pulls = [row["drawbar_pull_n"] for row in rows]
        self.assertEqual(pulls, sorted(pulls))
        with tempfile.TemporaryDirectory() as folder:
            csv, plot = os.path.join(folder, "wheel.csv"), os.path.join(folder, "wheel.svg")
            command = [SLIPWAY, "wheel", "--data", DATA, "--soil", "jlu_mars_2_dense", "--load", "100", "--sweep",
                       "slip=-0.4:0.8:0.2", "--json", "--csv", csv, "--plot", plot]
            self.assertEqual(answered(command).stdout.rstrip(b"\n"), body)
            self.assertEqual(pathlib.Path(csv).read_bytes(),
                             self.server.ask("POST", "/v1/wheel-sweeps", request, {"Accept": "text/csv"})[2])
            self.assertTrue(pathlib.Path(plot).read_text().startswith("<svg"))
        self.refused("/v1/wheel-sweeps", {"rover": "mer-class", "soil": "sand", "slip": 2}, 422, "/soil", "/slip")

    def test_a_plan_has_three_routes_that_differ_and_the_safest_is_ranked_with_reasons(self):
        answer = json.loads(self.server.answer("/v1/plans", plan()))
        self.assertTrue(len(answer["summary"]) == 3 or answer["fewer_because"], answer["fewer_because"])
        described = json.loads(self.server.ask("GET", "/openapi.json")[2])["components"]["schemas"]
        for part, schema in (("limits", "DriveLimits"), ("checks", "DriveChecks"), ("bars", "DriveBars")):
            self.assertEqual(described["PlanRequest"]["properties"][part]["$ref"], f"#/components/schemas/{schema}")
            defaults = {key: of["x-default"] for key, of in described[schema]["properties"].items() if "x-default" in of}
            self.assertEqual(answer["request"][part], defaults, part)
        for rank, (row, feature) in enumerate(zip(answer["summary"], answer["routes"]["features"]), 1):
            self.assertEqual(row["rank"], rank)
            self.assertTrue(row["reasons"])
            self.assertIn(row["verdict"], ("go", "no_go", "unknown"))
            stations = feature["properties"]["stations"]
            for series in ("distance_m", "slip", "slip_p95", "risk"):
                self.assertEqual(len(stations[series]), stations["count"])
            self.assertEqual(len(feature["geometry"]["coordinates"]), stations["count"])
            steps = [b - a for a, b in zip(stations["distance_m"], stations["distance_m"][1:])]
            self.assertLessEqual(max(steps), 0.5 + 1e-3, "two wheel radii of 0.25 m")
            if row["unknown_length_m"] > 0:
                self.assertNotEqual(row["verdict"], "go", "unknown ground is never shown as safe")
        for before, after in zip(answer["summary"], answer["summary"][1:]):
            if before["cost"] > after["cost"] and before["verdict"] == after["verdict"]:
                self.assertTrue(any("alike" in reason for reason in before["reasons"]), "what the draws tell apart is in order of cost")

    def test_the_same_request_gives_the_same_bytes_here_and_on_the_command_line(self):
        request = plan(routes=2, draws=8, seed=5)
        first = self.server.answer("/v1/plans", request)
        self.assertEqual(first, self.server.answer("/v1/plans", request))
        local = answered([SLIPWAY, "plan", "--data", DATA, "--json", "--request", "-"], input=json.dumps(request).encode()).stdout
        self.assertEqual(first, local.rstrip(b"\n"))

    def test_a_poller_hears_when_nothing_changed(self):
        status, headers, _ = self.server.ask("POST", "/v1/predictions", SHORT, {"Prefer": "respond-async"})
        self.assertEqual(status, 201)
        location = headers["Location"]
        self.server.end_of(location)
        status, headers, body = self.server.ask("GET", location)
        self.assertEqual(json.loads(body)["state"], "successful")
        status, _, body = self.server.ask("GET", location, headers={"If-None-Match": headers["ETag"]})
        self.assertEqual((status, body), (304, b""))

    def test_prefer_wait_answers_at_once(self):
        status, headers, body = self.server.ask("POST", "/v1/plans", plan(routes=1, draws=4), {"Prefer": "wait=30"})
        self.assertEqual(status, 200)
        self.assertEqual(json.loads(body)["format"], "plan/1")

    def test_a_dismissed_plan_stops_within_two_seconds(self):
        status, headers, _ = self.server.ask("POST", "/v1/plans", plan(draws=500, routes=8), {"Prefer": "respond-async"})
        location = headers["Location"]
        while json.loads(self.server.ask("GET", location)[2])["state"] == "accepted":
            time.sleep(0.02)
        time.sleep(0.3)
        begun = time.time()
        self.assertEqual(self.server.ask("DELETE", location)[0], 200)
        self.assertEqual(json.loads(self.server.ask("GET", location)[2])["state"], "dismissed")
        # Really stopped: the processor time stands still.
        while time.time() - begun < 2.0:
            before = self.server.processor_s()
            time.sleep(0.2)
            if self.server.processor_s() - before <= 0.04:
                break
        else:
            self.fail("the work went on for two seconds")
        self.assertEqual(self.server.ask("GET", location + "/result")[0], 409)

    def test_a_dismissed_diagnosis_stops_within_a_tenth_of_a_second_of_each_core(self):
        stage = "estimating the drives' own scatter"  # the others are asked of the library itself
        status, headers, _ = self.server.ask("POST", "/v1/diagnoses", {"campaign": "p05"}, {"Prefer": "respond-async"})
        self.assertEqual(status, 201)
        location = headers["Location"]
        deadline = time.time() + 100
        while time.time() < deadline:
            job = json.loads(self.server.ask("GET", location)[2])
            if job["state"] == "running" and job.get("stage") == stage:
                break
            time.sleep(0.05)
        else:
            self.fail(f"it was never {stage}")
        self.assertEqual(self.server.ask("GET", location + "/report")[0], 409)
        before = self.server.processor_s()
        self.assertEqual(self.server.ask("DELETE", location)[0], 200)
        # All the processor time that the work still takes; asking takes some of it.
        time.sleep(1.0)
        self.assertLess(self.server.processor_s() - before, 0.1 * (os.cpu_count() or 1) + 0.05, stage)
        self.assertEqual(self.server.ask("GET", location + "/report")[0], 409)

    def test_the_campaigns_that_ship_are_listed_and_a_diagnosis_of_one_is_a_page(self):
        campaigns = json.loads(self.server.ask("GET", "/v1/drive-campaigns")[2])["campaigns"]
        paths = json.loads(self.server.ask("GET", "/openapi.json")[2])["paths"]
        example = paths["/v1/drive-campaigns"]["get"]["responses"]["200"]["content"]["application/json"]["examples"]["practice"]["value"]["campaigns"]
        p05 = next(c for c in campaigns if c["name"] == "p05")
        self.assertEqual(list(p05), list(example[0]))
        self.assertIn("cuadriga_2018_2019", [c["name"] for c in campaigns if c["rover"] == "cuadriga"])
        self.assertEqual((p05["rover"], len(p05["drives"]), p05["terrains"][0]), ("mer-class", 11, "tilt_00"))
        asked = paths["/v1/diagnoses"]["post"]["requestBody"]["content"]["application/json"]["examples"]
        self.assertEqual(asked["shortest"]["value"], {"campaign": "p05"}, "which the next one asks with more keys")
        status, headers, _ = self.server.ask("POST", "/v1/diagnoses", asked["practice"]["value"], {"Prefer": "respond-async"})
        location = headers["Location"]
        self.assertEqual(self.server.end_of(location, 300)["state"], "successful")
        document = json.loads(self.server.ask("GET", location + "/result")[2])
        self.assertEqual(document["format"], "diagnosis/1")
        self.assertNotIn("reference", document, "none was asked for")
        self.assertTrue(document["where"]["windows"])
        status, headers, page = self.server.ask("GET", location.replace("/jobs/", "/diagnoses/") + "/report")
        self.assertEqual((status, headers["Content-Type"]), (200, "text/html; charset=utf-8"))
        self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
        text = page.decode()
        for words in ("<!DOCTYPE html>", "motor_temperature", "the map of the gap", "data:image/png;base64,"):
            self.assertIn(words, text)
        for outside in ("<script", "src=", "<link", 'href="http', "@import"):
            self.assertNotIn(outside, text)
        self.plans_with(location.rsplit("/", 1)[1], document["model"])
        self.checks_the_model(location.rsplit("/", 1)[1])
        problem = self.server.ask("GET", "/v1/diagnoses/" + "0" * 32 + "/report")
        self.assertEqual((problem[0], problem[1]["Content-Type"]), (404, "application/problem+json"))

    def drives_of(self, campaign, ids):
        """Drives of a practice campaign as a request has them."""
        folder = pathlib.Path(DATA) / "gap-practice" / campaign
        described = {d["id"]: d for d in json.loads((folder / "campaign.json").read_text())["drives"]}
        return [{**{k: v for k, v in described[i].items() if k != "file"}, "csv": (folder / described[i]["file"]).read_text()}
                for i in ids]

    def test_drives_appended_to_a_watch_raise_an_alarm_once_something_has_changed(self):
        wait = {"Prefer": "wait=30"}
        healthy, changed = self.drives_of("p02", ["D001", "D013", "D033"]), self.drives_of("p03", ["D041", "D042", "D043", "D044"])
        for number, drive in enumerate(healthy + changed):
            drive["id"] = f"sol_{number}"
            drive.pop("repeat_of", None)
        status, headers, body = self.server.ask("POST", "/v1/watches", {"reference": "p01", "diagnose": False, "drives": healthy[:2]}, wait)
        self.assertEqual(status, 200, body[:500])
        first = json.loads(body)
        self.assertEqual((first["format"], first["reference"]["campaign"], first["changed"]), ("watch/1", "p01", False))
        self.assertEqual([d["id"] for d in first["drives"]], ["sol_0", "sol_1"])
        job = headers["Content-Location"].split("/")[3]
        status, headers, body = self.server.ask("POST", "/v1/watches", {"continues": job, "drives": healthy[2:] + changed}, wait)
        self.assertEqual(status, 200, body[:500])
        second = json.loads(body)
        self.assertEqual([d["id"] for d in second["drives"]], [f"sol_{n}" for n in range(7)])
        for before, now in zip(first["drives"], second["drives"]):
            self.assertAlmostEqual(before["log10_evidence"], now["log10_evidence"], delta=0.05, msg="what was said before stands")
        self.assertTrue(second["changed"], second)
        self.assertIn(second["alarm"]["since"], [d["id"] for d in changed])
        at_once = self.server.ask("POST", "/v1/watches", {"reference": "p01", "diagnose": False, "drives": healthy + changed}, wait)[2]
        self.assertEqual(at_once, body, "however the drives were dealt into requests")
        # Faults count drives as they were sent; what is not there is not continued.
        bad = {**changed[0], "csv": "t_s,x_m,y_m,z_m\n0,0,0,deep\n"}
        last = headers["Content-Location"].split("/")[3]
        self.refused("/v1/watches", {"continues": last, "drives": [{**changed[0], "id": "sol_9"}, bad]}, 422, "/drives/1/id", "/drives/1/csv")
        self.refused("/v1/watches", {"continues": "0" * 32, "drives": changed}, 422, "/continues")
        self.refused("/v1/watches", {"reference": "../p01", "drives": changed}, 422, "/reference")

    def test_a_diagnosis_with_a_reference_says_what_has_changed_since(self):
        self.refused("/v1/diagnoses", {"campaign": "p03", "reference": "p03"}, 422, "/reference")
        self.refused("/v1/diagnoses", {"campaign": "p03", "reference": "p99"}, 422, "/reference")
        document = json.loads(self.server.answer("/v1/diagnoses", {"campaign": "p03", "reference": "p01"}))
        self.assertEqual((document["reference"]["campaign"], document["reference"]["drives"]), ("p01", 44))
        self.assertTrue(document["reference"]["discrepancy"])
        self.assertEqual([e["name"] for e in document["effects"]], ["slip_sinkage"])

    def test_a_check_is_a_page_and_its_stations_a_table_here_and_on_the_command_line(self):
        request = {"terrain": "gale", "rover": "msl-class", "path": [STOP_967, STOP_997], "draws": 4}
        status, headers, body = self.server.ask("POST", "/v1/checks", request, {"Prefer": "wait=30"})
        self.assertEqual(status, 200, body[:500])
        check = json.loads(body)
        result = headers["Content-Location"]
        report = result.replace("/jobs/", "/checks/").replace("/result", "/report")
        status, headers, page = self.server.ask("GET", report)
        self.assertEqual((status, headers["Content-Type"]), (200, "text/html; charset=utf-8"))
        self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
        self.assertEqual(self.server.ask("GET", report, headers={"If-None-Match": headers["ETag"]})[0], 304)
        text = page.decode()
        for words in ('class="banner', "What would change it", "data:image/png;base64,", "The rules"):
            self.assertIn(words, text)
        for outside in ("<script", "src=", "<link", 'href="http', "@import"):
            self.assertNotIn(outside, text)
        status, headers, table = self.server.ask("GET", result, headers={"Accept": "text/csv"})
        self.assertEqual((status, headers["Content-Type"]), (200, "text/csv"))
        rows = table.decode().splitlines()
        self.assertEqual(len(rows), 1 + check["routes"]["features"][0]["properties"]["stations"]["count"])
        with tempfile.TemporaryDirectory() as folder:
            html, csv = pathlib.Path(folder) / "check.html", pathlib.Path(folder) / "check.csv"
            answered([SLIPWAY, "check", "--data", DATA, "--request", "-", "--report", str(html), "--csv", str(csv)],
                     input=json.dumps(request).encode())
            self.assertEqual(html.read_bytes(), page)
            self.assertEqual(csv.read_bytes(), table)
        self.lets_go(result.split("/")[3], check["verdict"])
        self.compares(result.split("/")[3], request)
        # What has no report, and an answer that is no drive: asked for as CSV it stays JSON.
        status, headers, _ = self.server.ask("POST", "/v1/predictions", request, {"Prefer": "wait=30"})
        self.assertEqual(self.server.ask("GET", headers["Content-Location"].replace("/result", "/report"))[0], 404)

    def checks_the_model(self, diagnosis):
        """The model of a diagnosis against drives that it was not made of."""
        status, _, body = self.server.ask("POST", "/v1/model-checks", {"campaign": "p01", "model": {"diagnosis": diagnosis}}, {"Prefer": "wait=30"})
        self.assertEqual(status, 200, body[:500])
        check = json.loads(body)
        self.assertEqual((check["format"], check["campaign"], check["model"]["campaign"]), ("model-check/1", "p01", "p05"))
        self.assertGreater(len(check["channels"]), 3)
        self.refused("/v1/model-checks", {"campaign": "p99", "model": {"diagnosis": "0" * 32}, "soil": 1}, 422, "/campaign", "/model/diagnosis", "/soil")
        self.refused("/v1/model-checks", {"campaign": "p01"}, 422, "/model")

    def lets_go(self, check, verdict):
        """A check that does not say go is overridden in two steps, once, with a reason; a check that says go is not."""
        address, reason = f"/v1/checks/{check}/override", "The drivers have walked this ground with the rover's twin."
        self.assertEqual(self.server.ask("GET", address)[0], 404)
        if verdict == "go":
            self.assertEqual(self.server.ask("POST", address, {"reason": reason})[0], 409)
            return
        self.refused(address, {"reason": "yes"}, 422, "/reason")
        self.refused(address, {"reason": reason, "confirmation": "0" * 16}, 422, "/confirmation")
        status, _, body = self.server.ask("POST", address, {"reason": reason})
        asked = json.loads(body)
        self.assertEqual((status, asked["state"], asked["verdict"]), (200, "to_be_confirmed", verdict))
        self.assertEqual(self.server.ask("GET", address)[0], 404, "not before it is confirmed")
        self.refused(address, {"reason": reason + " Twice.", "confirmation": asked["confirmation"]}, 422, "/reason")
        status, headers, body = self.server.ask("POST", address, {"reason": reason, "confirmation": asked["confirmation"]})
        self.assertEqual((status, headers["Location"]), (201, address), body)
        self.assertEqual((json.loads(body)["state"], json.loads(body)["reason"]), ("overridden", reason))
        self.assertEqual(self.server.ask("GET", address)[2], body)
        self.assertEqual(self.server.ask("POST", address, {"reason": reason})[0], 409, "once")
        kept = json.loads(self.server.ask("GET", "/v1/jobs?kind=override&state=successful")[2])["jobs"]
        self.assertEqual([job["kind"] for job in kept], ["override"])
        self.assertEqual(json.loads(self.server.ask("GET", f"/v1/jobs/{check}/result")[2])["verdict"], verdict, "the check stays as it is")

    def compares(self, check, request):
        """Two answers side by side here are those on the command line."""
        status, headers, other = self.server.ask("POST", "/v1/checks", {**request, "limits": {"max_slip": 0.2}}, {"Prefer": "wait=30"})
        self.assertEqual(status, 200, other[:500])
        second = headers["Content-Location"].split("/")[3]
        status, _, body = self.server.ask("GET", f"/v1/comparisons?a={check}&b={second}")
        self.assertEqual(status, 200, body[:500])
        with tempfile.TemporaryDirectory() as folder:
            a, b = pathlib.Path(folder) / "a.json", pathlib.Path(folder) / "b.json"
            a.write_bytes(self.server.ask("GET", f"/v1/jobs/{check}/result")[2])
            b.write_bytes(other)
            local = answered([SLIPWAY, "compare-plans", str(a), str(b), "--json"]).stdout
        self.assertEqual(body, local.rstrip(b"\n"))
        status, _, body = self.server.ask("GET", f"/v1/comparisons?a={check}&b={'0' * 32}&routes=1")
        self.assertEqual((status, [f["pointer"] for f in json.loads(body)["faults"]]), (422, ["/routes", "/b"]))

    def plans_with(self, diagnosis, model):
        """A diagnosis named in requests is the model that it offers."""
        path = {"terrain": "gale", "rover": "mer-class", "path": [STOP_967, STOP_997], "draws": 2}
        wait = {"Prefer": "wait=30"}
        nominal = json.loads(self.server.ask("POST", "/v1/predictions", path, wait)[2])
        named = {"diagnosis": diagnosis, "ground": [nominal["provenance"]["soils"][0]]}
        corrected = json.loads(self.server.ask("POST", "/v1/predictions", {**path, "model": named}, wait)[2])
        self.assertEqual(corrected["request"]["model"], named)
        self.assertEqual(corrected["rover"], model["rover"]["name"])
        self.assertIn(model["soils"]["soils"][0]["name"], corrected["provenance"]["soils"])
        self.assertNotEqual(corrected["summary"], nominal["summary"])
        status, headers, _ = self.server.ask("POST", "/v1/plans", plan(rover="mer-class", routes=1, draws=2, model=named))
        self.assertEqual(status, 201)
        self.assertEqual(self.server.end_of(headers["Location"])["state"], "successful")
        planned = headers["Location"].rsplit("/", 1)[1]
        for job, reason in (("0" * 32, "no job of this id"), (planned, "offers a model")):
            problem = self.refused("/v1/plans", plan(rover="mer", model={"diagnosis": job}), 422, "/rover", "/model/diagnosis")
            self.assertIn(reason, problem["faults"][1]["message"])

    def test_a_sol_is_a_page_with_its_day_its_checks_and_its_way_back(self):
        day = {"from": "2016-03-22T05:00:00Z", "to": "2016-03-22T15:00:00Z", "min_sun_deg": 10, "charge_percent": 60, "min_charge_percent": 40}
        request = {"terrain": "gale", "rover": "msl-class", "start": STOP_967, "goal": STOP_997, "routes": 1, "draws": 24, "departure": day,
                   "start_error": {"position_m": 0.2, "heading_deg": 1}}
        status, headers, body = self.server.ask("POST", "/v1/sols", request, {"Prefer": "wait=30"})
        self.assertIn(status, (200, 201), body[:500])
        location = headers["Location"] if status == 201 else headers["Content-Location"].replace("/result", "")
        if status == 201:
            self.server.end_of(location)
            body = self.server.ask("GET", location + "/result")[2]
        sol = json.loads(body)
        self.assertEqual((sol["format"], sol["plan"]["format"]), ("sol/1", "plan/1"))
        decision = sol["plan"]["routes"]["features"][0]["properties"]["decision"]
        departures, starts = decision["departures"], decision["starts"]
        (of_start,) = [rule for rule in decision["rules"] if rule["rule"] == "start"]
        self.assertEqual((starts["starts"], starts["go"] + starts["unknown"] + starts["no_go"]), (25, 25))
        self.assertEqual(of_start["verdict"] == "go", starts["go"] == 25)
        (window,) = departures["windows"]
        self.assertLess(window["from"], departures["best"]["arrives"])
        best = departures["best"]
        held = 60 + 100 * (best["gained_wh"] - best["used_wh"] - best["spilled_wh"]) / 2350
        self.assertAlmostEqual(held, best["charge_percent"], delta=0.1)
        self.assertEqual(len(departures["tried"]), 41)
        if sol["worst"]:
            self.assertEqual(sol["back_out"]["format"], "check/1")
            self.assertTrue(sol["back_out"]["request"]["backwards"])
            begun = sol["back_out"]["request"]["departure"]
            self.assertTrue(departures["best"]["departs"] <= begun["from"] == begun["to"] <= departures["best"]["arrives_late"])
            self.assertLess({"charge", "sun"}, {rule["rule"] for rule in sol["back_out"]["decision"]["rules"]})
        status, headers, page = self.server.ask("GET", location + "/report")
        self.assertEqual((status, headers["Content-Type"]), (200, "text/html; charset=utf-8"))
        for words in ("A sol of msl-class on gale", "The day", "Where to check the slip", "Commands"):
            self.assertIn(words, page.decode())
        self.refused("/v1/sols", {k: v for k, v in request.items() if k != "departure"}, 422, "/departure")
        self.refused("/v1/sols", {**request, "departure": {**day, "to": "noon", "min_sun_deg": 99}}, 422, "/departure/to", "/departure/min_sun_deg")
        self.refused("/v1/sols", {**request, "start_error": {"position_m": -1, "heading_deg": 90}}, 422, "/start_error/position_m", "/start_error/heading_deg")

    def test_bad_requests_name_every_fault(self):
        self.refused("/v1/plans", "{", 400)
        self.refused("/v1/plans", '{"start": NaN}', 400)
        self.refused("/v1/plans", "[" * 100_000, 400)
        self.refused("/v1/plans", {}, 422, "/terrain", "/rover", "/start", "/goal")
        self.refused("/v1/plans", plan(routes="three", seed=1.5, gaol=1, limits={"max_tilt_deg": 212, "max_slip": -1}), 422,
                     "/routes", "/seed", "/gaol", "/limits/max_tilt_deg", "/limits/max_slip")
        problem = self.refused("/v1/plans", plan(limits={"max_tilt_deg": 212}), 422, "/limits/max_tilt_deg")
        self.assertIn("max_tilt_deg = 212 deg, must be in (0, 60]", problem["faults"][0]["message"])
        self.refused("/v1/plans", plan(start={"x_m": 0, "y_m": 0}), 422, "/start")
        self.refused("/v1/plans", plan(terrain="../../etc/passwd"), 422, "/terrain")
        self.refused("/v1/plans", plan(terrain="/vsicurl/http://127.0.0.1/x.tif"), 422, "/terrain")
        self.refused("/v1/plans", plan(verify=4, failed_wheels={"rf": "bent"}), 422, "/verify", "/failed_wheels/rf")
        self.refused("/v1/plans", plan(effects=[{"name": "tether"}]), 422, "/effects/0/name")
        off = {"terrain": "gale", "rover": "msl-class", "path": [STOP_967, {"x_m": 8142579.7, "y_m": -279000.0}]}
        self.refused("/v1/predictions", off, 422, "/path/1")
        self.refused("/v1/diagnoses", {"campaign": "p99", "without": ["tether"], "seed": -1}, 422, "/campaign", "/without/0", "/seed")
        for campaign in ("../p05", "/etc", "", 5):
            self.refused("/v1/diagnoses", {"campaign": campaign}, 422, "/campaign")
        self.refused("/v1/soil-estimates", {}, 422, "")
        self.refused("/v1/soil-estimates", {"campaign": "p99", "soil": "chalk", "free": ["m"], "seed": -1}, 422, "/campaign", "/soil", "/free/0", "/seed")
        self.refused("/v1/soil-estimates", {"radius_m": 0.1, "wheel_tests": [{"load_n": 10, "slip_ratio": 2}, {"load_n": 10, "slip_ratio": 0.1}]}, 422,
                     "/wheel_tests/0/slip_ratio", "/width_m")
        self.refused("/v1/plans", b"\xff\xfe", 400)
        self.refused("/v1/plans", "start=1", 415, headers={"Content-Type": "application/x-www-form-urlencoded"})

    def test_a_gigabyte_is_refused_before_it_is_read(self):
        before = self.server.rss_mb("VmRSS")
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=10) as s:
            s.sendall(b"POST /v1/plans HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 1000000000\r\n\r\n")
            self.assertIn(b" 413 ", s.recv(4096))
        self.assertLess(self.server.rss_mb("VmRSS") - before, 20)
        self.assertEqual(self.server.ask("GET", "/healthz")[0], 200)

    def test_memory_stays_below_300_mb(self):
        self.server.answer("/v1/plans", plan())
        self.assertLess(self.server.rss_mb("VmHWM"), 300)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
