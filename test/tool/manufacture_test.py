# SPDX-License-Identifier: BSD-3-Clause
"""Errors of manufacture through the tool: tables written and read, and which lines an error makes."""
import cmath
import csv
import math

import tool

JOINT_TURN = 101  # motor turns


class Tables(tool.ToolTest):
    PITCH = ["--set", "manufacture.flexspline_pitch_deviation=4.0e-6",
             "--set", "manufacture.circular_spline_pitch_deviation=8.0e-6"]

    def test_perfect_gear_has_no_errors(self):
        text = self.succeed_json("manufacture")
        for quantity in ("pitch_deviation", "across", "along"):
            self.assertEqual(text["flexspline"][quantity], [0.0] * 200)
            self.assertEqual(text["circular_spline"][quantity], [0.0] * 202)

    def test_tables_written_from_seeds_are_read_back_to_the_bit(self):
        seeded = self.succeed_json("manufacture", *self.PITCH, "--flexspline-csv", "teeth.csv", "--circular-spline-csv",
                                   "spaces.csv")
        self.assertAlmostEqual(seeded["flexspline"]["total_pitch_deviation"], 4e-6, delta=1e-18)
        self.assertAlmostEqual(seeded["circular_spline"]["total_pitch_deviation"], 8e-6, delta=1e-18)
        with open(self.path("teeth.csv")) as file:
            self.assertEqual([int(row["tooth"]) for row in csv.DictReader(file)], list(range(200)))
        tabled = self.succeed_json("manufacture",
                                   "--set", "manufacture.flexspline_pitch_table=" + self.path("teeth.csv"),
                                   "--set", "manufacture.circular_spline_pitch_table=" + self.path("spaces.csv"))
        self.assertEqual(tabled, seeded)
        self.fail_with(1, ["teeth.csv exists; --force overwrites it"], "manufacture", "--flexspline-csv", "teeth.csv")

    def test_measures_name_units(self):
        self.assertRegex(self.succeed("manufacture", *self.PITCH).stdout,
                         r"circular spline, total pitch deviation +8e-06 m\n")

    def test_bad_tables_are_named(self):
        key = "manufacture.flexspline_pitch_table"
        self.fail_with(1, [key, "'teeth.csv' must be an absolute path, or none"], "stiffness", "--torques", "5",
                       "--set",
                       f"{key}=teeth.csv")
        self.fail_with(1, [key, "cannot be read"], "stiffness", "--torques", "5", "--set",
                       f"{key}={self.path('teeth.csv')}")
        table = self.write("teeth.csv", "tooth,deviation\n0,0.0\n1,2.0e-3\n")
        self.fail_with(1, [key, "teeth.csv:3: column 'deviation' = 0.002 [m] is out of range"], "stiffness",
                       "--torques", "5", "--set", f"{key}={table}")
        self.fail_with(1, ["manufacture.flexspline_pitch_deviation = 4.0e-6 [m] must be 0"], "manufacture", *self.PITCH,
                       "--set", f"{key}={table}")


class Lines(tool.ToolTest):
    """Kinematic error over one whole turn of the joint, so that lines are whole numbers and do not leak."""

    def lines(self, numbers, *options, load=5):
        """Amplitudes at so many lines a joint turn [rad]."""
        # 30 samples a motor turn: the tooth pass, 200, folds to multiples of 10 orders.
        steps = 30 * JOINT_TURN
        rows = self.succeed_json("turn", "--load", load, "--angle-range", repr(2.0 * math.pi * JOINT_TURN), "--steps",
                                 steps,
                                 *options)["rows"]
        error = [row["kinematic_error"] for row in rows[:-1]]
        self.assertEqual(error[7], rows[7]["output_angle"] - rows[7]["wave_generator_angle"] / JOINT_TURN)
        return [2.0 / steps * abs(sum(e * cmath.exp(-2j * math.pi * number * i / steps) for i, e in enumerate(error)))
                for number in numbers]

    def test_flexspline_makes_202_and_circular_spline_200_lines_a_joint_turn(self):
        arcsec = math.pi / 180.0 / 3600.0
        for member, own, other in [("flexspline", 202, 200), ("circular_spline", 200, 202)]:
            with self.subTest(member):
                at = self.lines([own, other], "--set", f"manufacture.{member}_pitch_deviation=8.0e-6")
                self.assertGreater(at[0], 5.0 * arcsec)
                self.assertLess(at[1], 1e-3 * arcsec)

    def test_run_out_and_an_eccentric_wave_generator_make_a_line_a_motor_turn_that_load_takes_away(self):
        generator = ("--config", "golden.yaml", "--set", "manufacture.wave_generator_eccentricity=[5.0e-6, 0.0]")
        run_out = ("--config", "golden.yaml", "--set", "manufacture.flexspline_eccentricity=[5.0e-6, 0.0]")
        for alone in (generator, run_out):
            self.assertLess(self.lines([101], *alone)[0], 0.1e-6)
        light = self.lines([101], *generator, *run_out)[0]
        heavy = self.lines([101], *generator, *run_out, load=67)[0]
        self.assertGreater(light, 20e-6)
        self.assertLess(heavy, 0.4 * light)

    def test_gear_as_built_starts_the_simulation(self):
        done = self.succeed_json("simulate", "--torque", 1.0, "--duration", 0.1, "--config", "as_built.yaml", "--out",
                                 "run.csv")
        self.assertEqual(done["solver_failures"], 0)


if __name__ == "__main__":
    tool.main()
