# SPDX-License-Identifier: BSD-3-Clause
"""What a fault of one drive does to the tool of a UR5 and to its currents.

The arm goes through four poses and back, twice, and stops at each. A run is judged beside the sound one in the same
motion. At rest: the last 0.2 s of a stop. ISO 9283: mean of the distances from their mean, and three of their standard
deviations.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import subprocess
import sys

import numpy

import lab
from lab import plt

PERIOD = 0.008                   # of the set points [s]
MOVE, STOP, REST = 1.0, 1.0, 0.2  # [s]
POSES = ((0.0, -1.4, 1.2, -1.4, -1.5, 0.2), (0.5, -1.1, 1.5, -1.9, -1.2, 0.8), (0.9, -0.8, 1.0, -1.6, -1.7, 0.3),
         (0.3, -1.5, 1.7, -1.2, -1.4, -0.4))
ORDER = (0, 1, 2, 3, 2, 1) * 2 + (0,)
JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")
SEVERITIES = (0.3, 1.0)
MAKERS_REPEATABILITY = 0.1       # of a UR5 [mm]
FIGURES = ("at_rest", "repeatability", "path_rms", "path_max", "current")
# A fault is hidden where the current shows it [%] and the tool's path departs by no more than this share.
CURRENT_SEEN, PATH_KEPT = 1.0, 0.1


def write_motion(path):
    """Quintics between the poses: no jump of the acceleration. Returns the begin of each stop [s] and its pose."""
    rows, stops, time = [], [(0.0, ORDER[0])], 0.0
    for pose in ORDER:
        here = numpy.array(POSES[pose])
        if rows:
            before = rows[-1][1]
            for s in numpy.arange(1, round(MOVE / PERIOD) + 1) * PERIOD / MOVE:
                rows.append((time + s * MOVE, before + (here - before) * (10 * s**3 - 15 * s**4 + 6 * s**5)))
            time += MOVE
            stops.append((time, pose))
        rows += [(time + k * PERIOD, here) for k in range(1 if rows else 0, round(STOP / PERIOD) + 1)]
        time += STOP
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(["timestamp"] + [f"target_q_{i}" for i in range(len(JOINTS))])
        table.writerows([f"{at:.3f}", *angles] for at, angles in rows)
    return stops


def run(options, motion, name, fault):
    """Columns of the run, by name; None: a protective stop. Made unless this program has made them."""
    path, report = options.work / f"{name}.csv", options.work / f"{name}.json"
    if not report.exists() or report.stat().st_mtime < options.tool.stat().st_mtime:
        words = [options.tool, "arm", motion, "--arm", "ur5", "--out", path, "--force", "--json"]
        done = subprocess.run([*map(str, words), *(["--fault", fault] if fault else [])], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, check=False)
        if done.returncode not in (0, lab.STOPPED):
            sys.exit(f"arm_faults: {name}: {done.stderr}")
        report.write_text(done.stdout, encoding="utf-8")
    stopped = json.loads(report.read_text(encoding="utf-8"))["protective_stop"]
    return None if stopped else numpy.genfromtxt(path, delimiter=",", names=True)


def tool_of(rows, which):
    return 1e3 * numpy.column_stack([rows[f"{which}_TCP_pose_{axis}"] for axis in range(3)])  # [mm]


def rests_of(rows, stops):
    """Mean position of the tool at the end of each stop, by pose."""
    positions = {}
    for begin, pose in stops:
        last = (rows["timestamp"] > begin + STOP - REST) & (rows["timestamp"] <= begin + STOP)
        positions.setdefault(pose, []).append(tool_of(rows, "actual")[last].mean(axis=0))
    return {pose: numpy.array(several) for pose, several in positions.items()}


def repeatability(rests):
    """ISO 9283's RP, the largest of the poses [mm]."""
    found = []
    for several in rests.values():
        apart = numpy.linalg.norm(several - several.mean(axis=0), axis=1)
        found.append(apart.mean() + 3.0 * apart.std(ddof=1))
    return max(found)


def figures_of(rows, sound, stops, joint):
    """NaN: the arm stopped itself."""
    if rows is None:
        return dict.fromkeys(FIGURES, math.nan)
    rests, sound_rests = rests_of(rows, stops), rests_of(sound, stops)
    moved = max(numpy.linalg.norm(rests[pose].mean(axis=0) - sound_rests[pose].mean(axis=0)) for pose in rests)
    error = numpy.linalg.norm(tool_of(rows, "actual") - tool_of(rows, "target"), axis=1)
    number = JOINTS.index(joint) if joint else 0
    current = [float(numpy.sqrt(numpy.mean(of[f"actual_current_{number}"]**2))) for of in (rows, sound)]
    return {"at_rest": moved, "repeatability": repeatability(rests),
            "path_rms": float(numpy.sqrt(numpy.mean(error**2))), "path_max": float(error.max()),
            "current": 100.0 * (current[0] / current[1] - 1.0)}


