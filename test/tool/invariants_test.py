# SPDX-License-Identifier: BSD-3-Clause
"""What must hold whatever the parameters, as the tool reports it; parameters away from the shipped ones, too."""
import tool

OTHER_GEAR = ["--set", "gear.wave_amplitude=0.33e-3", "--set", "contact.stiffness=1.3e+8", "--set",
              "mesh.flank_angle=0.33"]


class State(tool.ToolTest):
    def states(self, *arguments):
        return self.succeed_json("invariants", "state", *arguments)

    def test_symmetry_shift_and_balance(self):
        for overlay in [[], OTHER_GEAR]:
            for pitches in [1, -31]:
                with self.subTest((overlay, pitches)):
                    rows = self.states("--angle", "-0.7", "--loads", "0,30,-120", "--pitches", pitches,
                                       *overlay)["states"]
                    self.assertEqual([row["load"] for row in rows], [0.0, 30.0, -120.0])
                    for row in rows:
                        self.assertAlmostEqual(row["output_torque"], row["load"], delta=1e-8)
                        self.assertGreater(row["softest_stiffness"], 1e4)
                        for difference in ["half_turn", "pitch_shift"]:
                            # Forces left, up to 5e-7 N on 200 teeth, over the softest stiffness.
                            self.assertLess(row[difference + "_position"], 20 * 5e-7 / row["softest_stiffness"])
                            self.assertLess(row[difference + "_flank_force"], 1e-5)
                            self.assertLess(row[difference + "_contact_force"], 1e-5)
                        self.assertLess(abs(row["pitch_shift_energy"]), 1e-10)
                        total = row["wave_generator_torque"] + row["output_torque"] + row["cup_torque"]
                        self.assertLess(abs(total), 1e-6)

    def test_half_a_pitch_on_is_another_state(self):
        # So that the shift above compares states that could differ.
        there, here = (self.states("--loads", "30", "--angle", angle)["states"][0] for angle in ["0.3", "0.31570796"])
        self.assertGreater(abs(there["flank_force_max"] - here["flank_force_max"]), 0.1)

    def test_torques_are_derivatives_of_the_energy(self):
        # At 1e-5 rad the forces left, up to 5e-7 N on 200 teeth, are 2e-5 of the differences, and more at less.
        rows = self.states("--loads", "30", "--steps", "1e-4,3e-5")["potential"]
        self.assertEqual([row["wave_generator_step"] for row in rows], [1e-4, 3e-5])
        for row in rows:
            self.assertGreater(abs(row["wave_generator_torque"]), 0.2)
            self.assertLess(abs(row["wave_generator_difference"]), 1e-6)
            self.assertLess(abs(row["output_difference"]), 1e-6)
            self.assertAlmostEqual(row["wave_generator_by_output"] / row["output_by_wave_generator"], 1.0, delta=1e-6)
            self.assertAlmostEqual(row["wave_generator_by_output"] / row["condensed_stiffness"], -1.0, delta=1e-6)

    def test_a_law_that_holds_on_to_the_housing_does_not_balance(self):
        row = self.states("--loads", "120", "--set", "ring.bending_law=absolute")["states"][0]
        self.assertGreater(abs(row["wave_generator_torque"] + row["output_torque"] + row["cup_torque"]), 10.0)


class Frame(tool.ToolTest):
    def test_only_the_absolute_law_minds_the_frame(self):
        result = self.succeed_json("invariants", "frame", "--load", 40, "--seed", 3, "--samples", 11, "--config",
                                   "golden.yaml")
        elements = {element["name"]: element for element in result["elements"]}
        self.assertEqual(set(elements), {"rim_tension", "rim_bending_curvature", "rim_bending_absolute",
                                         "wave_generator_contact", "tooth_mesh"})
        for name, element in elements.items():
            self.assertGreater(element["force_max"], 1.0)
            if name == "rim_bending_absolute":
                self.assertGreater(element["force_difference"], 1e4)
            else:
                # Coordinates rounded to 3e-18 m, 5e9 N/m.
                self.assertLess(element["force_difference"], 1e-6, name)
        self.assertEqual(len(result["bending"]), 11)
        # 1/2 N k angle^2 = 40000 J for a radian, on both sides of where it is.
        first, middle, last = (result["bending"][i]["absolute_energy"] for i in (0, 5, 10))
        self.assertAlmostEqual(0.5 * (first + last) - middle, 40000.0 * 0.25, delta=1e-3)


