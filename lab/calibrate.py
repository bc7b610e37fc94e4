# SPDX-License-Identifier: BSD-3-Clause
"""Least squares over static runs of joint_twin: the cup's slopes, the ball forces without load and the grease's
viscosity to the catalogue of a gear; preload and viscosity of a robot's joints to their recorded friction."""
import argparse
import json
import math
import os
import subprocess
import sys
from dataclasses import dataclass

import numpy
from scipy.optimize import least_squares

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "validation"))
# pylint: disable=wrong-import-position
import catalogue  # noqa: E402
import size14  # noqa: E402
from drives import JOINTS, LOW_LOAD, RATIO, UR10E, UR5E_LOSS, UR5E_SPEEDS, friction_map, moving_rows  # noqa: E402

TORSION, FRICTION = 0.002, 0.005  # relative errors that weigh alike
TEETH = 200


@dataclass(frozen=True)
class Gear:
    """What the catalogue says of a size."""
    overlays: tuple
    slopes: tuple  # of the whole gear [N.m/rad]
    breakpoints: tuple  # [N.m]
    torques: tuple  # at which the torsion is fitted [N.m]: at the breakpoints and the joint's limit
    no_load: float  # running torque at 2000 rpm, 20 degC [N.m]
    starting: float  # [N.m]
    efficiency: tuple  # load [N.m], efficiency; not fitted
    rated: float  # [N.m]


GEARS = {
    "25": Gear((), catalogue.STIFFNESSES, catalogue.BREAKPOINTS, (*catalogue.BREAKPOINTS, 150.0), catalogue.NO_LOAD,
               catalogue.STARTING, (catalogue.EFFICIENCY_TORQUE, catalogue.EFFICIENCY), catalogue.RATED_TORQUE),
    "14": Gear(size14.SIZE_14, size14.STIFFNESSES, size14.BREAKPOINTS, (*size14.BREAKPOINTS, 28.0), size14.NO_LOAD,
               size14.STARTING, (size14.EFFICIENCY_TORQUE, size14.EFFICIENCY), size14.RATED_TORQUE),
}
CUP, PRELOAD, VISCOSITY = "cup.torsion_stiffness", "bearing.race_preload", "bearing.viscosity"


