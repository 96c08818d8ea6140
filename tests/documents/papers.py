#!/usr/bin/env python3
"""The printed equations of the papers that docs/results/papers.md is about, evaluated by themselves, against what the program prints.

    papers.py [PART ...]     of the `slipway` that the shell finds

The integrals are summed here, with the standard library alone; parameters are those of data/soils. What a part takes of the program besides:
side_wall its sinkage and entry angle, grousers and limit its entry angle, motor its torque, estimate its observations. A part is one of
fido, slide, wheel, derivations, side_wall, grousers, slip_sinkage, estimate, limit, motor, current, tests, climb, states, soils; all of them
where none is named."""
import collections
import csv
import json
import math
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]


def run(*words, data=root / "data"):
    command, verb = ["slipway", *words[:1]], list(words[1:])
    if words[0] in ("current", "estimate"):
        command, verb = [*command, words[1]], list(words[2:])
    done = subprocess.run([*command, "--data", str(data), *verb], capture_output=True, text=True)
    if done.returncode not in (0, 5):
        raise RuntimeError(f"{words}: exit status {done.returncode}\n{done.stderr}")
    return done.stdout


def wheel(*words, **kw):
    return json.loads(run("wheel", *words, "--json", **kw))["rows"]


def soils():
    found = {}
    for path in sorted((root / "data/soils").glob("*.json")):
        for soil in json.loads(path.read_text())["soils"]:
            found[soil["name"]] = soil
    return found


def integral(f, low, high, panels=1000):
    """Simpson's rule."""
    if high <= low:
        return 0.0
    step = (high - low) / panels
    return step / 3 * sum((1 if k in (0, panels) else 4 if k % 2 else 2) * f(low + k * step) for k in range(panels + 1))


def split(f, low, middle, high):
    return integral(f, low, middle) + integral(f, middle, high)


class Artemis:
    """ARTEMIS equations 1 to 11 and 16 to 20; contact ends behind the lowest point at that share of the entry angle."""

    def __init__(self, soil, r, b, load, slip, beta=0.0, n=None, exit_ratio=0.0):
        self.r, self.b, self.soil, self.exit_ratio = r, b, soil, exit_ratio
        k, n = soil["k_c"] / b + soil["k_phi"], soil["n"] if n is None else n
        tan_phi, c = math.tan(math.radians(soil["friction_angle_deg"])), soil["cohesion_pa"]
        shear, a1, a2 = soil["shear_modulus_x_m"], soil.get("c1", 0.18), soil.get("c2", 0.32)
        u, skew = (1 - slip if slip >= 0 else 1 / (1 + slip)), math.tan(beta)

        def stresses(front):
            top = (a1 + a2 * abs(slip)) * front

            def sigma(t):
                rear = -exit_ratio * front
                behind = front - (t - rear) / (top - rear) * (front - top) if t < top else t
                return k * (r * max(0.0, math.cos(behind) - math.cos(front))) ** n

            def mobilised(j):
                return math.copysign(1 - math.exp(-abs(j) / shear), j)

            def along(t):
                return (c + sigma(t) * tan_phi) * mobilised(r * (front - t - u * (math.sin(front) - math.sin(t))))

            def across(t):
                return (c + sigma(t) * tan_phi) * mobilised(r * u * (front - t) * skew)

            return top, sigma, along, across

        def carried(front):
            top, sigma, along, _ = stresses(front)
            return b * r * split(lambda t: sigma(t) * math.cos(t) + along(t) * math.sin(t), -exit_ratio * front, top, front)

        low, high = 1e-4, 1.4
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if carried(middle) < load else (low, middle)
        self.front = (low + high) / 2
        self.shear_at(stresses)

    def shear_at(self, stresses):
        r, b, front = self.r, self.b, self.front
        top, sigma, along, across = stresses(front)
        rear = -self.exit_ratio * front
        c, tan_phi = self.soil["cohesion_pa"], math.tan(math.radians(self.soil["friction_angle_deg"]))
        self.strength_along_n = b * r * split(lambda t: (c + sigma(t) * tan_phi) * math.cos(t), rear, top, front)
        self.sinkage_m = r * (1 - math.cos(front))
        self.thrust_n = b * r * split(lambda t: along(t) * math.cos(t), rear, top, front)
        self.compaction_resistance_n = b * r * split(lambda t: sigma(t) * math.sin(t), rear, top, front)
        self.drawbar_pull_n = self.thrust_n - self.compaction_resistance_n
        self.lateral_force_n = -b * r * split(across, rear, top, front)
        self.torque_nm = b * r * r * split(along, rear, top, front)


