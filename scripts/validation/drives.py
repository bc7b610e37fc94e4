# SPDX-License-Identifier: BSD-3-Clause
"""Recordings and tests of real drives: friction of UR5 and UR5e joints, torsion of a 101:1 drive with two encoders."""
import os

import numpy as np

from bounds import AtMost, Between, Within
from page import BLUE, GREEN, GREY, ORANGE, number

RATIO = 101
JOINTS = ("base", "shoulder", "elbow")
COLOURS = dict(zip(JOINTS, (BLUE, ORANGE, GREEN)))

# Loss without load at the joint [N.m] by joint speed [rad/s]: lowest and highest of two robots.
UR5E_SPEEDS = (0.01, 0.5, 1.5, 3.2)
UR5E_LOSS = {"base": ((5.5, 5.9), (9.2, 9.6), (13.7, 14.5), (17.6, 20.0)),
             "shoulder": ((6.4, 6.8), (10.2, 10.8), (13.0, 16.2), (17.4, 22.0)),
             "elbow": ((5.0, 5.0), (8.5, 9.0), (13.1, 13.8), (18.0, 18.5))}

GAIN = 10.7  # N.m at the joint per ampere of motor current, the controller's own ratio at rest
SPEED_BINS = (0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 1.0, 1.3)  # rad/s at the joint
FEWEST_ROWS = 20  # in a bin

# Of a UR10e, four recordings on three days: overlays of the joint, largest load of the recordings [N.m], and what its
# friction grows by with the load, as a share of it [%], with the spread of the four and of each.
UR10E_LOAD_LOSS = {"elbow": (("joints/elbow.yaml",), 45.0, (5.7 - 1.5, 6.9 + 1.5)),
                   "shoulder": (("size_32.yaml", "joints/size_4.yaml"), 133.0, (6.2 - 1.0, 6.6 + 1.0))}
LOAD_LOSS_SPEED = 0.5  # rad/s at the joint
# Recording, and of its joints number and gain: torque at the joint per ampere by the controller at rest [N.m/A].
UR10E = {"ur10e_20_01_22-joint_3.csv": {"elbow": (2, 9.84)},
         "ur10e_20_02_12-40sec_12harm.csv": {"base": (0, 11.98), "shoulder": (1, 11.98), "elbow": (2, 9.84)}}

COUNTS = 2 ** 24  # of both encoders of the 101:1 drive, per turn
DIRECTION_GAP = 0.09e-3  # rad, between the directions of motion without load
# Why a joint's friction does not hold.
UR10E_KNOWN = {"base": "the joint's friction by speed is 1.8 times that of the catalogue's gear with an estimated "
               "motor; in a UR5's recorded joints, which have their own overlays, it is 1.6 times"}


def build(page):
    ur5e(page)
    ur5(page)
    ur10e(page)
    load_loss(page)
    two_encoders(page)


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
                       "two robots and 2 %, which two degrees of grease temperature make")
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


def ur10e(page):
    page.heading("UR10e: friction while it moves")
    page.text("""
The same for a UR10e (shamilmamedov/dynamic_calibration), by speed at the mean load of each bin. Nothing is fitted to
it: the elbow is that of a UR5, whose type and gear it has; base and shoulder are the family's size 32 with a motor that
is an estimate (`config/joints/size_4.yaml`), without what seals and output bearing add.
""")
    rows = []
    for name, joints in UR10E.items():
        path = recording(page, "ur10e", name)
        if not path:
            return
        data = np.genfromtxt(path, delimiter=",", names=True)
        for joint, (number_of, gain) in joints.items():
            speeds, loads, friction, scatter = friction_map(data, number_of, gain).T
            overlays = UR10E_LOAD_LOSS["elbow" if joint == "elbow" else "shoulder"][0]
            arguments = [word for overlay in overlays for word in ("--config", overlay)]
            twin = np.diag(joint_loss(page, speeds, loads, *arguments))
            # Of an elbow in a recording of the whole arm the first recording is the better one.
            if joint not in [row[0] for row in rows]:
                page.check(f"drives.ur10e.friction.{joint}", f"{joint}, friction over speed, rms error", "recording",
                           AtMost(round(friction[0] / 7.0, 2)), np.sqrt(np.mean((twin - friction) ** 2)), "N·m",
                           f"a seventh of the friction at the slowest, as for the UR5; within a bin it scatters by "
                           f"{scatter.mean():.1f} N·m", known=UR10E_KNOWN.get(joint, ""))
            rows.append([joint, name, *(f"{value:.1f}" for value in (friction[0], twin[0], friction[-1], twin[-1]))])
    page.table(["joint", "recording", "slowest bin [N·m]", "twin", "fastest bin [N·m]", "twin"], rows)


