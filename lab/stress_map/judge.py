# SPDX-License-Identifier: BSD-3-Clause
"""Runs one cell and its converged runs, and gives one verdict."""
import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass

import numpy as np

from cells import DURATION, STEPS

PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ACCURATE, DEGRADED, REFUSED = "accurate", "degraded, reported", "refused with a reason"
SILENT, NOT_FINITE, HUNG, CRASHED = "SILENTLY WRONG", "NOT FINITE", "HUNG", "CRASHED"
GOOD = [ACCURATE, DEGRADED, REFUSED]
VERDICTS = GOOD + [SILENT, NOT_FINITE, HUNG, CRASHED]

ACCURACY = 0.01  # of the largest torque and of the travel in the converged run
# Scales are not less than these: the cup's first slope ends at 14 N.m, the angle that belongs to it is 0.43 mrad.
LEAST_TORQUE = 14.0  # N.m
LEAST_ANGLE = 14.0 / 32.5e3  # rad at the output
RATIO = 101.0
SAMPLE_PERIOD = 1e-3  # s
SMOOTH_PHASE = 0.01  # rad: a converged run resolves the fastest swing with 600 steps
TIMEOUT = 60.0  # s a run; the longest takes a few


@dataclass
class Judged:
    """What one cell was like."""
    cell: object
    verdict: str
    reason: str = ""
    error: float = float("nan")  # of the scale
    doubt: float = float("nan")  # of the converged run itself, of the scale
    drift: float = float("nan")  # largest energy residual over the work of motor and load
    iterations: float = float("nan")
    iterations_max: int = 0
    cuts: int = 0
    coarse: int = 0
    phase: float = float("nan")  # rad a step
    turn: float = float("nan")  # rad a step
    seconds: float = 0.0


def run(cell, step):
    """(exit code, document or None, text on stderr) of a run in steps of `step` [s], `run.py`."""
    rate = 1e9 / round(step * 1e9)
    least = min(rate, 1000.0)
    changes = {"solver.rate": rate, "publish.joint_states_rate": least, "publish.encoders_rate": least,
               "publish.contact_forces_rate": 100.0, "publish.health_rate": 10.0, "indicators.sample_rate": least,
               **cell.changes, "fault_scale.rim_crack_segments": 1}
    faults = ([f"tooth_root_crack:1:{tooth}" for tooth in cell.missing] +
              [f"flexspline_crack:1:{tooth}" for tooth in cell.cut])
    asked = {"changes": changes, "faults": faults, "drive": cell.drive, "duration": DURATION,
             "sample_period": max(step, SAMPLE_PERIOD)}
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "run.py")
    done = subprocess.run([sys.executable, program], input=json.dumps(asked), capture_output=True, text=True,
                          timeout=TIMEOUT, check=False)
    document = json.loads(done.stdout) if done.stdout else None
    return done.returncode, document, done.stderr.strip()


def converged_steps(step, phase):
    """Two steps of the 1-2-5 row, both finer than `step` where there are any, that resolve the swing of the cell."""
    wanted = min(step / 10.0, step * SMOOTH_PHASE / max(phase, 1e-12), 2e-5)
    finer = max((s for s in STEPS if s <= wanted * 1.001), default=STEPS[0])
    return finer, STEPS[STEPS.index(finer) + 1]


def difference(document, reference):
    """Largest difference of torque and angles over the samples of both, over their scales."""
    here, there = document["samples"], reference["samples"]
    times = {round(t * 1e9): i for i, t in enumerate(there["time"])}
    pairs = [(i, times[round(t * 1e9)]) for i, t in enumerate(here["time"]) if round(t * 1e9) in times]
    worst = 0.0
    for name, least in [("joint_torque", LEAST_TORQUE), ("output_angle", LEAST_ANGLE),
                        ("motor_angle", RATIO * LEAST_ANGLE)]:
        a = np.array([here[name][i] for i, _ in pairs])
        b = np.array([there[name][j] for _, j in pairs])
        scale = max(least, np.max(np.abs(there[name])) if name == "joint_torque" else np.ptp(there[name]))
        worst = max(worst, float(np.max(np.abs(a - b))) / scale)
    return worst


def judge(cell):
    started = time.monotonic()
    try:
        judged = _judge(cell)
    except subprocess.TimeoutExpired:
        judged = Judged(cell, HUNG, f"a run took more than {TIMEOUT:.0f} s")
    judged.seconds = time.monotonic() - started
    return judged


def _judge(cell):
    code, document, message = run(cell, cell.step)
    if code < 0 or code not in (0, 1) or (document is None and "joint_twin: " not in message):
        return Judged(cell, CRASHED, message or f"exit code {code}")
    if document is None:
        return Judged(cell, REFUSED, message.replace("joint_twin: ", "").replace(PROJECT + os.sep, ""))
    judged = Judged(cell, "", iterations=document["iterations_mean"], iterations_max=document["iterations_max"],
                    cuts=document["step_cuts"], coarse=document["coarse_steps"], phase=document["phase_advance_max"],
                    turn=document["wave_generator_turn_max"])
    judged.drift = document["energy_residual_max"] / max(document["throughput"], 1e-3)
    if not document["finite"]:
        judged.verdict = NOT_FINITE
        return judged
    finer, fine = converged_steps(cell.step, judged.phase * document["substeps"])
    runs = []
    for step in (finer, fine):
        _, finer_run, why = run(cell, step)
        if finer_run is None:
            judged.verdict, judged.reason = CRASHED, f"the converged run was refused: {why}"
            return judged
        runs.append(finer_run)
    judged.doubt = difference(runs[1], runs[0])
    judged.error = difference(document, runs[0] if finer < cell.step else runs[1])
    state = document["solver_state"]
    if state != "OK":
        judged.verdict = DEGRADED
        judged.reason = ", ".join(f"{count} steps {what}" for count, what in [
            (document["solver_failures"], "failed"), (judged.cuts, "cut"), (document["jumps"], "with teeth jumping"),
            (judged.coarse, "too long")] if count)
    else:
        judged.verdict = ACCURATE if judged.error <= ACCURACY else SILENT
    return judged
