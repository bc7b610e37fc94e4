# SPDX-License-Identifier: BSD-3-Clause
"""One trial as the stress matrix runs it: the solver's status, samples, faults, an advanced profile."""
import tool

PROFILE = "time,motor_torque,load_torque,brake\n0,0,0,1\n0.004,0,40,1\n0.012,0,-40,1\n"


class Trial(tool.ToolTest):
    def trial(self, *arguments, profile=PROFILE):
        self.write("profile.csv", profile)
        return self.succeed_json("trial", "--profile", "profile.csv", "--duration", "0.02", *arguments)

    def test_says_what_the_solver_said(self):
        fine = self.trial()
        self.assertTrue(fine["finite"])
        self.assertEqual(fine["solver_state"], "ok")
        self.assertEqual(fine["steps"], 200)
        self.assertEqual(len(fine["samples"]["time"]), 20)
        self.assertAlmostEqual(fine["samples"]["time"][-1], 0.02)
        self.assertGreater(max(fine["samples"]["joint_torque"]), 40.0)
        self.assertLess(fine["energy_residual_max"], 1e-2 * fine["throughput"])
        self.assertEqual(fine["substeps"], 1)
        soft_shaft = ["--set", "motor.presliding_angle=1.2e-3", "--set", "input.temperature=0.0"]
        coarse = self.trial(*soft_shaft, profile="time,motor_torque,load_torque,brake\n0,0,150,0\n")
        self.assertEqual(coarse["solver_state"], "degraded")
        self.assertGreater(coarse["coarse_steps"], 100)

    def test_a_step_too_long_for_the_swing_is_divided(self):
        for options, substeps in [(["--set", "solver.rate=1000", "--set", "indicators.sample_rate=1000"], 11),
                                  (["--set", "output.load_inertia=0.0"], 23)]:
            with self.subTest(options):
                divided = self.trial(*options)
                self.assertEqual(divided["solver_state"], "ok")
                self.assertEqual(divided["substeps"], substeps)
                self.assertLess(divided["phase_advance_max"], 0.1)
                self.assertLess(divided["energy_residual_max"], 1e-2 * divided["throughput"])

    def test_advance_is_an_earlier_profile(self):
        here = self.trial("--sample-period", "1e-4")["samples"]["joint_torque"]
        there = self.trial("--sample-period", "1e-4", "--advance", "1e-3")["samples"]["joint_torque"]
        for now, earlier in zip(here[30:100], there[20:90]):
            self.assertAlmostEqual(now, earlier, delta=1e-9)

    def test_faults(self):
        broken = self.trial(*[word for tooth in (0, 1, 2, 100, 101, 102)
                              for word in ("--fault", f"tooth_root_crack:1:{tooth}")])["samples"]["output_angle"]
        whole = self.trial()["samples"]["output_angle"]
        self.assertGreater(abs(broken[-1] - whole[-1]), 1e-6)
        for fault, text in [("flexspline_crack:1:200", ["place = 200", "0 ... 199"]),
                            ("tooth_wear:1.5", ["severity = 1.5", "0 ... 1"]),
                            ("tooth_were:1", ["unknown kind", "tooth_wear"]),
                            ("tooth_wear", ["expected KIND:SEVERITY"])]:
            self.fail_with(1, text, "trial", "--profile", "profile.csv", "--duration", "0.02", "--fault", fault)

    def test_without_a_profile(self):
        self.fail_with(2, ["--profile"], "trial", "--duration", "0.02")


if __name__ == "__main__":
    tool.main()
