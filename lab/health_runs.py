# SPDX-License-Identifier: BSD-3-Clause
"""Runs of sound and faulty joints with real sensors, one window of the indicators each, and what `joint_twin
indicators` makes of them. The split into runs for the fit and runs for judgement is here.

Runs are made by `joint_twin sweep`, in bags that hold the windows' indicators only; a run that is there already is not
made again."""
import collections
import csv
import itertools
import json
import math
import subprocess
import sys

import numpy

RATIO = 101.0
TOOTH = 40                # of the figures of the single faults
ACCELERATION = 300.0      # of a motion at work [deg/s^2]

# `payload`: with the weight and inertia of anything from none to one of some 2.5 kg at the end of a straight arm.
# `steady`: speed of a turn under a constant load, without weight [deg/s].
# `windows`: of a run. A run of one window begins with the motion, a longer one is of work that goes on: pauses,
# angles and first move are drawn at random. `path`: (time [s], speed of the joint [rad/s]) rows from a generator of
# random numbers and the end, another for each run; the joint's states are recorded too.
COMPARED = ("assessed", "too few windows")  # states of a window that was compared with the reference
Motion = collections.namedtuple("Motion", "name tag window payload moves steady windows path",
                                defaults=[None, None, 1, None])
CHECK_UP = Motion("check-up", "check_up", 29.0, False)


def turn(speed):
    return Motion(f"turn at {speed}°/s", f"turn_{speed}", 20.0, False, steady=float(speed))


LOAD = 28.0               # of the steady turns [N.m]

# Moves at work: to an angle about the upright arm [deg] at a speed [deg/s], in a loop.
STACKING = Motion("stacking", "stacking", 20.0, True, [(-25, 70), (20, 100), (-10, 50), (30, 80), (-5, 40)])
PICK_AND_PLACE = Motion("pick-and-place", "pick_and_place", 20.0, True, [(-50, 90), (35, 90), (-20, 60), (50, 120)])
SEAM = Motion("seam", "seam", 20.0, True, [(35, 45), (15, 25), (40, 70), (-30, 55)])
LOADING = Motion("loading", "loading", 20.0, True, [(40, 60), (-15, 110), (10, 35), (-45, 80)])
SORTING = Motion("sorting", "sorting", 20.0, True, [(-30, 80), (10, 55), (-5, 95), (45, 65)])
TENDING = Motion("tending", "tending", 20.0, True, [(55, 105), (5, 60), (-35, 85), (15, 45)])
LABELLING = Motion("labelling", "labelling", 20.0, True, [(25, 60), (-20, 40), (10, 110), (-35, 75)])

WORK_WINDOWS = 12         # of a run at work with a fault
SOUND_WINDOWS = 30        # of one without
REFERENCE_WINDOWS = 6
REFERENCE_RUNS = 48       # at work


def at_work(motion, windows=WORK_WINDOWS):
    return motion._replace(windows=windows)


# `alike`: all teeth are, so that any fault has a response surface. Else every tooth is solved in faulty
# runs. `overlay`: between the joint's and its sensors'.
Gear = collections.namedtuple("Gear", "name alike settings overlay", defaults=[None])


def even(name, stiffness, clearance, preload, viscosity):
    """Stiffness of the cup as a share of the shipped one's, flank clearance [m], preload of the race [N], viscosity of
    the grease [m^2/s]."""
    springs = ", ".join(f"{stiffness * shipped:.0f}.0" for shipped in CUP)
    return Gear(name, True, [f"  cup.torsion_stiffness: [{springs}]", f"  mesh.flank_clearance: {clearance}",
                             f"  bearing.race_preload: {preload}", f"  bearing.viscosity: {viscosity}"])


