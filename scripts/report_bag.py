#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a bag with the output of a twin, prints a table of the results, and draws a figure of them."""
import argparse
import os
import sys

import numpy as np
import rosbag

from bag_figure import draw
from bag_series import Recording

MOST_MISSING = 1.0  # largest simulated time that may be missing at the end [s]
SOLVER_STATES = {0: "every step converged", 1: "some steps were divided, or too long, or a tooth jumped",
                 2: "FAILED: the twin kept its last converged state"}


def typical(health, name):
    """Median of an indicator over the messages in which it is valid; None if it never is."""
    valid = health[name + "_valid"].astype(bool)
    return np.median(health[name][valid]) if valid.any() else None


def span(values, factor=1.0):
    return f"{values.min() * factor:.3f} ... {values.max() * factor:.3f}"


def shown(value, format_text, factor=1.0):
    return "no value" if value is None else format_text.format(value * factor)


def surface_share(health):
    """Share of the messages that come from the response surface [-]; None if the bag was made before this field."""
    return health["on_response_surface"].mean() if "on_response_surface" in health.fields else None


def joint_rows(recording):
    encoders, states = recording["encoders"], recording["joint_states"]
    return [
        ("joint angle", span(encoders["output_angle_true"]), "rad"),
        ("motor angle", span(encoders["motor_angle_true"]), "rad"),
        ("joint speed", span(states["output_velocity"]), "rad/s"),
    ]


def health_rows(health):
    return [
        ("motor torque", span(health["motor_torque"]), "N.m"),
        ("joint torque", span(health["joint_torque"]), "N.m"),
        ("transmission ratio, median", shown(typical(health, "transmission_ratio"), "{:.4f}"), "-"),
        ("torsion", span(health["torsion"], 1e3), "mrad"),
        ("torsional stiffness, median", shown(typical(health, "torsional_stiffness"), "{:.1f}", 1e-3), "kN.m/rad"),
        ("kinematic error, median", shown(typical(health, "kinematic_error"), "{:.3f}", 1e3), "mrad"),
        ("friction at the motor shaft", span(health["friction_torque"]), "N.m"),
        ("efficiency, median", shown(typical(health, "efficiency"), "{:.1f}", 100.0), "%"),
        ("teeth loaded, most", f"{health['teeth_loaded'].max()}", "-"),
        ("wave generator bearing load, most", f"{health['wave_generator_load'].max():.0f}", "N"),
        ("largest energy residual", f"{np.abs(health['energy_residual']).max():.2g}", "J"),
        ("solver failures", f"{health['solver_failures'].max()}", "-"),
        ("on the response surface", shown(surface_share(health), "{:.0f}", 100.0), "%"),
        ("solver", SOLVER_STATES.get(int(health["solver_state"].max()), "unknown state"), ""),
    ]


def force_rows(forces):
    return [
        ("mesh force on a tooth, most", f"{np.abs(forces['mesh_force']).max():.1f}", "N"),
        ("rim tension, most", f"{forces['rim_tension'].max():.1f}", "N"),
    ]


def stress_rows(stress):
    if len(stress) == 0:
        return []
    worst = stress["largest"].argmax()
    return [
        (f"stress of the flexspline at the notch, most ({stress['place'][worst]})",
         f"{1e-6 * stress['largest'][worst]:.0f}", "MPa"),
        ("share of its endurance limit, most", f"{stress['endurance_share'].max():.2f}", "-"),
    ]


def print_table(recording):
    health = recording["health"]
    counts = ", ".join(f"{name} {count}" for name, count in recording.counts.items())
    rows = [("simulated", f"{recording['joint_states'].time[-1]:.2f}", "s")]
    rows += joint_rows(recording) + health_rows(health) + force_rows(recording["contact_forces"])
    rows += stress_rows(recording["stress"])
    print(f"{recording.joint} ({recording.namespace}); messages: {counts}")
    widths = [max(len(row[column]) for row in rows) for column in range(2)]
    for name, value, unit in rows:
        print(f"  {name:<{widths[0]}}  {value:>{widths[1]}}  {unit}".rstrip())


def check_complete(recording):
    """Ends the script with an error if the output of the twin ends long before its commands."""
    commands = recording["command"]
    missing = commands.time[-1] - recording["joint_states"].time[-1] if len(commands) else 0.0
    if missing > MOST_MISSING:
        sys.exit(f"the twin's output ends {missing:.1f} s before its commands")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bag")
    parser.add_argument("--plot", metavar="FILE.png", help="draw the figure into this file")
    parser.add_argument("--namespace", help="namespace of the twin in the bag (default: the first one found)")
    parser.add_argument("--title", help="title of the figure (default: the bag's name)")
    options = parser.parse_args()
    try:
        recording = Recording(options.bag, options.namespace)
    except (ValueError, OSError, rosbag.ROSBagException) as error:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {error}")
    print_table(recording)
    if options.plot:
        draw(recording, options.title or os.path.basename(options.bag), options.plot)
    check_complete(recording)


if __name__ == "__main__":
    main()
