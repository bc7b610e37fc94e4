#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A recording beside the twin from Python gives the tool's numbers. Argument: the tool."""
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import harmonic_joint_twin as hjt

TOOL = sys.argv.pop(1)
OVERLAYS = ("joints/elbow.yaml",)


def recording(seconds=6.0):
    time = np.arange(0.0, seconds, 0.008)
    return (time, 0.6 * np.sin(1.3 * time), 1.0 + 2.0 * np.cos(1.3 * time), 5.0 * np.sin(time))


class Follow(unittest.TestCase):
    def follow_by_tool(self, mode, columns):
        time, position, current, load = columns
        with tempfile.TemporaryDirectory() as folder:
            path, out = os.path.join(folder, "recording.csv"), os.path.join(folder, "followed.csv")
            np.savetxt(path, np.column_stack([time, position, current, load]), fmt="%.17g", delimiter=",", comments="",
                       header="timestamp,actual_q_2,actual_current_2,target_moment_2")
            subprocess.run([TOOL, "follow", path, "--joint", "elbow", "--mode", mode, "--out", out,
                            *[word for overlay in OVERLAYS for word in ("--config", overlay)]],
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=True)
            return np.genfromtxt(out, delimiter=",", names=True)

    def test_gives_the_numbers_of_the_tool(self):
        columns = recording()
        for mode in ("motion", "torque", "observer"):
            with self.subTest(mode):
                expected = self.follow_by_tool(mode, columns)
                time, position, current, load = columns
                rows = hjt.Tracker(hjt.Parameters(*OVERLAYS), mode).follow(time, position, current, load=load)
                self.assertEqual(len(rows), len(expected))
                for name in expected.dtype.names:
                    np.testing.assert_array_equal(rows[name], expected[name], name)
                self.assertEqual(rows.dtype, hjt.COMPARISON_DTYPE)

    def test_in_parts_is_the_same_as_at_once(self):
        columns = recording()
        whole = hjt.Tracker(hjt.Parameters(*OVERLAYS)).follow(*columns)
        tracker = hjt.Tracker(hjt.Parameters(*OVERLAYS))
        parts = [tracker.follow(*[column[begin:begin + 100] for column in columns], at_end=begin + 100 >= len(whole))
                 for begin in range(0, len(whole), 100)]
        np.testing.assert_array_equal(np.concatenate(parts), whole)
        self.assertEqual(tracker.counters["compared"], len(whole))

    def test_old_grease_shows_in_the_current(self):
        """The twin makes its own recording of 5 s; the healthy one is laid beside it."""
        residuals = []
        for faults in ([], ["lubricant_degradation:1"]):
            parameters = hjt.Parameters(*OVERLAYS)
            healthy = parameters.copy()
            parameters.faults = faults
            twin = hjt.Twin(parameters)
            rows = np.concatenate(
                [twin.run(80, motor_torque=0.02 * (target - twin.outputs["motor_velocity"]), every=80)
                 for target in np.tile(np.repeat([50.0, -50.0], 150), 2)])
            current = 101.0 * rows["motor_torque"] / parameters["telemetry.torque_per_current"]
            followed = hjt.Tracker(healthy).follow(rows["time"], rows["output_angle"], current)
            # Against the motion: positive where the joint takes more current than a healthy one.
            residuals.append(np.median(followed["current_residual"] * np.sign(followed["velocity_measured"])))
        self.assertGreater(residuals[1], residuals[0] + 0.1)

    def test_bad_arguments_are_named(self):
        tracker = hjt.Tracker(hjt.Parameters(*OVERLAYS))
        time, position, current, _ = recording()
        with self.assertRaisesRegex(hjt.InputError, "position has 3 values in 1 dimensions"):
            tracker.follow(time, position[:3], current)
        with self.assertRaisesRegex(hjt.InputError, "mode = 'commands' must be 'motion', 'torque' or 'observer'"):
            hjt.Tracker(hjt.Parameters(*OVERLAYS), "commands")
        self.assertEqual(len(tracker.follow(time, np.full_like(time, np.nan), current)), 0)
        self.assertEqual(tracker.counters["refused"], len(time))


if __name__ == "__main__":
    unittest.main(verbosity=2)
