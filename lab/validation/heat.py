# SPDX-License-Identifier: BSD-3-Clause
"""Heat: warm-up of a UR3's joints, and how friction falls with it."""
import csv
import datetime

import numpy as np
from scipy.optimize import curve_fit

from bounds import AtMost, Between, Within
from evidence import MEASUREMENT, fitted, measured
from drives import recording

JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")
LARGE = JOINTS[:3]
RECORDED = {"size 25": (2180.0, 2320.0), "size 14": (1630.0, 1930.0)}  # time constants of a UR3 [s]
AMBIENT = 25.0  # degC, assumed: only temperatures above it matter
SWEEP = (0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4)  # rad/s at the joint
MOVING = 0.3  # rad/s
STANDING = ("--torque", 0, "--set", "brake.engaged_at_start=true", "--set", "solver.rate=1000", "--set",
            "indicators.sample_rate=1000", "--set", "publish.joint_states_rate=0.1", "--set",
            "publish.encoders_rate=1.0", "--set", "publish.contact_forces_rate=1.0", "--set",
            "output.gravity_torque=0.0")
RATIO = 101
RISE = 10.0  # K
# Published change of viscous friction, mean of the joints [%], and the overlays of each joint's gear and motor.
WRIST, SMALL_WRIST = ("size_14.yaml",), ("size_11.yaml", "joints/size_0.yaml")
WARMED_UP = {"ur5": (-17.0, [(f"joints/{joint}.yaml",) for joint in LARGE] + 3 * [WRIST]),
             "ur3": (-20.0, 2 * [("size_17.yaml", "joints/size_2.yaml")] + [WRIST] + 3 * [SMALL_WRIST])}


def build(page):
    time_constants(page)
    warm_up(page)
    viscous(page)


