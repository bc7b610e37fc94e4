#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every kind of fault in every static analysis: it changes the result or is refused, with the reason. Argument: the
tool."""
import subprocess
import sys
import unittest

import numpy as np

import harmonic_joint_twin as hjt

TOOL = sys.argv.pop(1)

# Each with the tool's command of the same name.
ANALYSES = {
    "insert": lambda given: numbers(hjt.analyse_insertion(given), "solve_time"),
    "stiffness": lambda given: [numbers(row) for row in hjt.analyse_stiffness(given, [40.0, -40.0], angle=0.3)],
    "turn": lambda given: hjt.analyse_turn(given, load=40.0, angle_range=0.05, steps=2),
    "losses": lambda given: hjt.analyse_losses(given, [1.0, 100.0], [0.0, 40.0], positions=2),
    "breakaway": lambda given: numbers(hjt.analyse_breakaway(given, positions=2)),
    "hysteresis": lambda given: numbers(hjt.analyse_torsion_loop(given, 60.0, 2.7, steps=8)),
    "endurance share": lambda given: hjt.endurance_share(
        given, "tooth space", hjt.analyse_stiffness(given, [60.0])[0].stress.cycle("tooth space")),
}


def numbers(result, *without):
    """Every number of a result, those of its parts too."""
    found = []
    for name in dir(result):
        if name.startswith("_") or name in without or callable(getattr(result, name)):
            continue
        value = getattr(result, name)
        if isinstance(value, (int, float, np.ndarray)):
            found.append(np.asarray(value, dtype=float).ravel())
        else:
            found.append(numbers(value))
    return np.concatenate([np.zeros(0), *found])


def bits(result):
    if isinstance(result, list):
        return b"".join(part.tobytes() for part in result)
    return np.asarray(result).tobytes()


def outcome(analysis, given):
    """Bits of the result; or why there is none."""
    try:
        return bits(ANALYSES[analysis](given))
    except (hjt.InputError, hjt.NotConverged) as error:
        return str(error).encode()


class Analyses(unittest.TestCase):
    def test_every_fault_acts_or_is_refused(self):
        given = hjt.Parameters()
        for analysis in list(ANALYSES)[:-1]:
            sound = outcome(analysis, given)
            for name, kind in hjt.fault_kinds().items():
                with self.subTest(analysis=analysis, fault=name):
                    other = given.copy()
                    other.faults = [f"{name}:1" + ("" if kind.whole else ":0")]
                    try:
                        result = bits(ANALYSES[analysis](other))
                    except hjt.NotConverged:
                        continue
                    except hjt.ParameterError as error:
                        self.assertRegex(str(error), f"faults: {name} cannot act in this analysis, which does not ")
                        continue
                    self.assertNotEqual(result, sound)

    def test_refused_are_those_of_parts_left_out(self):
        refused = {analysis: set() for analysis in ANALYSES}
        for analysis in ANALYSES:
            for name, kind in hjt.fault_kinds().items():
                other = hjt.Parameters()
                other.faults = [f"{name}:0.5" + ("" if kind.whole else ":0")]
                if b"cannot act in this analysis" in outcome(analysis, other):
                    refused[analysis].add(name)
        self.assertEqual(refused["losses"] | refused["breakaway"] | refused["hysteresis"], set())
        self.assertEqual(refused["stiffness"], {"lubricant_degradation"})
        self.assertEqual(refused["turn"], {"lubricant_degradation"})
        self.assertEqual(refused["insert"], {"lubricant_degradation", "tooth_wear", "tooth_root_crack",
                                             "tooth_tip_crack", "pitting", "ratcheting", "rear_section_crack",
                                             "flange_crack"})

    def test_a_fault_that_sets_in_later_is_refused(self):
        given = hjt.Parameters()
        given.faults = ["tooth_wear:0.5:-1:2.5"]
        for analysis in ANALYSES:
            self.assertIn("tooth_wear sets in at 2.5 s, but this analysis has no time",
                          outcome(analysis, given).decode())

    def test_the_tool_says_the_same(self):
        command = [TOOL, "stiffness", "--torques", "40", "--json", "--fault"]
        done = subprocess.run([*command, "lubricant_degradation:0.5"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("lubricant_degradation cannot act in this analysis, which does not contain friction", done.stderr)
        given = hjt.Parameters()
        given.faults = ["tooth_wear:1"]
        worn = subprocess.run([*command, "tooth_wear:1"], stdout=subprocess.PIPE, universal_newlines=True, check=True)
        self.assertIn(repr(hjt.analyse_stiffness(given, [40.0])[0].output_angle), worn.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