CUP = (33.2e3, 56.1e3, 65.2e3)  # [N.m/rad]
EVEN = Gear("shipped", True, [])
LOOSE = even("loose", 0.935, -0.7e-6, 450.0, 300.0e-6)
TIGHT = even("tight", 1.053, -1.4e-6, 590.0, 380.0e-6)
FRESH = even("fresh", 1.025, -1.2e-6, 515.0, 335.0e-6)
# What is subtracted where a reference is carried from one motion to another: the shipped gear, without noise, with the
# encoders' eccentricities known or not.
QUIET = [f"  sensors.{sensor}_noise: 0.0" for sensor in ("motor", "output", "torque")]
CALIBRATED_MODEL = Gear("beside calibrated", True, QUIET)
MODEL = Gear("beside", True, [*QUIET, "  sensors.motor_eccentricity: 0.0", "  sensors.output_eccentricity: 0.0"])
MODELS = [MODEL, CALIBRATED_MODEL]


# Another model than that of the signatures: involute flanks, a spring under each tooth on a rigid wave generator, no
# bent race; and friction that falls from rest on, as a UR5's elbow has it.
OTHER_MODEL = Gear("another model", True, ["  mesh.profile: involute", "  motor.stribeck_torque: 0.05",
                                           "  bearing.race_preload: 900.0", "  bearing.viscosity: 220.0e-6"],
                   "golden.yaml")
# The same support under the shipped flanks, with stiffnesses and friction of its own.
FURTHER_MODEL = Gear("a further model", True, ["  mesh.stiffness: 7.0e+7", "  mesh.profile: double_arc",
                                               "  contact.stiffness: 6.0e+7", "  motor.stribeck_torque: 0.06",
                                               "  cup.torsion_stiffness: [30.9e+3, 54.0e+3, 62.1e+3]",
                                               "  bearing.race_preload: 850.0", "  bearing.viscosity: 260.0e-6"],
                     "golden.yaml")
# Of signatures: straight flanks and springs on a rigid wave generator; flanks that touch along most of the rim.
STRAIGHT = Gear("straight flanks", True, ["  bearing.race_preload: 1000.0", "  bearing.viscosity: 190.0e-6"],
                "golden.yaml")
CYCLOID = Gear("cycloid flanks", True, ["  mesh.profile: cycloid", "  bearing.race_preload: 620.0"])
# That the errors of signatures are fitted to: other flanks, less preload, dry friction at once.
OTHER_FLANKS = Gear("other flanks", True, ["  mesh.profile: involute", "  cup.friction_angle: 0.0",
                                           "  motor.stribeck_torque: 0.02", "  bearing.race_preload: 700.0",
                                           "  bearing.viscosity: 240.0e-6"])


def uneven(seed):
    """Pitch errors as in a UR5's joint, on one member, so that sound runs have a response surface."""
    return Gear(f"pitch errors {seed}", False, ["  manufacture.circular_spline_pitch_deviation: 9.5e-6",
                                                f"  manufacture.circular_spline_pitch_seed: {seed}"])


def drawn(number):
    """Cup, clearance, preload and grease drawn at random."""
    draw = numpy.random.default_rng(number).uniform
    return even(f"drawn {number}", draw(0.93, 1.07), draw(-1.4e-6, -0.7e-6), draw(450.0, 590.0), draw(300e-6, 380e-6))


def as_measured(number):
    """Preload and grease from the spread of those fitted to six joints of a UR5 and a UR5e (config/joints); friction
    that falls from rest on."""
    draw = numpy.random.default_rng(number).uniform
    gear = even(f"as measured {number}", draw(0.93, 1.07), draw(-1.4e-6, -0.7e-6),
                round(math.exp(draw(math.log(284.0), math.log(997.0)))), draw(280e-6, 340e-6))
    return gear._replace(settings=[*gear.settings, f"  motor.stribeck_torque: {draw(0.0, 0.05):.3f}"])


def of_series(number):
    """A drawn gear with errors of the circular spline."""
    gear, draw = drawn(number), numpy.random.default_rng(5000 + number).uniform
    return Gear(f"series {number}", False, gear.settings + [
        f"  manufacture.circular_spline_pitch_deviation: {draw(3e-6, 12e-6):.3e}",
        f"  manufacture.circular_spline_pitch_seed: {5000 + number}",
        f"  manufacture.circular_spline_eccentricity: [{draw(-1e-6, 1e-6):.3e}, {draw(-1e-6, 1e-6):.3e}]"])


