# SPDX-License-Identifier: BSD-3-Clause
"""Which faults of a drive show on a robot's own signals: the shoulder of a UR5 in closed loop, in motions of its own,
judged beside the same drive when it was sound.

Two robots, each with a drive and a program of its own. Each is recorded sound fifty times, at temperatures that the
judge does not know and on paths that differ a little. Of the first thirty each feature's mean and spread are taken; the
rest, and recordings with a fault, are judged. An alarm is a feature beyond Student's quantile of FALSE_ALARMS shared by
all features, and further off than in any of the references from the others of its robot. Recordings that are there
already are kept.

    lab/run faults_seen
"""
import argparse
import collections
import concurrent.futures
import pathlib
import sys

import numpy
import scipy.signal
import scipy.stats
import sklearn.covariance

import harmonic_joint_twin as hjt

import lab

RATE = 500                       # of the recordings [Hz]
RATIO = 101.0
JOINT, PLACE = "shoulder", 1
REFERENCE, JUDGED = 30, 20       # sound recordings of each robot
SEVERITIES = (0.3, 1.0)
FALSE_ALARMS = 0.01              # wanted, of recordings
TEMPERATURES = (20.0, 30.0)      # of the drives, unknown to the judge [degC]
STRAY = 0.03                     # of each pose from one recording to the next [rad]
MOVE, STOP, MOVES = (0.7, 1.4), 0.2, 10  # [s], [s]
VELOCITY_STEPS = 5               # over which the controller takes the motor's speed: 10 ms
# What a sound drive's friction differs by from one recording to the next: measured on one UR5 (docs/compare.md), beyond
# what temperature and sensors do here.
FRICTION_SHARE, FRICTION_FLOOR = 0.03, 0.22  # [-], [N.m]

SENSORS, ROBOTS = ("UR5", "UR5e", "motor encoder"), (870, 871)
# Sensors of a UR5 as its recordings show them: angles to 4e-6 rad, noise at rest of one count. The torque noise of
# real_sensors.yaml, 0.01 N.m, is 0.09 A: between what rows differ by at rest, 0.01 to 0.08 A, and in motion, 0.12 to
# 0.29 A.
OVERLAY = {"sensors.output_counts_per_turn": 1 << 20, "sensors.output_noise": 5e-6, "sensors.delay": 0.0}
COLUMNS = ("target_q", "target_qd", "target_qdd", "target_moment", "actual_q", "actual_qd", "actual_current")
CUP = (33.2e3, 56.1e3, 65.2e3)   # [N.m/rad]


def orders():
    """Lines of the drive by name, in cycles a turn of the motor (src/health/tracked_lines.cpp)."""
    drive = hjt.Parameters("joints/shoulder.yaml")
    share = drive["bearing.ball_diameter"] / drive["bearing.pitch_diameter"]
    cage, ball = 0.5 * (1.0 - share), 1.0 / share - share
    lobes, outer = 2.0 * (1.0 - cage), drive["bearing.balls"] * cage
    inner = drive["bearing.balls"] - outer
    return {"order 1": 1.0, "order 2": 2.0, "order 4": 4.0, "order 6": 6.0, "order 8": 8.0, "cage": lobes,
            "cage 2": 2.0 * lobes, "ball": ball, "ball -": ball - lobes, "ball +": ball + lobes, "outer": outer,
            "outer -": outer - 2.0, "outer +": outer + 2.0, "inner": inner, "inner 2": 2.0 * inner}


ORDERS = orders()


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


BANDS = (4.0, 8.0, 16.0, 31.0, 62.0, 125.0, 250.0)  # [Hz]


def fitted(columns, values):
    """Coefficients of columns of unit rms, and what is left."""
    matrix = numpy.column_stack(columns)
    found = numpy.linalg.lstsq(matrix, values, rcond=None)[0]
    return found, values - matrix @ found


def rms(values):
    return float(numpy.sqrt(numpy.mean(values**2)))