def campaign(table, folder):
    """The outcomes of a table's drives by their ids, with terrain, curvature and whether they turn on the spot; and the summary by terrain."""
    run("campaign", str(table), "--out", str(folder))
    drives = {}
    for drive in json.loads((folder / "campaign.json").read_text())["drives"]:
        drives[drive["id"]] = json.loads((folder / "drives" / f"{drive['id']}.json").read_text()) | {
            "terrain": drive["terrain"], "curvature": drive["commanded"]["curvature_1_m"], "turns": drive["commanded"]["turn_in_place"]}
    return drives, {t["terrain"]: t for t in json.loads((folder / "summary.json").read_text())["terrains"]}


def heading_error(pair):
    return abs((pair[0]["final"]["yaw_deg"] - pair[1]["final"]["yaw_deg"] + 180) % 360 - 180)


def part_fido():
    """ROAMS section 4: slip of the drives on drawn soils, and their errors against the same drives on the mean soil, a test being all repeats."""
    with tempfile.TemporaryDirectory() as folder:
        here = pathlib.Path(folder)
        table = json.loads((root / "data/campaigns/fido_table_1.json").read_text())
        (here / "mean.json").write_text(json.dumps(table | {"draw_soils": False}))
        drawn, summary = campaign("fido_table_1", here / "drawn")
        mean, _ = campaign(here / "mean.json", here / "mean")
        table["soils"][0]["friction_angle_deg"] = 51.6
        only = [drive | {"repeats": 1} for drive in table["drives"] if "length_m" in drive["legs"][0]]
        (here / "roams.json").write_text(json.dumps(table | {"draw_soils": False, "drives": only}))
        _, roams = campaign(here / "roams.json", here / "roams")
    for terrain, at in summary.items():
        tests = collections.defaultdict(list)
        for name, drive in drawn.items():
            if drive["terrain"] == terrain:
                tests[re.sub(r"-r\d+$", "", name)].append((drive, mean[name]))
        drives, turns = [t for t in tests.values() if not t[0][0]["turns"]], {n: t for n, t in tests.items() if t[0][0]["turns"]}
        slip, pairs = at["final_slip_ratio"], [pair for test in drives for pair in test]
        forward, aside = [], []
        for is_, said in pairs:
            x, y, yaw = is_["final"]["x_m"] - said["final"]["x_m"], is_["final"]["y_m"] - said["final"]["y_m"], math.radians(said["start"]["yaw_deg"])
            forward.append(abs(x * math.cos(yaw) + y * math.sin(yaw)))
            aside.append(abs(y * math.cos(yaw) - x * math.sin(yaw)))
        averages = [statistics.mean(map(heading_error, test)) for test in drives]
        tight = [heading_error(p) for p in pairs if abs(p[0]["curvature"]) > 0.5]
        other = [heading_error(p) for p in pairs if abs(p[0]["curvature"]) < 0.5]
        turned = [(float(re.search(r"turn_\w+?_(\d+)", name)[1]), heading_error(pair)) for name, test in turns.items() for pair in test]
        within = [(size, error < 0.1 * size) for size, error in turned]
        turn_averages = [statistics.mean(map(heading_error, test)) for test in turns.values()]
        print(f"  {terrain}: slip {100 * slip['lowest']:.2f} to {100 * slip['highest']:.1f} %, "
              f"5 to 95 % of drives {100 * slip['p05']:.1f} to {100 * slip['p95']:.1f} %, "
              f"standard deviation {100 * statistics.pstdev(p[0]['final_slip_ratio'] for p in pairs):.1f} points; "
              f"on one sand as ROAMS's {100 * roams[terrain]['final_slip_ratio']['lowest']:.1f} to {100 * roams[terrain]['final_slip_ratio']['highest']:.1f} %")
        print(f"    drives: {sum(a > 6 for a in averages)} of {len(averages)} tests average beyond 6 deg, at most {max(averages):.1f} deg; "
              f"tight arcs {statistics.mean(tight):.1f} deg, others {statistics.mean(other):.1f} deg; "
              f"forward {1000 * statistics.mean(forward):.0f} mm, sideways {1000 * statistics.mean(aside):.0f} mm")
        print(f"    turns: {100 * statistics.mean(w for _, w in within):.0f} % within a tenth of the turn, "
              f"{100 * statistics.mean(w for size, w in within if size == 5):.0f} % of those of 5 deg; mean error {statistics.mean(e for _, e in turned):.1f} deg; "
              f"{sum(a > 6 for a in turn_averages)} of {len(turn_averages)} tests average beyond 6 deg, at most {max(turn_averages):.1f} deg")


def part_slide():
    """ARTEMIS section 2.3: down the slope while the rover drives across it."""
    with tempfile.TemporaryDirectory() as folder:
        drives, _ = campaign(root / "docs/guide/examples/sliding.json", pathlib.Path(folder))
    for name, drive in drives.items():
        print(f"  {name}: {abs(drive['final']['y_m'] - drive['start']['y_m']):.2f} m across, "
              f"{drive['start']['x_m'] - drive['final']['x_m']:.2f} m down the slope, {drive['end']}")