def load_loss(page):
    page.heading("UR10e: friction that grows with the load")
    page.text(f"""
What the friction of a UR10e grows by with the load (recordings of shamilmamedov/dynamic_calibration; its currents by
the controller's own ratio at rest), beside a straight line through the twin's loss at {LOAD_LOSS_SPEED:g} rad/s, over
the loads of the recordings. Nothing is fitted to it. The twin's loss rises slowly at first and faster under load; a
line is what the recordings can tell.
""")
    for joint, (overlays, most, (low, high)) in UR10E_LOAD_LOSS.items():
        loads = np.linspace(0.0, most, 10)
        arguments = [word for overlay in overlays for word in ("--config", overlay)]
        loss = joint_loss(page, [LOAD_LOSS_SPEED], loads, *arguments)[:, 0]
        page.check(f"drives.ur10e.load_loss.{joint}", f"{joint}, friction by load up to {most:g} N·m, of the load",
                   "four recordings", Between(round(low, 1), round(high, 1)), 100.0 * np.polyfit(loads, loss, 1)[0],
                   "%", "spread of the four recordings and of each",
                   known="" if joint == "elbow" else
                   "the flanks' friction coefficient is assumed, 0.06; 0.05 would make 7.3 %, and 5.4 % at the elbow, "
                   "but 70.1 % of efficiency at size 14, whose catalogue has 67 ± 3 %")


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
    maps, twins = {}, {}
    for joint, name in enumerate(JOINTS):
        maps[name] = friction_map(data, joint)
        speeds, loads = maps[name][:, 0], maps[name][:, 1]
        twins[name] = np.diag(joint_loss(page, speeds, loads, "--config", f"joints/{name}.yaml"))
        error = np.sqrt(np.mean((twins[name] - maps[name][:, 2]) ** 2))
        page.check(f"drives.ur5.{name}", f"{name}, friction over speed, rms error", "recording", AtMost(1.0), error,
                   "N·m",
                   f"a seventh of the friction at the slowest; within a bin the recording scatters by "
                   f"{maps[name][:, 3].mean():.1f} N·m")
    page.text("""
*Limits of this recording:* the rigid-body torque is the controller's, so errors of its masses and of the
payload look like friction (the shoulder has the largest weight and the largest residual); no temperature; no encoder
at the motor, so no torsion and no kinematic error apart from ripples of the current.
""")

    def draw(figure):
        for axes, name in zip(figure.subplots(1, 3, sharey=True), JOINTS):
            speed, _, friction, scatter = maps[name].T
            axes.errorbar(speed, friction, yerr=scatter, fmt="o", ms=4, color=GREY, elinewidth=0.8, label="recording")
            axes.plot(speed, twins[name], color=COLOURS[name], label="twin")
            axes.set_title(f"{name} [N·m]")
            axes.set_xlabel("joint speed [rad/s]")
            axes.legend(loc="lower right")

    page.figure("drives_ur5",
                "Friction of a UR5's size 3 joints by speed; bars: scatter within a bin, which holds acceleration "
                "and ripple.", draw)


def unloaded_error(path, angle):
    """Transmission error without load [rad] at joint angles [rad]: medians per 2 degrees of the published points."""
    data = np.genfromtxt(path, delimiter=",", names=True)
    degrees, error = data["load_angle_deg"], data["transmission_error_counts"] * 2.0 * np.pi / COUNTS
    edges = np.arange(-150.0, 151.0, 2.0)
    bins = np.digitize(degrees, edges)
    known = np.unique(bins)
    centres = [0.5 * (edges[k - 1] + edges[k]) for k in known]
    return np.interp(np.degrees(angle), centres, [np.median(error[bins == k]) for k in known])


