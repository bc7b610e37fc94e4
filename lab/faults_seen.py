# SPDX-License-Identifier: BSD-3-Clause
"""Which faults of a drive show on a robot's own signals: the shoulder of a UR5 in closed loop, in motions of its own,
judged by hjt.assess beside the same drive when it was sound.

Robots, each with a drive and a program of its own. Each is recorded sound, at temperatures that the judge does not know
and on paths that differ a little; the first thirty recordings are its reference, the rest, and recordings with a fault,
are judged. Recordings that are there already are kept.

    lab/run faults_seen
"""
import argparse
import collections
import concurrent.futures
import pathlib
import re
import sys
import warnings

import numpy

import harmonic_joint_twin as hjt

import lab

RATE = 500                       # of the recordings [Hz]
RATIO = 101.0
JOINT, PLACE = "shoulder", 1
REFERENCE, JUDGED = 30, 20       # sound recordings of each robot
SEVERITIES = (0.3, 1.0)
TEMPERATURES = (20.0, 30.0)      # of the drives, unknown to the judge [degC]
STRAY = 0.03                     # of each pose from one recording to the next [rad]
MOVE, STOP, MOVES = (0.7, 1.4), 0.2, 10  # [s], [s]
SENSORS = {"UR5: 125 Hz": 125, "UR5e: 500 Hz": 500}  # [Hz]
ROBOTS, FITTED = (990, 991), (870, 871)  # that are judged; that config/signatures/size_25.yaml is fitted to
# Sensors of a UR5 as its recordings show them: angles to 4e-6 rad, noise at rest of one count. The torque noise of
# real_sensors.yaml, 0.01 N.m, is 0.09 A: between what rows differ by at rest, 0.01 to 0.08 A, and in motion, 0.12 to
# 0.29 A.
OVERLAY = {"sensors.output_counts_per_turn": 1 << 20, "sensors.output_noise": 5e-6, "sensors.delay": 0.0}
COLUMNS = ("target_q", "target_moment", "actual_q", "actual_current")
# As docs/python.md has them for a UR's RTDE.
SIGNALS = {"time": "time", "output_angle": "actual_q", "target_angle": "target_q", "motor_torque": "actual_current",
           "load_torque": "target_moment"}
SHARES = ("load_friction", "lag_ripple", "lag_order_1", "lag_order_2", "lag_order_4")
HIDDEN = 5.0                     # standard errors of a share
ROBOT_SECTION = """
# Changes of friction by load and lag of a robot in closed loop, for any gear in any motion: [cause, severity, then, as
# shares of the sound values, load_friction, lag_ripple, lag_order_1, _2, _4]. Source: `lab/run faults_seen --fit`.
robots:
"""
CUP = (33.2e3, 56.1e3, 65.2e3)   # [N.m/rad]


