# SPDX-License-Identifier: BSD-3-Clause
"""A whole UR5, from /joint_states alone: identified on one recording, judged on the others."""
import concurrent.futures
import csv
import itertools
import os

import numpy as np

import closed_loop
from pairs import is_alarm, pairs_text
from runs import BLUE, GREEN, GREY, RED, figure, read, rms, save, write_rows

FOLDER = "ur5_cb"
TRAIN = "no6"          # the only recording that is identified on
RAISED_IN = ["no2", "no5", "no9"]
SHOWN = "no2"          # in the figure of the currents
RAISED_ROWS, LOAD_ROWS = "real_robot_raised.csv", "real_robot_load.csv"  # beside the page
RATIO_ROWS, VERDICT_ROWS = "real_robot_ratios.csv", "real_robot_verdicts.csv"
LEAST_SPAN = 1.0        # of a moment [N.m], from which on a share of it is stated
RAISED = 0.2           # share of a joint's friction
RAISED_ALONE = (0.3, 0.6)  # the same where there is no reference
JOINTS = ["base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3"]
LARGE = JOINTS[:3]
LOADS = ["arm", "target_moment"]
MOVING = 0.01          # [rad/s]
STANDSTILL = 0.005     # [rad/s] of the fit: below it Coulomb friction has no sign
MEAN = 0.1             # [s]
WANTED_MEANS, WANTED_MOVING = 0.5, 0.7  # of the fit's error
JOBS = 2
COLUMNS = ["time", "velocity_measured", "current_measured", "current_predicted", "current_residual", "current_band",
           "residual_torque", "friction_torque", "load_torque"]
CURRENT = f"""
### Error of the predicted current

The program divides the twin's error of the current by the error of a simple fit. [{RATIO_ROWS}]({RATIO_ROWS}) has the
quotients for the large joints, and [real_robot_current.csv](real_robot_current.csv) the errors of all joints in moving
and in resting rows [A, rms]. The column *means* is for means of the current over {MEAN:g} s around each moving row (row
faster than {MOVING:g} rad/s), the column *moving rows* for all single moving rows. The column `load` says from what the
load of a joint was computed. With *arm* the program computes the load from the arm's links, and the twin gets only
`/joint_states`. With *target_moment* the load is the recorded moment, in the identification and in the prediction. The
simple *fit* has gain, Coulomb friction and viscous friction, fitted by least squares to all rows of {TRAIN} with the
recorded moment as load. The wanted quotient is at most {WANTED_MEANS:g} for means and {WANTED_MOVING:g} for moving
rows.

![Error of means over 0.1 s](images/real_robot/means.png)

The error that remains in moving rows is ripple with 200 periods per turn of a joint, because the two lobes pass a tooth
of the circular spline 200 times per turn. The arm transmits the ripple of each joint to the currents of all joints.

At rest stiction holds the joint, and any current within a band gives the same angle. Two encoder counts (9.4 µrad) are
a quarter of the presliding angle and correspond to a change of the current by some 0.3 A. So at rest the twin predicts
a band of the current, not a value.

![Current of the three large joints, measured and predicted](images/real_robot/current.png)
"""


def running_mean(time, values):
    """Of the rows within half of MEAN to either side, whatever their period."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    first = np.searchsorted(time, time - 0.5 * MEAN - 1e-6)
    last = np.searchsorted(time, time + 0.5 * MEAN + 1e-6)
    return (sums[last] - sums[first]) / (last - first)


class Recording:
    """A file, and its rows beside the twins that were identified on TRAIN: by load and joint."""

    def __init__(self, runner, name, arm="ur5", loads=LOADS, identified="identified"):
        self.name = name
        self.data = read(runner.path(f"{name}.csv"))
        self.rows = {}
        for load in loads:
            report = runner.run("follow", f"{name}.csv", "--arm", arm, "--load", load, "--identified",
                                f"{identified}_{load}", "--out", f"{name}_{load}", "--json")
            if load == "arm":
                self.load_errors = [joint["load_difference_rms"] for joint in report["joints"]]
            for joint in JOINTS:
                path = runner.path(os.path.join(f"{name}_{load}", f"{joint}.csv"))
                with open(path, encoding="utf-8") as file:
                    names = file.readline().strip().split(",")
                columns = np.loadtxt(path, delimiter=",", skiprows=1, usecols=[names.index(c) for c in COLUMNS]).T
                self.rows[load, joint] = dict(zip(COLUMNS, columns))

    def period(self):
        return float(np.median(np.diff(self.data["timestamp"])))

    def moving(self, joint):
        return np.abs(self.rows["arm", joint]["velocity_measured"]) > MOVING

    def moment(self, joint):
        """The controller's, at the rows that were compared [N.m]."""
        time = self.data["timestamp"] - self.data["timestamp"][0]
        return np.interp(self.rows["arm", joint]["time"], time, self.data[f"target_moment_{JOINTS.index(joint)}"])


