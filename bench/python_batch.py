#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A batch of 64 twins on the response surface: its rate on one thread and on two, alternating in one run, and a closed
loop at 1 kHz on the wall clock. Prints the figures of docs/python.md.
"""
import os
import statistics
import time

import numpy as np

import harmonic_joint_twin as hjt

TWINS = 64
REPEATS = 30
STEPS = {1: 200, 10: 40, 1000: 1}  # steps a call: calls timed at once
PERIOD = 0.001  # [s]
STEPS_A_PERIOD = 10
LOOP = 5.0  # [s]


def call_time(batch, steps, calls, rows):
    """Of one call, wall clock [s]."""
    torque, load = np.full(TWINS, 0.45), np.full(TWINS, 20.0)
    begin = time.perf_counter()
    for _ in range(calls):
        batch.step(torque, load, steps=steps, out=rows)
    return (time.perf_counter() - begin) / calls


def rates(one, two):
    rows = one.step()
    print(f"| steps a call | one thread [million steps/s] | {two.threads} threads [million steps/s] | "
          f"ratio, median of {REPEATS} |")
    print("|---|---|---|---|")
    for steps, calls in STEPS.items():
        times = [[call_time(batch, steps, calls, rows) for batch in (one, two)] for _ in range(REPEATS)]
        best = [1e-6 * TWINS * steps / min(column) for column in zip(*times)]
        ratio = statistics.median(alone / together for alone, together in times)
        print(f"| {steps} | {best[0]:.2f} | {best[1]:.2f} | {ratio:.2f} |", flush=True)


def closed_loop(batch):
    """Each twin holds a speed of its own: a measured speed in, a torque out, every millisecond."""
    wanted = np.linspace(20.0, 120.0, TWINS)  # [rad/s]
    rows = batch.outputs
    busy, late = [], 0
    due = time.perf_counter() + PERIOD
    for _ in range(int(LOOP / PERIOD)):
        now = time.perf_counter()
        if now < due:
            time.sleep(due - now)
        begin = time.perf_counter()
        torque = np.clip(0.02 * (wanted - rows["motor_velocity_encoder"]) + 0.2, -1.0, 1.0)
        batch.step(torque, 10.0, steps=STEPS_A_PERIOD, out=rows)
        end = time.perf_counter()
        busy.append(end - begin)
        late += end > due + PERIOD
        due += PERIOD
    shares = [statistics.median(busy), *np.quantile(busy, [0.99, 0.999]), max(busy)]
    text = ", ".join(f"{name} {100.0 * share / PERIOD:.0f} %"
                     for name, share in zip(("median", "p99", "p99.9", "largest"), shares))
    error = np.abs(rows["motor_velocity"] / wanted - 1.0).max()
    print(f"{TWINS} twins at {1.0 / PERIOD:.0f} Hz on {batch.threads} threads: share of the period {text}; "
          f"{late} of {len(busy)} periods ended late; largest error of a speed {100.0 * error:.1f} %")


if __name__ == "__main__":
    print("load average", os.getloadavg()[0])
    PARAMETERS = hjt.Parameters({"solver.scene": "auto"})
    ONE, TWO = (hjt.TwinBatch(PARAMETERS, TWINS, threads=threads) for threads in (1, 2))
    rates(ONE, TWO)
    for BATCH in (ONE, TWO):
        closed_loop(hjt.TwinBatch(PARAMETERS, TWINS, threads=BATCH.threads))
    print("load average", os.getloadavg()[0])
