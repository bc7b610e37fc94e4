# SPDX-License-Identifier: BSD-3-Clause
"""Runs of sound and faulty joints with real sensors, and the indicators of their windows by `joint_twin indicators`.

Runs are made by `joint_twin sweep`, in bags that hold the windows' indicators only; a run that is there already is not
made again."""
import collections
import csv
import json
import math
import subprocess
import sys

RATIO = 101.0
WINDOW_TURNS = 101.0      # of the motor: one of the joint
START = 0.5               # of a run, before it is steady [s]
# sound runs that make the reference at each point; of each two windows, or as many as fit [s]
COMMISSIONING = (20, 40.0)
WINDOWS = 2               # of a faulty run: as many as an alarm takes
SOUND_WINDOWS = 20        # of a sound run
SET_IN = 1.5              # windows after which a fault sets in on the way
ONE_TOOTH = {"pitting"}   # at one tooth, though it may be at all

# `degrees` a second at the joint, in the mean; `speed` and `load` as plans have them; `window`: turns and time at most.
Point = collections.namedtuple("Point", "name tag degrees speed load window", defaults=[(WINDOW_TURNS, 100.0)])


def constant_speed(degrees):
    """Within 0.4 s up to it: a step would throw the teeth."""
    speed = math.radians(degrees)
    return f"{{trapezoid: {{peak: {speed:.6f}, slope: {speed / 0.4:.6f}, hold: 1.0e+6, pause: 0.0}}}}"


def steady(degrees, load):
    return Point(f"{degrees:g}°/s, {load:g} N·m", f"steady_{degrees:g}", degrees, constant_speed(degrees),
                 f"{{constant: {load}}}")


def sinus(amplitude, frequency):
    return f"{{sinus: {{mean: 0.0, amplitude: {amplitude:.6f}, frequency: {frequency:.9f}, phase: 0.0}}}}"


SWING = 70.0              # greatest speed of the check-up motion [°/s]
PERIOD = math.pi * 360.0 / (2.0 * SWING)  # in which it travels one turn of the joint, there and back together [s]
TURNING = Point("turning under its weight: 30°/s, ±130 N·m once a turn", "turning", 30.0,
                constant_speed(30.0), sinus(130.0, 30.0 / 360.0))
# A window is one period, so that what stands fast in the joint is the same in all of them.
CHECK_UP = Point("check-up: to and fro at up to 70°/s, ±130 N·m once a second", "check_up", 360.0 / PERIOD,
                 sinus(math.radians(SWING), 1.0 / PERIOD), sinus(130.0, 8.0 / PERIOD), (1000.0, PERIOD))
STEADY_POINTS = [steady(5.0, 140.0), steady(15.0, 60.0), steady(45.0, 110.0), steady(90.0, 0.0), steady(170.0, 30.0)]
POINTS = [*STEADY_POINTS, TURNING, CHECK_UP]
TRAINING_POINTS = POINTS[1:]
SHORT_POINTS = [POINTS[1], POINTS[3], POINTS[4], CHECK_UP]  # for what takes long: see `takes_long`

# The grease's temperature is anywhere in a band [°C]; noise of both encoders, times that of real_sensors.yaml.
Condition = collections.namedtuple("Condition", "name temperatures noise")
COOL = Condition("cool", (21.0, 29.0), 1.0)
WARM = Condition("warm", (41.0, 49.0), 1.0)
NOISY = Condition("noisy", (41.0, 49.0), 3.0)
CONDITIONS = [COOL, WARM, NOISY]

Trial = collections.namedtuple("Trial", "name severities slow_severities tooth seed")
TRAINING = Trial("training", [0.2, 0.6], [0.6], 90, 2)   # that the signatures are fitted to
JUDGED = Trial("judged", [0.1, 0.3, 1.0], [0.3, 1.0], 40, 3)

# A window: number in its run from 1 on, values and scores by indicator, scores by feature, strongest score over its
# threshold, verdict.
Window = collections.namedtuple("Window", "number values scores features largest level cause confidence")
Run = collections.namedtuple("Run", "point condition kind severity windows")


def window_time(point):
    return WINDOW_TURNS * 360.0 / (point.degrees * RATIO)


def points_of(condition):
    return SHORT_POINTS if condition is NOISY else POINTS


def takes_long(kind):
    """Has no response surface, at some severity: every tooth is solved at every step."""
    return kind["kind"].startswith("bearing_") or kind["kind"] in ("tooth_wear", "flange_crack")


def place_of(kind, tooth):
    """The whole member where that may be, else a place in the middle."""
    whole = kind["first_place"] < 0 and kind["kind"] not in ONE_TOOTH
    return -1 if whole else min(tooth, kind["last_place"])