class Fit:
    """Current by the recorded moment, the sign of the speed and the speed: least squares over all rows of TRAIN."""

    def __init__(self, recording):
        self.coefficients = {joint: np.linalg.lstsq(self.columns(recording, joint),
                                                    recording.rows["arm", joint]["current_measured"], rcond=None)[0]
                             for joint in JOINTS}

    @staticmethod
    def columns(recording, joint):
        speed = recording.rows["arm", joint]["velocity_measured"]
        sign = np.where(np.abs(speed) < STANDSTILL, 0.0, np.sign(speed))
        return np.column_stack([recording.moment(joint), sign, speed])

    def residual(self, recording, joint):
        return (recording.rows["arm", joint]["current_measured"]
                - self.columns(recording, joint) @ self.coefficients[joint])


class Errors:
    """Rms errors of the current of one joint in one recording [A]; NaN where no row is of the kind."""

    def __init__(self, recording, joint, residual):
        moving = recording.moving(joint)
        time = recording.rows["arm", joint]["time"]

        def over(values, mask):
            return rms(values[mask]) if mask.any() else float("nan")

        self.all = rms(residual)
        self.moving = over(residual, moving)
        self.resting = over(residual, ~moving)
        self.means = over(running_mean(time, residual), moving)


KINDS = ["all", "moving", "resting", "means"]  # rows; means: over MEAN around each moving row


def errors_of(recording, fit):
    """By joint: of the twin with either load, and of the fit."""
    errors = {}
    for joint in JOINTS:
        residuals = {load: recording.rows[load, joint]["current_residual"] for load in LOADS}
        residuals["fit"] = fit.residual(recording, joint)
        errors[joint] = {name: Errors(recording, joint, residual) for name, residual in residuals.items()}
    return errors


def number(value):
    return "" if np.isnan(value) else f"{value:.2f}"


def load_text(recordings, path):
    """Writes difference of the load and range of the moment [N.m], a row each recording and joint; gives the worst."""
    spans = np.array([[np.ptp(recording.moment(joint)) for joint in JOINTS] for recording in recordings])
    errors = np.array([recording.load_errors for recording in recordings])
    write_rows(path, ["recording", "joint", "difference_rms [N.m]", "range [N.m]"],
               [[recording.name, joint, error, span] for recording, *rows in zip(recordings, errors, spans)
                for joint, error, span in zip(JOINTS, *rows)])
    shares = ((spans > LEAST_SPAN) * 100.0 * errors / np.maximum(spans, LEAST_SPAN)).max(axis=0)
    return ", ".join(f"{share:.1f} % in {joint}" for joint, share in zip(JOINTS, shares) if share > 0.0)


def write_errors(path, all_errors):
    """A row each recording and joint: errors of the current by load, and of the fit [A]; empty where no row is."""
    names = (*LOADS, "fit")
    with open(path, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["recording", "joint", *(f"{kind}_{name}" for kind in KINDS for name in names)])
        for recording, errors in all_errors.items():
            for joint in JOINTS:
                values = [getattr(errors[joint][name], kind) for kind in KINDS for name in names]
                rows.writerow([recording, joint, *("" if np.isnan(value) else f"{value:.3f}" for value in values)])


def share(errors, joint, kind, load="arm"):
    return getattr(errors[joint][load], kind) / getattr(errors[joint]["fit"], kind)


def ratio_rows(all_errors):
    """The twin's error over the fit's, of the large joints."""
    return [[name, joint, load, *(number(share(errors, joint, kind, load)) for kind in ("means", "moving"))]
            for name, errors in all_errors.items() for load in LOADS for joint in LARGE]


def write_raised(runner, recording, joints, path, share):
    """The recording with more friction in these joints: `share` times the identified twin's."""
    with open(runner.path(f"{recording.name}.csv"), encoding="utf-8") as file:
        head, *lines = file.read().splitlines()
    names, cells = head.split(","), [line.split(",") for line in lines]
    time = recording.data["timestamp"] - recording.data["timestamp"][0]
    for joint in joints:
        rows = recording.rows["arm", joint]
        large = np.argmax(np.abs(rows["current_residual"]))
        gain = rows["residual_torque"][large] / rows["current_residual"][large]
        more = share * np.interp(time, rows["time"], rows["friction_torque"]) / gain
        column = names.index(f"actual_current_{JOINTS.index(joint)}")
        for row, current in zip(cells, more):
            row[column] = repr(float(row[column]) + current)
    with open(runner.path(path), "w", encoding="utf-8") as file:
        file.write("\n".join([head, *(",".join(row) for row in cells), ""]))


