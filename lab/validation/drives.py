# SPDX-License-Identifier: BSD-3-Clause
"""Recordings and tests of real drives: friction of UR5 and UR5e joints, torsion of a 101:1 drive with two encoders."""
import os
import sys

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from bounds import AtMost, Between, Within
from evidence import MEASUREMENT, fitted, measured
from page import BLUE, GREEN, ORANGE, number

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "real"))
import two_encoders  # noqa: E402  (its folder is known now)

RATIO = 101
JOINTS = ("base", "shoulder", "elbow")
COLOURS = dict(zip(JOINTS, (BLUE, ORANGE, GREEN)))

# Loss without load at the joint [N.m] by joint speed [rad/s]: lowest and highest of two robots.
UR5E_SPEEDS = (0.01, 0.5, 1.5, 3.2)
UR5E_LOSS = {"base": ((5.5, 5.9), (9.2, 9.6), (13.7, 14.5), (17.6, 20.0)),
             "shoulder": ((6.4, 6.8), (10.2, 10.8), (13.0, 16.2), (17.4, 22.0)),
             "elbow": ((5.0, 5.0), (8.5, 9.0), (13.1, 13.8), (18.0, 18.5))}

# What the controller of a UR3e expects of its joints, target_current times gain less target_moment: a + b v by joint
# [N.m], [N.m.s/rad], over 9 s at 25 Hz (ubc-systopia/dsn-2022-rad-artifact); by size with its temperature [degC] and
# overlays. Joints of one size of a UR10e differ by SAME_SIZE.
UR3E = {17: (((3.43, 3.49), (3.26, 3.36)), 35.0, ("size_17.yaml", "joints/size_2.yaml")),
        14: (((1.57, 1.63),), 38.0, ("size_14.yaml",)),
        11: (((0.83, 0.72), (0.58, 0.53), (0.76, 0.56)), 42.0, ("size_11.yaml", "joints/size_0.yaml"))}
UR3E_SPEEDS = (0.1, 1.0)  # rad/s at the joint
SAME_SIZE = 1.3
UR3E_KNOWN = {(17, 1.0): "preload and viscosity are fitted to the catalogue's gear. The friction that motor, seals and "
                         "output bearing add at this speed is not known",
              (14, 0.1): "the preload is fitted to the catalogue's starting torque of a new gear. A UR3e's elbow is "
                         "expected to have less friction than a new gear"}

GAIN = 10.7  # N.m at the joint per ampere of motor current, the controller's own ratio at rest
SPEED_BINS = (0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0, 1.3)  # rad/s at the joint
FEWEST_ROWS = 20  # in a bin

# Of a UR10e: number of a joint, its gain, torque at the joint per ampere by the controller at rest [N.m/A], its
# overlays, the recordings it moves in, and what its friction grows by with the load, as a share of it [%]: four
# recordings on three days, their spread and that of each.
UR10E = {"elbow": (2, 9.84, ("joints/elbow.yaml",),
                   ("ur10e_20_01_22-joint_3.csv", "ur10e_20_02_12-40sec_12harm.csv", "ur10e_20_02_19_14harm50sec.csv"),
                   (5.7 - 1.5, 6.9 + 1.5)),
         "base": (0, 11.98, ("size_32.yaml", "joints/size_4.yaml"), ("ur10e_20_02_12-40sec_12harm.csv",), None),
         "shoulder": (1, 11.98, ("size_32.yaml", "joints/size_4.yaml"),
                      ("ur10e_20_02_12-40sec_12harm.csv", "ur10e_20_02_19_14harm50sec.csv"), (6.2 - 1.0, 6.6 + 1.0))}
PAYLOAD = 2.805  # kg at the flange of a UR10e, which its controller was not told
GAINS_KNOWN = 0.1  # two standard deviations of a joint's gain, as the fit of a payload takes it
MOVING = 0.05  # rad/s at the joint
LOW_LOAD = 30.0  # N.m: hardly anything of the shoulder's friction is by load below
GRID = (0.05, 0.1, 0.2, 0.35, 0.5, 0.8, 1.2, 1.8)  # rad/s at the joint, and loads between the least and the largest
GRID_LOADS = 9
OWN_LOADS, OWN_SPEEDS = (20.0, 50.0, 100.0), (0.1, 0.5, 1.0)  # N.m, rad/s at the joint

DIRECTION_GAP = 0.09e-3  # rad, between the directions of motion without load
# Why a joint's friction does not hold.
UR10E_KNOWN = {"base": "the twin has the friction fitted to the shoulder and the grease of a UR5. The base has 1.3 "
                       "times the friction of the shoulder at every speed, and the tilting moment explains little of "
                       "the difference. Drives of one size differ"}
