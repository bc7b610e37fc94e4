# SPDX-License-Identifier: BSD-3-Clause
"""What a fault of one drive does to the tool of a UR5 and to its currents, for scripts/arm_faults.

The arm goes through four poses and back, twice, and stops at each. A run is judged beside the sound one in the same
motion. At rest: the last 0.2 s of a stop. ISO 9283: mean of the distances from their mean, and three of their standard
deviations.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import subprocess
import sys

import matplotlib
import numpy

import page_section

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of its backend)

PERIOD = 0.008                   # of the set points [s]
MOVE, STOP, REST = 1.0, 1.0, 0.2  # [s]
POSES = ((0.0, -1.4, 1.2, -1.4, -1.5, 0.2), (0.5, -1.1, 1.5, -1.9, -1.2, 0.8), (0.9, -0.8, 1.0, -1.6, -1.7, 0.3),
         (0.3, -1.5, 1.7, -1.2, -1.4, -0.4))
ORDER = (0, 1, 2, 3, 2, 1) * 2 + (0,)
JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")
FAULTY = ("shoulder", "elbow", "wrist_1")
SEVERITIES = (0.3, 1.0)
MAKERS_REPEATABILITY = 0.1       # of a UR5 [mm]


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
    """Columns of the run, by name; made unless they are there."""
    path = options.work / f"{name}.csv"
    if not path.exists():
        words = [options.tool, "arm", motion, "--arm", "ur5", "--out", path, "--json"]
        done = subprocess.run([*map(str, words), *(["--fault", fault] if fault else [])], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, check=False)
        if done.returncode != 0:
            sys.exit(f"arm_faults: {name}: {done.stderr}")
    return numpy.genfromtxt(path, delimiter=",", names=True)


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
    rests, sound_rests = rests_of(rows, stops), rests_of(sound, stops)
    moved = max(numpy.linalg.norm(rests[pose].mean(axis=0) - sound_rests[pose].mean(axis=0)) for pose in rests)
    error = numpy.linalg.norm(tool_of(rows, "actual") - tool_of(rows, "target"), axis=1)
    number = JOINTS.index(joint) if joint else 0
    current = [float(numpy.sqrt(numpy.mean(of[f"actual_current_{number}"]**2))) for of in (rows, sound)]
    return {"at_rest": moved, "repeatability": repeatability(rests),
            "path_rms": float(numpy.sqrt(numpy.mean(error**2))), "path_max": float(error.max()),
            "current": 100.0 * (current[0] / current[1] - 1.0)}


def draw(path, kinds, found, sound):
    columns = (("path_max", "tool off its path at most [mm]", sound["path_max"]),
               ("repeatability", "repeatability [mm]", sound["repeatability"]),
               ("current", "more current of the joint, rms [%]", 0.0))
    figure, axes = plt.subplots(1, len(columns), figsize=(12.0, 0.32 * len(kinds) + 1.6), sharey=True)
    for axis, (key, label, without) in zip(axes, columns):
        for joint, marker in zip(FAULTY, "os^"):
            for severity, filled in zip(SEVERITIES, ("none", None)):
                axis.plot([found[kind, joint, severity][key] for kind in kinds], range(len(kinds)), marker,
                          fillstyle=filled, label=f"{joint}, severity {severity}", markersize=6,
                          color=f"C{FAULTY.index(joint)}")
        axis.axvline(without, color="0.4", linewidth=1.0)
        axis.set_xlabel(label)
        axis.grid(alpha=0.3)
    axes[2].set_xscale("symlog", linthresh=1.0)
    axes[1].axvline(MAKERS_REPEATABILITY, color="0.4", linewidth=1.0, linestyle="--")
    axes[0].set_yticks(range(len(kinds)))
    axes[0].set_yticklabels([kind.replace("_", " ") for kind in kinds])
    axes[0].invert_yaxis()
    figure.legend(*axes[0].get_legend_handles_labels(), loc="upper center", ncol=len(FAULTY) * len(SEVERITIES),
                  fontsize=8)
    figure.tight_layout(rect=(0.0, 0.0, 1.0, 0.95))
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path, dpi=110)


def table(kinds, found, sound):
    head = " | ".join(f"{joint}: path, repeats, current" for joint in FAULTY)
    lines = [f"Severity {SEVERITIES[1]:g}, tool off its path at most [mm], repeatability (ISO 9283) [mm], more current "
             "of the joint [%, rms]:", "", f"| fault | {head} | at rest [mm] |", "|---|" + "---|" * (len(FAULTY) + 1),
             f"| none | {sound['path_max']:.2f}, {sound['repeatability']:.3f}, 0 |" + " |" * len(FAULTY)]
    for kind in kinds:
        cells = [found[kind, joint, SEVERITIES[1]] for joint in FAULTY]
        lines.append(f"| `{kind}` | " + " | ".join(
            f"{cell['path_max']:.2f}, {cell['repeatability']:.3f}, {round(cell['current']):+d}" for cell in cells) +
                     f" | {max(cell['at_rest'] for cell in cells):.3f} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", required=True, help="program joint_twin")
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder of arm_twin.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the runs; those there are kept")
    parser.add_argument("--jobs", type=int, default=2, help="runs at the same time")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    listed = json.loads(subprocess.run([options.tool, "faults", "--json"], stdout=subprocess.PIPE, check=True).stdout)
    kinds = [fault["kind"] for fault in listed]
    places = {fault["kind"]: max(fault["first_place"], -1) for fault in listed}
    motion = options.work / "motion.csv"
    stops = write_motion(motion)
    sound_rows = run(options, motion, "sound", None)
    cases = [(kind, joint, severity) for kind in kinds for joint in FAULTY for severity in SEVERITIES]
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
    draw(options.docs / "images" / "arm_twin" / "faults.png", kinds, found, sound)
    page_section.write(options.docs / "arm_twin.md", "arm_faults", table(kinds, found, sound))


if __name__ == "__main__":
    main()
