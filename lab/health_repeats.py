# SPDX-License-Identifier: BSD-3-Clause
"""Judges check-ups of drives that repeat as real ones do, by the calls that a user has: friction that wanders, payloads
that the reference has not, references of few windows; and what is left with a robot's own signals.

Two gears, each with sound check-ups for its reference, others to be judged, payloads beside that of the reference and
every kind of fault. Nothing is fitted to them. Runs that are there already are kept.

    lab/run health_repeats
"""
import argparse
import collections
import functools
import pathlib
import shutil
import warnings

import h5py
import numpy
import pandas

import harmonic_joint_twin as hjt

import health_runs
import lab

GEARS = (health_runs.even("first", 1.0468, -0.892e-6, 534.2, 296.6e-6),
         health_runs.even("second", 0.945, -1.21e-6, 481.0, 355e-6))
REFERENCE, SOUND, OF_EACH = 60, 40, 12          # check-ups
BESIDE = (0.25, 0.5, 1.0, 2.0)                  # the payload's weight beside the reference's [N.m]
WEIGHT = 53.4                                   # config/joints/shoulder.yaml [N.m]
SEVERITIES = (0.2, 0.3, 0.5, 1.0)
TOOTH = 60
SIZES = (8, 10, 12, 15, 16, 20, 40)             # windows of a reference
WHOLE = ("interface_wear", "rear_section_crack", "lubricant_degradation", "flange_crack", "wave_generator_wear",
         "buckling")                            # of whole members: in the trial of small references
WORN = ("tooth_wear", "interface_wear", "lubricant_degradation")  # that use makes together
WORN_FROM, WORN_TO, WORN_DRIVES = 0.1, 0.5, 24  # severities of each; drives of a gear
SHARE, FLOOR = 0.03, 0.22                       # of friction between recordings of one UR5: docs/compare.md [-], [N.m]
WINDOW = {"indicators.window_time": 29.0, "indicators.window_turns": 1e5}
OWN_SIGNALS = {"output_angle": "output_angle_encoder", "motor_torque": "motor_torque_reading",
               "load_torque": "load_torque", "temperature": "housing_temperature"}
RATE = 500                                      # of the recordings [Hz]
PLAN = """name: {name}
seed: {seed}
duration: 30.3
overlays: [joints/shoulder.yaml, real_sensors.yaml]
set:
  solver.scene: auto
  input.temperature: {{uniform: [20.5, 29.5]}}
  indicators.window_turns: 100000.0
  indicators.window_time: 29.0
{settings}
repeats: {repeats}
duty:
  - name: check_up
    speed: {{csv: {{file: check_up.csv, column: shoulder_velocity}}}}
    bandwidth: 8.0
    load: {{constant: {{uniform: [-3.0, 3.0]}}}}
classes:
{classes}
record:
  indicators: true
  groups:
    signals: {{rate: {rate}, type: float64, columns: [motor_angle_encoder, output_angle_encoder, motor_torque_reading,
                                                    load_torque, housing_temperature]}}
"""


def made(work, gear, name, seed, repeats, classes=("  healthy: []",), settings=()):
    """Runs of a plan: their index."""
    name = f"{gear.name}_{name}"
    plan = work / f"{name}.yaml"
    plan.write_text(PLAN.format(name=name, seed=seed, repeats=repeats, classes="\n".join(classes), rate=float(RATE),
                                settings="\n".join([*gear.settings, *settings])), encoding="utf-8")
    print(f"health_repeats: {name}", flush=True)
    hjt.sweep(plan, work / name)
    return hjt.load(work / name, group=None)


def fault_classes():
    return [f"  {name}: [{{kind: {name}, severity: {{grid: [{', '.join(map(str, SEVERITIES))}]}}, onset: 0.0"
            + (f", place: {TOOTH}" if name in ("tooth_root_crack", "tooth_tip_crack", "pitting") else "") + "}]"
            for name in hjt.fault_kinds()]


def worn_class():
    severity = f"severity: {{uniform: [{WORN_FROM}, {WORN_TO}]}}"
    return f"  worn: [{', '.join(f'{{kind: {kind}, {severity}}}' for kind in WORN)}]"