TILTED = ("ur10e_20_02_12-40sec_12harm.csv", "ur10e_20_02_19_14harm50sec.csv", "ur10e_20_02_19_14harm50secLoad.csv")
INDEPENDENT = 40  # rows of a joint, at most: errors of a model are no noise


def build(page):
    ur5e(page)
    ur3e(page)
    ur5(page)
    ur10e(page)
    load_loss(page)
    tilting(page)
    payload(page)
    own_share(page)
    both_encoders(page)


def joint_loss(page, speeds, loads, *arguments):
    """Friction at the joint [N.m], of gear and motor, for pairs of joint speed and load."""
    rows = page.tool("losses", "--positions", 4, "--speeds", ",".join(f"{RATIO * speed:.6g}" for speed in speeds),
                     "--loads",
                     ",".join(f"{load:.6g}" for load in loads), *arguments)["rows"]
    return np.array([RATIO * (row["gear_loss"] + row["motor"]) for row in rows]).reshape(len(loads), len(speeds))


def ur5e(page):
    page.heading("UR5e: factory test without load")
    page.text("""
Universal Robots' own figures for two robots at about 45 °C. One viscosity of the grease serves three joints and four
speeds; each joint has its own preload (`config/joints/ur5e_*.yaml`). That the speed part is the same in all three
joints, and grows with the speed to the power of 2/3, is Palmgren's law at work; its size is more than the catalogue
gear's: seals, output bearing and motor are in it.
""")
    losses = {}
    for joint in JOINTS:
        overlays = ("--config", f"joints/{joint}.yaml", "--config", f"joints/ur5e_{joint}.yaml")
        losses[joint] = joint_loss(page, UR5E_SPEEDS, [0.0], *overlays)[0]
        for speed, (low, high), loss in zip(UR5E_SPEEDS, UR5E_LOSS[joint], losses[joint]):
            page.check(f"drives.ur5e.{joint}.{speed:g}", f"{joint}, loss at {speed:g} rad/s",
                       "factory test, two robots",
                       Between(round(0.98 * low, 2), round(1.02 * high, 2)), loss, "N·m",
                       "two robots and 2 %, which two degrees of grease temperature make",
                       evidence=fitted("preload and viscosity of joints/ur5e_*.yaml to these tests"))
    if page.fast:
        return
    sweep = np.geomspace(0.01, 3.3, 25)

    def draw(figure):
        axes = figure.subplots()
        axes.set_title("Loss without load at the joint [N·m] against its speed [rad/s]")
        for joint in JOINTS:
            overlays = ("--config", f"joints/{joint}.yaml", "--config", f"joints/ur5e_{joint}.yaml")
            axes.plot(sweep, joint_loss(page, sweep, [0.0], *overlays)[0], color=COLOURS[joint], label=f"{joint}, twin")
            for speed, band in zip(UR5E_SPEEDS, UR5E_LOSS[joint]):
                axes.plot([speed, speed], band, "_-", color=COLOURS[joint], lw=4, alpha=0.5, ms=8)
        axes.legend()

    page.figure("drives_ur5e", "Loss of UR5e joints without load; bars: the two robots of the factory test.", draw,
                (6.4, 3.0))


def ur3e(page):
    page.heading("UR3e: what its controller expects")
    page.text("""
A UR3e's controller states the moment that it wants and the current that it wants it with; what is between them is the
friction that it expects, by speed. Nothing of the sizes 17, 14 and 11 is fitted to a robot.
""")
    for size, (joints, temperature, overlays) in UR3E.items():
        losses = joint_loss(page, UR3E_SPEEDS, [0.0], *overlay_arguments(overlays), "--set",
                            f"input.temperature={temperature}")[0]
        for speed, loss in zip(UR3E_SPEEDS, losses):
            expected = [constant + by_speed * speed for constant, by_speed in joints]
            page.check(f"drives.ur3e.{size}.{speed:g}", f"size {size}, friction at {speed:g} rad/s",
                       "a UR3e's controller",
                       Between(round(min(expected) / SAME_SIZE, 2), round(max(expected) * SAME_SIZE, 2)), loss, "N·m",
                       f"at {temperature:g} °C; two joints of one size of a UR10e differ by {SAME_SIZE:g} times",
                       known=UR3E_KNOWN.get((size, speed), ""), evidence=MEASUREMENT)


def overlay_arguments(overlays):
    return [word for overlay in overlays for word in ("--config", overlay)]


