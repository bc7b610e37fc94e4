# SPDX-License-Identifier: BSD-3-Clause
"""Draws a figure of the pages from runs of the tool and prints the numbers beside it.

hysteresis: torsion loops of the running twin at four amplitudes of the load. The brake holds the motor, the load swings
slowly, once before it is drawn; above with the whole friction of the cup at once, below as shipped. warm_up: an elbow
turns for two hours from a cold start at the drive's limit, 1 rad/s at the joint, and stands for one more.
response_surface: one open-loop profile on the full ring and on the surface. single_balls: the ball-pass line of a sound
drive over whole turns of the balls past the lobes, friction left out, and the loads of its bearing's balls.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import pandas as pd

from lab import CHECKOUT, plt

RATIO = 101
ARC_SECOND = np.pi / 180.0 / 3600.0


class Tool:
    """Runs of the tool with the settings of the command line last, in a folder that goes away."""

    def __init__(self, program, settings, folder):
        self.program, self.settings, self.folder = program, settings, folder

    def rows(self, *words):
        done = subprocess.run([self.program, *words, "--json", *self.settings], check=True, stdout=subprocess.PIPE)
        return json.loads(done.stdout)["rows"]

    def simulate(self, profile, *words):
        """Columns of a run under a profile, as text."""
        path, out = (os.path.join(self.folder, name) for name in ("profile.csv", "run.csv"))
        with open(path, "w", encoding="utf-8") as file:
            file.write(profile)
        subprocess.run([self.program, "simulate", "--profile", path, *words, *self.settings, "--out", out, "--force"],
                       check=True, stdout=sys.stderr)
        return pd.read_csv(out)


def options(**settings):
    """`--set` for each; `__` for the dot."""
    return [word for key, value in settings.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]


def hysteresis(tool):
    period, rows = 2.0, 4000  # s, of a swing
    figure, axes = plt.subplots(2, 4, figsize=(11, 5.6), sharex="col", sharey="col")
    for row, (name, more) in zip(axes, (("one Coulomb element", options(cup__friction_angle=0.0)),
                                        ("springs and sliders", []))):
        for axis, amplitude in zip(row, (2.0, 5.0, 14.0, 67.0)):
            load = amplitude * np.sin(2.0 * np.pi * np.arange(1.5 * rows + 1) / rows)
            text = pd.DataFrame({"time": period / rows * np.arange(len(load)), "motor_torque": 0.0, "load_torque": load,
                                 "brake": 1}).to_csv(index=False)
            run = tool.simulate(text, "--duration", str(1.5 * period),
                                *options(input__command_timeout=10.0, output__load_inertia=0.3), *more)
            run = run[run.time > 0.5 * period]
            torsion = -1e3 * run.output_angle
            axis.plot(run.load_torque, torsion, linewidth=1)
            lost = np.sum(0.5 * (run.load_torque.values[1:] + run.load_torque.values[:-1]) * np.diff(torsion))
            axis.set_title(f"± {amplitude:g} N·m: {1e3 * lost:.0f} µJ a swing", fontsize=9)
        row[0].set_ylabel(f"{name}\ntorsion [mrad]")
    for axis in axes[1]:
        axis.set_xlabel("load [N·m]")
    return figure


def warm_up(tool):
    torque_per_current = 10.7  # N.m/A at the joint
    run = tool.simulate("time,motor_torque,brake\n0,0.6,0\n7200,0,1\n10800,0,1\n", "--config", "joints/elbow.yaml",
                        *options(thermal__model="two_nodes", solver__scene="auto", solver__rate=2000,
                                 motor__speed_limit=103.0, output__gravity_torque=0.0, input__command_timeout=20000.0,
                                 publish__joint_states_rate=10.0, publish__encoders_rate=1.0,
                                 publish__contact_forces_rate=1.0))
    run = run.groupby(run.index // 200).mean()  # over 20 s: the current has ripple
    turning = run[run.brake == 0.0]
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2))
    axes[0].plot(run.time / 60.0, run.temperature, label="grease")
    axes[0].plot(run.time / 60.0, run.housing_temperature, label="housing")
    axes[0].set_title("temperature [°C]")
    axes[0].legend()
    axes[1].plot(turning.time / 60.0, RATIO * turning.friction_torque)
    axes[1].set_title("friction at the joint [N.m]")
    axes[2].plot(turning.time / 60.0, RATIO * turning.motor_torque / torque_per_current)
    axes[2].set_title("motor current [A]")
    for axis in axes[1:]:
        axis.set_ylim(bottom=0.0)
    for axis in axes:
        axis.set_xlabel("time [min]")
    first, last = turning.iloc[0], turning.iloc[-1]
    print(f"friction {RATIO * first.friction_torque:.2f} to {RATIO * last.friction_torque:.2f} N.m, grease "
          f"{first.temperature:.1f} to {last.temperature:.1f} degC, housing {last.housing_temperature:.1f} degC")
    return figure


def response_surface(tool):
    profile = ("time,motor_torque,load_torque,brake\n0,0.25,0,0\n0.2,0.8,60,0\n0.5,0.45,60,0\n0.8,0,60,1\n"
               "1.1,0.85,60,0\n")

    def simulate(scene, **more):
        """Columns of the run, and the time it took."""
        begin = os.times().children_user
        run = tool.simulate(profile, "--duration", "1.3",
                            *options(solver__scene=scene, input__command_timeout=10.0, **more))
        run["torsion"] = (run.motor_angle / RATIO - run.output_angle) / ARC_SECOND
        return run, os.times().children_user - begin

    simulate("auto")  # builds the surface where there is none yet
    (full, full_time), (auto, auto_time) = simulate("full_ring"), simulate("auto")
    smooth = [simulate(scene, cup__friction_torque=0.0)[0] for scene in ("auto", "full_ring")]
    figure, axes = plt.subplots(3, 1, figsize=(9, 7), sharex=True)
    axes[0].plot(full.time, full.motor_velocity, color="0.6", label="motor [rad/s]")
    axes[0].plot(full.time, full.joint_torque, label="joint torque [N.m]")
    axes[1].plot(full.time, full.torsion, color="0.6", linewidth=3, label="full ring")
    axes[1].plot(full.time, auto.torsion, linewidth=1, label="surface")
    axes[1].set_ylabel("torsion [arcsec]")
    axes[2].plot(full.time, auto.torsion - full.torsion, linewidth=0.8, label="as shipped")
    axes[2].plot(full.time, smooth[0].torsion - smooth[1].torsion, linewidth=0.8, label="without the cup's friction")
    axes[2].set(ylabel="surface less full ring,\ntorsion [arcsec]", xlabel="time [s]")
    for axis in axes:
        axis.legend(loc="upper right")
    print(f"whole program, processor time: full ring {full_time:.2f} s, surface {auto_time:.2f} s")
    return figure


def single_balls(tool):
    support = options(contact__support="single_balls")
    turns, steps = 20, 500  # steps of a turn
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.6))
    highest = 0.0
    for load, colour, front in ((14.0, "tab:green", 3), (67.0, "tab:blue", 1), (150.0, "tab:red", 2)):
        turned = tool.rows("turn", "--load", str(load), "--angle-range", str(2.0 * np.pi * turns), "--steps",
                           str(turns * steps), *support)
        error = np.array([row["kinematic_error"] for row in turned[:-1]]) / ARC_SECOND
        window = np.hanning(error.size)
        spectrum = 2.0 * np.abs(np.fft.rfft((error - error.mean()) * window)) / window.sum()
        order = np.arange(spectrum.size) / turns
        axes[0].plot(order, spectrum, color=colour, lw=1.2, zorder=front, label=f"{load:g} N.m")
        low = np.where(order < 60.0, spectrum, 0.0)
        highest = max(highest, low.max())
        print(f"{load:g} N.m: strongest line below order 60 at {order[low.argmax()]:.2f} a motor turn, "
              f"{2.0 * low.max():.3f} arcsec peak to peak; all {np.ptp(error):.3f} arcsec")
        force = np.array(tool.rows("stiffness", "--torques", str(load), *support)[0]["ball_force"])
        axes[1].plot(range(len(force)), force, "o-", ms=3, lw=0.9, color=colour, label=f"{load:g} N.m")
        print(f"{load:g} N.m: hardest ball {force.max():.0f} N, {(force > 0.0).sum()} balls carry, "
              f"{force.sum():.0f} N in all")
    axes[0].set(xlim=(0.0, 60.0), ylim=(0.0, 1.2 * highest), title="error of the output [arcsec]",
                xlabel="order [per motor turn]")
    axes[1].set_ylim(bottom=0.0)
    axes[1].set(title="force on a ball [N]", xlabel="ball, from the major axis on")
    for axis in axes:
        axis.legend()
    return figure


FIGURES = {each.__name__: each for each in (hysteresis, warm_up, response_surface, single_balls)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("figure", choices=FIGURES)
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--out", help="PNG [docs/images/FIGURE.png]")
    parser.add_argument("--config", action="append", default=[], metavar="FILE", help="overlay for every run")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="further parameters")
    given = parser.parse_args()
    settings = [word for overlay in given.config for word in ("--config", overlay)]
    settings += [word for setting in given.set for word in ("--set", setting)]
    with tempfile.TemporaryDirectory() as folder:
        figure = FIGURES[given.figure](Tool(given.tool, settings, folder))
    for axis in figure.axes:
        axis.grid(color="0.9")
    figure.tight_layout()
    figure.savefig(given.out or CHECKOUT / "docs" / "images" / f"{given.figure}.png", dpi=110)


if __name__ == "__main__":
    main()
