# SPDX-License-Identifier: BSD-3-Clause
"""Judges simulated recordings of every shipped arm, sound and not, with a reference and without, and writes how many
verdicts are right into docs/compare.md.

The reference is another motion of the same drives. Sensors have noise and eccentricity. Friction is drawn: of each
drive, of each group of joints and of each joint in a recording. It is raised in the recorded current.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import subprocess
import sys

import numpy

import lab

ARMS = ("ur3", "ur5", "ur10", "ur3e", "ur5e", "ur10e", "ur16e")
JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")
GROUPS = (slice(0, 3), slice(3, 6))
NAMES = [f"{name}_joint" for name in ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")]
START = numpy.array([0.0, -1.2, 1.0, -1.3, -1.5, 0.3])   # [rad]
REACH = numpy.array([1.2, 0.6, 0.7, 1.0, 1.0, 1.5])      # to either side [rad]
SPEEDS = (0.15, 0.3, 0.5, 0.8)                           # [rad/s]
RATE = 125                                               # [Hz]
# Deviations of the friction: of a drive from its type, of a group of joints and of a joint in one recording.
OF_DRIVE, OF_GROUP, OF_RECORDING = 0.05, 0.05, 0.03
FAULTS = ("lubricant_degradation", "pitting", "bearing_outer_race", "interface_wear")
LOCAL = ("bearing_outer_race",)                          # faults that have a place
PAYLOAD = 1.8                                            # [kg]
LED = -0.85                                              # of the friction that a hand takes over


class Arm:
    """Simulated recordings of one shipped arm in `work`/`name`."""

    def __init__(self, options, name):
        self.tool, self.name = options.tool.resolve(), name
        self.work = options.work.resolve() / f"seed_{options.seed}" / name
        self.generator = numpy.random.default_rng([options.seed, ARMS.index(name)])
        self.work.mkdir(parents=True, exist_ok=True)
        self.drives = numpy.exp(OF_DRIVE * self.generator.standard_normal(len(JOINTS)))

    def run(self, *words):
        done = subprocess.run([str(self.tool), *map(str, words)], cwd=self.work, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, check=False)
        if done.returncode != 0:
            sys.exit(f"arm_verdicts: {self.name}: {' '.join(map(str, words))}: exit {done.returncode} {done.stderr}")
        return done

    def program(self, path, moves, speeds):
        lines = [f"start: {START.tolist()}", "speed: 0.5", "acceleration: 2.0", "moves:"]
        for move in range(moves):
            there = START + REACH * self.generator.uniform(-1.0, 1.0, len(JOINTS))
            lines.append(f"  - {{to: {numpy.round(there, 3).tolist()}, speed: {speeds[move % len(speeds)]}}}")
        (self.work / path).write_text("\n".join([*lines, ""]), encoding="utf-8")

    def simulate(self, program, path, *more, arm=None):
        if not (self.work / path).exists():
            self.run("arm", program, "--arm", arm or self.name, "--config", "real_sensors.yaml", "--rate", RATE,
                     "--out", path, "--json", *more)
        return self.rows(path)

    def rows(self, path, arm=None):
        """Columns by name, and each joint's friction in its current, as its twin has it [A]."""
        with open(self.work / path, encoding="utf-8") as file:
            names = file.readline().strip().split(",")
        table = numpy.loadtxt(self.work / path, delimiter=",", skiprows=1)
        rows = dict(zip(names, table.T))
        self.run("follow", path, "--arm", arm or self.name, "--out", path + ".rows", "--force", "--json")
        time, frictions = rows["timestamp"] - rows["timestamp"][0], []
        for joint in JOINTS:
            twin = numpy.genfromtxt(self.work / (path + ".rows") / f"{joint}.csv", delimiter=",", names=True)
            large = numpy.argmax(numpy.abs(twin["current_residual"]))
            gain = twin["residual_torque"][large] / twin["current_residual"][large]
            frictions.append(numpy.interp(time, twin["time"], twin["friction_torque"]) / gain)
        return rows, frictions

    def factors(self):
        """Of the friction of one recording of this arm."""
        groups = numpy.ones(len(JOINTS))
        for group in GROUPS:
            groups[group] = numpy.exp(OF_GROUP * self.generator.standard_normal())
        return self.drives * groups * numpy.exp(OF_RECORDING * self.generator.standard_normal(len(JOINTS)))

    def write(self, path, simulated, factors, stated=False):
        """With friction times `factors`; stated: the target current holds that of the type."""
        rows, frictions = simulated
        rows = dict(rows)
        for i, friction in enumerate(frictions):
            rows[f"actual_current_{i}"] = rows[f"actual_current_{i}"] + (factors[i] - 1.0) * friction
            if stated:
                rows[f"target_current_{i}"] = rows[f"target_current_{i}"] + friction
            else:
                rows.pop(f"target_current_{i}")
        self.table(path, rows)

    def table(self, path, rows):
        with open(self.work / path, "w", encoding="utf-8", newline="") as file:
            table = csv.writer(file)
            table.writerow(rows)
            table.writerows(map("{:.6g}".format, row) for row in zip(*rows.values()))

    def with_gripper(self, path, bag):
        """The recording as a driver and a gripper publish it on one topic."""
        import rosbag
        import rospy
        from sensor_msgs.msg import JointState
        rows = numpy.genfromtxt(self.work / path, delimiter=",", names=True)
        with rosbag.Bag(str(self.work / bag), "w") as out:
            for row in rows:
                message = JointState()
                message.header.stamp = rospy.Time.from_sec(1000.0 + row["timestamp"])
                message.name = ["finger_joint", *NAMES]
                message.position = [0.4, *(row[f"actual_q_{i}"] for i in range(6))]
                message.velocity = [0.0, *(row[f"actual_qd_{i}"] for i in range(6))]
                message.effort = [0.1, *(row[f"actual_current_{i}"] for i in range(6))]
                out.write("/joint_states", message, message.header.stamp)

    def named(self, path, *more):
        """(joints that are WARN or worse, those not judged, what is said)."""
        done = self.run("compare", path, "--arm", self.name, "--json", *more)
        arm = json.loads(done.stdout)
        named = {joint["joint"] for joint in arm["joints"] if joint["level"] in ("WARN", "ERROR")}
        return named, {joint["joint"] for joint in arm["joints"] if joint["level"] == "NOT JUDGED"}, arm