class SmallWave(tool.ToolTest):
    def test_error_falls_with_the_wave_down_to_a_tenth_of_a_micrometre(self):
        for overlay in [[], OTHER_GEAR]:
            with self.subTest(overlay):
                rows = self.succeed_json("invariants", "small-wave", "--smallest", 1e-7, "--count", 31, "--hold",
                                         *overlay)["rows"]
                for row in rows:
                    self.assertEqual(row["teeth_in_contact"], 200)
                    for key, factor in {"radial": 0.636, "tangential": 0.125, "tilt": 0.875}.items():
                        self.assertAlmostEqual(row["linear"][key] / (row["wave_amplitude"] / 30.65e-3) / factor, 1.0,
                                               delta=0.04)
                self.assertLess(max(rows[-1]["second_order"].values()), 2e-8)

    def test_rim_that_bends_as_given_lifts_off(self):
        rows = self.succeed_json("invariants", "small-wave", "--smallest", 0.08e-3, "--count", 60, "--config",
                                 "golden.yaml")["rows"]
        touching = [row["wave_amplitude"] for row in rows if row["teeth_in_contact"] == 200]
        self.assertAlmostEqual(min(touching), 0.097e-3, delta=3e-6)


class Energy(tool.ToolTest):
    def test_residual_falls_with_the_square_of_the_step(self):
        arguments = ["invariants", "energy", "--seed", 2, "--load", 15, "--duration", 0.3, "--set",
                     "motor.torque_limit=0.5"]
        rows = self.succeed_json(*arguments, "--rates", "10000,40000")["rows"]
        self.assertEqual([row["rate"] for row in rows], [10000.0, 40000.0])
        self.assertGreater(rows[0]["travel"], 1.0)
        self.assertGreater(rows[0]["reversals"], 0)
        self.assertLess(rows[0]["relative_residual"], 1e-4)
        self.assertLess(rows[1]["relative_residual"], rows[0]["relative_residual"] / 4.0)

    def test_the_same_seed_gives_the_same_numbers(self):
        run = [self.succeed_json("invariants", "energy", "--seed", seed, "--duration", 0.1)["rows"]
               for seed in [4, 4, 5]]
        self.assertEqual(run[0], run[1])
        self.assertNotEqual(run[0], run[2])


class CommandLine(tool.ToolTest):
    def test_wrong_usage_ends_with_2(self):
        for arguments in [[], ["dance"], ["state"], ["state", "--loads", "nan"],
                          ["state", "--loads", "5", "--steps", "0"],
                          ["small-wave", "--count", "3"], ["small-wave", "--smallest", "0", "--count", "3"],
                          ["energy", "--rates", "0"], ["energy", "--duration", "-1"], ["frame", "--samples", "0"]]:
            with self.subTest(arguments):
                self.fail_with(2, [], "invariants", *arguments)

    def test_every_part_prints_a_table_with_units(self):
        for arguments, heading in [(["state", "--loads", "5", "--steps", "1e-5"], "torque sum [N.m]"),
                                   (["frame", "--samples", 3], "law absolute [N]"),
                                   (["small-wave", "--smallest", "3e-4", "--count", 2], "wave amplitude [m]"),
                                   (["energy", "--duration", "0.01"], "left over [J]")]:
            with self.subTest(arguments):
                self.assertIn(heading, self.succeed("invariants", *arguments).stdout)

    def test_no_equilibrium_is_a_failure(self):
        self.fail_with(1, ["no equilibrium found for a load of 5 N.m"], "invariants", "state", "--loads", "5", "--json",
                       "--config", "golden.yaml", "--set", "solver.max_iterations=1", "--set",
                       "solver.max_step_cuts=0", "--set",
                       "contact.stiffness=1.0e+12")


if __name__ == "__main__":
    tool.main()