# The split. Every tooth of a gear whose teeth differ is solved, which takes longest: it runs the check-up only.
Trial = collections.namedtuple("Trial", "name gear motions severities tooth seed")
# A line grows tenfold where its order meets a resonance of the drive, 45 Hz in the shoulder: order 4 at 40°/s, order 2
# at 80°/s.
FITTED = [Trial("fitted", EVEN, [CHECK_UP, STACKING, turn(25), turn(40), turn(80), turn(90)], [0.15, 0.4, 1.0], 90, 2),
          Trial("fitted", drawn(700), [CHECK_UP, LOADING], [0.15, 0.4, 1.0], 25, 12),
          Trial("fitted", drawn(701), [CHECK_UP, SEAM], [0.15, 0.4, 1.0], 130, 13)]
# Other models: of whole members alone, which look alike there.
FITTED_MODELS = [Trial("fitted", gear, [CHECK_UP, SEAM], [0.15, 0.4, 1.0], 90, 40) for gear in (STRAIGHT, CYCLOID)]
CALIBRATED = [Trial("calibrated", LOOSE, [CHECK_UP, at_work(STACKING), turn(33)], [0.25, 0.6], 15, 3),
              Trial("calibrated", FRESH, [CHECK_UP, LOADING, at_work(turn(84))], [0.2, 0.5], 61, 21),
              Trial("calibrated", drawn(702), [CHECK_UP, at_work(PICK_AND_PLACE)], [0.2, 0.5], 75, 31),
              Trial("calibrated", drawn(703), [CHECK_UP, at_work(SEAM)], [0.3, 0.8], 110, 32),
              Trial("calibrated", drawn(704), [CHECK_UP, at_work(turn(60))], [0.2, 0.5], 150, 33),
              Trial("calibrated", uneven(777), [CHECK_UP], [0.5], 40, 5),
              Trial("calibrated", uneven(86420), [CHECK_UP], [0.2, 0.5], 61, 21)]
# Of a quick fit, beside the motions of health_motions: one gear in the check-up.
CALIBRATED_QUICK = [CALIBRATED[2]._replace(motions=[CHECK_UP])]
JUDGED = [Trial("judged", drawn(860), [CHECK_UP, at_work(LABELLING)], [0.2, 0.5], 45, 91),
          Trial("judged", drawn(863), [CHECK_UP, at_work(turn(76))], [0.2, 0.5], 20, 94),
          Trial("judged", uneven(75025), [CHECK_UP], [0.5], 70, 95)]
# Gears whose references of the check-up are carried to motions at work, without a fault: how far they are off.
CARRIED = [drawn(702), drawn(703), LOOSE, FRESH, *map(of_series, range(120, 126))]
CARRIED_MOTIONS = [STACKING, LOADING, PICK_AND_PLACE, SEAM, SORTING, TENDING]
CARRIED_RUNS = 20         # of each gear and motion
CARRIED_SEED = 7
SERIES_FIRST = 140  # gears of lower numbers were looked at while the assessment was made
SERIES_MOTIONS = [at_work(motion) for motion in (PICK_AND_PLACE, SEAM, TENDING, SORTING)]  # one each in turn
QUICK = [Trial("quick", TIGHT, [CHECK_UP, at_work(PICK_AND_PLACE)], [0.5], 60, 5)]

GREASE = (10.0, 50.0)     # [degC]
DRAWN = f"{{uniform: [{GREASE[0]}, {GREASE[1]}]}}"
# Of the reference in the check-up, away from the edges of its classes [degC].
COMMISSIONING = [10.0 * step + offset for step in range(1, 5) for offset in (1.0, 3.0, 5.0, 7.0, 9.0)]
SAME = [20.0, 40.0]       # of the runs that the signatures are differences of [degC]