def part_wheel():
    soil, columns = soils()["artemis_dry_sand"], ("sinkage_m", "thrust_n", "compaction_resistance_n", "drawbar_pull_n", "lateral_force_n", "torque_nm")
    rows = wheel("--rover", "mer-class", "--soil", "artemis_dry_sand", "--load", "100", "--sweep", "slip=-0.3,0,0.3,0.6,0.9", "--sweep", "slip_angle_deg=0,15")
    furthest = dict.fromkeys(columns, 0.0)
    for row in rows:
        paper = Artemis(soil, 0.125, 0.16, 100, row["slip"], math.radians(row["slip_angle_deg"]))
        for name in columns:
            scale = 100 if name.endswith("_n") else 12.5 if name == "torque_nm" else paper.sinkage_m
            furthest[name] = max(furthest[name], abs(row[name] - getattr(paper, name)) / scale)
    for name in columns:
        print(f"  {name}: furthest apart by {100 * furthest[name]:.4f} % of {'the sinkage' if name == 'sinkage_m' else 'the load' if name != 'torque_nm' else 'load times radius'} over {len(rows)} tests")
    row = next(r for r in rows if r["slip"] == 0.6 and r["slip_angle_deg"] == 0)
    print(f"  slip 0.6: pull times v over torque times rate, v by equation 21: {row['drawbar_pull_n'] * (1 - 0.6) * 0.125 / row['torque_nm']:.5f}, program {row['tractive_efficiency']:.5f}")
    row = next(r for r in rows if r["slip"] == 0.6 and r["slip_angle_deg"] == 15)
    paper = Artemis(soil, 0.125, 0.16, 100, 0.6, math.radians(15))
    for name in columns:
        print(f"  slip 0.6, 15 deg: {name} printed equations {getattr(paper, name):.5g}, program {row[name]:.5g}")
    row, paper = wheel(*ON_SAND, "--slip", "0.3", "--set", "soil.exit_angle_ratio=0.1")[0], Artemis(soil, 0.125, 0.16, 100, 0.3, exit_ratio=0.1)
    print(f"  slip 0.3, exit angle a tenth of the entry angle: {beside(paper, row)}")
    for name in ("artemis_dry_sand", "vl1_blocky"):
        row = wheel("--rover", "mer-class", "--soil", name, "--load", "100", "--slip", "-0.9")[0]
        print(f"  slip -0.9 on {name}: {beside(Artemis(soils()[name], 0.125, 0.16, 100, -0.9), row)}")


ON_SAND = ("--rover", "mer-class", "--soil", "artemis_dry_sand", "--load", "100")


def beside(paper, row):
    return (f"sinkage printed equations {1000 * paper.sinkage_m:.4f} mm, program {1000 * row['sinkage_m']:.4f} mm; "
            f"pull {paper.drawbar_pull_n:.4f}, {row['drawbar_pull_n']:.4f} N; torque {paper.torque_nm:.4f}, {row['torque_nm']:.4f} N m")


def part_derivations():
    """Shear displacements: the integrals and derivatives that the papers print against the closed forms that they print."""
    front, r, skew, furthest = 0.6, 0.125, math.tan(math.radians(15)), {}

    def apart(name, got, want):
        furthest[name] = max(furthest.get(name, 0.0), abs(got - want) / r)

    for slip in (-0.4, 0.0, 0.3, 0.9):
        u = 1 - slip if slip >= 0 else 1 / (1 + slip)  # forward speed over the rim's, by equation 21
        for t in (0.0, 0.2, 0.4):
            driving = r * (front - t - (1 - slip) * (math.sin(front) - math.sin(t)))
            braking = r * (front - t - (math.sin(front) - math.sin(t)) / (1 + slip))
            apart("ARTEMIS 4 to 5", integral(lambda a: r * (1 - u * math.cos(a)), t, front), driving if slip >= 0 else braking)
            across = r * (1 - slip) * (front - t) * skew if slip >= 0 else r * (front - t) * skew / (1 + slip)
            apart("ARTEMIS 7, 8 to 9, 10", integral(lambda a: r * u * skew, t, front), across)
            if slip < 0:
                continue

            def x(a):
                return r * (1 - slip) * (front - a) - r * (math.sin(front) - math.sin(a))

            def y(a):
                return r * (math.cos(a) - math.cos(front))

            h = 1e-5
            dx, dy = r * (math.cos(t) - 1 + slip), -r * math.sin(t)
            apart("Zhurong A5 to A6", math.hypot((x(t + h) - x(t - h)) / (2 * h) - dx, (y(t + h) - y(t - h)) / (2 * h) - dy), 0.0)
            apart("Zhurong A6 to A7", dy * math.sin(t) - dx * math.cos(t), r * ((1 - slip) * math.cos(t) - 1))
            apart("Zhurong A7 to A8", -integral(lambda a: r * ((1 - slip) * math.cos(a) - 1), t, front), driving)
    for name, most in furthest.items():
        print(f"  {name}: {'less' if most < 1e-9 else 'MORE'} than 1e-9 of the radius apart")