def stand(page, name, seconds, *settings):
    """Time and temperature of the housing of a joint that is switched on and stands."""
    arguments = [word for setting in settings for word in ("--set", setting)]
    page.run("simulate", *STANDING, "--duration", seconds, "--set", "thermal.model=two_nodes", *arguments, "--out",
             name + ".csv", "--force")
    with open(page.scratch(name + ".csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return tuple(np.array([float(row[key]) for row in rows]) for key in ("time", "housing_temperature"))


def exponential(time, end, rise, constant):
    return end - rise * np.exp(-time / constant)


def time_constants(page):
    page.heading("Time constants")
    page.text("""
A joint at rest cools down. The slower of its two time constants is that of housing to surroundings; the capacities are
estimates from masses (`config/joint.yaml`, `config/size_14.yaml`), the conductance of size 25 is fitted to the
recording below, that of size 14 follows from its surface.
""")
    for size, overlay in (("size 25", ()), ("size 14", ("--config", "size_14.yaml"))):
        page.run("simulate", *STANDING, *overlay, "--duration", 3600 if page.fast else 7200, "--set",
                 "thermal.model=two_nodes", "--set", "thermal.standby_power=0.0", "--set", "thermal.housing_rise=20.0",
                 "--set", "thermal.grease_rise=20.0", "--out", "cooling.csv", "--force")
        with open(page.scratch("cooling.csv"), encoding="utf-8") as file:
            rows = [(float(row["time"]), float(row["housing_temperature"])) for row in csv.DictReader(file)]
        time, above = np.array(rows).T
        late = time > 1800.0
        constant = -1.0 / np.polyfit(time[late], np.log(above[late] - AMBIENT), 1)[0]
        page.check(f"heat.time_constant.{size.replace(' ', '_')}", f"{size}, housing to surroundings",
                   "UR3: base, shoulder, elbow" if size == "size 25" else "UR3: wrists",
                   Between(*RECORDED[size]), constant, "s",
                   "fitted" if size == "size 25" else "not fitted; the joints of the two robots differ",
                   evidence=fitted("thermal.ambient_conductance of size 25 to it") if size == "size 25" else
                   measured("the conductance of size 25, fitted to other joints, by the surface"))


def read_warm_up(path):
    """Time [s], number of rows before its pause of five hours, currents [A], temperatures [degC], speeds [rad/s]."""
    with open(path, encoding="utf-8-sig") as file:
        table = csv.reader(file)
        next(table)
        rows = [[datetime.datetime.fromisoformat(row[1].strip('"Z')).timestamp(),
                 *(float(cell) if cell else np.nan for cell in row[2:20])] for row in table]
    data = np.array(rows)
    time = data[:, 0] - data[0, 0]
    return time, int(np.argmax(np.diff(time))) + 1, data[:, 1:13:2], data[:, 2:14:2], data[:, 13:19]


def warm_up(page):
    page.heading("A UR3 warms up")
    page.text("""
A UR3 at work from a cold start (UCI Machine Learning Repository 963, M. Tyrovolas et al.): temperatures beside the
motors and currents at 1 Hz, 49 minutes from a cold start and, after a pause of five hours in which it stayed switched
on, 76 minutes more. Start, end and time constant of each joint are fitted to the first part. The twin, with these as
conductance and mean power, starts the second part at the temperature found there and is judged on it.
""")
    path = recording(page, "ur3_cobotops", "cobot_dataset_02052023.csv")
    if not path:
        return
    time, split, currents, temperatures, speeds = read_warm_up(path)
    pause = time[split]
    capacities = page.tool("parameters")["thermal"]
    capacity = capacities["grease_capacity"] + capacities["housing_capacity"]
    before = np.arange(len(time)) < split
    for k, joint in enumerate(JOINTS[:1] if page.fast else JOINTS):
        known = np.isfinite(temperatures[:, k])
        found, _ = curve_fit(exponential, time[known & before], temperatures[known & before, k], (40.0, 10.0, 2000.0))
        end, _, constant = found
        conductance = capacity / constant
        start = temperatures[split, k] - AMBIENT
        moment, degrees = stand(page, f"warm_up_{joint}", 4600, f"thermal.ambient_conductance={conductance:.6f}",
                                f"thermal.standby_power={(end - AMBIENT) * conductance:.6f}",
                                f"thermal.housing_rise={start:.6f}", f"thermal.grease_rise={start:.6f}")
        judged = known & ~before
        error = np.sqrt(np.mean((np.interp(time - pause, moment, degrees) - temperatures[:, k])[judged] ** 2))
        page.check(f"heat.ur3.{joint}", f"{joint}: temperature in the second part of the recording, rms error",
                   "recording", AtMost(0.5), error, "K", "0.5 K make 1.5 % of the friction that grows with speed",
                   known="" if joint in LARGE else
                   "the arm around a wrist warms up more slowly than the wrist. The twin has no part for the arm",
                   evidence=fitted("end, rise and time constant of each joint to the first part of this recording"))
    page.text("""
In base, shoulder and elbow what 49 minutes show determines where the joint settles. The wrists settle up to 1.2 K
higher: beyond their own time constant there is a slower one, that of the arm around them, which a joint between
surroundings of one temperature does not have.
""")
    if page.fast:
        return
    friction_of_wrist(page, time, currents[:, 3], temperatures[:, 3], speeds[:, 3])


def friction_of_wrist(page, time, current, temperature, speed):
    """Friction against temperature: current along the motion, rows at speed, by a straight line."""
    moving = (np.abs(speed) > MOVING) & np.isfinite(current) & np.isfinite(temperature)
    along = current[moving] * np.sign(speed[moving])
    warmer = temperature[moving] - temperature[moving].max()
    # In blocks of a minute, whose scatter gives the interval: rows of one motion depend on each other.
    blocks = np.unique((time[moving] // 60.0).astype(int), return_inverse=True)[1]
    slopes = []
    draws = np.random.default_rng(1)
    members = [np.flatnonzero(blocks == k) for k in range(blocks.max() + 1)]
    for _ in range(400):
        chosen = np.concatenate([members[k] for k in draws.integers(0, len(members), len(members))])
        slope, warm = np.polyfit(warmer[chosen], along[chosen], 1)
        slopes.append(-slope * warmer.min() / (warm + slope * warmer.min()))
    low, high = np.percentile(slopes, (2.5, 97.5))
    cold, hot = temperature[moving].min(), temperature[moving].max()
    motor_speed = RATIO * float(np.mean(np.abs(speed[moving])))
    friction = []
    for degrees in (cold, hot):
        row = page.tool("losses", "--positions", 4, "--speeds", f"{motor_speed:.6g}", "--loads", 0, "--config",
                        "size_14.yaml", "--set", f"input.temperature={degrees:.2f}")["rows"][0]
        friction.append(row["gear_loss"] + row["motor"])
    page.text(f"""
wrist_1: friction at {hot:.1f} °C over that at {cold:.1f} °C, less one: {100.0 * low:.1f} … {100.0 * high:.1f} %
recorded (95 % of resampled minutes), {100.0 * (friction[1] / friction[0] - 1.0):.1f} % of the twin, a size 14 gear for
a smaller one. The band contains too much to judge by.
""")
    page.value("heat.ur3.friction", 100.0 * (friction[1] / friction[0] - 1.0), "%")


def viscous(page):
    page.heading("Viscous friction of two robots, cold and warm")

    def coefficient(overlays, degrees):
        arguments = [word for overlay in overlays for word in ("--config", overlay)]
        rows = page.tool("losses", "--positions", 4, "--speeds", ",".join(f"{RATIO * speed:.6g}" for speed in SWEEP),
                         "--loads", 0, *arguments, "--set", f"input.temperature={degrees:.1f}")
        return np.polyfit(SWEEP, [RATIO * (row["gear_loss"] + row["motor"]) for row in rows["rows"]], 1)[0]

    def fall(overlays, rise):
        return 100.0 * (coefficient(overlays, AMBIENT + rise) / coefficient(overlays, AMBIENT) - 1.0)

    for robot, (published, joints) in WARMED_UP.items():
        falls = {overlays: fall(overlays, RISE) for overlays in set(joints)}
        page.check(f"heat.{robot}.viscous", f"{robot.upper()}: slope of friction over speed, {AMBIENT + RISE:g} over "
                   f"{AMBIENT:g} °C, less one, mean of six joints",
                   "Raviola et al., Robotics 10(3) 83 (2021), warmed up", Within(published, absolute=3.0),
                   float(np.mean([falls[overlays] for overlays in joints])), "%",
                   "the rise is assumed; a UR3's joints rise by 9 to 12 K, which makes that much", evidence=MEASUREMENT)
    thin = [fall(("size_14.yaml",), rise) for rise in (9.0, 12.0)]
    bare = fall(("joints/elbow.yaml",), RISE), fall((), RISE)
    page.text(f"""
The paper's temperatures were not at hand. Nothing is fitted to it: the catalogue's gear thins as its oil does, and what
a joint has beyond its gear, recorded (`bearing.constant_share`) or of the motor's data (`motor.viscous_friction`), does
not. A large UR5 joint falls by {-bare[0]:.1f} % in {RISE:g} K, the gear of size 25 with its motor's viscous friction by
{-bare[1]:.1f} %, a wrist by {-thin[0]:.1f} to {-thin[1]:.1f} % in 9 to 12 K.
""")