def draw(path, kinds, found, sound):
    """Each change by kind and joint, one row of panels a severity."""
    columns = (("path_max", "change of the largest error on the path [mm]", 1.0),
               ("at_rest", "moved at rest [mm]", 0.1),
               ("repeatability", "change of the repeatability [mm]", 0.1),
               ("current", "change of the joint's current, rms [%]", 20.0))
    figure, axes = plt.subplots(len(SEVERITIES), len(columns), figsize=(13.0, 0.55 * len(kinds) + 2.0), sharex=True,
                                sharey=True, squeeze=False, constrained_layout=True)
    for column, (key, label, most) in enumerate(columns):
        for axis, severity in zip(axes[:, column], SEVERITIES):
            without = 0.0 if key == "at_rest" else sound[key]
            change = [[found[kind, joint, severity][key] - without for joint in JOINTS] for kind in kinds]
            image = axis.imshow(change, cmap="RdBu_r", vmin=-most, vmax=most, aspect="auto")
            axis.set_title(f"severity {severity:g}", fontsize=9)
        figure.colorbar(image, ax=axes[:, column], orientation="horizontal", label=label, extend="both", pad=0.02)
        axes[-1, column].set_xticks(range(len(JOINTS)))
        axes[-1, column].set_xticklabels(JOINTS, rotation=60, fontsize=8)
    for axis in axes[:, 0]:
        axis.set_yticks(range(len(kinds)))
        axis.set_yticklabels([kind.replace("_", " ") for kind in kinds], fontsize=8)
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path, dpi=110)


def hidden(cell, sound):
    return abs(cell["current"]) > CURRENT_SEEN and abs(cell["path_max"] / sound["path_max"] - 1.0) < PATH_KEPT


def table(kinds, found, sound):
    """The joint in which a fault of severity 1 changes a figure most, and where the controller hides it."""
    lines = [f"The tool of the sound arm leaves its path by at most {sound['path_max']:.2f} mm, "
             f"{sound['path_rms']:.2f} mm rms. The repeatability of the sound arm is "
             f"{sound['repeatability']:.3f} mm (ISO 9283; the maker states {MAKERS_REPEATABILITY:g} mm). "
             f"The table has faults of severity {SEVERITIES[1]:g}. Each cell has the value for the joint, named in "
             "the cell, in which the fault changes this value most. [arm_faults.csv](arm_faults.csv) has all joints "
             "and severities.", "",
             "| fault | largest distance of the tool from its path [mm], joint | shift of the tool at rest [mm], joint "
             "| repeatability [mm], joint | change of the joint's current [%], joint "
             "| joints that hide the fault |", "|---|---|---|---|---|---|"]
    for kind in kinds:
        cells = {joint: found[kind, joint, SEVERITIES[1]] for joint in JOINTS}
        cells = {joint: cell for joint, cell in cells.items() if not math.isnan(cell["current"])}
        words = []
        for key, shape in (("path_max", "{:.2f}"), ("at_rest", "{:.3f}"), ("repeatability", "{:.3f}"),
                           ("current", "{:+.1f}")):
            without = 0.0 if key == "at_rest" else sound[key]
            most = max(cells, key=lambda joint: abs(cells[joint][key] - without))
            words.append(f"{shape.format(cells[most][key])} {most}")
        words.append(", ".join(joint for joint in cells if hidden(cells[joint], sound)) or "-")
        lines.append(f"| `{kind}` | " + " | ".join(words) + " |")
    stopped = [f"`{kind}` of severity {severity:g} in {joint}" for (kind, joint, severity), cell in found.items()
               if math.isnan(cell["current"])]
    return lines + (["", "The arm stops itself ([protective stop](#protective-stop)) with " + ", ".join(stopped) + "."]
                    if stopped else [])


def write_csv(path, found, sound):
    with open(path, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["fault", "joint", "severity", "moved_at_rest_mm", "repeatability_mm", "path_rms_mm",
                       "path_max_mm", "more_current_percent"])
        for case, cell in [(("none", "", 0), sound), *found.items()]:
            rows.writerow([*case, *("" if math.isnan(cell[key]) else f"{cell[key]:.4g}" for key in FIGURES)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help="program joint_twin")
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder of arm_twin.md")
    parser.add_argument("--work", type=pathlib.Path, required=True,
                        help="folder for the runs; those that this program made are kept")
    parser.add_argument("--jobs", type=int, default=2, help="runs at the same time")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    listed = json.loads(subprocess.run([options.tool, "faults", "--json"], stdout=subprocess.PIPE, check=True).stdout)
    kinds = [fault["kind"] for fault in listed]
    places = {fault["kind"]: max(fault["first_place"], -1) for fault in listed}
    motion = options.work / "motion.csv"
    stops = write_motion(motion)
    sound_rows = run(options, motion, "sound", None)
    cases = [(kind, joint, severity) for kind in kinds for joint in JOINTS for severity in SEVERITIES]
    found = {}

    def work(case):
        kind, joint, severity = case
        rows = run(options, motion, f"{kind}_{joint}_{severity}", f"{joint}:{kind}:{severity}:{places[kind]}")
        return case, figures_of(rows, sound_rows, stops, joint)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for done, (case, figures) in enumerate(pool.map(work, cases), 1):
            found[case] = figures
            print(f"{done} of {len(cases)}: {' '.join(map(str, case))}: "
                  + ", ".join(f"{key} {value:.3f}" for key, value in figures.items()), flush=True)
    sound = figures_of(sound_rows, sound_rows, stops, None)
    write_csv(options.docs / "arm_faults.csv", found, sound)
    draw(options.docs / "images" / "arm_twin" / "faults.png", kinds, found, sound)
    lab.write(options.docs / "arm_twin.md", "arm_faults", table(kinds, found, sound))


if __name__ == "__main__":
    main()