def part_side_wall():
    soil, r = soils()["artemis_dry_sand"], 0.125
    for slip in (0.3, 0.9):
        side_wall_at(soil, r, slip)


def side_wall_at(soil, r, slip):
    words = ("--rover", "mer-class", "--soil", "artemis_dry_sand", "--load", "100", "--slip", str(slip), "--slip-angle-deg", "15")
    bare, walled = wheel(*words)[0], wheel(*words, "--effect", "side_bulldozing")[0]
    phi, gamma = math.radians(soil["friction_angle_deg"]), soil.get("density_kg_m3", 1500) * 3.71
    n_q = math.exp((1.5 * math.pi - phi) * math.tan(phi)) / (2 * math.cos(math.pi / 4 + phi / 2) ** 2)
    n_c, n_gamma = (n_q - 1) / math.tan(phi), 2 * (n_q + 1) * math.tan(phi) / (1 + 0.4 * math.sin(4 * phi))
    half, axle = r * math.sin(math.radians(walled["entry_angle_deg"])), r - walled["sinkage_m"]

    def f(x):
        return math.sqrt(max(0.0, r * r - x * x)) - axle

    wall = integral(lambda x: (gamma * n_gamma * f(x) + soil["cohesion_pa"] * n_c) * f(x), -half, half)
    print(f"  N_q {n_q:.2f}, N_c {n_c:.2f}, N_gamma {n_gamma:.2f}; F_b {wall:.4f} N")
    want, got = wall * math.sin(math.radians(15)), bare["lateral_force_n"] - walled["lateral_force_n"]
    print(f"  slip {slip}: F_b sin(15 deg) printed equations {want:.4f} N, program {got:.4f} N ({100 * (got / want - 1):+.2f} %)")


def part_grousers():
    soil, r, b, h, count = soils()["artemis_dry_sand"], 0.125, 0.16, 0.01, 24
    phi, gamma, c = math.radians(soil["friction_angle_deg"]), soil.get("density_kg_m3", 1500) * 3.71, soil["cohesion_pa"]
    n_phi = math.tan(math.pi / 4 + phi / 2) ** 2
    one = b * (gamma * h * h * n_phi / 2 + 2 * c * h * math.sqrt(n_phi))
    words = ("--rover", "mer-class", "--soil", "artemis_dry_sand", "--sinkage-m", "0.01", "--slip", "0.9")
    bare = wheel(*words)[0]
    front = math.radians(bare["entry_angle_deg"])
    want = count / (2 * math.pi) * one * math.sin(front)
    print(f"  F_g of one grouser, alpha 0: {one:.3f} N; of the {count * front / (2 * math.pi):.2f} in contact along the travel: {want:.3f} N")
    for mobilisation in (0.02, 1):
        lugged = wheel(*words, "--effect", f"grousers:height_m={h},count={count},mobilisation={mobilisation}")[0]
        got = lugged["thrust_n"] - bare["thrust_n"]
        print(f"  mobilisation={mobilisation}: thrust {got:.3f} N more ({100 * (got / want - 1):+.2f} %), upward {lugged['vertical_force_n'] - bare['vertical_force_n']:.3f} N "
              f"more (equation 20: {count / (2 * math.pi) * one * (1 - math.cos(front)):.3f}), torque {lugged['torque_nm'] - bare['torque_nm']:.4f} N m more "
              f"(at 2/3 of the height: {count * front / (2 * math.pi) * one * (r + 2 / 3 * h):.4f})")


def part_slip_sinkage():
    soil = soils()["artemis_dry_sand"]
    for slip in (0.2, 0.6):
        row = wheel("--rover", "mer-class", "--soil", "artemis_dry_sand", "--load", "100", "--slip", str(slip), "--effect", "slip_sinkage:n1=0.3")[0]
        paper = Artemis(soil, 0.125, 0.16, 100, slip, n=soil["n"] + 0.3 * slip)
        print(f"  slip {slip}: sinkage printed equation {1000 * paper.sinkage_m:.3f} mm, program {1000 * row['sinkage_m']:.3f} mm; pull {paper.drawbar_pull_n:.3f}, {row['drawbar_pull_n']:.3f} N")
        row = wheel(*ON_SAND, "--slip", str(slip), "--slip-angle-deg", "30", "--effect", "slip_sinkage:n1=0.3")[0]
        paper = Artemis(soil, 0.125, 0.16, 100, slip, math.radians(30), n=soil["n"] + 0.3 * slip)
        print(f"  slip {slip}, 30 deg: sinkage printed equation {1000 * paper.sinkage_m:.3f} mm, "
              f"program {1000 * row['sinkage_m']:.3f} mm ({100 * (row['sinkage_m'] / paper.sinkage_m - 1):+.1f} %)")


