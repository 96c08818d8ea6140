#!/usr/bin/env python3
"""Writes this campaign from the published windows of Cuadriga: campaign.json, a CSV per log, the cropped map.

  make_campaign.py WINDOWS_CSV ELEVATION_TIF FOLDER

Python's standard library, and gdal_translate for the map. PROVENANCE.md says what is done and why.
"""

import collections
import csv
import json
import math
import pathlib
import statistics
import subprocess
import sys

ORIGIN_E_M, ORIGIN_N_M = 366966.344, 4064291.333  # the lower left corner of the published map
WINDOW_S = 4.0
MARGIN_M = 8.0
MOST_TURN_DEG_S = 3.0
MOST_SPEED_CHANGE = 0.15
WHEELS = ("lf", "lr", "rf", "rr")
RADIUS_M = 0.209

# Upland sandy loam of Wong's table: firm natural ground, known before the drives. K is a usual one.
NOMINAL_SOIL = {
    "k_c": 74600.0,
    "k_phi": 2080000.0,
    "n": 1.10,
    "cohesion_pa": 3300.0,
    "friction_angle_deg": 33.7,
    "shear_modulus_x_m": 0.01,
    "density_kg_m3": 1500.0,
    "c1": 0.18,
    "c2": 0.32,
}

# The rover as described where it ships, but for its motors: what one who has not seen these drives would assume.
ROVER_FILE = pathlib.Path(__file__).resolve().parents[2] / "rovers" / "cuadriga.json"
ASSUMED_MOTORS = {"torque_constant_nm_per_a": 0.1, "no_load_current_a": 0.0}


def nominal_rover():
    rover = json.loads(ROVER_FILE.read_text(encoding="utf-8"))
    for key in ("format", "summary", "sources", "assumed"):
        del rover[key]
    rover["drive"].update(ASSUMED_MOTORS)
    return rover


def wrapped_deg(angle):
    return (angle + 180.0) % 360.0 - 180.0


def read_logs(path):
    logs = collections.OrderedDict()
    with open(path, newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            window = {key: value if key == "log" else float(value) for key, value in row.items()}
            logs.setdefault(window["log"], []).append(window)
    return logs


def turn_rate_deg_s(windows, k):
    around = [w for w in windows[max(0, k - 1) : k + 2] if abs(w["t_s"] - windows[k]["t_s"]) <= 2.6]
    if len(around) < 2:
        return 0.0
    turned = wrapped_deg(around[-1]["heading_deg_ccw_from_east"] - around[0]["heading_deg_ccw_from_east"])
    return turned / (around[-1]["t_s"] - around[0]["t_s"])


def chosen(windows):
    """Windows that do not overlap, in runs that follow each other without a pause: lists of (window, turn)."""
    speed = statistics.median(w["wheel_speed_mps"] for w in windows)
    runs, last_s = [], -math.inf
    for k, w in enumerate(windows):
        turn = turn_rate_deg_s(windows, k)
        duration_s = w["charge_per_metre_As"] * w["distance_m"] / w["total_current_A"]
        jumped = w["distance_m"] > 1.4 * w["gps_speed_mps"] * duration_s
        steady = abs(w["wheel_speed_mps"] / speed - 1.0) <= MOST_SPEED_CHANGE
        if jumped or not steady or abs(turn) > MOST_TURN_DEG_S:
            continue
        since_s = w["t_s"] - last_s
        if abs(since_s - WINDOW_S) < 0.3:
            runs[-1].append((w, turn))
        elif since_s >= 2.0 * WINDOW_S - 0.3:
            runs.append([(w, turn)])
        else:
            continue
        last_s = w["t_s"]
    return speed, runs


def pose_at(window, turn, offset_s, speed):
    """Along the window's arc at its mean speed, offset from its middle. The wheels' speed sags under load and a
    drive has one commanded speed, so the distance is what the same slip makes of that."""
    duration_s = window["charge_per_metre_As"] * window["distance_m"] / window["total_current_A"]
    along = window["distance_m"] * speed / window["wheel_speed_mps"] * offset_s / duration_s
    yaw = window["heading_deg_ccw_from_east"] + turn * offset_s
    course = math.radians(window["heading_deg_ccw_from_east"] + 0.5 * turn * offset_s)
    return (
        window["utm30n_e_m"] - ORIGIN_E_M + along * math.cos(course),
        window["utm30n_n_m"] - ORIGIN_N_M + along * math.sin(course),
        yaw,
    )


def between(a, b):
    return (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), a[2] + 0.5 * wrapped_deg(b[2] - a[2]))


