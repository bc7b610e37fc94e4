# SPDX-License-Identifier: BSD-3-Clause
"""A whole arm far from its usual range: a run beside itself on a quarter of the step, one verdict a cell. Motions go
through `joint_twin arm`, what changes while the arm moves through hjt.Arm."""
import csv
import json
import os
import re
import subprocess
import sys

import numpy as np
import yaml

import harmonic_joint_twin as hjt
import judge

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import lab  # noqa: E402  (its folder is known now)

RATE = 10000.0             # of the solver, as shipped [Hz]
FINER = 4.0                # the converged run's over it
LEAST_TRAVEL = 0.02        # rad: a joint that hardly moves is held against this
ACCURACY = 0.01            # of the travel
TIMEOUT = 600.0            # s a run
COUNTS = ["solver_failures", "step_cuts", "jumps", "coarse_steps", "torque_clamped", "speed_limited", "overloads",
          "feedback_limited"]
START = [0.0, -1.2, 1.0, -1.3, -1.5, 0.3]
# Those of ArmController::defaultGains of the UR5: position [1/s], speed [N.m.s/rad], integral time [s].
SPEEDS = [271.1] * 3 + [62.5] * 3
GAINS = [{"position": 20.0, "speed": speed, "integral_time": 0.07, "coulomb": 0.0, "viscous": 0.0} for speed in SPEEDS]


def program(way=0.5, speed=1.0, acceleration=4.0, jerk=None):
    """There and back, all joints."""
    there = [angle + (-way if i % 2 else way) for i, angle in enumerate(START)]
    common = {"start": START, "speed": speed, "acceleration": acceleration}
    return {**common, **({"jerk": jerk} if jerk else {}), "moves": [{"to": there}, {"to": START}]}


def scaled(name, factor):
    return [{**gains, name: gains[name] * factor} for gains in GAINS]


def all_scaled(factor):
    return [{**gains, "position": gains["position"] * factor, "speed": gains["speed"] * factor} for gains in GAINS]


def set_points(*ways, period=0.008):
    """Set points a period apart, all joints as far from the start."""
    return [[period * k, *(angle + way for angle in START)] for k, way in enumerate(ways)]


