# SPDX-License-Identifier: BSD-3-Clause
"""Judges forty made-up working days of three arms by `compare`, alone and beside a reference of another motion of the
same drives, and writes truth and answer of each day into docs/working_days.csv, the counts into docs/compare.md.

The arms run in closed loop; drives differ, and the sensors' noise and eccentricity are those of arm_verdicts. In every
second day one joint's friction is raised by a half.
"""
import argparse
import concurrent.futures
import csv
import pathlib

import numpy

import arm_verdicts
import harmonic_joint_twin as hjt
import lab

ARMS = {"ur5": 5.0, "ur10e": 12.5, "ur3e": 3.0}   # rated payload [kg], data sheets
DAYS = ("sound", *(f"carries {share} of the rated payload" for share in ("0.1", "0.3", "0.8")),
        "gripper of 0.3 of the rated payload", "cold morning", "cold morning, gripper of 0.3 of the rated payload",
        "on a wall", "tool drags with 10 N", "pushed by hand, 60 N",
        "gripper of 0.3 of the rated payload from half time on", "currents late by 0.15 s", "gain of one joint 1.25")
SEED = 1                                          # of the page
WORN = 1.5                                        # of the friction of a worn joint
MORNING = 12.0                                    # of the oil [degC]; 25 is configured
CENTRE = (0.0, 0.02, 0.06)                        # of what is carried, in the frame of the flange [m]
DRAG = 10.0                                       # [N]
CYCLES = 8                                        # from A to B and back
RATE = arm_verdicts.RATE
WAYS = ("without a reference", "with a reference")
HEAD = ("day", "arm", "truth", *(f"{what} {way}" for way in WAYS for what in ("answer", "result")))  # of the CSV
STATES = ("right", "missed", "not judged", "wrong")
COLUMNS = ("target_q", "target_qd", "actual_q", "actual_qd", "actual_current", "target_current")


def dragged(arm, length):
    """Rows of a leg by tenths of a second, in each a force against the tip's motion in the one before."""
    parts = []
    for _ in range(int(numpy.ceil(10.0 * length))):
        parts.append(arm.run(0.1, rate=RATE))
        way = parts[-1]["actual_TCP_pose"][-1] - parts[-1]["actual_TCP_pose"][0]
        arm.set_wrench(force=-DRAG * way / max(numpy.linalg.norm(way), 1e-4))
    return parts


class Day(arm_verdicts.Arm):
    """A day of one arm: its recording, and what is true of it."""

    def __init__(self, options, arm, number, kind):
        super().__init__(options, arm)
        self.kind, self.rated = kind, ARMS[arm]
        self.work /= f"day_{number}"
        self.work.mkdir(parents=True, exist_ok=True)
        self.generator = numpy.random.default_rng([options.seed, number])
        self.drives = numpy.exp(arm_verdicts.OF_DRIVE * self.generator.standard_normal(6))
        shares = [float(word) for word in kind.split() if word[:2] == "0."]
        self.mass = shares[0] * self.rated if kind.startswith(("carries", "cold", "gripper")) and shares else 0.0
        self.worn = [arm_verdicts.JOINTS[self.generator.integers(5)]] if number % 2 else []

    def places(self):
        return arm_verdicts.START + arm_verdicts.REACH * self.generator.uniform(-1.0, 1.0, (2, 6))

    def simulated(self):
        """As of `simulate`: columns by name, and each joint's friction in its current [A]."""
        lines = f"like: {lab.CHECKOUT / 'config' / 'arms' / self.name}.yaml\n"
        lines += "gravity: [0.0, -9.82, 0.0]\n" if self.kind == "on a wall" else ""
        (self.work / "truth.yaml").write_text(lines, encoding="utf-8")
        start, there = self.places()
        arm = hjt.Arm(self.work / "truth.yaml", start, overlays=["real_sensors.yaml"])
        if self.kind.startswith("cold"):
            arm.set_temperature(MORNING)
        at_half_time = self.kind.endswith("half time on")
        if self.kind.startswith(("gripper", "cold")) and not at_half_time:
            arm.set_payload(self.mass, centre=CENTRE)
        parts = []
        for leg in range(2 * CYCLES):
            onward = leg % 2 == 0
            if self.kind.startswith("carries"):
                arm.set_payload(self.mass if onward else 0.0, centre=CENTRE)
            if at_half_time and leg == CYCLES:
                arm.set_payload(self.mass, centre=CENTRE)
            if self.kind.startswith("pushed") and leg % 5 == 2:
                arm.set_wrench(force=60.0 * self.generator.standard_normal(3) / 3.0 ** 0.5)
            program = self.work / "leg.yaml"
            goal, here = (there, start) if onward else (start, there)
            program.write_text(f"start: {here.tolist()}\nspeed: 0.5\nacceleration: 2.0\nmoves:\n"
                               f"  - {{to: {goal.tolist()}, speed: {arm_verdicts.SPEEDS[leg // 2 % 4]}}}\n",
                               encoding="utf-8")
            length = arm.move(str(program))
            parts += dragged(arm, length) if self.kind.startswith("tool") else [arm.run(length, rate=RATE)]
            arm.set_wrench()
            parts.append(arm.run(0.5, rate=RATE))
        joined = {name: numpy.concatenate([part[name] for part in parts]) for name in COLUMNS}
        table = {"timestamp": numpy.arange(len(joined["actual_q"])) / RATE}
        table.update((f"{name}_{i}", values[:, i]) for name, values in joined.items() for i in range(6))
        self.table("raw.csv", table)
        return self.rows("raw.csv", "truth.yaml")

    def record(self):
        """The recording of this day, and the joint whose current is changed."""
        factors = self.factors()
        for joint in self.worn:
            factors[arm_verdicts.JOINTS.index(joint)] *= WORN
        rows, frictions = self.simulated()
        late = round(0.15 * RATE) if self.kind.startswith("currents") else 0
        gains = numpy.ones(6)
        if self.kind.startswith("gain"):
            gains[1 + self.generator.integers(3)] = 1.25
        changed = dict(rows)
        for i, friction in enumerate(frictions):
            current = (rows[f"actual_current_{i}"] + (factors[i] - 1.0) * friction) / gains[i]
            changed[f"actual_current_{i}"] = numpy.append(numpy.full(late, current[0]), current[:len(current) - late])
            del changed[f"target_current_{i}"]
        self.table("day.csv", changed)
        self.program("reference.yaml", 9, arm_verdicts.SPEEDS)
        self.write("reference.csv", self.simulate("reference.yaml", "reference_raw.csv"), self.factors())
        self.run("compare", "reference.csv", "--arm", self.name, "--report", "reference", "--force", "--json")