class Verdicts:
    """Runs `compare --arm`, several at a time."""

    def __init__(self, runner):
        self.runner, self.runs = runner, concurrent.futures.ThreadPoolExecutor(JOBS)

    def start(self, name, report, *more, listed=True):
        """Without a report no page is made."""
        return self.runs.submit(self.runner.run, "compare", f"{name}.csv", "--arm", "ur5", "--json",
                                *(["--report", report] if report else []), *more, listed=listed)


def verdict_cell(arm):
    """The arm's level, and that of each joint that is not OK."""
    others = [f"{joint['joint']} {joint['level']}" for joint in arm["joints"] if joint["level"] != "OK"]
    common = f", {arm['friction_ratio']:.2f} of the whole arm" if arm["friction_ratio"] != 1.0 else ""
    return arm["level"] + common + (f" ({'; '.join(others)})" if others else "")


def ratio_cells(arm):
    return ["" if joint["friction_ratio"] is None else f"{joint['friction_ratio']:.2f}" for joint in arm["joints"]]


def is_right(arm, raised):
    """The raised joint, if its friction can be seen, is named and no other; of all: temperature or gain."""
    departing = {joint["joint"] for joint in arm["joints"] if is_alarm(joint)}
    seen = {joint["joint"] for joint in arm["joints"] if joint["friction_ratio"] is not None}
    return departing == (set(raised) & seen if len(raised) == 1 else set())


def raised_rows(verdicts):
    """(rows with their head, how many are right)."""
    rows, right = [["recording", "raised", *JOINTS, "verdict", "right"]], 0
    for (name, what), (arm, raised) in verdicts.items():
        answer = "yes" if is_right(arm, raised) else "no"
        right += answer == "yes"
        rows.append([name, what, *ratio_cells(arm), verdict_cell(arm), answer])
    return rows, right


def named_text(verdicts):
    """Of joints that were raised alone and whose friction is shown."""
    shown = [is_right(arm, raised) for arm, raised in verdicts if len(raised) == 1 and
             any(joint["joint"] == raised[0] and joint["friction_ratio"] is not None for joint in arm["joints"])]
    return (f"In {len(shown)} of these recordings the friction of one joint is raised and the motion shows the "
            f"friction of this joint. The verdict names this joint and no other in {sum(shown)} of these {len(shown)}.")


def raised_alone(runner, verdicts, recordings):
    """A sentence on joints that were raised alone and compared without a reference."""
    parts = []
    for more in RAISED_ALONE:
        runs = []
        for recording, joint in itertools.product(recordings, JOINTS):
            name = f"{recording.name}_{joint}_{more:.1f}"
            write_raised(runner, recording, [joint], f"{name}.csv", more)
            runs.append((verdicts.start(name, "", listed=False), joint))
        answers = [({line["joint"] for line in run.result()["joints"] if is_alarm(line)},
                    {line["joint"] for line in run.result()["joints"] if line["friction_ratio"] is not None}, joint)
                   for run, joint in runs]
        shown = sum(joint in seen for _, seen, joint in answers)
        named = sum(joint in departing for departing, _, joint in answers)
        others = sum(bool(departing - {joint}) for departing, _, joint in answers)
        parts.append(f"With {100.0 * more:.0f} % more friction the verdict names {named} of {shown} raised joints, "
                     f"and names another joint in {others} runs.")
    return ("Without a reference the verdict finds fewer of the joints with raised friction (raised joints). "
            f"{' '.join(parts)}")


def draw_current(path, recording):
    drawing, all_axes = figure(3, 1, (9.0, 7.0), sharex=True)
    for axes, joint in zip(all_axes, LARGE):
        rows = recording.rows["arm", joint]
        axes.plot(rows["time"], rows["current_measured"], color=GREY, lw=0.8, label="measured")
        axes.fill_between(rows["time"], rows["current_predicted"] - rows["current_band"],
                          rows["current_predicted"] + rows["current_band"], color=BLUE, alpha=0.2, lw=0,
                          label="band of a healthy joint")
        axes.plot(rows["time"], rows["current_predicted"], color=BLUE, lw=0.8, label="twin, from /joint_states alone")
        axes.set_title(f"{joint}: motor current [A]")
        axes.set_ylim(*(np.array([-0.6, 0.6]) + np.percentile(rows["current_measured"], [0.5, 99.5])))
    all_axes[0].legend(loc="lower right", fontsize=8, ncol=3)
    all_axes[-1].set_xlabel(f"time in {recording.name} [s]; identified on {TRAIN}")
    save(drawing, path)


