# SPDX-License-Identifier: BSD-3-Clause
"""A gear by its size and ratio, and gears that do not go together."""
import math
import os

import yaml

import tool

# Parameters of size_14.yaml that are of the joint, chosen or fitted, not scaled.
OF_THE_JOINT = {"motor.rotor_inertia", "motor.viscous_friction", "motor.copper_loss", "motor.torque_limit",
                "motor.wave_generator_inertia", "output.load_inertia", "output.torque_limit", "brake.holding_torque",
                "health.stiffness_torque_span"}


def flat(document):
    return {f"{section}.{key}": value for section, members in document.items() for key, value in members.items()}


def overlay(path):
    with open(path) as file:
        return flat(yaml.safe_load(file))


def configured():
    values = {}
    for name in ("gear", "elements", "joint", "health", "life"):
        values.update(overlay(os.path.join(tool.CHECKOUT, "config", f"{name}.yaml")))
    return values


class Gear(tool.ToolTest):
    def design(self, *options):
        figures = self.succeed_json("gear", *options, "--out", "gear.yaml")["figures"]
        return overlay(self.path("gear.yaml")), {row["name"]: row for row in figures}

    def check(self, value, expected, relative, key):
        pairs = zip(value, expected) if isinstance(expected, list) else [(value, expected)]
        for got, wanted in pairs:
            self.assertTrue(math.isclose(got, wanted, rel_tol=relative), f"{key}: {got}, not {wanted}")

    def test_the_configured_gear_is_itself(self):
        designed, _ = self.design("--size", 25, "--ratio", 100)
        shipped = configured()
        rounded = {"cup.torsion_stiffness": 0.02, "bearing.race_preload": 0.02, "bearing.viscosity": 0.02,
                   "health.stiffness_torque_span": 0.1, "indicators.lost_motion_torque": 0.01}
        for key, value in designed.items():
            self.check(value, shipped[key], rounded.get(key, 1e-5), key)

    def test_size_14_is_the_worked_example(self):
        designed, figures = self.design("--size", 14)
        example = overlay(os.path.join(tool.CHECKOUT, "config", "size_14.yaml"))
        for key in set(example) & set(designed) - OF_THE_JOINT:
            # The example rounds, and leaves its viscosity between two figures of the catalogue.
            self.check(designed[key], example[key], 0.12 if key == "bearing.viscosity" else 0.05, key)
        missing = set(example) - set(designed) - OF_THE_JOINT
        self.assertEqual({key.split(".")[0] for key in missing}, {"thermal"})
        for name in ("starting torque", "no-load torque at 2000 rpm"):
            self.check(figures[name]["gear"], figures[name]["catalogue"], 2e-3, name)

    def test_the_shipped_gears_of_other_sizes_are_what_it_writes(self):
        for size in (11, 17, 32):
            self.succeed("gear", "--size", size, "--out", "gear.yaml", "--force")
            designed = overlay(self.path("gear.yaml"))
            shipped = overlay(os.path.join(tool.CHECKOUT, "config", f"size_{size}.yaml"))
            self.assertEqual(set(designed), set(shipped))
            for key, value in designed.items():
                self.check(value, shipped[key], 2e-3, key)

    def test_every_size_and_ratio_of_the_catalogue_twists_as_it_says(self):
        for size, ratio in ((11, 50), (14, 50), (17, 120), (20, 160), (32, 80)):
            with self.subTest(size=size, ratio=ratio):
                _, figures = self.design("--size", size, "--ratio", ratio, "--force")
                twists = [row for name, row in figures.items() if name.startswith("torsion")]
                self.assertEqual(len(twists), 4)
                for row in twists:
                    self.check(row["gear"], row["catalogue"], 0.02, row["name"])

    def test_the_overlay_runs(self):
        self.design("--size", 20, "--ratio", 80)
        done = self.succeed("stiffness", "--torques", "0,34", "--config", "gear.yaml")
        self.assertNotIn("warning", done.stderr)

    def test_a_thicker_rim_is_given(self):
        designed, _ = self.design("--rim-thickness", "1.2e-3")
        self.check(designed["gear.wave_amplitude"], 0.37039e-3, 1e-3, "wave_amplitude")  # docs/gear_study.md
        self.check(designed["ring.bending_stiffness"], 871.0, 2e-3, "bending_stiffness")

    def test_figures_of_another_catalogue_are_met(self):
        slopes, breakpoints = (9e3, 15e3, 18e3), (4.0, 14.0)
        designed, figures = self.design(
            "--size", 20, "--ratio", 100, "--stiffness", "9e3,15e3,18e3", "--breakpoints", "4,14",
            "--ratings", "21,30,60,100", "--starting-torque", "0.05", "--no-load-torque", "0.12")
        self.assertEqual(designed["life.rated_torque"], 21.0)
        twist = 4.0 / slopes[0] + 10.0 / slopes[1] + 46.0 / slopes[2]
        self.check(figures["torsion at 60 N.m"]["gear"], math.degrees(twist) * 60.0, 1e-3, "torsion")
        self.assertEqual(designed["cup.torsion_breakpoints"], list(breakpoints))
        for name, wanted in (("starting torque", 50.0), ("no-load torque at 2000 rpm", 120.0)):
            self.check(figures[name]["gear"], wanted, 2e-3, name)

    def test_an_unlisted_ratio_is_scaled_from_its_own_size(self):
        report = self.succeed_json("gear", "--size", 14, "--ratio", 60, "--out", "gear.yaml")
        self.assertEqual(report["catalogue"], "size 14, ratio 50 scaled")
        twist = math.degrees(2.0 / 3.4e3) * 60.0
        self.check(report["figures"][0]["catalogue"], twist, 1e-9, report["figures"][0]["name"])

    def test_bad_requests_are_named(self):
        for options, reason in ((("--stiffness", "9e3,15e3"), "K1, K2, K3 > 0"), (("--breakpoints", "14,4"), "T1 < T2"),
                                (("--starting-torque", "1e-4"), "other friction alone is"),
                                (("--ratings", "21,30,60,0"), "ratings needs four values > 0")):
            self.fail_with(1, [reason], "gear", *options, "--out", "gear.yaml")
        self.fail_with(2, ["--ratio", "30 ... 320"], "gear", "--ratio", "7", "--out", "gear.yaml")
        self.fail_with(2, ["--size"], "gear", "--size", "1000", "--out", "gear.yaml")
        self.write("gear.yaml", "")
        self.fail_with(1, ["gear.yaml exists"], "gear", "--out", "gear.yaml")