def part_estimate():
    """ARTEMIS's case study: random loads and slips, every number 49 % off, one Bekker constant, torque and thrust read."""
    truth, b = soils()["artemis_dry_sand"], 0.16
    wanted = {"k_bekker": truth["k_c"] / b + truth["k_phi"], "n": truth["n"], "cohesion": truth["cohesion_pa"],
              "friction_angle": truth["friction_angle_deg"], "shear_modulus": truth["shear_modulus_x_m"]}
    with tempfile.TemporaryDirectory() as folder:
        data = pathlib.Path(folder) / "data"
        data.mkdir()
        for entry in (root / "data").iterdir():
            if entry.name != "soils":
                (data / entry.name).symlink_to(entry)
        (data / "soils").mkdir()
        for path in (root / "data/soils").glob("*.json"):
            (data / "soils" / path.name).write_text(path.read_text())
        for name, sign in (("start_above", 1.49), ("start_below", 0.51)):
            start = dict(truth, name=name, summary="49 % off", source="papers.py")
            for key in ("k_c", "k_phi", "n", "cohesion_pa", "friction_angle_deg", "shear_modulus_x_m"):
                start[key] = truth[key] * sign
            start.pop("shear_modulus_y_m", None)
            (data / "soils" / f"{name}.json").write_text(json.dumps({"format": "soils/1", "soils": [start]}))
        for noise in (0.0, 0.02):
            for count in (5, 10, 20, 50, 100):
                worst = dict.fromkeys(wanted, 0.0)
                for seed in (1, 2, 3):
                    tests = wheel_tests(pathlib.Path(folder), count, noise, seed)
                    for start in ("start_above", "start_below"):
                        found = json.loads(run("estimate", "wheel", str(tests), "--wheel-radius", "0.125", "--wheel-width", "0.16", "--soil", start,
                                               "--merge-stiffness", "--prior", "none", "--no-profile", "--json", data=data))
                        values = {p["name"]: p["value"] for p in found["estimates"][0]["parameters"]}
                        worst = {name: max(worst[name], 100 * abs(values[name] / true - 1)) for name, true in wanted.items()}
                print(f"  {100 * noise:g} % noise, {count} tests, worst of 3 seeds and 2 starts: " + ", ".join(f"{name} {worst[name]:.2f} %" for name in wanted))


def wheel_tests(folder, count, noise, seed):
    """Torque and thrust of that many tests at random loads and slips, as the program's wheel has them, with noise as a share of a reading."""
    draw = random.Random(seed)
    (folder / "rows.csv").write_text("load_n,slip\n" + "".join(f"{draw.uniform(40, 200):.1f},{draw.uniform(0.05, 0.8):.3f}\n" for _ in range(count)))
    tests = folder / "tests.csv"
    tests.write_text("load_n,slip_ratio,torque_nm,thrust_n\n" + "".join(
        f"{r['load_n']},{r['slip']},{r['torque_nm'] * draw.gauss(1, noise):.8g},{r['thrust_n'] * draw.gauss(1, noise):.8g}\n"
        for r in wheel("--rover", "mer-class", "--soil", "artemis_dry_sand", "--rows", str(folder / "rows.csv"))))
    return tests


def part_limit():
    """What a contact may carry at most: c A + W tan(phi), which ROAMS takes from Terzaghi."""
    soil = soils()["artemis_dry_sand"]
    row = wheel("--rover", "mer-class", "--soil", "artemis_dry_sand", "--load", "100", "--slip", "0.99")[0]
    contact = 0.16 * 0.125 * math.radians(row["entry_angle_deg"])
    limit = soil["cohesion_pa"] * contact + 100 * math.tan(math.radians(soil["friction_angle_deg"]))
    print(f"  thrust at slip 0.99: {row['thrust_n']:.2f} N; c A + W tan(phi): {limit:.2f} N, {100 * (row['thrust_n'] / limit - 1):+.1f} %")
    paper = Artemis(soil, 0.125, 0.16, 100, 0.99)
    print(f"  strength along the travel, all of it mobilised: {paper.strength_along_n:.2f} N; by 1 - exp(-j / K): {paper.thrust_n:.2f} N")