def two_encoders(page):
    page.heading("A 101:1 drive with encoders on both sides")
    page.text("""
Elbow of a NEURA LARA 8 (A. Lucious, 2024), swept under gravity and payload. Torsion is motor angle over 101 less
output angle, less the same without load; torque is the motor's, at the joint. Nothing is fitted: the twin's curve is
the catalogue gear's, moved by the friction that the twin itself has at this speed; the mean, which the arbitrary zero
of the encoders leaves open, is taken out. Only the part at constant speed is used.
""")
    loaded = recording(page, "lara8", "validate.csv")
    unloaded = recording(page, "lara8", "unloaded_transmission_error.csv")
    if not loaded or not unloaded:
        return
    data = np.genfromtxt(loaded, delimiter=",", names=True)
    angle, torque = data["joint_angles_3"], data["joint_torque_current_3"]
    turn = 2.0 * np.pi / COUNTS
    torsion = turn * (data["encoder_motorinc_3"] / RATIO - data["encoder_loadinc_3"]) - unloaded_error(unloaded, angle)
    speed = data["joint_velocity_3"]
    steady = speed > 0.6  # rad/s
    angle, torque, torsion = angle[steady], torque[steady], torsion[steady]
    friction = joint_loss(page, [np.median(speed[steady])], [np.median(np.abs(torque))])[0, 0]

    loads = np.linspace(-160.0, 160.0, 65)
    rows = page.tool("stiffness", "--torques", ",".join(f"{load:g}" for load in loads))["rows"]
    twist = np.array([-row["output_angle"] for row in rows])

    predicted = np.interp(torque - friction, loads, twist)
    origin = (torsion - predicted).mean()
    residual = torsion - predicted - origin
    slope, twin_slope = (1.0 / np.polyfit(torque, values, 1)[0] for values in (torsion, predicted))
    page.check("drives.torsion_slope", "mean slope of torque over torsion", f"recording: {number(slope)} N·m/rad",
               Within(slope / 1e3, relative=0.20), twin_slope / 1e3, "10³ N·m/rad",
               "size 25 is inferred; links and bearings between the encoders only soften; motor torque contains "
               "friction")
    page.check("drives.torsion_residual", "rms of recording less twin", "recording", AtMost(0.35),
               1e3 * residual.std(), "mrad", "a straight line fitted to this very recording leaves "
               f"{1e3 * np.std(torsion - np.polyval(np.polyfit(torque, torsion, 1), torque)):.2f} mrad")
    loop = page.tool("hysteresis", "--amplitude", 67, "--lost-motion-torque", 2.68)
    page.check("drives.direction_gap", "gap between the directions, no load", "recording without load",
               Within(1e3 * DIRECTION_GAP, relative=0.2), 1e3 * loop["hysteresis"], "mrad",
               "fitted (`cup.friction_torque`); read from a published figure")
    page.text("""
*Limits of this recording:* the drive's size is inferred from its ratio and torque; the sweep is one way, 7 s
long; the torque is computed from current. It shows no soft beginning at small load; whether the drive has none or the
sweep hides it in its transmission error (up to 1.4 mrad), one sweep cannot decide.
""")

    def draw(figure):
        left, right = figure.subplots(1, 2, gridspec_kw={"width_ratios": [2.0, 1.0]})
        left.plot(torque - friction, 1e3 * (torsion - origin), ".", ms=2, color=GREY, label="recording")
        left.plot(loads, 1e3 * twist, color=BLUE, label="twin, catalogue gear")
        left.set_xlim(-90.0, 130.0)
        left.set_ylim(-2.6, 3.4)
        left.set_title("Torsion [mrad]")
        left.set_xlabel("torque at the joint less friction [N·m]")
        left.legend()
        right.plot(np.degrees(angle), 1e3 * residual, ".", ms=2, color=BLUE)
        right.set_title("Recording less twin [mrad]")
        right.set_xlabel("joint angle [°]")

    page.figure("drives_torsion", "Torsion of a real 101:1 drive and of the twin.", draw)