class Checks(tool.ToolTest):
    JAMMED = ("--set", "gear.teeth_flexspline=160", "--set", "gear.teeth_circular_spline=162")

    def test_a_jammed_gear_is_warned_of_and_does_not_run(self):
        reason = ["the teeth jam without load", "gear.wave_amplitude = 0.00035 [m] should be near 0.000436"]
        self.fail_with(1, reason, "simulate", "--duration", "0.01", "--torque", "0.5", "--out", "run.csv", *self.JAMMED)
        warned = self.succeed("stiffness", "--torques", "5", *self.JAMMED).stderr
        for part in reason:
            self.assertIn(part, warned)

    def test_the_shipped_gears_have_no_warning(self):
        for overlays in ((), ("--config", "size_14.yaml"), ("--config", "golden.yaml"), ("--config", "as_built.yaml")):
            with self.subTest(overlays=overlays):
                self.assertEqual(self.succeed("stiffness", "--torques", "5", *overlays).stderr, "")

    def test_what_does_not_go_together_is_warned_of(self):
        for assignment, text in (("gear.wave_amplitude=0.362e-3", "gear.wave_amplitude = 0.000362 [m] should be near"),
                                 ("ring.bending_stiffness=20.0", "ring.bending_stiffness = 20 [N.m/rad] should be"),
                                 ("bearing.race_preload=20000.0", "efficiency"),
                                 ("mesh.flank_clearance=40.0e-6", "no tooth in contact")):
            with self.subTest(assignment=assignment):
                self.assertIn(text, self.succeed("stiffness", "--torques", "5", "--set", assignment).stderr)


if __name__ == "__main__":
    tool.main()
