#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Blocks of steps from Python beside the same loop in C++, alternating in one run, and two twins in two threads.

Argument: the executable step_loop. Prints the rows of the table in docs/python.md. Build: scripts/build step_loop.
"""
import statistics
import subprocess
import sys
import threading
import time

import numpy as np

import harmonic_joint_twin as hjt

REPEATS = 15
# Steps a call, and a call's rows.
BLOCKS = {"full_ring": [(10000, 10), (10000, 1), (1000, 10)], "auto": [(10000, 10), (10000, 1), (1000, 10), (100, 10)]}
LEAST_STEPS = {"full_ring": 10000, "auto": 200000}  # timed at once
NAMES = {"full_ring": "full ring", "auto": "response surface"}


def run(twin, steps, every, least):
    """Processor time of this thread, for steps in blocks [s]."""
    torque, load = np.full(steps, 0.45), 20.0
    rows = twin.run(motor_torque=torque, load_torque=load, every=every)
    begin = time.thread_time()
    for _ in range(least // steps):
        twin.run(motor_torque=torque, load_torque=load, every=every, out=rows)
    return time.thread_time() - begin


def compare(executable, scene):
    parameters = hjt.Parameters({"solver.scene": scene})
    least = LEAST_STEPS[scene]
    command = [executable, parameters.__getstate__()[0], scene]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as peer:

        def in_cpp(every):
            peer.stdin.write(f"{least} {every}\n")
            peer.stdin.flush()
            return float(peer.stdout.readline().split()[0])

        in_cpp(1)
        for steps, every in BLOCKS[scene]:
            twin = hjt.Twin(parameters)
            run(twin, steps, every, least)
            times = [(in_cpp(every), run(twin, steps, every, least)) for _ in range(REPEATS)]
            ratio = statistics.median(cpp / python for cpp, python in times)
            cpp, python = (1e6 * statistics.median(column) / least for column in zip(*times))
            print(f"| {NAMES[scene]} | {steps} | {every} | {cpp:.3g} | {python:.3g} | {ratio:.3f} |", flush=True)
        peer.stdin.close()


def threads(scene, blocks):
    """Wall time of two twins one after the other over both at once, in two threads."""
    twins = [hjt.Twin(hjt.Parameters({"solver.scene": scene})) for _ in range(2)]

    def work(twin):
        for _ in range(blocks):
            twin.run(10000, motor_torque=0.45, load_torque=20.0, every=10)

    ratios = []
    for _ in range(7):
        begin = time.perf_counter()
        for twin in twins:
            work(twin)
        middle = time.perf_counter()
        pair = [threading.Thread(target=work, args=(twin,)) for twin in twins]
        for thread in pair:
            thread.start()
        for thread in pair:
            thread.join()
        ratios.append((middle - begin) / (time.perf_counter() - middle))
    print(f"{NAMES[scene]}: two threads do {statistics.median(ratios):.2f} times the work of one "
          f"({min(ratios):.2f} ... {max(ratios):.2f})")


if __name__ == "__main__":
    print("| scene | steps a call | rows every | C++ [us a step] | Python [us a step] | C++ / Python |\n"
          "|---|---|---|---|---|---|")
    for SCENE in ("auto", "full_ring"):
        compare(sys.argv[1], SCENE)
    for SCENE, COUNT in (("auto", 20), ("full_ring", 1)):
        threads(SCENE, COUNT)