def draw_means(path, all_errors):
    drawing, all_axes = figure(1, 3, (9.0, 3.2), sharey=True)
    at = np.arange(len(all_errors))
    for axes, joint in zip(all_axes, LARGE):
        for shift, (name, label), colour in zip((-0.26, 0.0, 0.26),
                                                (("arm", "twin, load of the arm"), ("target_moment", "twin, recorded "
                                                                                    "moment"),
                                                 ("fit", "fit, recorded moment")), (BLUE, GREEN, GREY)):
            axes.bar(at + shift, [errors[joint][name].means for errors in all_errors.values()], 0.24, color=colour,
                     label=label)
        half = [WANTED_MEANS * errors[joint]["fit"].means for errors in all_errors.values()]
        axes.hlines(half, at - 0.4, at + 0.4, color=RED, lw=1.0, label="wanted: half of the fit's")
        axes.set_xticks(at)
        axes.set_xticklabels(all_errors, fontsize=8, rotation=30)
        axes.set_title(joint)
    all_axes[0].set_ylabel("error of means over 0.1 s, moving [A]")
    all_axes[-1].legend(fontsize=7)
    save(drawing, path)


def rows_of(recordings):
    return ", ".join(f"{recording.name} ({len(recording.data)} rows, one every {1e3 * recording.period():.0f} ms)"
                     for recording in recordings)


def met(all_errors, kind, wanted):
    """How many of the large joints in the judged recordings are within what was wanted, of how many."""
    shares = [share(errors, joint, kind) for errors in all_errors.values() for joint in LARGE]
    shares = [value for value in shares if not np.isnan(value)]
    return sum(value <= wanted for value in shares), len(shares), max(shares)


def section(runner, telemetry, docs, images):
    """Lines of the page; the table beside it."""
    heading = ["## A UR5"]
    names = runner.link(os.path.join(telemetry, FOLDER), TRAIN)
    if not names:
        return heading + ["", f"*Not run: no recordings in {os.path.join(telemetry, FOLDER)}.*", ""]
    for load in LOADS:
        runner.run("identify", f"{TRAIN}.csv", "--arm", "ur5", "--load", load, "--out", f"identified_{load}")
    recordings = [Recording(runner, name) for name in names]
    by_name = {recording.name: recording for recording in recordings}
    judged = [recording for recording in recordings if recording.name != TRAIN]
    fit = Fit(by_name[TRAIN])
    all_errors = {recording.name: errors_of(recording, fit) for recording in recordings}
    judged_errors = {recording.name: all_errors[recording.name] for recording in judged}

    verdicts, raised_lines, judged_right = verdict_section(runner, by_name, judged, docs)
    draw_current(os.path.join(images, "current.png"), by_name.get(SHOWN, judged[0]))
    draw_means(os.path.join(images, "means.png"), judged_errors)
    means, means_of, worst_means = met(judged_errors, "means", WANTED_MEANS)
    moving, moving_of, worst_moving = met(judged_errors, "moving", WANTED_MOVING)
    summary = [f"The page compares the twin's error of the current with the error of a simple fit. A case is one large "
               f"joint in one recording that the twins were not identified on. For means over 0.1 s the twin's error "
               f"is at most {WANTED_MEANS:g} of the fit's error in {means} of {means_of} cases, and "
               f"{worst_means:.2f} times the fit's error in the worst case. For single moving rows the twin's error is "
               f"at most {WANTED_MOVING:g} of the fit's error in {moving} of {moving_of} cases, and "
               f"{worst_moving:.2f} times the fit's error in the worst case.",
               judged_right]
    write_errors(os.path.join(docs, "real_robot_current.csv"), {**judged_errors, TRAIN: all_errors[TRAIN]})
    write_rows(os.path.join(docs, RATIO_ROWS), ["recording", "joint", "load", "means", "moving rows"],
               ratio_rows(all_errors))
    print("\n".join([*map(",".join, raised_lines), *summary]))
    return [*heading, *introduction(summary, recordings, load_text(recordings, os.path.join(docs, LOAD_ROWS))),
            CURRENT,
            *closed_loop.section(runner, judged, fit, JOINTS, by_name.get(SHOWN, judged[0]).name,
                                 docs, TRAIN), *verdicts]