def once(motion):
    """Options: a check-up is judged by itself, at work the last windows together, so that a day of alarms is no day of
    false ones."""
    return [] if motion.windows > 1 else ["--set", "indicators.evidence_windows=1",
                                          "--set", "indicators.false_alarm_rate=1e-3"]


Window = collections.namedtuple("Window", "averaged largest level cause confidence alternatives severity deviation")
Run = collections.namedtuple("Run", "gear motion kind severity windows")  # those that were compared


def place_of(kind, tooth):
    """The whole member where that may be, else a place in the middle; pitting at one tooth, though it may be at all."""
    whole = kind["first_place"] < 0 and kind["kind"] != "pitting"
    return -1 if whole else min(tooth, kind["last_place"])


def split_table(*rows):
    """Of (name, trials)."""
    lines = ["| runs | gear | motions | severities | tooth | seed |", "|---|---|---|---|---|---|"]
    for name, trials in rows:
        for trial in trials:
            lines.append(f"| {name} | {trial.gear.name} | {', '.join(motion.name for motion in trial.motions)} | "
                         f"{', '.join(f'{severity:g}' for severity in trial.severities)} | {trial.tooth} | "
                         f"{trial.seed} |")
    return lines


def speed_rows(moves, end, draw=None):
    """Corners of the trapezoids of a loop that ends before `end`: time [s], speed of the joint [rad/s]. With `draw` the
    loop begins anywhere, angles vary by 3° and a pause follows each move, as where parts lie and what is waited for
    differ."""
    time, position, rows = 0.5, 0.0, [(0.0, 0.0), (0.5, 0.0)]
    first = 0 if draw is None else int(draw.integers(len(moves)))
    for target, speed in itertools.islice(itertools.cycle(moves), first, None):
        target += 0.0 if draw is None else draw.uniform(-3.0, 3.0)
        distance = abs(target - position)
        peak = min(speed, math.sqrt(distance * ACCELERATION))
        rise, hold = peak / ACCELERATION, distance / peak - peak / ACCELERATION
        if time + 2.0 * rise + hold > end:
            break
        signed = math.radians(math.copysign(peak, target - position))
        rows += [(time + rise, signed), (time + rise + hold + 1e-4, signed), (time + 2.0 * rise + hold + 2e-4, 0.0)]
        time += 2.0 * rise + hold + (0.01 if draw is None else draw.uniform(0.05, 0.6))
        rows.append((time, 0.0))
        position = target
    return rows


