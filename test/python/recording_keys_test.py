#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each parameter acts in the commands on recordings that docs/parameters_recordings.csv marks, and in no other."""
import os
import unittest
import warnings

import numpy as np

import harmonic_joint_twin as hjt
import keys_test

RATE = 125.0  # [Hz]
OTHERS = {"thermal.model": "two_nodes", "telemetry.load": "model", "output.gravity_torque": 20.0,
          "output.tilting_moment": 20.0, "output.tilting_friction": 0.01, "bearing.constant_share": 0.1,
          "motor.stribeck_torque": 0.02, "manufacture.flexspline_pitch_deviation": 2e-6,
          "manufacture.circular_spline_pitch_deviation": 2e-6, "telemetry.ripple_circular_spline_2": (0.3, 0.1),
          "telemetry.ripple_fastest": 0.5, "input.temperature": 35.0}
DRIVES = [(["joints/elbow.yaml", "recorded_load.yaml", overlay], []) for overlay in (OTHERS, {})]


def recorded(seconds, friction=1.0):
    """An elbow under a weight, swinging, as a robot would tell of it."""
    time = np.arange(0.0, seconds, 1.0 / RATE)
    angle = 0.7 * np.sin(0.9 * time) + 0.2 * np.sin(2.3 * time)
    speed = 0.63 * np.cos(0.9 * time) + 0.46 * np.cos(2.3 * time)
    load = 20.0 * np.sin(angle + 0.4)
    torque = load + friction * (np.copysign(12.0, speed) + 4.0 * speed) + 0.4 * np.cos(202.0 * angle)
    return {"time": time, "position": angle, "current": torque / 9.5 + 0.02 * np.sin(7919.0 * time), "load": load,
            "temperature": 30.0 + 0.1 * time, "motor_angle": 101.0 * angle + 0.05 * np.sin(101.0 * angle)}


def write_table(path, month):
    """As a UR's controller does, without temperatures."""
    row = recorded(30.0, 1.0 + 0.15 * month)
    columns = {"timestamp": 1.7e9 + 30 * 86400.0 * month + row["time"], "actual_q_2": row["position"],
               "actual_current_2": row["current"], "target_moment_2": row["load"]}
    np.savetxt(path, np.column_stack(list(columns.values())), "%.9f", ",", comments="", header=",".join(columns))


def leaves(document):
    """Numbers and texts of a document, but for what it was made of."""
    if isinstance(document, dict):
        return [leaf for name, value in document.items() if name != "made_with" for leaf in [name, *leaves(value)]]
    if isinstance(document, (list, tuple)):
        return [leaf for value in document for leaf in leaves(value)]
    if isinstance(document, np.ndarray) and document.dtype.names:
        return [document[name].astype(float) for name in document.dtype.names]
    return [document]


def compared(document):
    """As keys_test compares results: numbers, then a text."""
    found = leaves(document)
    numbers = [np.atleast_1d(np.nan_to_num(leaf)) for leaf in found if isinstance(leaf, (float, np.ndarray))]
    text = repr([leaf for leaf in found if not isinstance(leaf, (float, np.ndarray))])
    return [*numbers, np.frombuffer(text.encode(), np.uint8).astype(float)]


class Recordings(keys_test.Keys):
    TABLE = "parameters_recordings.csv"
    DRIVES = DRIVES

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        warnings.simplefilter("ignore", RuntimeWarning)
        folder, joint, turns = os.path.join(cls.folder.name, "months"), recorded(6.0), recorded(12.0)
        os.mkdir(folder)
        for month in range(2):
            write_table(os.path.join(folder, f"{month}.csv"), month)
        run = hjt.Twin(hjt.Parameters({"solver.rate": 1000.0, "indicators.sample_rate": 1000.0})).run(
            6000, motor_torque=0.4, load_torque=5.0)

        bare = {name: joint[name] for name in ("time", "position", "current", "load")}
        shipped = hjt.Parameters()

        def command(function, *recordings, **options):
            def run_with(parameters):
                changes = {key: value for key, value in parameters.items() if value != shipped[key]}
                return sum((compared(function(each, overlays=[changes], **options)) for each in recordings), [])
            return run_with
        cls.ANALYSES = {
            "follow": command(hjt.follow, joint, bare, joint="elbow"),
            "observer": command(hjt.follow, joint, joint="elbow", mode="observer"),
            "compare": command(hjt.compare, turns, bare, joint="elbow"),
            "identify": command(hjt.identify, joint, joint="elbow", out=os.path.join(cls.folder.name, "found.yaml"),
                                force=True),
            "trend": command(hjt.trend, folder, joint="elbow"),
            "indicators": command(hjt.indicators, run),
        }

    def test_an_arm_has_its_own_load(self):
        row = recorded(6.0)
        arm = {"time": row["time"], **{name: np.tile(row[name], (6, 1)).T for name in ("position", "current")}}

        def followed(**parameters):
            return leaves(hjt.follow(arm, arm="ur5", overlays=[parameters]))
        sound = followed()
        for key, value in (("output.gravity_torque", 20.0), ("output.load_inertia", 2.0)):
            self.assertEqual(repr(followed(**{key: value})), repr(sound), key)
        self.assertNotEqual(repr(followed(**{"input.temperature": 40.0})), repr(sound))
        with self.assertRaisesRegex(hjt.InputError, "load"):
            followed(**{"telemetry.load": "model"})


if __name__ == "__main__":
    unittest.main()