def part_motor():
    """ROAMS section 2.4 on the rover of docs/guide/examples, with a resistance and a damping of the shaft."""
    with tempfile.TemporaryDirectory() as folder:
        data = pathlib.Path(folder) / "data"
        (data / "rovers").mkdir(parents=True)
        (data / "soils").symlink_to(root / "data/soils")
        rover = json.loads((root / "docs/guide/examples/four_wheeled.json").read_text())
        k, gear, ohm, b = 0.03, 100.0, 8.0, 2e-5
        rover["drive"] |= {"gear_efficiency": 1.0, "no_load_current_a": 0.0, "resistance_ohm": ohm, "damping_nms_rad": b}
        (data / "rovers/four_wheeled.json").write_text(json.dumps(rover))
        for slope in (0, 10):
            row = wheel("--rover", "four_wheeled", "--soil", "jlu_mars_2_dense", "--whole-rover", "--gravity", "9.81", "--slope", str(slope), data=data)[0]
            rate = gear * rover["cruise_speed_m_s"] / 0.1
            power = 0.0
            for name in ("lf", "lr", "rf", "rr"):
                torque, current = row[f"{name}_torque_nm"], row[f"{name}_current_a"]
                want = (torque / gear + b * rate) / k
                power += want * (ohm * want + k * rate)
                if name in ("lf", "lr"):
                    print(f"  {slope} deg, {name}: torque {torque:.4f} N m, current printed equations {want:.5f} A, program {current:.5f} A")
            print(f"  {slope} deg: power V i of the four {power:.4f} W, program {row['power_w']:.4f} W")
        rover["drive"]["resistance_ohm"] = 20.0
        (data / "rovers/four_wheeled.json").write_text(json.dumps(rover))
        rows = wheel("--rover", "four_wheeled", "--soil", "jlu_mars_2_dense", "--whole-rover", "--gravity", "9.81", "--sweep", "slope_deg=0:12:2", data=data)
        volts, rate = rover["drive"]["bus_voltage_v"], gear * rover["cruise_speed_m_s"] / 0.1
        print(f"  20 ohm: {volts:g} V leave {(volts - k * rate) / 20:.4f} A at this rate; " + "; ".join(
            f"{r['slope_deg']:g} deg {r['outcome']}" + (f" {max(r[w + '_current_a'] for w in ('lf', 'lr', 'rf', 'rr')):.3f} A" if r["outcome"] == "balanced" else "") for r in rows))


def zhurong_torque(r, b, k_s, n, c, phi_deg, shear, c1, c2, slip, sinkage):
    """Zhurong equation A16 with A11, A15 and A9."""
    front = math.acos((r - sinkage) / r)
    top, tan_phi = (c1 + c2 * slip) * front, math.tan(math.radians(phi_deg))

    def tau(t):
        at = t if t > top else front - t / top * (front - top)
        sigma = k_s * (r * max(0.0, math.cos(at) - math.cos(front))) ** n
        return (c + sigma * tan_phi) * (1 - math.exp(-r / shear * ((front - t) - (1 - slip) * (math.sin(front) - math.sin(t)))))

    return r * r * b * (integral(tau, 0, top, 400) + integral(tau, top, front, 400))


def part_current():
    r, b, k_i, load = 0.1475, 0.2, 0.1578, 204.5 * 9.81 / 6
    known = soils()
    for figure in (9, 10, 11):
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            run("current", "map", "--figure", str(figure), "--csv", file.name)
            rows = list(csv.DictReader(open(file.name)))
        furthest_t = furthest_z = 0.0
        sunk = compared = below = 0
        for row in rows:
            soil = known[row["soil"]]
            k_s, n, slip = float(row["k_s"]), float(row["n"]), float(row["slip"])
            z = (3 * load / (b * k_s * math.sqrt(2 * r) * (3 - n))) ** (2 / (2 * n + 1))
            if not row["current_a"]:
                sunk, below = sunk + 1, below + (z > r)
                continue
            t = zhurong_torque(r, b, k_s, n, float(row["cohesion_pa"]), float(row["friction_angle_deg"]), float(row["shear_modulus_x_m"]), soil["c1"], soil["c2"], slip, z)
            furthest_t = max(furthest_t, abs(float(row["torque_nm"]) / t - 1))
            furthest_z = max(furthest_z, abs(float(row["sinkage_m"]) / z - 1))
            compared += 1
        print(f"  figure {figure}: {compared} points, torque (A16) at most {100 * furthest_t:.4f} % apart, sinkage (A18) {100 * furthest_z:.4f} %; {sunk} points have no current, at {below} of which A18 is below the axle")
        {9: trends_9, 10: trends_10, 11: lambda _: None}[figure](rows)
    soil = known["jlu_mars_2_dense"]
    k_s = soil["k_c"] / b + soil["k_phi"]
    z = (3 * load / (b * k_s * math.sqrt(2 * r) * (3 - soil["n"]))) ** (2 / (2 * soil["n"] + 1))
    t = zhurong_torque(r, b, k_s, soil["n"], soil["cohesion_pa"], soil["friction_angle_deg"], soil["shear_modulus_x_m"], soil["c1"], soil["c2"], 0, z)
    print(f"  JLU Mars 2 dense at slip 0: T {t:.4f} N m, T / k_I {t / k_i:.2f} A, T / (79.3 k_I) {t / k_i / 79.3:.4f} A")
    rows = wheel("--rover", "zhurong-class", "--soil", "jlu_mars_2_dense", "--gravity", "9.81", "--sweep", "slip=0:0.9:0.3")
    print("  torque over current of the shipped motor: " + ", ".join(f"{w['torque_nm'] / w['current_a']:.4f}" for w in rows) + f" N m/A; 79.3 k_I {79.3 * k_i:.4f}")