def spectral(found, name, values, rate, motor, moves):
    """Rms in bands, the logarithm, and amplitudes of the lines in the moves, to the power of 2/3."""
    for low, high in zip(BANDS, BANDS[1:]):
        if high <= 0.5 * rate:
            wanted = [low, min(high, 0.499 * rate)]
            band = scipy.signal.sosfiltfilt(scipy.signal.butter(2, wanted, "bandpass", fs=rate, output="sos"), values)
            found[f"{name}, {low:g} Hz"] = numpy.log(rms(band) + 1e-12)
    for line, order in ORDERS.items():
        power = [abs(numpy.mean(values[move] * numpy.hanning(len(motor[move]))
                                * numpy.exp(1j * order * motor[move])))**2 for move in moves]
        found[f"{name}, {line}"] = numpy.cbrt(numpy.mean(power))  # nearly normal (Wilson and Hilferty 1931)


def features(run, sensors, gain):
    """Numbers that tell of the drive, by name."""
    step = 4 if sensors == "UR5" else 1
    rate = RATE / step
    target, speed, acceleration, moment = (run[name][::step] for name in (
        "target_q", "target_qd", "target_qdd", "target_moment"))
    angle, torque = run["actual_q"][::step], gain * run["actual_current"][::step]
    motor = RATIO * angle
    moving = numpy.abs(speed) > 0.05
    edges = numpy.flatnonzero(numpy.diff(moving.astype(int)))
    moves = [slice(a + 1, b + 1) for a, b in zip(edges, edges[1:]) if moving[a + 1] and b - a > 0.3 * rate]
    turning, one = numpy.tanh(speed / 0.01), numpy.ones_like(speed)
    found = {}
    # Friction of each direction, its growth with the speed and with the load, and the gain.
    names = ("constant friction", "friction by speed", "offset", "gain", "loss by load", "inertia")
    beyond = torque - moment
    numbers, left = fitted([turning[moving], speed[moving], one[moving], moment[moving],
                            (turning * numpy.abs(moment))[moving], acceleration[moving]], beyond[moving])
    found.update(zip(names, numbers))
    found["friction"] = float(numpy.mean((beyond * turning)[moving]))
    found["current left, rms"] = numpy.log(rms(left))
    # What the controller cannot keep: friction that turns about, torsion that winds up.
    error, winding = target - angle, numpy.gradient(moment) * rate
    numbers, left = fitted([turning, speed, one, acceleration, winding, moment, numpy.gradient(turning) * rate], error)
    found.update(zip(("lag by direction", "lag by speed", "lag", "lag by acceleration", "lag by winding", "lag by load",
                      "lag at turning"), numbers))
    found["lag left, rms"] = numpy.log(rms(left))
    found["lag, largest"] = numpy.log(numpy.abs(error).max())
    quiet = torque - scipy.signal.sosfiltfilt(scipy.signal.butter(2, 3.0, fs=rate, output="sos"), torque)
    spectral(found, "current", quiet, rate, motor, moves)
    spectral(found, "lag", left, rate, motor, moves)
    if sensors == "motor encoder":
        torsion(found, run, torque, moves, rate)
    return found


def torsion(found, run, torque, moves, rate):
    """The motor's angle is the sum of its speeds, each the difference over the last VELOCITY_STEPS rows."""
    turned = numpy.zeros(len(run["time"]))
    steps = run["actual_qd"] * VELOCITY_STEPS / RATE
    for first in range(VELOCITY_STEPS):
        turned[first::VELOCITY_STEPS] = numpy.cumsum(steps[first::VELOCITY_STEPS])
    twist = turned - (run["actual_q"] - run["actual_q"][0])
    moment, speed = run["target_moment"], run["target_qd"]
    turning = numpy.tanh(speed / 0.01)
    light = numpy.tanh(moment / 8.0)
    numbers, left = fitted([moment, light, turning, numpy.ones_like(speed), speed], twist)
    found.update(zip(("compliance", "compliance at low load", "torsion by direction", "torsion", "torsion by speed"),
                     numbers))
    found["torsion left, rms"] = numpy.log(rms(left))
    spectral(found, "torsion", left, rate, RATIO * run["actual_q"], moves)