class Robot:
    """A drive of the shoulder and a program, drawn by number."""

    def __init__(self, number, work):
        draw = numpy.random.default_rng(number)
        self.number, self.folder = number, work / f"robot_{number}"
        self.folder.mkdir(parents=True, exist_ok=True)
        stretch = draw.uniform(0.93, 1.07)
        springs = ", ".join(f"{stretch * shipped:.0f}.0" for shipped in CUP)
        drive = (f"cup: {{torsion_stiffness: [{springs}]}}\n"
                 f"mesh: {{flank_clearance: {draw.uniform(-1.4e-6, -0.7e-6):.3e}}}\n"
                 f"bearing: {{race_preload: {draw.uniform(450.0, 590.0):.1f}, "
                 f"viscosity: {draw.uniform(300e-6, 380e-6):.3e}}}\n"
                 f"sensors: {{motor_lines: [{draw.uniform(0, 2e-4):.2e}, {draw.uniform(0, 2e-4):.2e}]}}\n")
        drives = self.folder / "drives"
        drives.mkdir(exist_ok=True)
        for name in ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3"):
            (drives / f"{name}.yaml").write_text(drive if name == JOINT else "sensors: {}\n")
        self.drives = drives
        # About the upright arm, so that the shoulder's load passes through zero.
        middle, reach = numpy.array([0.0, -1.5, 1.0, -1.3, -1.5, 0.0]), numpy.array([0.8, 0.5, 0.6, 0.5, 0.4, 0.8])
        self.poses = middle + draw.uniform(-1.0, 1.0, (5, 6)) * reach
        self.poses[:, PLACE] = middle[PLACE] + reach[PLACE] * draw.permutation([-1.0, -0.5, 0.1, 0.6, 1.0])
        self.times = draw.uniform(*MOVE, 5)

    def motion(self, seed):
        """Quintics between the poses, which stray: columns of hjt.arm."""
        draw = numpy.random.default_rng([self.number, seed])
        at = self.poses[0] + draw.normal(0.0, STRAY, 6)
        position, velocity, acceleration = [at], [numpy.zeros(6)], [numpy.zeros(6)]
        for move in range(1, MOVES + 1):
            before, at = at, self.poses[move % 5] + draw.normal(0.0, STRAY, 6)
            length = self.times[move % 5]
            s = numpy.arange(1, round(length * 125) + 1)[:, None] / round(length * 125)
            length = round(length * 125) / 125.0
            position += list(before + (at - before) * (10 * s**3 - 15 * s**4 + 6 * s**5))
            velocity += list((at - before) * (30 * s**2 - 60 * s**3 + 30 * s**4) / length)
            acceleration += list((at - before) * (60 * s - 180 * s**2 + 120 * s**3) / length**2)
            rest = round(STOP * 125)
            for column, held in ((position, at), (velocity, numpy.zeros(6)), (acceleration, numpy.zeros(6))):
                column += [held] * rest
        return {"time": numpy.arange(len(position)) / 125.0, "position": numpy.array(position),
                "velocity": numpy.array(velocity), "acceleration": numpy.array(acceleration)}

    def record(self, seed, fault=None, shift=0.0):
        """Columns of the joint at RATE; made unless it is there. `shift`: of its angle [rad]."""
        name = fault.replace(":", "_") if fault else f"shift_{shift}" if shift else "sound"
        path = self.folder / f"{name}_{seed}.npz"
        if not path.exists():
            draw = numpy.random.default_rng([self.number, seed, 7])
            overlays = ["real_sensors.yaml", {**OVERLAY, "sensors.noise_seed": int(seed),
                                              "input.temperature": float(draw.uniform(*TEMPERATURES))}]
            motion = self.motion(seed)
            motion["position"][:, PLACE] += shift
            made = hjt.arm(motion, "ur5", faults=[f"{JOINT}:{fault}"] if fault else [], rate=float(RATE),
                           identified=self.drives, overlays=overlays)
            numpy.savez(path, time=made["rows"]["timestamp"], **{key: made["rows"][key][:, PLACE] for key in COLUMNS})
        with numpy.load(path) as file:
            return {name: file[name] for name in file.files}


# Faults that are not the gear's: kind of hjt.drive_fault, in words, three sizes as printed, their factor to SI.
Other = collections.namedtuple("Other", "kind words sizes unit factor")
OTHERS = (Other("brake_drag", "brake drags", (0.01, 0.03, 0.1), "N·m at the motor", 1.0),
          Other("encoder_offset", "output encoder off", (1.0, 5.0, 20.0), "mrad", 1e-3),
          Other("current_gain", "gain of the current", (2.0, 5.0, 10.0), "%", 0.01),
          Other("weak_magnets", "weak magnets", (2.0, 5.0, 10.0), "% of the flux", 0.01))


def disturbed(robot, seed, other, size, gain):
    """A sound recording with a fault that is not the gear's. A wrong angle at the output is what the controller goes
    by: the joint stands elsewhere, its readings where they are wanted. Other faults leave the motion as it is."""
    sound = robot.record(seed)
    if other.kind == "encoder_offset":
        elsewhere = robot.record(seed, shift=size * other.factor)
        return {**elsewhere, **{name: sound[name] for name in ("target_q", "target_moment")},
                "actual_q": elsewhere["actual_q"] - size * other.factor}
    changed = hjt.drive_fault({"time": sound["time"], "motor_torque_reading": sound["actual_current"] * gain / RATIO,
                               "motor_angle_encoder": RATIO * sound["actual_q"]}, other.kind, size * other.factor)
    return {**sound, "actual_current": changed["motor_torque_reading"] * RATIO / gain}


