#!/usr/bin/env python3
"""Closes the loop of the diagnosis' next drives by simulation: a campaign of a few drives is diagnosed, the drives that it proposes
are made by the other simulator and added, and all are diagnosed again; beside it drives drawn at random from the same flight rules.

    close_the_loop.py SEALED_CAMPAIGNS SLIPWAY DATA CAUSE[+CAUSE] [--fidelity L2] [--size 1] [--seed 1] [--first 8] [--steps 4] [--random 2]

Prints a Markdown row a policy: after each step "+" where exactly the hidden effects are named (alone or beside something unexplained),
the verdict otherwise, and the marginal probability of the hidden effects. The policies see the diagnosis alone, never the key.
"""
import argparse
import json
import pathlib
import random
import subprocess
import tempfile

FLIGHT_RULES = {"tilt": (0, 5, 10, 15), "heading": (0, 90, 180), "speed": (0.05, 0.025, -0.05), "curvature": (0.0, 0.3), "temperature": (20, -40)}


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sealed_campaigns")
    parser.add_argument("slipway")
    parser.add_argument("data")
    parser.add_argument("cause")
    parser.add_argument("--fidelity", default="L2")
    parser.add_argument("--size", default="1")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=8)
    parser.add_argument("--steps", type=int, default=4)
    parser.add_argument("--random", type=int, default=2)
    return parser.parse_args()


class Loop:
    def __init__(self, asked, folder):
        self.asked, self.folder, self.made = asked, folder, 0
        self.hidden = set(asked.cause.split("+"))

    def diagnosed(self, more):
        """The diagnosis of the first drives and those that were added since."""
        self.made += 1
        out = self.folder / f"step-{self.made}"
        orders = self.folder / f"more-{self.made}.csv"
        # A drive that goes nowhere is added too, so that every folder is made with --more and on the same tables.
        orders.write_text("".join(f"s01,{','.join(str(v) for v in drive)}\n" for drive in more) or "none,0,0,0.05,0,20\n")
        command = [self.asked.sealed_campaigns, str(out), "--set", "each", "--only", self.asked.cause.split("+")[0],
                   "--fidelity", self.asked.fidelity, "--size", self.asked.size, "--seed", str(self.asked.seed),
                   "--drives", str(self.asked.first), "--more", str(orders)]
        subprocess.run(command, check=True, capture_output=True)
        done = subprocess.run([self.asked.slipway, "diagnose", str(out / "s01"), "--data", self.asked.data, "--json"],
                              check=True, capture_output=True)
        return json.loads(done.stdout)

    def words(self, diagnosis):
        named = {effect["name"] for effect in diagnosis["effects"]}
        marginal = min(m["probability"] for m in diagnosis["marginals"] if m["name"] in self.hidden)
        return f"{'+' if named == self.hidden else diagnosis['verdict']} ({marginal:.2f})"

    def run(self, start, choose):
        more, diagnosis, row = [], start, [self.words(start)]
        for _ in range(self.asked.steps):
            more += choose(diagnosis)
            diagnosis = self.diagnosed(more)
            row.append(self.words(diagnosis))
        return row


def proposed(diagnosis):
    return [(d["tilt_deg"], d["heading_deg"], d["speed_m_s"], d["curvature_1_m"], d["motor_temp_c"]) for d in diagnosis["next_drives"][:2]]


def main():
    asked = options()
    with tempfile.TemporaryDirectory() as name:
        loop = Loop(asked, pathlib.Path(name))
        start = loop.diagnosed([])
        heads = [f"{asked.first + 2 * step} drives" for step in range(asked.steps + 1)]
        print(f"| {asked.cause}, {asked.fidelity}, size {asked.size}, seed {asked.seed} | " + " | ".join(heads) + " |")
        print("|---" * (len(heads) + 1) + "|")
        print("| proposed | " + " | ".join(loop.run(start, proposed)) + " |", flush=True)
        for repeat in range(asked.random):
            dice = random.Random(1000 * asked.seed + repeat)
            drawn = lambda _: [tuple(dice.choice(FLIGHT_RULES[k]) for k in FLIGHT_RULES) for _ in range(2)]
            print(f"| random {repeat + 1} | " + " | ".join(loop.run(start, drawn)) + " |", flush=True)


if __name__ == "__main__":
    main()
