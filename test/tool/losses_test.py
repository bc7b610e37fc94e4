# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin losses`, `breakaway` and `hysteresis` as their user meets them."""
import tool


class Losses(tool.ToolTest):
    def test_a_row_for_every_load_and_speed(self):
        document = self.succeed_json("losses", "--speeds", "10,100", "--loads", "0,50", "--positions", 4, "--set",
                                     "ring.loss_factor=0.003", "--set", "output.coulomb_torque=1.0")
        rows = document["rows"]
        self.assertEqual([(row["load_torque"], row["motor_speed"]) for row in rows],
                         [(0.0, 10.0), (0.0, 100.0), (50.0, 10.0), (50.0, 100.0)])
        for row in rows:
            shares = [row[key] for key in ("bearing", "interface", "flexing", "mesh", "cup", "damping", "output")]
            self.assertGreaterEqual(min(shares), 0.0)
            self.assertAlmostEqual(row["output"], 1.0 / 101.0, delta=1e-4)
            self.assertGreater(row["flexing"], 1e-4)
            self.assertAlmostEqual(sum(shares), row["gear_loss"], delta=1e-12)
        self.assertEqual(rows[0]["gear_efficiency"], 0.0)
        self.assertAlmostEqual(rows[3]["gear_efficiency"],
                               rows[3]["load_reduced"] / (rows[3]["load_reduced"] + rows[3]["gear_loss"]), delta=1e-12)

    def test_warm_grease_costs_less(self):
        cold, warm = (self.succeed_json("losses", "--speeds", 200, "--loads", 0, "--set",
                                        f"input.temperature={degrees}")
                      for degrees in ("0.0", "60.0"))
        self.assertEqual((cold["temperature"], warm["temperature"]), (0.0, 60.0))
        self.assertGreater(cold["rows"][0]["bearing"], 2.0 * warm["rows"][0]["bearing"])

    def test_table_for_people(self):
        self.assertIn("gear efficiency [-]", self.succeed("losses", "--speeds", 10, "--loads", 20).stdout)
        self.assertIn("back-driving torque", self.succeed("breakaway").stdout)
        self.assertIn("lost motion", self.succeed("hysteresis", "--amplitude", 50, "--lost-motion-torque", 2).stdout)

    def test_wrong_usage(self):
        for arguments in [["losses", "--speeds", "10"], ["losses", "--loads", "1"],
                          ["losses", "--speeds", "nan", "--loads", "1"],
                          ["losses", "--speeds", "1", "--loads", "1", "--positions", "0"],
                          ["hysteresis", "--amplitude", "-1", "--lost-motion-torque", "2"],
                          ["hysteresis", "--amplitude", "1", "--lost-motion-torque", "2"]]:
            with self.subTest(arguments):
                self.fail_with(2, [], *arguments)

    def test_no_equilibrium_is_a_failure(self):
        hopeless = ("--config", "golden.yaml", "--set", "solver.max_iterations=1", "--set", "solver.max_step_cuts=0")
        self.fail_with(1, ["no equilibrium"], "losses", "--speeds", 10, "--loads", 20, *hopeless)
        self.fail_with(1, ["no equilibrium"], "breakaway", *hopeless)
        self.fail_with(1, ["no equilibrium"], "hysteresis", "--amplitude", 50, "--lost-motion-torque", 2,
                       "--config", "golden.yaml", "--set", "gear.rim_thickness=0.4e-3")  # no tooth touches


if __name__ == "__main__":
    tool.main()