class Bench:
    """Makes runs below a folder."""

    def __init__(self, tool, work, jobs):
        self.tool, self.work, self.jobs = tool, work.resolve(), jobs
        self.references = set()  # files of those that are made
        work.mkdir(parents=True, exist_ok=True)
        listed = subprocess.run([tool, "faults", "--json"], check=True, capture_output=True, text=True).stdout
        self.kinds = json.loads(listed)
        subprocess.run([tool, "checkup", "--arm", "ur5", "--joint", "shoulder", "--force", "--out",
                        work / "check_up.csv"], check=True, stdout=subprocess.DEVNULL)

    def speeds(self, name, motion, seed, paths):
        """Of the duties of a sweep."""
        if motion.steady:
            return [f"{{constant: {math.radians(motion.steady):.6f}}}"]
        if not motion.moves and not motion.path:
            return [f"{{csv: {{file: {motion.tag}.csv, column: shoulder_velocity}}}}"]
        end = motion.windows * motion.window
        speeds = []
        for path in range(paths):
            draw = numpy.random.default_rng([seed, path]) if motion.windows > 1 or motion.path else None
            rows = motion.path(draw, end) if motion.path else speed_rows(motion.moves, end, draw)
            file = f"{name}_{path}.csv"
            (self.work / file).write_text("time,shoulder_velocity\n" + "".join(
                f"{time:.6f},{speed:.9f}\n" for time, speed in rows))
            speeds.append(f"{{csv: {{file: {file}, column: shoulder_velocity}}}}")
        return speeds

    def plan(self, name, gear, motion, temperature, classes, repeats=1, seed=1, scene="auto", others=(), paths=1):
        """File of a plan of runs; `others`: settings, and no payload."""
        name = name.replace(" ", "_")
        lines = [f"name: {name}", f"seed: {seed}", f"duration: {motion.windows * motion.window + 1.3:.3f}",
                 "overlays: [joints/shoulder.yaml, " + (f"{gear.overlay}, " if gear.overlay else "")
                 + "real_sensors.yaml]", "set:", f"  solver.scene: {scene}",
                 f"  input.temperature: {temperature}", "  indicators.window_turns: 100000.0",
                 f"  indicators.window_time: {motion.window}", "  publish.indicators_rate: 1.0",
                 f"  publish.joint_states_rate: {500.0 if motion.path else 0.001}",
                 *(f"  publish.{topic}_rate: 0.001" for topic in ("encoders", "contact_forces", "health", "stress")),
                 *gear.settings, *others]
        if motion.payload and not others:
            lines += ["  output.gravity_torque: {uniform: [53.4, 73.4]}",
                      "  output.load_inertia: {uniform: [3.3, 5.0]}"]
        mean = 0.0
        if motion.steady:
            lines.append("  output.gravity_torque: 0.0")
            mean = LOAD
        load = mean if others else f"{{uniform: [{mean - 3.0}, {mean + 3.0}]}}"
        speeds = self.speeds(name, motion, seed, paths)
        lines += [f"repeats: {repeats * paths // len(speeds)}", "duty:"]
        for path, speed in enumerate(speeds):
            name_of_path = f"{motion.tag}_{path}" if path else motion.tag
            lines += [f"  - name: {name_of_path}", f"    speed: {speed}", "    bandwidth: 8.0",
                      f"    load: {{constant: {load}}}"]
        lines += ["classes:", *classes, "record:", "  format: bag"]
        plan = self.work / f"{name}.yaml"
        plan.write_text("\n".join(lines) + "\n")
        return plan

    def sweep(self, *arguments, **options):
        """Bags of the runs of a plan that went well, each with its row of the index."""
        plan = self.plan(*arguments, **options)
        out = plan.with_suffix("")
        print(f"evaluate_health: {out.name}", file=sys.stderr)
        done = subprocess.run([self.tool, "sweep", plan, "--out", out, "--jobs", str(self.jobs), "--json"], check=False,
                              stdout=subprocess.PIPE)
        # 1: some run failed, as its row in the index says; or all was refused, and nothing reported.
        if done.returncode == 1 and not done.stdout:
            sys.exit(f"evaluate_health: the sweep of {plan} was refused (message above); runs of another version of "
                     f"the software or of another plan stay in {out} until you delete it")
        if done.returncode not in (0, 1):
            sys.exit(f"evaluate_health: the sweep of {plan} ended with {done.returncode}")
        with open(out / "index.csv", newline="", encoding="utf-8") as index:
            return [(out / row["file"], row) for row in csv.DictReader(index) if row["status"] == "ok"]

    def sound(self, purpose, gear, motion, temperature, repeats, seed, others=()):
        """At work each on a path of its own."""
        repeats, paths = (1, repeats) if motion.windows > 1 or motion.path else (repeats, 1)
        return self.sweep(f"{purpose}_{gear.name}_{motion.tag}", gear, motion, temperature, ["  healthy: []"], repeats,
                          seed, others=others, paths=paths)

    def fault_classes(self, trial, kinds=None):
        """Every kind, or those named, at every severity, from the start on."""
        return [line for kind in self.kinds if kinds is None or kind["kind"] in kinds for line in (
            f"  {kind['kind']}:", f"    - {{kind: {kind['kind']}, severity: {{grid: {trial.severities}}}, "
                                  f"place: {place_of(kind, trial.tooth)}, onset: 0.0}}")]

    def faulty(self, trial, motion, temperature, kinds=None):
        return self.sweep(f"{trial.name}_{trial.gear.name}_{motion.tag}", trial.gear, motion, temperature,
                          self.fault_classes(trial, kinds), 1, trial.seed, "auto" if trial.gear.alike else "full_ring")

    def signatures(self, trials, path, kinds=None, options=()):
        """Of the trials' faults, each beside a sound run at the same temperature, without noise."""
        plans = [self.plan(f"same_{trial.gear.name}_{motion.tag}", trial.gear, motion, f"{{grid: {SAME}}}",
                           ["  healthy: []", *self.fault_classes(trial, kinds)], 1, trial.seed, others=QUIET)
                 for trial in trials for motion in trial.motions]
        done = subprocess.run([self.tool, "signatures", *plans, "--out", path, "--runs", self.work, "--jobs",
                               str(self.jobs), "--force", *options], check=False, stdout=subprocess.DEVNULL)
        if done.returncode not in (0, 1):  # 1: without the runs that found no equilibrium
            sys.exit(f"evaluate_health: joint_twin signatures ended with {done.returncode}")

    def beside(self, model, bags, motion, temperature, seed, repeats=1, paths=1):
        """Bags of a model beside the runs `bags`, in their order: same path, temperature and payload."""
        name = f"{model.name}_{motion.tag}_{motion.windows}_{seed}_{repeats}_{paths}"
        runs = self.sweep(name, model, motion, temperature, ["  healthy: []"], repeats, seed, paths=paths)
        own = {row["run"]: (bag, row) for bag, row in runs}
        for _, row in bags:
            drawn = own[row["run"]][1]
            if any(drawn[key] != row[key] for key in drawn if key.startswith(("set.", "duty"))):
                sys.exit(f"evaluate_health: run {row['run']} of {name} differs from that of the joint")
        return [own[row["run"]][0] for _, row in bags]

    def reference(self, gear, motion, model=None):
        """File of the healthy reference, from runs of its own; of the check-up also less a model."""
        name = f"reference_{gear.name}_{motion.tag}{f'_{model.name}' if model else ''}".replace(" ", "_")
        path = self.work / f"{name}.yaml"
        if path in self.references:
            return path
        temperature, repeats = f"{{grid: {COMMISSIONING}}}", 8
        if motion.windows > 1:
            motion, temperature, repeats = at_work(motion, REFERENCE_WINDOWS), DRAWN, REFERENCE_RUNS
        bags = self.sound("commissioning", gear, motion, temperature, repeats, 1)
        models = self.beside(model, bags, motion, temperature, 1, repeats) if model else []
        self.indicators(bags, ["--set", "indicators.baseline_windows=10000", "--save-baseline", path, "--force"],
                        models)
        self.references.add(path)
        return path

    def judge(self, bags, gear, motion, model=None, models=()):
        """Assessments of runs compared with the reference, none of windows at an operating point that it has not. With
        a model and its bags the reference is carried from the check-up."""
        reference = self.reference(gear, CHECK_UP if model else motion, model)
        options = ["--baseline", reference, *once(motion), *(["--carry"] if model else [])]
        report = self.indicators(bags, options, models)
        windows = collections.defaultdict(list)
        for window in report["windows"]:
            verdict = window["assessment"]
            if verdict["state"] in COMPARED:
                windows[window["recording"]].append(Window(window["averaged"], *(verdict[key] for key in (
                    "largest_score", "level", "cause", "confidence", "alternatives", "severity",
                    "severity_deviation"))))
        return [Run(gear, motion, row["fault_kind"] or "healthy", float(row["fault_severity"] or 0.0),
                    windows[str(bag)])
                for bag, row in bags]

    def indicators(self, bags, options=(), models=(), source=("--windows",)):
        """Of (bag, row) pairs, less those of a model's bag for each."""
        beside = [part for model in models for part in ("--model", model)]
        done = subprocess.run([self.tool, "indicators", *source, "--json", *options, *beside,
                               *(bag for bag, _ in bags)], check=True, capture_output=True, text=True)
        return json.loads(done.stdout)