def verdict_section(runner, by_name, judged, docs):
    """(lines of the page, rows of the raised friction, a sentence)."""
    verdicts = Verdicts(runner)
    other = judged[0].name
    alone = {name: verdicts.start(name, f"report_{name}") for name in (TRAIN, *(r.name for r in judged))}
    concurrent.futures.wait(alone.values())  # references of the rest
    beside = {name: verdicts.start(name, "", "--reference", f"report_{other if name == TRAIN else TRAIN}")
              for name in alone}
    pairs = {(name, reference): verdicts.start(name, "", "--reference", f"report_{reference}", listed=False)
             for name in alone for reference in alone if name != reference}
    started = {}
    for name in RAISED_IN:
        for what, joints in [*((joint, [joint]) for joint in JOINTS), ("all", JOINTS)]:
            if name in by_name:
                write_raised(runner, by_name[name], joints, f"{name}_{what}.csv", RAISED)
                started[name, what] = (verdicts.start(f"{name}_{what}", "", "--reference", f"report_{TRAIN}",
                                                      listed=False), joints)
    sound = [[name, verdict_cell(alone[name].result()), *ratio_cells(beside[name].result()),
              verdict_cell(beside[name].result())] for name in alone]
    raised = {key: (run.result(), joints) for key, (run, joints) in started.items()}
    false_alarms = sum(is_alarm(joint) for runs in (alone, beside) for run in runs.values()
                       for joint in run.result()["joints"])
    of_pairs = [pairs_text([run.result() for run in pairs.values()], (LARGE, JOINTS[3:]))]
    write_rows(os.path.join(docs, VERDICT_ROWS),
               ["recording", "verdict alone", *JOINTS, "verdict with reference"], sound)
    raised_lines, right = raised_rows(raised)
    write_rows(os.path.join(docs, RAISED_ROWS), raised_lines[0], raised_lines[1:])
    sentence = (f"Of {2 * len(JOINTS) * len(alone)} verdicts on sound joints {false_alarms} are WARN or worse. The "
                f"verdict is right on {right} of {len(raised)} recordings with raised friction. "
                f"{named_text(raised.values())} "
                f"{raised_alone(runner, verdicts, list(by_name.values()))}")
    lines = ["""
### Verdicts

""" + f"""`joint_twin compare --arm ur5` judges each recording twice, alone and with the report of
{TRAIN} as `--reference` ({TRAIN} itself with the report of {other}). The arm is sound in all recordings.
[{VERDICT_ROWS}]({VERDICT_ROWS}) has the verdicts, and for each joint the friction divided by the friction in the
reference, at the speeds that recording and reference have in common, without the factor that all joints share. In the
CSV file a cell is empty if the motion does not show the friction of the joint.
""", *of_pairs, f"""
The recordings with raised friction are made from recordings of the sound arm. The program adds {100.0 * RAISED:.0f} %
of the identified friction of one joint, or of all joints, to the recorded current. If the friction of one joint is
raised, a verdict is right if it names this joint and no other. If the friction of all joints is raised, a verdict is
right if it names no single joint. No verdict can name a joint whose friction the motion does not show.
[{RAISED_ROWS}]({RAISED_ROWS}) has all runs.
""", """
### Limits of these recordings

The arm has no encoder behind the gear, so the torsion is not recorded. The recordings do not contain temperature and
payload. In no5 and no7 some rows are missing, over gaps of up to 0.4 s.
"""]
    return lines, raised_lines, sentence


def introduction(summary, recordings, loads):
    return [f"""
The arm is a UR5 of the CB series with six joints (K. Kufieta, *Force Estimation in Robotic Manipulators*, NTNU 2014).
The twins receive the angles and currents of the six joints, as in the `/joint_states` of a UR driver. The twins compute
the load of each joint from the angles of all joints ([arm.md](arm.md)). The program identifies the six twins on the
recording {TRAIN} alone (`joint_twin identify --arm`).

{summary[0]}
{summary[1]}

The recordings are {rows_of(recordings)}. A mean over {MEAN:g} s contains half as many rows in no2 (62.5 Hz) as in the
other recordings. In no5_pushed a person pushes the arm. No twin predicts the pushes. no7 repeats the motion of no6 on
another day.

### Load

The program compares the load that follows from the arm's links with the controller's `target_moment`. Where
`target_moment` has a range of more than {LEAST_SPAN:g} N·m in a recording, the rms difference divided by the range is
at most {loads}. [{LOAD_ROWS}]({LOAD_ROWS}) has rms difference and range for each recording and joint.
"""]
