# SPDX-License-Identifier: BSD-3-Clause
"""One run of a cell in a process of its own, so that a crash or an endless loop is that run's alone: the run as JSON on
stdin, its course and the solver's messages as JSON on stdout; refused parameters on stderr, exit code 1."""
import json
import sys

import numpy as np

import harmonic_joint_twin as hjt

SAMPLED = ("time", "motor_angle", "output_angle", "wave_generator_torque", "joint_torque")


def inputs(drive, steps, step):
    """Motor torque, load and brake from the begin of each step [ns] on; a row holds until the next."""
    times = np.array([round(row[0] * 1e9) for row in drive])
    rows = np.searchsorted(times, np.arange(steps) * step, side="right") - 1
    return {name: np.array([row[column] for row in drive], dtype=float)[rows]
            for column, name in enumerate(("motor_torque", "load_torque", "brake"), start=1)}


def course(changes, faults, drive, duration, sample_period):
    """All that a verdict is made of. ParameterError."""
    parameters = hjt.Parameters(changes)
    parameters.faults = faults
    twin = hjt.Twin(parameters)
    step = twin.step_length
    steps = round(duration * 1e9) // step
    rows = twin.run(**inputs(drive, steps, step))
    turns = np.diff(rows["motor_angle"], prepend=0.0)
    work = (np.abs(rows["motor_torque"] * turns) +
            np.abs(rows["load_torque"] * np.diff(rows["output_angle"], prepend=0.0)))
    every = max(1, round(sample_period * 1e9) // step)
    return {"finite": bool(all(np.isfinite(rows[name]).all() for name in rows.dtype.names)),
            "solver_state": twin.health().solver_state, **twin.counters,
            "iterations_mean": float(rows["iterations"].mean()), "iterations_max": int(rows["iterations"].max()),
            "energy_residual_max": float(np.abs(rows["energy_residual"]).max()), "throughput": float(work.sum()),
            "substeps": int(rows["substeps"][-1]), "phase_advance_max": float(rows["phase_advance"].max()),
            "wave_generator_turn_max": float(np.abs(turns).max()),
            "samples": {name: rows[name][every - 1::every].tolist() for name in SAMPLED}}


def main():
    try:
        json.dump(course(**json.load(sys.stdin)), sys.stdout)
    except hjt.InputError as error:
        sys.exit(f"joint_twin: {error}")


if __name__ == "__main__":
    main()
