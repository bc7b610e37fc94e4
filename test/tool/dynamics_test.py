# SPDX-License-Identifier: BSD-3-Clause
"""The dynamic ring on the command line: insertion as motion, and turning against the ring in equilibrium."""
import csv

import tool

THESIS = ["--config", "config/thesis_insertion.yaml"]


class Transient(tool.ToolTest):
    def test_implicit_euler_settles_on_the_static_force(self):
        static = self.succeed_json("insert", "--csv", "teeth.csv", *THESIS)["wave_generator_force_max"]
        result = self.succeed_json("transient", "--method", "implicit_euler", "--step", "1e-5", *THESIS)
        self.assertEqual(set(result),
                         {"method", "step", "tolerance", "window_start", "force_max_lowest", "force_max_highest",
                          "force_max_mean", "energy_supplied", "energy_stored", "energy_kinetic", "energy_dissipated",
                          "energy_lost", "steps", "force_evaluations", "factorisations", "halvings", "rejections",
                          "solve_time", "series", "tooth_x", "tooth_y"})
        self.assertAlmostEqual(result["force_max_mean"], static, delta=0.01)
        self.assertEqual((result["steps"], len(result["tooth_x"])), (5000, 200))
        self.assertGreater(result["energy_lost"], 100 * result["energy_dissipated"])
        for name, values in tool.read_columns(self.path("teeth.csv")).items():
            if name in ("tooth_x", "tooth_y"):
                for value, at_rest in zip(result[name], values):
                    self.assertAlmostEqual(value, at_rest, delta=1e-7)

    def test_csv_is_the_series(self):
        arguments = ["transient", "--step", "1e-5", "--duration", "6e-3", "--window", "5.5e-3", "--sample", "1e-3",
                     "--csv", "rows.csv", *THESIS]
        series = self.succeed_json(*arguments)["series"]
        with open(self.path("rows.csv")) as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["time"]) for row in rows], series["time"])
        self.assertEqual([float(row["force_max"]) for row in rows], series["force_max"])
        self.assertEqual(len(rows), 7)
        for row in rows:
            self.assertLessEqual(float(row["force_lowest"]), float(row["force_highest"]))
        self.fail_with(1, ["rows.csv exists; --force overwrites it"], *arguments)

    def test_steps_by_a_tolerance(self):
        arguments = ["transient", "--step", "1e-4", "--duration", "6e-3", "--window", "5.5e-3", *THESIS]
        loose, tight = (self.succeed_json(*arguments, "--tolerance", tolerance) for tolerance in ("1e-6", "1e-7"))
        self.assertGreater(tight["steps"], loose["steps"])
        self.assertEqual(tight["tolerance"], 1e-7)

    def test_a_step_beyond_stability_is_a_failure_in_words(self):
        self.fail_with(1, ["the integration of the ring failed at", "a shorter --step may help"],
                       "transient", "--method", "rk4", "--step", "5e-6", *THESIS)

    def test_wrong_usage(self):
        for arguments in (["--method", "euler"], ["--step", "0"], ["--step", "nan"], ["--duration", "-1"]):
            with self.subTest(arguments):
                self.fail_with(2, [], "transient", *arguments)
        self.fail_with(1, ["--tolerance 1e-06 [m]: rk4 has no error estimate"],
                       "transient", "--method", "rk4", "--tolerance", "1e-6")
        self.fail_with(1, ["--window 0.05 [s] must be before the end, --duration 0.01 [s]"],
                       "transient", "--window", "0.05", "--duration", "0.01")


class Dynamics(tool.ToolTest):
    def test_at_low_speed_the_ring_is_quasi_static(self):
        result = self.succeed_json("dynamics", "--speed", 10, "--load", 20, "--method", "esdirk4", "--step", "1e-5",
                                   "--settle", "2e-3", "--duration", "4e-3", "--every", "37e-6")
        self.assertEqual((result["speed"], result["load"], result["mass"]), (10, 20, 0.038))
        for name, bound in (("contact_force", 1e-3), ("mesh_force", 1e-3), ("position", 1e-4), ("torsion", 2e-3),
                            ("wave_generator_torque", 2e-3), ("output_torque", 2e-3)):
            self.assertEqual(set(result[name]), {"size", "error_rms", "error_max", "relative_rms", "relative_max"})
            self.assertTrue(0.0 < result[name]["relative_rms"] < bound, (name, result[name]))
        self.assertEqual(len(result["teeth"]["contact_force"]), 200)
        lengths = {len(values) for values in result["series"].values()}
        self.assertEqual(len(lengths), 1)

    def test_table_names_units(self):
        text = self.succeed("dynamics", "--settle", "0", "--duration", "1e-4").stdout
        self.assertRegex(text, r"mesh_force, error rms +\S+ N\n")

    def test_wrong_usage(self):
        for arguments in (["--speed", "fast"], ["--settle", "-1"], ["--every", "0"], ["--load", "inf"]):
            with self.subTest(arguments):
                self.fail_with(2, [], "dynamics", *arguments)


if __name__ == "__main__":
    tool.main()