def trends_9(rows):
    curves = collections.defaultdict(list)
    for row in rows:
        curves[row["panel"]].append((float(row["slip"]), float(row["current_a"])))
    for panel, curve in curves.items():
        curve.sort()
        top = max(curve, key=lambda p: p[1])
        slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(curve, curve[1:])]
        print(f"    {panel}: {curve[0][1]:.3f} A at slip 0, first slope {slopes[0]:.2f} A, "
              f"slope {'falls throughout' if all(b < a for a, b in zip(slopes, slopes[1:])) else 'does NOT fall throughout'}, current greatest at slip {top[0]:g}")


def trends_10(rows):
    """Panels 1 have curves over k_s by n at slip 0.1, panels 2 by slip at the soil's n; a, b, c have the shear numbers of the three simulants."""
    over_k, over_n, over_slip, places = (collections.defaultdict(list) for _ in range(4))
    for row in rows:
        if not row["current_a"]:
            continue
        (simulant, group), k, n, slip, current = row["panel"], float(row["k_s"]), float(row["n"]), float(row["slip"]), float(row["current_a"])
        over_k[row["panel"], n if group == "1" else slip].append((k, current))
        if group == "1":
            over_n[simulant, k].append((n, current))
            places[k, n].append((simulant, current))
        else:
            over_slip[simulant, k].append((slip, current))

    def count(curves, rises):
        return sum(all((b[1] > a[1]) == rises for a, b in zip(sorted(c), sorted(c)[1:])) for c in curves)

    several = [c for c in over_n.values() if len(c) > 1]
    full = [p for p in places.values() if len(p) == 3]
    print(f"    over k_s: falls on {count(over_k.values(), False)} of {len(over_k)} curves; over n: rises on {count(several, True)} of {len(several)}; "
          f"over slip: rises on {count(over_slip.values(), True)} of {len(over_slip)}; "
          f"JLU Mars 2's shear draws most at {sum(max(p, key=lambda s: s[1])[0] == 'b' for p in full)} of {len(full)} pairs of k_s and n")
    for simulant in "abc":
        peaks = [max(current for _, current in over_k[simulant + "2", slip]) for slip in (0.1, 0.9)]
        curves = {n: dict(over_k[simulant + "1", n]) for n in (0.7, 1.4)}
        shared = sorted(curves[0.7].keys() & curves[1.4].keys())
        steep = [max((curve[a] - curve[b]) / (b - a) for a, b in zip(shared, shared[1:])) * 1e6 for curve in curves.values()]
        print(f"    {simulant}: greatest current over k_s {peaks[0]:.2f} A at slip 0.1, {peaks[1]:.2f} A at 0.9; "
              f"steepest fall from k_s {shared[0] / 1000:.0f} kN/m^(n+2) on: "
              f"{steep[0]:.2f} A per 1,000 kN/m^(n+2) with n 0.7, {steep[1]:.2f} with n 1.4")


def part_tests():
    """Zhurong's Table 4, Figure 15 and the means of section 4.2; an error of the paper is over the measured value."""
    six, means, said = (0.125, 0.100, 0.128, 0.108, 0.096, 0.110), {"+Y": 0.117, "-Y": 0.105, "all": 0.110}, 0.114
    errors = [100 * (i - said) / i for i in six]
    print("  Table 4: errors " + ", ".join(f"{e:+.2f}" for e in errors) + f" %, mean of their sizes {statistics.mean(map(abs, errors)):.2f} %")
    for name, of in (("+Y", six[:3]), ("-Y", six[3:]), ("all", six)):
        print(f"    mean {name}: printed {means[name]:.3f} A, error {100 * (means[name] - said) / means[name]:+.2f} %; "
              f"mean of the printed currents {statistics.mean(of):.4f} A, error {100 * (statistics.mean(of) - said) / statistics.mean(of):+.2f} %")
    for soil, slip, error in (("jlu_mars_2_dense", 0.05, 47.82), ("jlu_mars_2_dense", 0.5, 2.26), ("jlu_mars_3_dense", 0.28, 0.99), ("jlu_mars_3_dense", 0.59, 11.51)):
        literal, balanced = (float(json.loads(run("current", "map", "--soil", soil, "--x", f"slip={slip}", "--model", model, "--json"))["panels"][0]["points"][0]["current_a"])
                             for model in ("literal", "balanced"))
        low, high = literal / (1 + error / 100), literal / (1 - error / 100)
        print(f"  {soil}, slip {slip}: literal {literal:.3f} A; by its error of {error} % {low:.3f} or {high:.3f} A were measured; "
              f"balanced {balanced:.3f} A, {balanced / high:.2f} to {balanced / low:.2f} times that")
    print(f"  section 4.2: (13 x 14.58 + 8 x 8.40) / 21 = {(13 * 14.58 + 8 * 8.40) / 21:.2f} %; the nine other tests on JLU Mars 2 average {(17 * 6.52 - 8 * 8.40) / 9:.1f} %, "
          f"the four of low pull {(13 * 14.58 - (17 * 6.52 - 8 * 8.40)) / 4:.1f} %")