def rows_of(runs, speed):
    """(time, pose, window or None): a row at each end of a window and one in its middle."""
    rows = []
    for run in runs:
        first_s = run[0][0]["t_s"]
        for k, (w, turn) in enumerate(run):
            start = pose_at(w, turn, -0.5 * WINDOW_S, speed)
            if k > 0:
                before, turn_before = run[k - 1]
                start = between(pose_at(before, turn_before, 0.5 * WINDOW_S, speed), start)
            middle_s = first_s + WINDOW_S * k
            rows.append((middle_s - 0.5 * WINDOW_S, start, None))
            rows.append((middle_s, pose_at(w, turn, 0.0, speed), w))
        w, turn = run[-1]
        rows.append((first_s + WINDOW_S * (len(run) - 0.5), pose_at(w, turn, 0.5 * WINDOW_S, speed), None))
    return rows


def write_drive(path, rows):
    columns = ["t_s", "x_m", "y_m", "z_m", "yaw_deg"]
    for wheel in WHEELS:
        columns += [f"{wheel}_rate_deg_s", f"{wheel}_current_a"]
    columns += ["logged_slip", "logged_total_current_a", "logged_charge_per_metre_as", "logged_path_gradient_deg"]
    with open(path, "w", newline="", encoding="utf-8") as stream:
        out = csv.writer(stream, lineterminator="\n")
        out.writerow(columns)
        for time_s, (x, y, yaw), w in rows:
            row = [f"{time_s:.2f}", f"{x:.3f}", f"{y:.3f}", "0", f"{wrapped_deg(yaw):.2f}"]
            for _ in WHEELS:
                row += (
                    [f"{math.degrees(w['wheel_speed_mps'] / RADIUS_M):.2f}", f"{w['total_current_A'] / 4.0:.4f}"]
                    if w
                    else ["", ""]
                )
            row += (
                [w["slip_ratio"], w["total_current_A"], w["charge_per_metre_As"], w["path_gradient_deg"]]
                if w
                else [""] * 4
            )
            out.writerow(row)


def crop(source, target, places):
    xs, ys = [p[0] for p in places], [p[1] for p in places]
    west, east = math.floor(min(xs) - MARGIN_M), math.ceil(max(xs) + MARGIN_M)
    south, north = math.floor(min(ys) - MARGIN_M), math.ceil(max(ys) + MARGIN_M)
    west, south = max(0, west), max(0, south)
    east, north = min(200, east), min(200, north)
    # From the raster of 200 rows, first row in the north.
    window = [str(v) for v in (west, 200 - north, east - west, north - south)]
    corners = [str(v) for v in (west, north, east, south)]
    subprocess.run(
        ["gdal_translate", "-q", "-srcwin", *window, "-a_ullr", *corners, "-a_srs", "LOCAL_CS[\"campaign\",UNIT[\"metre\",1]]"]
        + ["-co", "COMPRESS=DEFLATE", "-co", "PREDICTOR=3", str(source), str(target)],
        check=True,
    )
    pathlib.Path(str(target) + ".aux.xml").unlink(missing_ok=True)


def main(windows_csv, elevation_tif, folder):
    folder = pathlib.Path(folder)
    drives, places = [], []
    for name, windows in read_logs(windows_csv).items():
        speed, runs = chosen(windows)
        rows = rows_of(runs, speed)
        if not rows:
            continue
        write_drive(folder / f"{name}.csv", rows)
        places += [pose for _, pose, _ in rows]
        commanded = {
            "speed_m_s": round(speed, 4),
            "curvature_1_m": 0.0,
            "turn_in_place": False,
            "duration_s": round(rows[-1][0] - rows[0][0], 2),
        }
        drives.append({"id": name, "file": f"{name}.csv", "terrain": "uma_rescue_area", "commanded": commanded})
    crop(elevation_tif, folder / "uma_rescue_area.tif", places)
    campaign = {
        "format": "drive-campaign/1",
        "name": "Cuadriga 2018-2019",
        "gravity_m_s2": 9.81,
        "rover": nominal_rover(),
        "soils": {"upland_sandy_loam": NOMINAL_SOIL},
        "terrains": {"uma_rescue_area": {"dem": "uma_rescue_area.tif", "soil": "upland_sandy_loam"}},
        "measurement_std": {
            "position_m": 0.04,
            "attitude_deg": 1.5,
            "current_rel": 0.02,
            "current_a": 0.05,
            "sinkage_m": 0.01,
        },
        "drives": drives,
    }
    (folder / "campaign.json").write_text(json.dumps(campaign, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:4])