def judge(options, number, arm, kind):
    day = Day(options, arm, number, kind)
    day.record()
    found = [day.named("day.csv", *beside) for beside in ([], ["--reference", "reference"])]
    for named, unjudged, document in found:
        print(f"{number} {arm} {kind}: worn {day.worn}, named {sorted(named)}, not judged {sorted(unjudged)}: "
              f"{document['text']}", flush=True)
    return day, found


def answer(day, named, unjudged, document):
    """What is said of a day, in the words of the table, and whether it is right, wrong or not judged."""
    words = [f"{name} {document['joints'][arm_verdicts.JOINTS.index(name)]['friction_ratio']:.2f}"
             for name in arm_verdicts.JOINTS if name in named]
    if document["payload_mass"] is not None:
        words.append(f"{document['payload_mass']:.1f} ± {document['payload_half_width']:.1f} kg")
    if document["gravity_tilt"] is not None:
        words.append(f"tilted by {numpy.degrees(document['gravity_tilt']):.0f}°")
    if document["drag"] is not None:
        words.append(f"drag of {document['drag']:.0f} ± {document['drag_half_width']:.0f} N")
    words += [f"not judged: {', '.join(name for name in arm_verdicts.JOINTS if name in unjudged)}"] if unjudged else []
    wrong = bool(named - set(day.worn)) or (
        document["payload_mass"] is not None
        and abs(document["payload_mass"] - day.mass) > document["payload_half_width"]) or (
        document["drag"] is not None
        and not (day.kind.startswith("tool") and abs(document["drag"] - DRAG) < document["drag_half_width"]))
    missed = set(day.worn) - named - unjudged
    open_ = set(day.worn) & unjudged if day.worn else unjudged
    state = "wrong" if wrong else "missed" if missed else "not judged" if open_ else "right"
    return "; ".join(words) or "OK", state


def rows_of(days):
    """Kind, arm, truth, then answer and state alone and beside a reference, of each day."""
    rows = []
    for day, found in days:
        truth = [f"{joint} {WORN * day.drives[arm_verdicts.JOINTS.index(joint)]:.2f}" for joint in day.worn]
        truth += [f"{day.mass:.1f} kg"] if day.mass else []
        rows.append([day.kind, day.name, ", ".join(truth) or "-",
                     *(cell for verdict in found for cell in answer(day, *verdict))])
    return rows


def table(rows):
    """Days by kind and state."""
    def counts(of, column):
        return [str(sum(row[column] == state for row in of) or "") for state in STATES]

    head = [f"{state}, {way}" for way in WAYS for state in STATES]
    lines = ["| day | " + " | ".join(head) + " |", "|---" * (1 + len(head)) + "|"]
    for kind, of in [*((kind, [row for row in rows if row[0] == kind]) for kind in DAYS), ("all", rows)]:
        lines.append(f"| {kind} | {' | '.join(counts(of, 4) + counts(of, 6))} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder of compare.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder of the runs")
    parser.add_argument("--seed", type=int, default=SEED,
                        help=f"of motions, frictions and worn joints; another than {SEED} prints the table [{SEED}]")
    parser.add_argument("--days", type=int, default=40, help="of 40, the first; the table is printed then [40]")
    parser.add_argument("--jobs", type=int, default=2, help="days at the same time [2]")
    options = parser.parse_args()
    chosen = [(number, list(ARMS)[number % 3], DAYS[number % len(DAYS)]) for number in range(options.days)]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        days = list(pool.map(lambda day: judge(options, *day), chosen))
    rows = rows_of(days)
    docs = options.docs if (options.days, options.seed) == (40, SEED) else None
    if docs:
        with open(docs / "working_days.csv", "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([HEAD, *rows])
    lab.write_or_print(docs, "compare.md", "working_days", table(rows))


if __name__ == "__main__":
    main()