def ur10e(page):
    page.heading("UR10e: friction while it moves")
    page.text("""
The same for a UR10e (shamilmamedov/dynamic_calibration), by speed at the mean load of each bin. The elbow is that of a
UR5, whose type and gear it has; base and shoulder are the family's size 32 with the friction by speed of a UR5's joints
(`config/joints/size_4.yaml`). One value is fitted, the interference of the wave generator (`contact.fit`), to the
shoulder's friction at low load.
""")
    rows = []
    for joint, (number_of, gain, overlays, names, _) in UR10E.items():
        path = recording(page, "ur10e", names[0])
        if not path:
            return
        data = np.genfromtxt(path, delimiter=",", names=True)
        speeds, loads, friction, scatter = friction_map(data, number_of, gain).T
        twin = np.diag(joint_loss(page, speeds, loads, *overlay_arguments(overlays)))
        page.check(f"drives.ur10e.friction.{joint}", f"{joint}, friction over speed, rms error", "recording",
                   AtMost(round(friction[0] / 7.0, 2)), np.sqrt(np.mean((twin - friction) ** 2)), "N·m",
                   f"a seventh of the friction at the slowest, as for the UR5; within a bin it scatters by "
                   f"{scatter.mean():.1f} N·m", known=UR10E_KNOWN.get(joint, ""),
                   evidence=ur10e_evidence(joint, names[0]))
        rows.append([joint, names[0], *(f"{value:.1f}" for value in (friction[0], twin[0], friction[-1], twin[-1]))])
    page.table(["joint", "recording", "slowest bin [N·m]", "twin", "fastest bin [N·m]", "twin"], rows)


def ur10e_evidence(joint, recording_name):
    """Of a row of one joint in one recording."""
    if joint == "shoulder" and recording_name == UR10E[joint][3][0]:
        return fitted("contact.fit of joints/size_4.yaml to the friction at low load in this recording")
    shares = {"shoulder": "contact.fit of joints/size_4.yaml is fitted to another recording of this joint",
              "base": "contact.fit of joints/size_4.yaml is fitted to the shoulder",
              "elbow": "joints/elbow.yaml is fitted to a UR5"}
    return measured(shares[joint])


def moving_rows(data, joint, gain):
    """Of the rows in which a joint moves: speed, size of the load, friction, and the load along the motion."""
    speed, load = data[f"actual_qd_{joint}"], data[f"target_moment_{joint}"]
    moving = np.abs(speed) > MOVING
    friction = (gain * data[f"actual_current_{joint}"] - load) * np.sign(speed)
    return tuple(values[moving] for values in (np.abs(speed), np.abs(load), friction, load * np.sign(speed)))


def at_rows(page, overlays, speed, load, *arguments):
    """The twin's friction at these speeds and loads [N.m], between points of a grid."""
    loads = np.linspace(0.0, load.max(), GRID_LOADS)
    loss = joint_loss(page, GRID, loads, *overlay_arguments(overlays), *arguments)
    return RegularGridInterpolator((loads, GRID), loss, bounds_error=False, fill_value=None)(np.c_[load, speed])


def parts_of(friction, speed, load, along):
    """Friction at standstill [N.m], by speed to the power of 2/3, by load, and what a wrong gain would make of it."""
    return np.linalg.lstsq(np.c_[np.ones_like(speed), speed ** (2.0 / 3.0), load, along], friction, rcond=None)[0]


def load_loss(page):
    page.heading("UR10e: friction that grows with the load")
    page.text("""
What the friction of a UR10e grows by with the load, beside what the twin's does at the same speeds and loads, row by
row of each recording: both are split in the same way, into friction at standstill, by speed, by load, and by load along
the motion, which a wrong gain would make. No load share is fitted: the shoulder's interference follows from its
friction at low load, and decides what the balls gain by the load.
""")
    table = []
    for joint, (number_of, gain, overlays, names, band) in UR10E.items():
        for k, name in enumerate(names if band else ()):
            path = recording(page, "ur10e", name)
            if not path:
                return
            speed, load, friction, along = moving_rows(np.genfromtxt(path, delimiter=",", names=True), number_of, gain)
            recorded = parts_of(friction, speed, load, along)
            twin = parts_of(at_rows(page, overlays, speed, load), speed, load, along)
            page.check(f"drives.ur10e.load_loss.{joint}.{k + 1}", f"{joint}, friction by load in {name}, of the load",
                       "four recordings", Between(round(band[0], 1), round(band[1], 1)), 100.0 * twin[2], "%",
                       f"spread of the four recordings and of each; this one has {100.0 * recorded[2]:.1f} %",
                       evidence=ur10e_evidence(joint, name))
            table.append([joint, name, *(f"{a:.1f} ({b:.1f})" for a, b in zip(recorded[:2], twin[:2])),
                          f"{100.0 * recorded[2]:.1f} ({100.0 * twin[2]:.1f})"])
    page.table(["joint", "recording", "at standstill [N·m] (twin)", "by speed [N·m at 1 rad/s] (twin)",
                "by load [%] (twin)"], table)