def wandering(index, folder, draw):
    """Copies of runs whose friction is that of another day: an indicator of friction is in proportion to it."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    files = []
    for file in index["file"]:
        files.append(shutil.copy(file, folder))
        share, floor = 1.0 + SHARE * draw.standard_normal(), FLOOR / health_runs.RATIO * draw.standard_normal()
        with h5py.File(files[-1], "a") as run:
            for name, offset in (("running_torque", floor), ("coulomb_torque", floor), ("viscous_friction", 0.0)):
                column = run["indicators"][name]
                column[:] = column[:] * share + offset
    return files


def own_signals(index, rate):
    """What a robot gives: angle at the output, current; and estimates of load and temperature."""
    frames = []
    for file in index["file"]:
        with h5py.File(file, "r") as run:
            frames.append({name: run["signals"][name][::RATE // rate] for name in ("time", *OWN_SIGNALS.values())})
    return frames


def alarmed(verdicts):
    return int((verdicts["level"].notna() & (verdicts["level"] != "OK")).sum())


def judged_of(verdicts):
    return int((verdicts["state"] == "assessed").sum())


def trial(work, gear, seed):
    """Everything that is judged of one gear: verdicts by name."""
    reference = made(work, gear, "reference", seed + 1, REFERENCE)
    sound = made(work, gear, "sound", seed + 2, SOUND)
    other = {beside: made(work, gear, f"payload_{beside}", seed + 3, OF_EACH,
                          settings=[f"  output.gravity_torque: {WEIGHT + beside}"]) for beside in BESIDE}
    faulty = made(work, gear, "faulty", seed + 4, 1, fault_classes())
    worn = made(work, gear, "worn", seed + 5, WORN_DRIVES, [worn_class()])
    path = work / f"{gear.name}.yaml"
    assess = functools.partial(hjt.assess, reference=path, check_up=True)

    def learn(size, first=0):
        hjt.reference(list(reference["file"][first:first + size]), path, force=True)

    found = {"sizes": {}}
    for size in SIZES:
        counts = collections.Counter()
        for first in range(0, REFERENCE - size + 1, max(size, 20)):
            learn(size, first)
            few = faulty[faulty["class"].isin(WHOLE) & (faulty["fault_severity"] <= 0.5)]
            verdicts = assess(list(few["file"]))
            counts.update(found=alarmed(verdicts), faulty=len(few), sound=SOUND)
            counts.update(seen_as_said(few, verdicts, sound, path))
            counts.update(false=alarmed(assess(list(sound["file"]))))
        found["sizes"][size] = counts
    learn(REFERENCE)
    draw = numpy.random.default_rng(seed)
    found["sound"] = assess(list(sound["file"]))
    found["friction"] = assess(wandering(sound, work / f"{gear.name}_wandering", draw))
    found["worn"] = assess(list(worn["file"]))
    found["payloads"] = {beside: assess(list(index["file"])) for beside, index in other.items()}
    found["faulty"] = pandas.concat([faulty, assess(list(faulty["file"]))], axis=1)
    for rate in (125, RATE):
        own = {"columns": OWN_SIGNALS, "overlays": ["joints/shoulder.yaml", "real_sensors.yaml", WINDOW]}
        hjt.reference(own_signals(reference, rate), path, force=True, **own)
        found[f"sound, {rate}"] = assess(own_signals(sound, rate), **own)
        found[f"faulty, {rate}"] = pandas.concat([faulty, assess(own_signals(faulty, rate), **own)], axis=1)
    return found


def seen_as_said(faulty, verdicts, sound, reference):
    """Of faults that sound check-ups say would have shown, how many did."""
    said = hjt.indicators(list(sound["file"]), baseline=reference,
                          overlays=[{"indicators.evidence_windows": 1, "indicators.false_alarm_rate": 1e-3}])
    least = collections.defaultdict(list)
    for window in said["windows"]:
        for cause, severity in (window["seen_from"] or {}).items():
            least[cause].append(numpy.inf if severity is None else severity)
    shown = [alarm for cause, severity, alarm in zip(faulty["class"], faulty["fault_severity"],
                                                     verdicts["level"] != "OK")
             if severity >= numpy.median(least.get(cause, [numpy.inf]))]
    return {"promised": len(shown), "kept": sum(shown)}


def share(numbers):
    return " of ".join(str(sum(each)) for each in zip(*numbers))


def repeats_table(trials):
    rows = [("friction and payload as in the reference", [found["sound"] for found in trials]),
            (f"friction of another day: {100 * SHARE:g} % and {FLOOR} N·m", [found["friction"] for found in trials]),
            *((f"payload {beside:g} N·m heavier at the joint than in the reference; "
               "`output.gravity_torque` has this weight",
               [found["payloads"][beside] for found in trials])
              for beside in BESIDE)]
    return ["| check-ups of sound drives | judged | alarms |", "|---|---|---|",
            *(f"| {name} | {share([(judged_of(one), len(one)) for one in several])} | {sum(map(alarmed, several))} |"
              for name, several in rows)]


def sizes_table(trials):
    lines = ["| check-ups in the reference | faults found | found, of faults at or above `seen_from` | false alarms |",
             "|---|---|---|---|"]
    for size in SIZES:
        counts = sum((found["sizes"][size] for found in trials), collections.Counter())
        lines.append(f"| {size} | {counts['found']} of {counts['faulty']} | {counts['kept']} of {counts['promised']} | "
                     f"{counts['false']} of {counts['sound']} |")
    return lines


def faults_table(trials):
    tables = {"both encoders, current": "faulty", "output angle, current, 125 Hz": "faulty, 125",
              f"output angle, current, {RATE} Hz": f"faulty, {RATE}"}
    lines = [f"| fault (each cell: how many of {len(trials)} gears alarm at severity "
             f"{', '.join(f'{severity:g}' for severity in SEVERITIES)}) | " + " | ".join(tables) + " |",
             "|---|" + "---|" * len(tables)]

    def cell(kind, name):
        parts = []
        for severity in SEVERITIES:
            several = [found[name][(found[name]["class"] == kind) & (found[name]["fault_severity"] == severity)]
                       for found in trials]
            parts.append(str(sum(map(alarmed, several))))
        return ", ".join(parts)

    lines += [f"| `{kind}` | " + " | ".join(cell(kind, name) for name in tables.values()) + " |"
              for kind in hjt.fault_kinds()]
    alarms = [sum(alarmed(found["sound" + name[len("faulty"):]]) for found in trials) for name in tables.values()]
    lines.append(f"| none: false alarms in {SOUND * len(trials)} check-ups | " + " | ".join(map(str, alarms)) + " |")
    right, in_sets = [], []
    for name in tables.values():
        all_of = pandas.concat([found[name] for found in trials])
        all_of = all_of[all_of["level"].isin(["WARN", "ERROR"])]
        in_set = sum(kind in [cause, *str(others).split(", ")] for kind, cause, others in
                     zip(all_of["class"], all_of["cause"], all_of["alternatives"]))
        right.append(f"{sum(all_of['class'] == all_of['cause'])} of {len(all_of)}")
        in_sets.append(f"{in_set} of {len(all_of)}")
    return [*lines, "| named cause right, of alarms | " + " | ".join(right) + " |",
            "| true cause in the set, of alarms | " + " | ".join(in_sets) + " |"]


def worn_line(trials):
    """Of drives whose teeth, interface and grease are worn together."""
    verdicts = pandas.concat([found["worn"] for found in trials])
    alarms = verdicts[verdicts["level"].isin(["WARN", "ERROR"])]
    named = alarms["cause"].isin(WORN)
    in_set = [any(kind in str(others).split(", ") for kind in WORN) for others in alarms["alternatives"]]
    others = collections.Counter(alarms["cause"][~named]).most_common()
    return (f"{len(verdicts)} drives have teeth, interface and grease worn together, each with a severity of "
            f"{WORN_FROM} to {WORN_TO}. {len(alarms)} of these drives cause an alarm. {named.sum()} verdicts "
            f"name one of the three causes, and {(named | in_set).sum()} verdicts have one of the three causes in "
            "their set."
            + (f" The other verdicts name {', '.join(f'`{cause}` ({count})' for cause, count in others)}." if others
               else ""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the recordings")
    parser.add_argument("--docs", type=pathlib.Path, help="folder of health.md; else to the terminal")
    options = parser.parse_args()
    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore")  # of check-ups that are not judged; the table counts them
    hjt.checkup("ur5", work / "check_up.csv", joint="shoulder", force=True)
    trials = [trial(work, gear, 100 * place) for place, gear in enumerate(GEARS, 1)]
    lab.write_or_print(options.docs, "health.md", "repeats",
                       [*sizes_table(trials), "", *faults_table(trials), "", *repeats_table(trials), "",
                        worn_line(trials)])


if __name__ == "__main__":
    main()