def recordings(arm):
    """Of each case: (what, file, joints that are faulty, whether it is judged alone, beside the reference)."""
    arm.program("reference.yaml", 9, SPEEDS)
    arm.program("work.yaml", 14, SPEEDS[1:] + SPEEDS[:1])
    arm.write("reference.csv", arm.simulate("reference.yaml", "reference_raw.csv"), arm.factors())
    arm.run("compare", "reference.csv", "--arm", arm.name, "--report", "reference", "--force", "--json")
    sound = arm.simulate("work.yaml", "sound_raw.csv")
    factors = arm.factors()
    arm.write("sound.csv", sound, factors)
    cases = [("sound", "sound.csv", (), True, True)]
    for number, kind in enumerate(FAULTS):
        joint = JOINTS[(number + ARMS.index(arm.name)) % len(JOINTS)] if number > 1 else JOINTS[2 * number + 1]
        file = f"{kind}_{joint}.csv"
        fault = f"{joint}:{kind}:0.8:{0 if kind in LOCAL else -1}"
        arm.write(file, arm.simulate("work.yaml", "raw_" + file, "--fault", fault), factors)
        cases.append((kind, file, (joint,), True, True))
    arm.write("two.csv", sound, factors * [1.0, 1.0, 1.6, 1.0, 1.8, 1.0])
    cases.append(("friction + 60 % elbow, + 80 % wrist_2", "two.csv", ("elbow", "wrist_2"), True, True))
    return sound, factors, cases