def work_through(robots, kinds, jobs):
    """Makes what is not there."""
    todo = [(robot, seed, None, 0.0) for robot in robots for seed in range(REFERENCE + JUDGED)]
    todo += [(robot, REFERENCE, None, size * other.factor) for robot in robots for other in OTHERS
             if other.kind == "encoder_offset" for size in other.sizes]
    todo += [(robot, seed_of(place, severity), fault_of(kind, severity), 0.0) for robot in robots
             for severity in SEVERITIES for place, kind in enumerate(kinds)]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for done, _ in enumerate(pool.map(lambda each: each[0].record(*each[1:]), todo), 1):
            if done % 10 == 0:
                print(f"faults_seen: {done} of {len(todo)}", file=sys.stderr, flush=True)


def seed_of(place, severity):
    """Every fault and severity has a path, a temperature and noise of its own."""
    return 1000 + 100 * (len(SEVERITIES) - 1 - SEVERITIES.index(severity)) + place


def fault_of(kind, severity):
    """Of the whole member where that may be, pitting of one tooth, others at their first place."""
    return f"{kind}:{severity}" + (":40" if kind == "pitting" else "")


class Judge:
    """Verdicts on recordings of one robot, by its first sound ones."""

    def __init__(self, robot, rate, gain):
        self.rate, self.file = rate, robot.folder / f"reference_{rate}.yaml"
        sound = [robot.record(seed) for seed in range(REFERENCE)]
        whole = {"indicators.window_turns": 1e5, "indicators.window_time": float(sound[0]["time"][-1]) - 0.1,
                 "output.gravity_torque": 0.0}  # the moment has it
        self.how = {"columns": SIGNALS, "torque_scale": gain / RATIO, "overlays": ["joints/shoulder.yaml", whole]}
        hjt.reference(self.frames(sound), self.file, force=True, **self.how)

    def frames(self, runs):
        return [{name: run[name][::RATE // self.rate] for name in SIGNALS.values()} for run in runs]

    def __call__(self, runs):
        return hjt.assess(self.frames(runs), self.file, check_up=True, **self.how)

    def numbers(self, runs):
        """Those of SHARES, a row for each recording."""
        windows = hjt.indicators(self.frames(runs), **self.how)["windows"]
        return numpy.array([[window["indicators"][name] for name in SHARES] for window in windows], float)


def shares_of(robots, kinds, gain):
    """What faults change in the numbers of robots, over the sound values; 0 what the spread of sound recordings hides:
    {(kind, severity): shares}."""
    found = collections.defaultdict(list)
    errors = []
    for robot in robots:
        for rate in SENSORS.values():
            judge = Judge(robot, rate, gain)
            sound = judge.numbers([robot.record(seed) for seed in range(REFERENCE)])
            errors.append(numpy.nanstd(sound, axis=0, ddof=1) / numpy.nanmean(sound, axis=0) / numpy.sqrt(len(robots)))
            for place, kind in enumerate(kinds):
                runs = [robot.record(seed_of(place, severity), fault_of(kind, severity)) for severity in SEVERITIES]
                for severity, numbers in zip(SEVERITIES, judge.numbers(runs)):
                    found[kind, severity].append(numbers / numpy.nanmean(sound, axis=0) - 1.0)
    error = numpy.nanmean(errors, axis=0)
    means = {key: numpy.nanmean(several, axis=0) for key, several in found.items()}
    return {key: numpy.where(numpy.abs(mean) > HIDDEN * error, mean, 0.0) for key, mean in means.items()}


def write_shares(path, shares):
    """The section `robots` of a file of signatures."""
    text = path.read_text(encoding="utf-8")
    rows = "".join(f"  - [{', '.join([kind, *(str(float(f'{number:.3g}')) for number in (severity, *numbers))])}]\n"
                   for (kind, severity), numbers in shares.items() if numpy.any(numbers))
    text = re.sub(r"\n# Changes of friction by load and lag.*?(?=\n# A row each)", "", text, flags=re.DOTALL)
    path.write_text(text.replace("\n# A row each", ROBOT_SECTION + rows + "\n# A row each"), encoding="utf-8")


def alarms(verdicts):
    return list(verdicts["level"].isin(["WARN", "ERROR"]))


def in_set(kind, verdict):
    return kind in [verdict["cause"], *str(verdict["alternatives"]).split(", ")]


def judge_robot(robot, judge, kinds, gain, found):
    """Alarms, causes in the set and what was furthest off, by fault and size."""
    sound = alarms(judge([robot.record(seed) for seed in range(REFERENCE, REFERENCE + JUDGED)]))
    found["sound"] += sum(sound)
    for place, kind in enumerate(kinds):
        verdicts = judge([robot.record(seed_of(place, severity), fault_of(kind, severity)) for severity in SEVERITIES])
        for severity, alarm, (_, verdict) in zip(SEVERITIES, alarms(verdicts), verdicts.iterrows()):
            found[kind, severity] += alarm
            found["alarms"] += alarm
            found["right"] += alarm and verdict["cause"] == kind
            found["in set"] += alarm and in_set(kind, verdict)
            found[kind].update([verdict["indicator"]] * alarm)
    for other in OTHERS:
        verdicts = judge([disturbed(robot, REFERENCE, other, size, gain) for size in other.sizes])
        for size, alarm, indicator in zip(other.sizes, alarms(verdicts), verdicts["indicator"]):
            found[other.kind, size] += alarm
            found[other.kind].update([indicator] * alarm)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the recordings")
    parser.add_argument("--docs", type=pathlib.Path, help="folder of health.md; else to the terminal")
    parser.add_argument("--robots", type=int, default=len(ROBOTS), help="how many [2]")
    parser.add_argument("--fit", type=pathlib.Path, metavar="FILE", help="of signatures: writes its section `robots` "
                        "from robots of their own in place of the table")
    parser.add_argument("--jobs", type=int, default=2, help="recordings at a time [2]")
    options = parser.parse_args()
    warnings.simplefilter("ignore")  # of recordings that are not judged: they count as no alarm
    kinds = list(hjt.fault_kinds())
    numbers = FITTED if options.fit else ROBOTS
    robots = [Robot(number, options.work.resolve()) for number in numbers[:options.robots]]
    work_through(robots, kinds, options.jobs)
    gain = hjt.Parameters("joints/shoulder.yaml")["telemetry.torque_per_current"]
    if options.fit:
        write_shares(options.fit, shares_of(robots, kinds, gain))
        return
    found = {}
    for sensors, rate in SENSORS.items():
        print(f"faults_seen: judging, {sensors}", file=sys.stderr, flush=True)
        found[sensors] = collections.Counter()
        for kind in [*kinds, *(other.kind for other in OTHERS)]:
            found[sensors][kind] = collections.Counter()
        for robot in robots:
            judge_robot(robot, Judge(robot, rate, gain), kinds, gain, found[sensors])
    lab.write_or_print(options.docs, "health.md", "seen", table(kinds, found, len(robots)))


def table(kinds, found, robots):
    def most(kind):
        names = sum((each[kind] for each in found.values()), collections.Counter())
        return ", ".join(f"`{name}`" for name, _ in names.most_common(2)) or "-"

    def row(words, kind, sizes):
        cells = [", ".join(str(each[kind, size]) for size in sizes) for each in found.values()]
        return f"| {words} | " + " | ".join(cells) + f" | {most(kind)} |"

    rows = [f"| fault (each cell: how many of {robots} robots alarm at severity "
            f"{' and at '.join(f'{severity:g}' for severity in SEVERITIES)}, or at the stated sizes) | "
            + " | ".join(found) + " | indicators with the largest deviation |", "|---|" + "---|" * (len(found) + 1)]
    rows += [row(f"`{kind}`", kind, SEVERITIES) for kind in kinds]
    rows += [row(f"{other.words}, {', '.join(f'{size:g}' for size in other.sizes)} {other.unit}", other.kind,
                 other.sizes) for other in OTHERS]
    rows.append(f"| none: false alarms in {robots * JUDGED} recordings | "
                + " | ".join(str(each["sound"]) for each in found.values()) + " | |")
    rows += [f"| {words}, of alarms | " + " | ".join(f"{each[key]} of {each['alarms']}" for each in found.values())
             + " | |" for words, key in (("named cause right", "right"), ("true cause in the set", "in set"))]
    return rows


if __name__ == "__main__":
    main()