class Judge:
    """Sound recordings of one robot with one set of sensors: mean and spread of each feature of the first, and what the
    others have of them."""

    def __init__(self, sound):
        self.names = sorted(sound[0])
        self.reference = self.table(sound[:REFERENCE])
        self.mean, self.spread = self.moments(self.reference)
        self.inverse = sklearn.covariance.LedoitWolf().fit(self.deviations(sound[:REFERENCE])).precision_
        self.others = self.deviations(sound[REFERENCE:])

    def moments(self, table):
        mean, spread = table.mean(axis=0), table.std(axis=0, ddof=1)
        friction = mean[self.names.index("friction")]
        for name in ("friction", "constant friction"):
            place = self.names.index(name)
            spread[place] = numpy.hypot(spread[place], numpy.hypot(FRICTION_SHARE * friction, FRICTION_FLOOR))
        return mean, spread

    def largest_of_its_own(self):
        """Of each feature the largest deviation of a reference from the others, in their spreads."""
        found = numpy.zeros(len(self.names))
        for place, row in enumerate(self.reference):
            mean, spread = self.moments(numpy.delete(self.reference, place, axis=0))
            found = numpy.maximum(found, numpy.abs((row - mean) / spread))
        return found

    def table(self, several):
        return numpy.array([[one[name] for name in self.names] for one in several])

    def deviations(self, several):
        """In spreads."""
        return (self.table(several) - self.mean) / self.spread

    def score(self, one, threshold):
        """(largest deviation over the threshold, its feature)."""
        scores = numpy.abs(self.deviations([one])[0]) / threshold
        return float(scores.max()), self.names[int(scores.argmax())]

    def detectability(self, taught, one):
        """d' of a detector that knows the direction that `taught` differs in, by the spread of the other recordings."""
        weights = self.inverse @ self.deviations([taught])[0]
        sound = self.others @ weights
        return float((self.deviations([one])[0] @ weights - sound.mean()) / sound.std(ddof=1))