def tilting(page):
    page.heading("UR10e: friction by the tilting moment")
    page.text("""
The bearing of the base's output bears the arm's weight as a tilting moment, which is the torque of the shoulder, and no
load. The base's friction is split, row by row of each recording, into friction at standstill, by speed to the power of
2/3, and by that moment, with a 95 % interval as of forty independent rows. The twin has no such part
(`output.tilting_friction` is 0).
""")
    table = []
    for k, name in enumerate(TILTED):
        path = recording(page, "ur10e", name)
        if not path:
            return
        data = np.genfromtxt(path, delimiter=",", names=True)
        number_of, gain = UR10E["base"][:2]
        speed, _, friction, _ = moving_rows(data, number_of, gain)
        moment = np.abs(data["target_moment_1"][np.abs(data[f"actual_qd_{number_of}"]) > MOVING])
        terms = np.c_[np.ones_like(speed), speed ** (2.0 / 3.0), moment]
        parts, squares, *_ = np.linalg.lstsq(terms, friction, rcond=None)
        deviation = np.sqrt(squares[0] / INDEPENDENT * np.linalg.inv(terms.T @ terms)[2, 2])
        page.value(f"drives.ur10e.tilting.{k + 1}", 100.0 * parts[2], "%")
        table.append([name, f"{moment.max():.0f}", f"{parts[0]:.1f}",
                      f"{100.0 * parts[2]:.1f} ± {196.0 * deviation:.1f}"])
    page.table(["recording", "largest tilting moment [N·m]", "at standstill [N·m]", "of the tilting moment [%]"], table)


def payload(page):
    page.heading("UR10e: a payload that nobody configured")
    path = recording(page, "ur10e", "ur10e_20_02_19_14harm50secLoad.csv")
    if not path:
        return
    found = page.tool("compare", path, "--arm", "ur10e")
    page.check("drives.ur10e.payload", "mass at the flange, by `joint_twin compare`", "recording: weighed",
               Within(PAYLOAD, absolute=min(GAINS_KNOWN * PAYLOAD, found["payload_half_width"])), found["payload_mass"],
               "kg", f"gains are known to {50.0 * GAINS_KNOWN:g} %, one standard deviation, and scale what the payload "
               f"takes; the tool's own 95 % interval, ± {found['payload_half_width']:.2f} kg, has to hold it too",
               evidence=measured("the current gains of the arm are of the same robot, from its calibration without "
                                 "payload"))


def own_share(page):
    page.heading("The shipped drive: friction by load")
    page.text("""
What a load adds to the loss of the shipped drive, of that load; below zero it is driven back. A UR10e's large joints
have 6 ± 1 % over their own loads, drives of this kind (xMate, eRob) 5 to 13 % near the rated torque.
""")
    loads = [0.0, *(sign * load for load in OWN_LOADS for sign in (1.0, -1.0))]
    loss = joint_loss(page, OWN_SPEEDS, loads)
    shares = 100.0 * (loss[1:] - loss[0]) / np.abs(loads[1:])[:, None]
    for load, row in zip(loads[1:], shares):
        for speed, share in zip(OWN_SPEEDS, row):
            page.value(f"drives.own_share.{'driven' if load > 0.0 else 'back'}.{abs(load):g}.{speed:g}", share, "%")
    page.table(["load [N·m]", *(f"{speed:g} rad/s" for speed in OWN_SPEEDS)],
               [[f"{load:g}", *(f"{share:.1f} %" for share in row)] for load, row in zip(loads[1:], shares)])


def recording(page, *parts):
    """Path of a recording, or None with a line on the page."""
    path = os.path.join(page.settings.telemetry, *parts)
    if os.path.isfile(path):
        return path
    page.text(f"*Not run: no recording `{os.path.join(*parts)}` in `{page.settings.telemetry}`.*")
    return None