def part_climb():
    """The steepest slope in whole degrees that the balanced rover climbs on each simulant, without lugs and with lugs of 5 mm."""
    for effect in ((), ("--effect", "grousers:height_m=0.005,count=20")):
        found = []
        for simulant in (1, 2, 3):
            for state in ("loose", "medium", "dense"):
                rows = wheel("--rover", "zhurong-class", "--whole-rover", "--gravity", "9.81", "--soil", f"jlu_mars_{simulant}_{state}", "--sweep", "slope_deg=0:28:1", *effect)
                climbed = [r["slope_deg"] for r in rows if r["outcome"] == "balanced"]
                found.append(f"{max(climbed):g}" if climbed else "none")
        print(f"  {'lugs of 5 mm' if effect else 'no lugs'}: {' '.join(found)} deg on loose, medium, dense of simulants 1, 2, 3")


def part_states():
    """Zhurong figure 3: the numbers of Table 1 over the greatest of their kind, and what the text says of their trends."""
    known, keys = soils(), ("k_c", "k_phi", "n", "cohesion_pa", "friction_angle_deg", "shear_modulus_x_m")
    table = {(s, state): known[f"jlu_mars_{s}_{state}"] for s in (1, 2, 3) for state in ("loose", "medium", "dense")}
    for key in keys:
        most = max(soil[key] for soil in table.values())
        rises = [s for s in (1, 2, 3) if table[s, "loose"][key] < table[s, "medium"][key] < table[s, "dense"][key]]
        grain = [state for state in ("loose", "medium", "dense") if table[1, state][key] < table[2, state][key] < table[3, state][key]]
        print(f"  {key}: " + " ".join(f"{table[s, state][key] / most:.3f}" for s in (1, 2, 3) for state in ("loose", "medium", "dense"))
              + f"; rises with hardness in simulants {rises}, with grain size in states {grain}")


def part_soils():
    """Table 1 of ARTEMIS, Tables 1 and 3 of Zhurong, as their pages print them, against the shipped soils; k in kN."""
    printed = {"artemis_dry_sand": (6.94, 505.8, 0.705, 0.960, 27.3, 1.14)}
    for row in csv.DictReader(open(root / "data/validation/zhurong_table_1.csv")):
        printed[row["state"].lower().replace(" ", "_")] = tuple(
            float(row[key]) for key in ("k_c_kn", "k_phi_kn", "n", "cohesion_kpa", "friction_angle_deg", "shear_modulus_cm"))
    printed |= {
        "vl1_drift": (1.4, 820, 1.0, 1.6, 18, None), "vl1_blocky": (1.4, 820, 1.0, 5.5, 30.8, None), "vl2_crusty_cloddy": (1.4, 820, 1.0, 1.1, 34.5, None),
        "mpf_drift": (1.4, 820, 1.0, 0.38, 23.1, None), "mpf_cloddy": (1.4, 820, 1.0, 0.17, 37.0, None), "mer_a_loose": (None, None, None, 1.0, 20, None),
        "mer_a_dense": (None, None, None, 15, 25, None), "mer_b_slope_soil": (20, 210, 0.8, 0.5, 20, 3), "mer_b_sandy_loam": (20, 7600, 1.0, 5, 20, 3),
        "msl_bedrock": (100, 100, 1.4, 1.5, 30, 3), "dry_sand": (0.99, 1528, 1.1, 1.04, 28, None), "sandy_loam": (5.27, 1515, 0.7, 1.72, 29, None),
        "clayey_soil": (13.19, 692.2, 0.5, 4.14, 13, None)}
    known, scale = soils(), (1000, 1000, 1, 1000, 1, 0.01)
    keys = ("k_c", "k_phi", "n", "cohesion_pa", "friction_angle_deg", "shear_modulus_x_m")
    same = compared = 0
    for name, row in printed.items():
        if name not in known:
            print(f"  {name}: no such soil")
            continue
        for key, value, factor in zip(keys, row, scale):
            if value is None:
                continue
            compared += 1
            if key in known[name] and abs(known[name][key] - value * factor) < 1e-9 + 1e-6 * abs(value * factor):
                same += 1
            else:
                print(f"  {name}.{key}: printed {value * factor:g}, shipped {known[name].get(key)}")
    print(f"  {same} of {compared} printed numbers of {len(printed)} rows are the shipped ones")


PARTS = {name[5:]: f for name, f in list(globals().items()) if name.startswith("part_")}
for name in sys.argv[1:] or PARTS:
    print(name)
    PARTS[name]()