class Twin:
    """Static runs of joint_twin, all with the options given on the command line."""

    def __init__(self, options):
        self.command, self.always = options.tool, []
        for path in options.config:
            self.always += ["--config", os.path.abspath(path) if os.path.isfile(path) else path]
        for assignment in options.set:
            self.always += ["--set", assignment]

    def run(self, overlays, values, *arguments):
        line = [self.command, *map(str, arguments), *overlays, *self.always, "--json"]
        for key, value in values.items():
            text = "[" + ", ".join(f"{part:.9e}" for part in value) + "]" if key == CUP else f"{value:.9e}"
            line += ["--set", f"{key}={text}"]
        done = subprocess.run(line, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{' '.join(line)}\n{done.stderr}")
        return json.loads(done.stdout)

    def losses(self, overlays, values, speeds, loads, *arguments):
        """Rows of `joint_twin losses` by load, then motor speed [rad/s]."""
        rows = self.run(overlays, values, "losses", "--positions", 4, "--speeds", ",".join(map(repr, speeds)),
                        "--loads", ",".join(map(repr, loads)), *arguments)["rows"]
        return [rows[i:i + len(speeds)] for i in range(0, len(rows), len(speeds))]


def solve(errors, start):
    """Positive values by their logarithms, from the values that are configured."""
    found = least_squares(lambda x: errors(numpy.exp(x)), numpy.log(start), diff_step=1e-3, xtol=1e-4, ftol=1e-6)
    return numpy.exp(found.x), found.fun


def calibrate_gear(twin, gear):
    given = twin.run(gear.overlays, {}, "parameters")
    start = [*given["cup"]["torsion_stiffness"], given["bearing"]["race_preload"], given["bearing"]["viscosity"]]

    def values(x):
        return {CUP: x[:3], PRELOAD: x[3], VISCOSITY: x[4]}

    def errors(x):
        set_to = values(x)
        rows = twin.run(gear.overlays, set_to, "stiffness", "--torques", ",".join(map(repr, gear.torques)))["rows"]
        torsion = [-row["output_angle"] / catalogue.catalogue_angle(row["torque"], gear.slopes, gear.breakpoints) - 1.0
                   for row in rows]
        running = twin.losses(gear.overlays, set_to, [catalogue.RPM_2000], [0.0], *catalogue.AT_20_DEGREES)[0][0]
        starts = twin.run(gear.overlays, set_to, "breakaway", *catalogue.AT_20_DEGREES)
        friction = [starts["starting_torque"] / gear.starting - 1.0, running["gear_loss"] / gear.no_load - 1.0]
        return [*(error / TORSION for error in torsion), *(error / FRICTION for error in friction)]

    report(twin, gear, {}, "as configured")
    found, _ = solve(errors, start)
    report(twin, gear, values(found), "fitted")
    print("cup:\n  torsion_stiffness: [" + ", ".join(f"{1e-3 * slope:.3g}e+3" for slope in found[:3]) + "]")
    print(f"bearing:\n  race_preload: {found[3]:.0f}.0\n  viscosity: {1e6 * found[4]:.1f}e-6")


def report(twin, gear, values, title):
    """What the catalogue gives beside what the twin makes of it, and what nothing is fitted to."""
    over = gear.overlays
    print(f"-- {title}")
    torques = sorted([*gear.torques, gear.rated])
    for row in twin.run(over, values, "stiffness", "--torques", ",".join(map(repr, torques)))["rows"]:
        angle = catalogue.catalogue_angle(row["torque"], gear.slopes, gear.breakpoints)
        print(f"torsion at {row['torque']:g} N.m: {-1e3 * row['output_angle']:.4f} mrad, catalogue {1e3 * angle:.4f}; "
              f"teeth in mesh {100.0 * row['teeth_loaded'] / TEETH:.0f} %, largest tooth force "
              f"{row['mesh_force_max']:.0f} N, sum of ball forces {row['wave_generator_force_sum']:.0f} N")
    starts = twin.run(over, values, "breakaway", *catalogue.AT_20_DEGREES)
    print(f"starting {1e3 * starts['starting_torque']:.1f} mN.m, catalogue {1e3 * gear.starting:g}; back-driving "
          f"{starts['back_driving_torque']:.2f} N.m")
    load, efficiency = gear.efficiency
    idle, loaded = (rows[0] for rows in twin.losses(over, values, [catalogue.RPM_2000], [0.0, load],
                                                    *catalogue.AT_20_DEGREES))
    print(f"no-load running {1e3 * idle['gear_loss']:.1f} mN.m, catalogue {1e3 * gear.no_load:g}; efficiency at "
          f"{load:g} N.m {100.0 * loaded['gear_efficiency']:.1f} %, catalogue {100.0 * efficiency:g}")
    loop = twin.run(over, values, "hysteresis", "--amplitude", gear.rated, "--lost-motion-torque", 0.04 * gear.rated)
    print(f"hysteresis {loop['hysteresis'] / catalogue.ARCMIN:.2f} arcmin, lost motion "
          f"{loop['lost_motion'] / catalogue.ARCMIN:.2f} arcmin")


def calibrate_joints(twin, measured, names):
    """One viscosity for all joints, a preload for each. `measured`: of each joint its overlays, the joint speeds
    [rad/s], loads, friction and its tolerance [N.m]."""
    given = [twin.run(measured[name][0], {}, "parameters")["bearing"] for name in names]

    def losses(name, values):
        overlays, speeds, loads, _, _ = measured[name]
        kinds = sorted(set(map(float, loads)))
        table = twin.losses(overlays, values, [float(RATIO * speed) for speed in speeds], kinds)
        rows = (table[kinds.index(load)][i] for i, load in enumerate(loads))
        return [RATIO * (row["gear_loss"] + row["motor"]) for row in rows]

    def errors(x):
        return numpy.concatenate([(losses(name, {PRELOAD: preload, VISCOSITY: x[-1]}) - numpy.array(measured[name][3]))
                                  / measured[name][4] for name, preload in zip(names, x)])

    found, left = solve(errors, [*(bearing["race_preload"] for bearing in given), given[0]["viscosity"]])
    ends = numpy.cumsum([len(measured[name][3]) for name in names])
    for name, preload, part in zip(names, found, numpy.split(left, ends)):
        rms = math.sqrt(numpy.mean((part * measured[name][4]) ** 2))
        print(f"{name}: race_preload: {preload:.0f}.0, viscosity: {1e6 * found[-1]:.0f}.0e-6; rms error {rms:.2f} N.m")


def ur5(twin, telemetry):
    path = os.path.join(telemetry, "ur5_cb", "ur5_cb_no6.csv")
    if not os.path.isfile(path):
        sys.exit(f"no recording {path}")
    data = numpy.genfromtxt(path, delimiter=",", names=True)
    measured = {}
    for joint, name in enumerate(JOINTS):
        speed, load, friction, _ = friction_map(data, joint).T
        measured[name] = (("--config", f"joints/{name}.yaml"), speed, load, friction, numpy.ones_like(friction))
    calibrate_joints(twin, measured, JOINTS)


def ur5e(twin, _):
    measured = {}
    for name in JOINTS:
        overlays = ("--config", f"joints/{name}.yaml", "--config", f"joints/ur5e_{name}.yaml")
        low, high = numpy.array(UR5E_LOSS[name]).T
        # Two robots, and 2 % that two degrees of the grease make.
        tolerance = 0.5 * (high - low) + 0.01 * (high + low)
        measured[name] = (overlays, UR5E_SPEEDS, [0.0] * len(UR5E_SPEEDS), 0.5 * (low + high), tolerance)
    calibrate_joints(twin, measured, JOINTS)


def ur10e(twin, telemetry):
    """Interference of wave generator and rim, without preload of the race, by the mean friction of a UR10e's shoulder
    at low load."""
    number_of, gain, overlays, names, _ = UR10E["shoulder"]
    path = os.path.join(telemetry, "ur10e", names[0])
    if not os.path.isfile(path):
        sys.exit(f"no recording {path}")
    speed, load, friction, _ = moving_rows(numpy.genfromtxt(path, delimiter=",", names=True), number_of, gain)
    low = load < LOW_LOAD
    speeds = numpy.linspace(speed[low].min(), speed[low].max(), 12)
    arguments = [word for overlay in overlays for word in ("--config", overlay)]

    def error(fit):
        rows = twin.losses(arguments, {PRELOAD: 0.0, "contact.fit": fit[0]}, [float(RATIO * v) for v in speeds],
                           [float(load[low].mean())])[0]
        loss = numpy.interp(speed[low], speeds, [RATIO * (row["gear_loss"] + row["motor"]) for row in rows])
        return [float((loss - friction[low]).mean())]

    found, left = solve(error, [5e-6])
    print(f"size_4: contact.fit: {1e6 * found[0]:.2f}e-6; mean error {left[0]:.2g} N.m of {low.sum()} rows")


def main():
    parser = argparse.ArgumentParser(
        prog="calibrate", description="Fits cup.torsion_stiffness, bearing.race_preload and bearing.viscosity of a "
        "gear to its catalogue, or preload and viscosity of a robot's joints to their recorded friction. Prints the "
        "lines for config/ and the figures before and after.")
    parser.add_argument("what", choices=["25", "14", "ur5", "ur5e", "ur10e"], help="size of the gear, or robot")
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--telemetry", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--config", action="append", default=[], metavar="FILE", help="overlay for every run")
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value",
                        help="one parameter for every run")
    options = parser.parse_args()
    twin = Twin(options)
    if options.what in GEARS:
        calibrate_gear(twin, GEARS[options.what])
    else:
        {"ur5": ur5, "ur5e": ur5e, "ur10e": ur10e}[options.what](twin, options.telemetry)


if __name__ == "__main__":
    main()