class Bench:
    """Makes runs below a folder."""

    def __init__(self, tool, work, jobs):
        self.tool, self.work, self.jobs = tool, work, jobs
        work.mkdir(parents=True, exist_ok=True)
        listed = subprocess.run([tool, "faults", "--json"], check=True, capture_output=True, text=True).stdout
        self.kinds = json.loads(listed)

    def sweep(self, name, condition, point, windows, repeats, seed, classes):
        """Bags of the runs that went well, each with its row of the index."""
        noise = [f"  sensors.motor_noise: {5.0e-5 * condition.noise:.7f}",
                 f"  sensors.output_noise: {1.2e-5 * condition.noise:.7f}"]
        low, high = condition.temperatures
        lines = [f"name: {name}", f"seed: {seed}", f"duration: {START + (windows + 0.1) * window_time(point):.3f}",
                 "overlays: [real_sensors.yaml]", "set:", "  solver.scene: auto", *noise,
                 f"  input.temperature: {{uniform: [{low}, {high}]}}", f"  indicators.window_turns: {point.window[0]}",
                 f"  indicators.window_time: {point.window[1]:.6f}",
                 f"  publish.indicators_rate: {1.0 if window_time(point) > 5.0 else 10.0}",
                 "  publish.joint_states_rate: 0.001",
                 "  publish.encoders_rate: 0.001", "  publish.contact_forces_rate: 0.001",
                 "  publish.health_rate: 0.001",
                 f"repeats: {repeats}", "duty:", f"  - name: {point.tag}", f"    speed: {point.speed}",
                 "    bandwidth: 8.0", f"    load: {point.load}", "classes:", *classes, "record:", "  format: bag"]
        plan = self.work / f"{name}.yaml"
        plan.write_text("\n".join(lines) + "\n")
        out = self.work / name
        print(f"evaluate_health: {name}", file=sys.stderr)
        done = subprocess.run([self.tool, "sweep", plan, "--out", out, "--jobs", str(self.jobs)], check=False)
        if done.returncode not in (0, 1):  # 1: some run failed, as its row in the index says
            sys.exit(f"evaluate_health: the sweep of {plan} ended with {done.returncode}")
        with open(out / "index.csv", newline="", encoding="utf-8") as index:
            return [(out / row["file"], row) for row in csv.DictReader(index) if row["status"] == "ok"]

    def sound(self, purpose, condition, point, windows, repeats, seed):
        return self.sweep(f"{purpose}_{condition.name}_{point.tag}", condition, point, windows, repeats, seed,
                          ["  healthy: []"])

    def faulty(self, trial, condition, point):
        """Every kind at every severity, from the start on."""
        bags = []
        groups = {"fast": trial.severities}
        if point in SHORT_POINTS and condition is not NOISY:
            groups["slow"] = trial.slow_severities
        for group, severities in groups.items():
            classes = []
            for kind in self.kinds:
                if takes_long(kind) == (group == "slow"):
                    classes += [f"  {kind['kind']}:",
                                f"    - {{kind: {kind['kind']}, severity: {{grid: {severities}}}, "
                                f"place: {place_of(kind, trial.tooth)}, onset: 0.0}}"]
            bags += self.sweep(f"{trial.name}_{group}_{condition.name}_{point.tag}", condition, point, WINDOWS, 1,
                               trial.seed, classes)
        return bags

    def setting_in(self, condition):
        """Faults that set in on a sound drive, in the check-up: from then on every tooth is solved at every step."""
        classes = [f"  {kind['kind']}:\n    - {{kind: {kind['kind']}, severity: 1.0, "
                   f"place: {place_of(kind, JUDGED.tooth)}, onset: {START + SET_IN * window_time(CHECK_UP):.3f}}}"
                   for kind in self.kinds if not takes_long(kind)]
        return self.sweep("setting_in", condition, CHECK_UP, 4, 1, 5, classes)

    def reference(self, condition):
        """File of the healthy reference, from separate runs."""
        bags = [bag for point in points_of(condition)
                for bag, _ in self.sound("commissioning", condition, point,
                                         max(round(COMMISSIONING[1] / window_time(point)), 2), COMMISSIONING[0], 1)]
        path = self.work / f"reference_{condition.name}.yaml"
        self._indicators(bags, ["--set", "indicators.baseline_windows=10000", "--save-baseline", path, "--force"])
        return path

    def judge(self, bags, condition, point, reference):
        """Assessments of runs compared with a reference."""
        report = self._indicators([bag for bag, _ in bags], ["--baseline", reference])
        windows = collections.defaultdict(list)
        for window in report["windows"]:
            verdict, own = window["assessment"], windows[window["recording"]]
            own.append(Window(len(own) + 1, window["indicators"], window["scores"], window["features"],
                              verdict["largest_score"], verdict["level"], verdict["cause"], verdict["confidence"]))
        return [Run(point, condition, row["fault_kind"] or "healthy", float(row["fault_severity"] or 0.0),
                    windows[str(bag)])
                for bag, row in bags]

    def _indicators(self, bags, options):
        done = subprocess.run([self.tool, "indicators", "--windows", "--json", *options, *bags], check=True,
                              capture_output=True, text=True)
        return json.loads(done.stdout)