def friction_map(data, joint, gain=GAIN):
    """Speed, size of the load, friction and its scatter in each speed bin: current less the controller's rigid-body
    torque."""
    speed, current = data[f"actual_qd_{joint}"], data[f"actual_current_{joint}"]
    load = data[f"target_moment_{joint}"]
    friction = (gain * current - load) * np.sign(speed)
    rows = []
    for low, high in zip(SPEED_BINS, SPEED_BINS[1:]):
        inside = (np.abs(speed) >= low) & (np.abs(speed) < high)
        if inside.sum() >= FEWEST_ROWS:
            rows.append((np.abs(speed[inside]).mean(), np.abs(load[inside]).mean(), friction[inside].mean(),
                         friction[inside].std()))
    return np.array(rows)


def ur5(page):
    page.heading("UR5, CB series: friction while it moves")
    page.text(f"""
82 s of a UR5 moving (K. Kufieta, NTNU 2014). Friction is {GAIN:g} N·m/A times the motor current, less the torque of
the controller's rigid-body model, in bins of speed. Again one viscosity for three joints and a preload for each
(`config/joints/*.yaml`).
""")
    path = recording(page, "ur5_cb", "ur5_cb_no6.csv")
    if not path:
        return
    data = np.genfromtxt(path, delimiter=",", names=True)
    for joint, name in enumerate(JOINTS):
        speeds, loads, friction, scatter = friction_map(data, joint).T
        twin = np.diag(joint_loss(page, speeds, loads, "--config", f"joints/{name}.yaml"))
        page.check(f"drives.ur5.{name}", f"{name}, friction over speed, rms error", "recording", AtMost(1.0),
                   np.sqrt(np.mean((twin - friction) ** 2)), "N·m",
                   f"a seventh of the friction at the slowest; within a bin the recording scatters by "
                   f"{scatter.mean():.1f} N·m",
                   evidence=fitted("preload and viscosity of joints/*.yaml to this recording"))
    page.text("""
*Limits of this recording:* the rigid-body torque is the controller's, so errors of its masses and of the
payload look like friction (the shoulder has the largest weight and the largest residual); no temperature; no encoder
at the motor, so no torsion and no kinematic error apart from ripples of the current.
""")


def both_encoders(page):
    page.heading("A 101:1 drive with encoders on both sides")
    page.text("""
Elbow of a NEURA LARA 8 (A. Lucious, 2024), swept under gravity and payload. Torsion is motor angle over 101 less
output angle, less the same without load; torque is the motor's, at the joint. Nothing is fitted: the twin's curve is
the catalogue gear's, moved by the friction that the twin itself has at this speed; the mean, which the arbitrary zero
of the encoders leaves open, is taken out. Only the part at constant speed is used.
""")
    loaded, unloaded = (recording(page, path) for path in (two_encoders.LOADED, two_encoders.UNLOADED))
    if not loaded or not unloaded:
        return
    found = two_encoders.Torsion(page.tool, two_encoders.read(loaded), two_encoders.unloaded_error(unloaded),
                                 with_motor=True)
    line = np.polyfit(found.torque, found.torsion, 1)
    slope, twin_slope = 1.0 / line[0], 1.0 / np.polyfit(found.torque, found.predicted, 1)[0]
    page.check("drives.torsion_slope", "mean slope of torque over torsion", f"recording: {number(slope)} N·m/rad",
               Within(slope / 1e3, relative=0.20), twin_slope / 1e3, "10³ N·m/rad",
               "size 25 is inferred; links and bearings between the encoders only soften; motor torque contains "
               "friction",
               evidence=measured("cup.friction_torque is fitted to the gap of the same drive's run without load, not "
                                 "to this sweep"))
    page.check("drives.torsion_residual", "rms of recording less twin", "recording", AtMost(0.35),
               1e3 * np.std(found.torsion - found.predicted), "mrad", "a straight line fitted to this very recording "
               f"leaves {1e3 * np.std(found.torsion - np.polyval(line, found.torque)):.2f} mrad",
               evidence=measured("cup.friction_torque is fitted to the gap of the same drive's run without load, not "
                                 "to this sweep"))
    loop = page.tool("hysteresis", "--amplitude", 67, "--lost-motion-torque", 2.68)
    page.check("drives.direction_gap", "gap between the directions, no load", "recording without load",
               Within(1e3 * DIRECTION_GAP, relative=0.2), 1e3 * loop["hysteresis"], "mrad",
               "fitted (`cup.friction_torque`); read from a published figure",
               evidence=fitted("cup.friction_torque to it"))
    page.text("""
*Limits of this recording:* the drive's size is inferred from its ratio and torque; the sweep is one way, 7 s
long; the torque is computed from current. It shows no soft beginning at small load; whether the drive has none or the
sweep hides it in its transmission error (up to 1.4 mrad), one sweep cannot decide. Figure: docs/real_robot.md.
""")
