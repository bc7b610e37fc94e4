#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each parameter acts in the analyses that docs/parameters_analyses.csv marks, and in no other."""
import csv
import fnmatch
import os
import shutil
import sys
import tempfile
import unittest

import numpy as np

import harmonic_joint_twin as hjt

sys.argv.pop(1)  # the tool: the other tests of the module compare with it
CHECKOUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
LEAST = 5e-10  # change over the largest value; equilibria are solved to less
PLACES = ("tooth space", "transition", "flange")
BEGIN = {"motor_torque": np.full(60, 0.5), "load_torque": 10.0, "temperature": 25.0 + np.arange(60) // 20}
END = {"motor_torque": np.where(np.arange(60) < 20, 3.2, -0.3), "load_torque": 280.0, "brake": np.arange(60) // 40}


def members(result, *names):
    return [np.asarray(getattr(result, name), float) for name in names]


def insert(parameters):
    return members(hjt.analyse_insertion(parameters).teeth, "radius", "angle_deviation", "rim_tension", "bending_force",
                   "wave_generator_force", "stress_tooth_space", "stress_transition", "stress_flange")


def stiffness(parameters):
    found = []
    for angle in 0.0, 0.1:
        row = hjt.analyse_stiffness(parameters, [60.0], angle)[0]
        found += members(row, "output_angle", "wave_generator_torque", "cup_rotation")
        found += members(row.teeth, "mesh_force", "stress_tooth_space", "stress_transition", "stress_flange")
        found += [np.array([hjt.endurance_share(parameters, place, row.stress.cycle(place))]) for place in PLACES]
    return found


def rows(table):
    return [table[name].astype(float) for name in table.dtype.names if name != "solve_time"]


def simulate(parameters):
    twin = hjt.Twin(parameters)
    steps = rows(twin.run(**BEGIN)) + rows(twin.run(**END))
    return steps + [np.array([count]) for count in twin.counters.values()]


ANALYSES = {
    "insert": insert,
    "stiffness": stiffness,
    "turn": lambda parameters: rows(hjt.analyse_turn(parameters, 60.0, 0.3, 3)),
    "losses": lambda parameters: rows(hjt.analyse_losses(parameters, [100.0], [30.0], 4)),
    "breakaway": lambda parameters: members(hjt.analyse_breakaway(parameters, 2), "starting", "back_driving"),
    "hysteresis": lambda parameters: members(hjt.analyse_torsion_loop(parameters, 60.0, 2.5, 8), "output_angle",
                                             "torque", "hysteresis", "lost_motion"),
    "simulate": simulate,
}

# Drives in which options are on that others need to act. solver.rate: 120 steps are longer than a step of the heat.
RICH = {"solver.rate": 1000.0, "indicators.sample_rate": 1000.0, "manufacture.flexspline_pitch_deviation": 2e-6,
        "manufacture.circular_spline_pitch_deviation": 2e-6, "bearing.constant_share": 0.1,
        "ring.tension_damping": 100.0, "motor.stribeck_torque": 0.02, "motor.current_bandwidth": 500.0,
        "motor.torque_ripple": 0.02, "motor.cogging_torque": 0.01, "output.tilting_moment": 20.0,
        "output.tilting_friction": 0.01, "output.gravity_torque": 20.0, "thermal.model": "two_nodes",
        "sensors.motor_noise": 1e-4, "input.temperature": 35.0}
DRIVES = [({}, []), (RICH, []), ({"contact.support": "springs"}, []), ({"contact.support": "single_balls"}, []),
          ({"motor.speed_limit": 1.0}, []), ({"brake.engaged_at_start": True}, [])]
FAULTY = [({}, [hjt.Fault(kind, severity)]) for kind in hjt.fault_kinds() for severity in (0.5, 0.02)]
TEETH = "gear.teeth_flexspline", "gear.teeth_circular_spline"  # together, or they contradict each other
UNTRIED = "solver.max_iterations", "solver.max_step_cuts"  # they act where no equilibrium is found


def drive(overlays, faults):
    parameters = hjt.Parameters(*overlays)
    parameters.faults = faults
    return parameters


def result(analysis, parameters):
    """None where a fault cannot act in the analysis."""
    try:
        return analysis(parameters)
    except (hjt.InputError, hjt.NotConverged) as error:
        return None if "cannot act here" in str(error) else str(error)


def differ(one, other):
    if isinstance(one, str) or isinstance(other, str):
        return one != other
    return any(a.shape != b.shape or np.abs(a - b).max() > LEAST * np.abs(a).max() for a, b in zip(one, other))


def acting(table):
    """Patterns of keys and the analyses in which they act, of a table beside docs/parameters.md."""
    with open(os.path.join(CHECKOUT, "docs", table), encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            yield row.pop("keys").split(), {name for name, mark in row.items() if mark}


class Keys(unittest.TestCase):
    TABLE = "parameters_analyses.csv"
    ANALYSES = ANALYSES
    DRIVES = [([overlay], faults) for overlay, faults in DRIVES + FAULTY]

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        for teeth in range(198, 208, 2):
            with open(os.path.join(cls.folder.name, f"{teeth}.csv"), "w", encoding="ascii") as file:
                file.write("tooth,deviation\n" + "".join(f"{i},{1e-6 * (i % 2)}\n" for i in range(teeth)))
        shutil.copy(os.path.join(CHECKOUT, "config", "signatures", "size_25.yaml"),
                    os.path.join(cls.folder.name, "signatures.yaml"))
        cls.fields = {field.key: field for field in hjt.parameter_fields()}
        cls.acts = {}
        for patterns, analyses in acting(cls.TABLE):
            for pattern in patterns:
                keys = fnmatch.filter(cls.fields, pattern)
                assert keys, pattern
                for key in keys:
                    cls.acts.setdefault(key, analyses)
        cls.acts = {key: cls.acts.get(key, set()) for key in cls.fields}

    def changed(self, parameters, key):
        """The same drive with another value of the key."""
        field, value = self.fields[key], parameters[key]

        def other(number, factor):
            step = 0.01 * min(field.maximum, 100.0) if number == 0 else number * (factor - 1.0)
            return min(max(number + step, field.minimum), field.maximum)
        if field.choices:
            options = [choice for choice in field.choices if choice != value]
        elif isinstance(value, bool):
            options = [not value]
        elif isinstance(value, str):
            table = str(parameters["gear.teeth_" + key[len("manufacture."):-len("_pitch_table")]]) + ".csv" \
                if key.startswith("manufacture.") else "signatures.yaml"
            options = [os.path.join(self.folder.name, table), "other"]
        elif isinstance(value, tuple):
            options = [tuple(other(number, factor) for number in value) for factor in (1.05, 0.95)]
        elif isinstance(value, int):
            options = [value + 2, value - 1, 2 * value]
        else:
            options = [other(value, factor) for factor in (0.95, 1.05, 2.0, 0.5)]
        for option in options:
            copy = parameters.copy()
            try:
                copy.update({each: parameters[each] + 2 for each in TEETH} if key in TEETH else {key: option})
            except hjt.ParameterError:
                continue
            if copy[key] != value:
                return copy
        return None

    def test_act_where_the_page_says(self):
        missing = {key: set(analyses) for key, analyses in self.acts.items() if key not in UNTRIED}
        for overlays, faults in self.DRIVES:
            sound = drive(overlays, faults)
            known = {}
            for key, analyses in missing.items():
                if not analyses or (faults and not key.startswith(("fault_scale.", "cup.wall", "bearing."))):
                    continue
                copy = self.changed(sound, key)
                for analysis in sorted(analyses) if copy else ():
                    if analysis not in known:
                        known[analysis] = result(self.ANALYSES[analysis], sound)
                    if known[analysis] is not None and differ(known[analysis], result(self.ANALYSES[analysis], copy)):
                        analyses.remove(analysis)
        self.assertEqual({key: analyses for key, analyses in missing.items() if analyses}, {})

    def test_act_nowhere_else(self):
        """All the others changed at once."""
        for overlays, faults in self.DRIVES:
            sound = drive(overlays, faults)
            for name, analysis in self.ANALYSES.items():
                expected = result(analysis, sound)
                other = sound
                for key, analyses in self.acts.items():
                    if expected is not None and name not in analyses:
                        other = self.changed(other, key) or other
                self.assertFalse(expected is not None and differ(expected, result(analysis, other)),
                                 (name, overlays, faults))


if __name__ == "__main__":
    unittest.main()