def judge(options, name):
    arm = Arm(options, name)
    sound, factors, cases = recordings(arm)
    loaded = options.docs.resolve().parent / "config" / "arms" / f"{name}.yaml"
    (arm.work / "loaded.yaml").write_text(f"like: {loaded}\npayload: {{mass: {PAYLOAD}, centre: [0.0, 0.02, 0.06]}}\n",
                                          encoding="utf-8")
    arm.write("loaded.csv", arm.simulate("work.yaml", "loaded_raw.csv", arm="loaded.yaml"), factors)
    cases.append((f"payload of {PAYLOAD} kg, not configured", "loaded.csv", (), True, True))
    arm.with_gripper("sound.csv", "gripper.bag")
    cases.append(("gripper in the messages", "gripper.bag", (), True, True))
    arm.write("led.csv", sound, numpy.full(len(JOINTS), 1.0 + LED))
    cases.append(("led by hand", "led.csv", (), True, True))
    for i, joint in enumerate(JOINTS):
        raised = numpy.ones(len(JOINTS))
        raised[i] = 1.2
        arm.write(f"raised_{joint}.csv", sound, factors * raised)
        cases.append(("friction + 20 %", f"raised_{joint}.csv", (joint,), False, True))
        raised[i] = 1.3
        arm.write(f"stated_{joint}.csv", sound, factors * raised, stated=True)
        cases.append(("friction + 30 %, target_current", f"stated_{joint}.csv", (joint,), True, False))
    found = []
    for what, file, faulty, alone, beside in cases:
        for with_reference in [False] * alone + [True] * beside:
            named, unjudged, text = arm.named(file, *(["--reference", "reference"] if with_reference else []))
            found.append((name, what, with_reference, faulty, named, unjudged, text))
            print(f"{name} {what} {'beside' if with_reference else 'alone'}: faulty {list(faulty)}, named "
                  f"{sorted(named)}, not judged {sorted(unjudged)}", flush=True)
    return found


def table(found):
    lines = ["| recording | reference | faulty joints (all joints if the recording has no fault) | faulty joints named "
             "| faulty joints missed | joints not judged | sound joints named | found payload [kg], in how many arms |",
             "|---|---|---|---|---|---|---|---|"]
    for what, reference in dict.fromkeys((case[1], case[2]) for case in found):
        cases = [case for case in found if case[1:3] == (what, reference)]
        faulty = sum(len(case[3]) for case in cases)
        right = sum(len(set(case[3]) & case[4]) for case in cases)
        unjudged = sum(len(set(case[3]) & case[5]) for case in cases)
        of_sound = sum(len(case[5] - set(case[3])) for case in cases)
        others = sum(len(case[4] - set(case[3])) for case in cases)
        masses = [case[6]["payload_mass"] for case in cases if case[6]["payload_mass"] is not None]
        payload = f"{min(masses):.1f} to {max(masses):.1f} in {len(masses)} of {len(cases)} arms" if masses else "-"
        count = f"{right} | {faulty - right - unjudged} | {unjudged}" if faulty else f"- | - | {of_sound}"
        lines.append(f"| {what} | {'yes' if reference else 'no'} | {faulty or len(cases) * len(JOINTS)} | {count} "
                     f"| {others} | {payload} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder of compare.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder of the runs; simulated ones are kept")
    parser.add_argument("--seed", type=int, default=1, help="of motions and frictions [1]")
    parser.add_argument("--arms", nargs="+", default=ARMS, choices=ARMS,
                        help="only these; the table is printed then [all]")
    parser.add_argument("--jobs", type=int, default=2, help="arms at the same time [2]")
    options = parser.parse_args()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        found = [case for cases in pool.map(lambda name: judge(options, name), options.arms) for case in cases]
    lab.write_or_print(options.docs if tuple(options.arms) == ARMS else None, "compare.md", "arm_verdicts",
                       table(found))


if __name__ == "__main__":
    main()
