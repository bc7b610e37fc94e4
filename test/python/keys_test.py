#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each parameter acts in the analyses and in the commands on recordings that docs/parameters_*.csv name it for, and in
no other."""
import csv
import fnmatch
import os
import shutil
import sys
import tempfile
import unittest
import warnings

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
        return None if "cannot act in this analysis" in str(error) else str(error)


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


RATE = 125.0  # [Hz]
OTHERS = {"thermal.model": "two_nodes", "telemetry.load": "model", "output.gravity_torque": 20.0,
          "output.tilting_moment": 20.0, "output.tilting_friction": 0.01, "bearing.constant_share": 0.1,
          "motor.stribeck_torque": 0.02, "manufacture.flexspline_pitch_deviation": 2e-6,
          "manufacture.circular_spline_pitch_deviation": 2e-6, "telemetry.ripple_circular_spline_2": (0.3, 0.1),
          "telemetry.ripple_fastest": 0.5, "input.temperature": 35.0}
RECORDED = [(["joints/elbow.yaml", "recorded_load.yaml", overlay], []) for overlay in (OTHERS, {})]


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
    """As `differ` compares results: numbers, then a text."""
    found = leaves(document)
    numbers = [np.atleast_1d(np.nan_to_num(leaf)) for leaf in found if isinstance(leaf, (float, np.ndarray))]
    text = repr([leaf for leaf in found if not isinstance(leaf, (float, np.ndarray))])
    return [*numbers, np.frombuffer(text.encode(), np.uint8).astype(float)]


class Recordings(Keys):
    TABLE = "parameters_recordings.csv"
    DRIVES = RECORDED

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