def stairs():
    """Steps of 0.02 rad, ten a second, up and down."""
    return set_points(*(0.02 * min(k // 12, 12 - k // 12) for k in range(150)))


def wave(changed=None):
    """There and back by 0.2 rad; one row is changed."""
    found = set_points(*(0.1 * (1.0 - np.cos(2.0 * np.pi * k / 150.0)) for k in range(151)))
    if changed:
        changed(found)
    return found


def not_a_number(found):
    found[70][3] = float("nan")


def twice(found):
    found[70][0] = found[69][0]


SMOOTH = program(jerk=40.0)
ALL_FAULTS = ["base:tooth_wear:0.6:-1:0.5", "shoulder:flexspline_crack:0.5:0:0.5", "shoulder:tooth_wear:0.5:-1:0.5",
              "elbow:lubricant_degradation:1.0:-1:0.5", "wrist_1:wave_generator_wear:0.8:-1:0.5",
              "wrist_2:bearing_outer_race:0.7:0:0.5", "wrist_3:interface_wear:0.9:-1:0.5"]

# Name, motion, changes: of the arm (wrist masses times, payload [kg], gains), of the run (arm, faults, rate of rows
# [Hz]) or while it moves (what hjt.Arm is told at which time [s]).
CELLS = [
    ("as shipped", SMOOTH, {}),
    ("no limit of the jerk, 4 rad/s2", program(), {}),
    ("15 rad/s2, 2.5 rad/s", program(speed=2.5, acceleration=15.0), {}),
    ("40 rad/s2: beyond the joints' torque", program(speed=2.5, acceleration=40.0), {}),
    ("a step of 0.5 rad within 0.03 s: the arm stops in its brakes", [
        [time, *(angle + way for angle in START)] for time, way in ((0.0, 0.0), (0.3, 0.0), (0.33, 0.5), (1.0, 0.5))],
     {}),
    ("stairs of 0.02 rad, ten a second", stairs(), {}),
    ("begins and ends at 1 rad/s", set_points(*(0.008 * k for k in range(100))), {}),
    ("a set point that is no number", wave(not_a_number), {}),
    ("two set points at one time", wave(twice), {}),
    ("payload of 5 kg, the maker's limit", SMOOTH, {"payload": 5.0}),
    ("payload of 50 kg", SMOOTH, {"payload": 50.0}),
    ("payload of 5 kg put on and off in motion", SMOOTH,
     {"during": [(0.7, "set_payload", (5.0,)), (1.4, "set_payload", (0.0,))]}),
    ("payload of 50 kg put on in motion", SMOOTH, {"during": [(0.7, "set_payload", (50.0,))]}),
    ("pushed by 30 N in motion", SMOOTH, {"during": [(0.7, "set_wrench", ((0.0, 30.0, -20.0),))]}),
    ("pushed by 1000 N in motion", SMOOTH, {"during": [(0.7, "set_wrench", ((0.0, 1000.0, 0.0),))]}),
    ("pushed by 2000 N", SMOOTH, {"during": [(0.7, "set_wrench", ((0.0, 2000.0, 0.0),))]}),
    ("wrists 2 and 3 of a tenth of their mass", SMOOTH, {"wrists": 0.1}),
    ("of a thousandth", SMOOTH, {"wrists": 1e-3}),
    ("gain of the position x 10", SMOOTH, {"gains": scaled("position", 10.0)}),
    ("gain of the speed x 10", SMOOTH, {"gains": scaled("speed", 10.0)}),
    ("integral time / 10", SMOOTH, {"gains": scaled("integral_time", 0.1)}),
    ("gain of the position / 10", SMOOTH, {"gains": scaled("position", 0.1)}),
    ("gain of the speed / 10", SMOOTH, {"gains": scaled("speed", 0.1)}),
    ("both / 10", SMOOTH, {"gains": all_scaled(0.1)}),
    ("seven faults in six joints, at once in motion", SMOOTH, {"faults": ALL_FAULTS}),
    ("a UR3e", SMOOTH, {"arm": "ur3e"}),
    ("a UR16e", SMOOTH, {"arm": "ur16e"}),
    ("a UR8 Long", SMOOTH, {"arm": "ur8long"}),
    ("rows at 1 kHz", SMOOTH, {"rate": 1000.0}),
]


def write_arm(work, config, payload=0.0, wrists=1.0, gains=None):
    """The UR5 with these changes: the path of its file."""
    with open(os.path.join(config, "arms", "ur5.yaml"), encoding="utf-8") as file:
        arm = yaml.safe_load(file)
    with open(os.path.join(config, "arms", "ur5.urdf"), encoding="utf-8") as file:
        urdf = file.read()
    for link in ("wrist_2_link", "wrist_3_link"):
        begin = urdf.index(f'<link name="{link}">')
        end = urdf.index("</link>", begin)
        lighter = re.sub(r'(mass value|i..)="([^"]*)"', lambda m: f'{m[1]}="{float(m[2]) * wrists!r}"', urdf[begin:end])
        urdf = urdf[:begin] + lighter + urdf[end:]
    with open(os.path.join(work, "arm.urdf"), "w", encoding="utf-8") as file:
        file.write(urdf)
    arm["description"] = "arm.urdf"
    arm["payload"]["mass"] = payload
    for joint, own in zip(arm["joints"], gains or [None] * len(arm["joints"])):
        joint.update({"controller": own} if own else {})
    path = os.path.join(work, "arm.yaml")
    with open(path, "w", encoding="utf-8") as file:
        yaml.safe_dump(arm, file)
    return path


def write_motion(work, motion):
    if isinstance(motion, dict):
        path = os.path.join(work, "motion.yaml")
        with open(path, "w", encoding="utf-8") as file:
            yaml.safe_dump(motion, file)
        return path
    path = os.path.join(work, "motion.csv")
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(["timestamp"] + [f"target_q_{i}" for i in range(len(START))])
        table.writerows(motion)
    return path


def run(tool, work, motion, arm, rate, faults, row_rate):
    """(exit code, document or None, actual angles over time, text on stderr)."""
    out = os.path.join(work, "run.csv")
    done = subprocess.run([tool, "arm", motion, "--arm", arm, "--out", out, "--force", "--json", "--set",
                           f"solver.rate={rate!r}", *(word for fault in faults for word in ("--fault", fault)),
                           *(["--rate", str(row_rate)] if row_rate else [])],
                          capture_output=True, text=True, timeout=TIMEOUT, check=False)
    if not done.stdout:
        return done.returncode, None, None, done.stderr.strip()
    table = np.genfromtxt(out, delimiter=",", names=True)
    angles = np.column_stack([table[f"actual_q_{i}"] for i in range(len(START))])
    return done.returncode, json.loads(done.stdout), angles, done.stderr.strip()


def run_told(motion, arm, rate, during):
    """The same of hjt.Arm, which is told something at some times."""
    moving = hjt.Arm(arm, START, overlays=[{"solver.rate": rate}])
    length, angles = moving.move(motion), []
    try:
        for time, call, arguments in [*during, (length, None, ())]:
            angles.append(moving.run(time - moving.time)["actual_q"])
            if call:
                getattr(moving, call)(*arguments)
    except (hjt.InputError, hjt.ParameterError) as error:
        return 1, None, None, f"joint_twin: {error}"
    return 0, {**moving.counters, "protective_stop": moving.protective_stop}, np.vstack(angles), ""


def reports(document):
    """What the run itself says was not as it should be."""
    found = [f"{document[count]} {count.replace('_', ' ')}" for count in COUNTS if document.get(count)]
    stop = document["protective_stop"]
    return ([f"protective stop: {stop['joint']} {stop['reason']}"] if stop else []) + found


def judge_cell(tool, work, config, cell):
    """(verdict, error over the travel, reason)."""
    _, motion, changes = cell
    changes = dict(changes)
    during, faults = changes.pop("during", None), changes.pop("faults", [])
    row_rate, other = changes.pop("rate", None), changes.pop("arm", None)
    arm, path = other or write_arm(work, config, **changes), write_motion(work, motion)

    def moved(rate):
        if during:
            return run_told(path, arm, rate, during)
        return run(tool, work, path, arm, rate, faults, row_rate)

    code, document, angles, message = moved(RATE)
    if code not in (0, 1, lab.STOPPED) or (document is None and "joint_twin: " not in message):
        return judge.CRASHED, float("nan"), message
    if document is None:
        reason = message.splitlines()[-1].split(": ", 2)[-1]
        return judge.REFUSED, float("nan"), reason.replace(work + os.sep, "").strip()
    if not np.all(np.isfinite(angles)):
        return judge.NOT_FINITE, float("nan"), ""
    _, _, finer, why = moved(FINER * RATE)
    if finer is None:
        return judge.CRASHED, float("nan"), f"the converged run was refused: {why}"
    travel = np.maximum(np.ptp(finer, axis=0), LEAST_TRAVEL)
    rows = min(len(angles), len(finer))
    error = float(np.max(np.abs(angles[:rows] - finer[:rows]) / travel))
    found = reports(document)
    if found:
        return judge.DEGRADED, error, ", ".join(found)
    return (judge.ACCURATE if error <= ACCURACY else judge.SILENT), error, ""


def main(tool, docs, work, only):
    """Judges the cells; unless some are left out, writes docs/arm_stress.csv, and how many there are of each verdict
    into docs/arm_twin.md. Returns the exit code."""
    config = os.path.join(os.path.dirname(docs), "config")
    rows = []
    for cell in CELLS:
        if only and only not in cell[0]:
            continue
        try:
            verdict, error, reason = judge_cell(tool, work, config, cell)
        except subprocess.TimeoutExpired:
            verdict, error, reason = judge.HUNG, float("nan"), f"more than {TIMEOUT:.0f} s"
        rows.append([cell[0], verdict, "" if np.isnan(error) else f"{100.0 * error:.2g} %", reason])
        print(f"{verdict}: {cell[0]}: {rows[-1][2]} {reason}", flush=True)
    verdicts = [row[1] for row in rows]
    if not only:
        with open(os.path.join(docs, "arm_stress.csv"), "w", encoding="utf-8", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(["UR5 unless named, six drives on surfaces", "verdict", "error", "what the run said"])
            table.writerows(rows)
        counts = "; ".join(f"{verdicts.count(name)} {name}" for name in judge.VERDICTS if name in verdicts)
        lab.write(os.path.join(docs, "arm_twin.md"), "arm_stress",
                  [f"The {len(rows)} runs have these results: {counts} ([arm_stress.csv](arm_stress.csv))."])
    return 0 if all(verdict in judge.GOOD for verdict in verdicts) else 1