# Faults that are not the gear's: kind of hjt.drive_fault, in words, three sizes as printed, their factor to SI.
Other = collections.namedtuple("Other", "kind words sizes unit factor")
OTHERS = (Other("brake_drag", "brake drags", (0.01, 0.03, 0.1), "N·m at the motor", 1.0),
          Other("lost_counts", "motor encoder loses counts", (0.1, 1.0, 10.0), "counts a turn",
                2.0 * numpy.pi / 4320.0),
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
    motor = RATIO * sound["actual_q"][0] + RATIO / RATE * numpy.cumsum(sound["actual_qd"])
    changed = hjt.drive_fault({"time": sound["time"], "motor_torque_reading": sound["actual_current"] * gain / RATIO,
                               "motor_angle_encoder": motor}, other.kind, size * other.factor)
    speed = numpy.gradient(changed["motor_angle_encoder"] - motor) * RATE / RATIO
    return {**sound, "actual_current": changed["motor_torque_reading"] * RATIO / gain,
            "actual_qd": sound["actual_qd"] + speed}


def cell(alarms, unit=""):
    """Smallest severity from which on all robots alarm; else how many do at the largest. `alarms`: by severity."""
    from_here = [severity for severity in sorted(alarms)
                 if all(all(alarms[later]) for later in alarms if later >= severity)]
    if from_here:
        return f"from {from_here[0]:g}{unit}"
    largest = alarms[max(alarms)]
    return f"{sum(largest)} of {len(largest)} at {max(alarms):g}{unit}" if any(largest) else "no"


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


class Found:
    """What was found of a fault and sensors, all robots together."""

    def __init__(self):
        self.alarms = collections.Counter()                                          # of sound recordings, by sensors
        self.seen = collections.defaultdict(lambda: collections.defaultdict(list))   # alarms by severity
        self.shows = collections.defaultdict(list)                                   # features of the alarms
        self.detectable = collections.defaultdict(list)                              # d'
        self.threshold = {}                                                          # of each feature [spreads]

    def take(self, kind, sensors, severity, score, feature):
        self.seen[kind, sensors][severity].append(score > 1.0)
        self.shows[kind, sensors].extend([feature] * (score > 1.0))


def sound_of(robot, sensors, gain):
    return [features(robot.record(seed), sensors, gain) for seed in range(REFERENCE + JUDGED)]


def judge_robot(robot, judge, sound, sensors, kinds, gain, found):
    threshold = found.threshold[sensors]
    found.alarms[sensors] += sum(judge.score(one, threshold)[0] > 1.0 for one in sound[REFERENCE:])
    for place, kind in enumerate(kinds):
        runs = [features(robot.record(seed_of(place, severity), fault_of(kind, severity)), sensors, gain)
                for severity in SEVERITIES]
        for severity, one in zip(SEVERITIES, runs):
            found.take(kind, sensors, severity, *judge.score(one, threshold))
        found.detectable[kind, sensors].append(judge.detectability(runs[-1], runs[0]))
    for other in OTHERS:
        for size in other.sizes:
            changed = features(disturbed(robot, REFERENCE, other, size, gain), sensors, gain)
            found.take(other.kind, sensors, size, *judge.score(changed, threshold))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the recordings")
    parser.add_argument("--docs", type=pathlib.Path, help="folder of health.md; else to the terminal")
    parser.add_argument("--robots", type=int, default=len(ROBOTS), help="how many [2]")
    parser.add_argument("--jobs", type=int, default=2, help="recordings at a time [2]")
    options = parser.parse_args()
    kinds = list(hjt.fault_kinds())
    robots = [Robot(number, options.work.resolve()) for number in ROBOTS[:options.robots]]
    work_through(robots, kinds, options.jobs)
    gain = hjt.Parameters("joints/shoulder.yaml")["telemetry.torque_per_current"]
    found = Found()
    for sensors in SENSORS:
        print(f"faults_seen: judging, {sensors}", file=sys.stderr, flush=True)
        sound = [sound_of(robot, sensors, gain) for robot in robots]
        judges = [Judge(own) for own in sound]
        student = scipy.stats.t.isf(0.5 * FALSE_ALARMS / len(judges[0].names), REFERENCE - 1)
        found.threshold[sensors] = numpy.maximum(student, numpy.max(
            [judge.largest_of_its_own() for judge in judges], axis=0))
        for robot, judge, own in zip(robots, judges, sound):
            judge_robot(robot, judge, own, sensors, kinds, gain, found)
    lines = table(kinds, found, len(robots))
    lab.write_or_print(options.docs, "health.md", "seen", lines)


def table(kinds, found, robots):
    def most(kind):
        names = collections.Counter(name for sensors in SENSORS for name in found.shows[kind, sensors])
        return "; ".join(name for name, _ in names.most_common(2)) or "-"

    judged = robots * JUDGED
    rows = ["| | UR5: angle, current, 125 Hz | UR5e: the same, 500 Hz | with motor encoder, 500 Hz | shows in "
            f"| d′ at {SEVERITIES[0]:g} |", "|---|---|---|---|---|---|"]
    for kind in kinds:
        best = " / ".join(f"{numpy.median(found.detectable[kind, sensors]):.1f}" for sensors in SENSORS)
        rows.append(f"| `{kind}` | " + " | ".join(cell(found.seen[kind, sensors]) for sensors in SENSORS)
                    + f" | {most(kind)} | {best} |")
    for other in OTHERS:
        unit = f" {other.unit}".rstrip()
        cells = [cell(found.seen[other.kind, sensors], unit) for sensors in SENSORS]
        if other.kind == "lost_counts":
            cells[:2] = ["not judged"] * 2
        rows.append(f"| {other.words} | " + " | ".join(cells) + f" | {most(other.kind)} | |")
    rows.append("| sound: false alarms | " + " | ".join(f"{found.alarms[sensors]} of {judged}" for sensors in SENSORS)
                + " | | |")
    return rows


if __name__ == "__main__":
    main()
