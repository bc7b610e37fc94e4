# SPDX-License-Identifier: BSD-3-Clause
"""The static analyses and the command line of the offline tool."""
import csv
import glob
import json
import math
import os
import shutil

import tool


class CommandLine(tool.ToolTest):
    def test_the_list_of_faults_fits_a_terminal(self):
        lines = self.succeed("faults").stdout.splitlines()
        self.assertLessEqual(max(map(len, lines)), 100)
        self.assertIn("bearing_cage", lines)

    def test_help_says_which_way_a_torque_turns(self):
        self.assertIn("negative angles", " ".join(self.succeed("stiffness", "--help").stdout.split()))

    def test_help_and_version_end_with_0(self):
        self.assertIn("SI units", self.succeed("--help").stdout)
        self.assertRegex(self.succeed("--version").stdout, r"^joint_twin \d+\.\d+\.\d+$")

    def test_wrong_parameters_are_named(self):
        self.fail_with(1, ["gear.wave_amplitude = 0.5 [m] is out of range, allowed: 0 ... 0.01 [m]"],
                       "insert", "--json", "--set", "gear.wave_amplitude=0.5")
        self.fail_with(1, ["unknown parameter gear.wave_amplitud ", "did you mean gear.wave_amplitude?"],
                       "insert", "--set", "gear.wave_amplitud=0.3e-3")
        overlay = self.write("overlay.yaml", "contact:\n  stiffness: stiff\n")
        self.fail_with(1, [f"{overlay}:2: contact.stiffness = 'stiff'", "[N/m]"],
                       "insert", "--config", overlay)
        self.fail_with(1, ["nowhere.yaml: cannot be read"], "insert", "--config", "nowhere.yaml")
        self.fail_with(1, ["no default configuration in 'nowhere'"], "insert", "--config-dir", "nowhere")

    def test_config_dir_comes_from_the_environment_too(self):
        done = self.run_tool("insert", environment={"HJT_CONFIG_DIR": self.directory})
        self.assertEqual(done.returncode, 1)
        self.assertIn(self.directory, done.stderr)

    def test_an_installed_tool_reads_the_installed_configuration(self):
        given = json.loads(self.succeed("parameters", "--json").stdout)
        folder = self.path("prefix/lib/harmonic_joint_twin")
        os.makedirs(folder)
        shutil.copy(self.executable, folder)
        shutil.copytree(os.path.join(tool.CHECKOUT, "config"), self.path("prefix/share/harmonic_joint_twin/config"))
        gear = self.path("prefix/share/harmonic_joint_twin/config/gear.yaml")
        with open(gear) as file:
            text = file.read()
        self.write(gear, text.replace("wave_amplitude: 0.35e-3", "wave_amplitude: 0.34e-3"))
        self.executable = os.path.join(folder, os.path.basename(self.executable))
        installed = self.succeed_json("parameters", "--config", "config/joints/elbow.yaml")
        self.assertEqual((given["gear"]["wave_amplitude"], installed["gear"]["wave_amplitude"]), (0.35e-3, 0.34e-3))
        self.assertEqual(installed["joint"]["name"], "elbow_joint")

    def test_a_tool_copied_without_its_files_says_how_to_name_them(self):
        folder = self.path("bare")
        os.makedirs(folder)
        shutil.copy(self.executable, folder)
        for library in glob.glob(os.path.join(os.path.dirname(self.executable), "..", "lib*.so")):
            shutil.copy(library, folder)
        self.executable = os.path.join(folder, os.path.basename(self.executable))
        bare = {"LD_LIBRARY_PATH": folder + ":" + os.environ.get("LD_LIBRARY_PATH", "")}
        done = self.run_tool("stiffness", "--torques", "5", environment=bare)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        for part in (folder, "no default configuration found", "--config-dir or HJT_CONFIG_DIR"):
            self.assertIn(part, done.stderr)
        bare["HJT_CONFIG_DIR"] = os.path.join(tool.CHECKOUT, "config")
        self.assertEqual(self.run_tool("stiffness", "--torques", "5", environment=bare).returncode, 0)

    def test_files_that_parameters_name_lie_beside_the_default_configuration(self):
        folder = self.path("own")
        shutil.copytree(os.path.join(tool.CHECKOUT, "config"), folder)
        named = self.succeed_json("parameters", "--config-dir", folder)["indicators"]["signatures"]
        self.assertTrue(named.startswith(folder) and os.path.exists(named), named)
        self.assertEqual(self.succeed_json("parameters")["indicators"]["signatures"], "signatures/size_25.yaml")

    def test_later_overlay_wins_and_set_wins_over_all(self):
        first = self.write("first.yaml", "motor:\n  torque_limit: 1.0\n")
        second = self.write("second.yaml", "motor:\n  torque_limit: 2.0\n")
        overlays = ["--config", first, "--config", second]
        self.assertEqual(self.succeed_json("parameters", *overlays)["motor"]["torque_limit"], 2.0)
        given = self.succeed_json("parameters", "--set", "motor.torque_limit=2.5", *overlays)
        self.assertEqual(given["motor"]["torque_limit"], 2.5)

    def test_parameters_describe_themselves(self):
        text = self.succeed("parameters").stdout
        self.assertRegex(text, r"(?m)^gear\.wave_amplitude: 0\.00035  # \[m\] ")
        table = self.succeed("parameters", "--markdown").stdout
        self.assertEqual(table.count("\n"), text.count("\n") + 2)


class Insertion(tool.ToolTest):
    def test_json_has_the_promised_keys(self):
        self.assertEqual(set(self.succeed_json("insert")),
                         {"wave_generator_force_max", "wave_generator_force_min", "wave_generator_force_sum",
                          "teeth_in_contact", "tension_min", "tension_max", "radius_major_axis", "radius_minor_axis",
                          "bending_force_max", "residual", "iterations", "solve_time"})

    def test_table_names_units(self):
        text = self.succeed("insert", "--config", "golden.yaml").stdout
        self.assertRegex(text, r"wave generator force, largest +6\.29\d* N\n")

    def test_csv_holds_every_tooth_and_is_not_overwritten_unasked(self):
        result = self.succeed_json("insert", "--csv", "teeth.csv")
        with open(self.path("teeth.csv")) as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 200)
        self.assertEqual(max(float(row["wave_generator_force"]) for row in rows), result["wave_generator_force_max"])
        self.assertEqual(min(float(row["rim_tension"]) for row in rows), result["tension_min"])
        before = tool.read_bytes(self.path("teeth.csv"))
        self.fail_with(1, ["teeth.csv exists; --force overwrites it"], "insert", "--csv", "teeth.csv", "--json")
        self.assertEqual(tool.read_bytes(self.path("teeth.csv")), before)
        self.succeed("insert", "--csv", "teeth.csv", "--force")

    def test_no_equilibrium_is_a_failure(self):
        self.fail_with(1, ["no equilibrium found for the insertion", "raise solver.max_iterations from 1 to"],
                       "insert", "--json", "--config", "golden.yaml", "--set",
                       "solver.max_iterations=1", "--set", "solver.max_step_cuts=0", "--set",
                       "contact.stiffness=1.0e+12")


class Stiffness(tool.ToolTest):
    def test_rows_are_those_of_the_locked_wave_generator(self):
        rows = self.succeed_json("stiffness", "--torques", "5,14,48", "--config", "golden.yaml", "--set",
                                 "cup.torsion_stiffness=[31.0e+3, 50.0e+3, 57.0e+3]")["rows"]
        self.assertEqual([row["torque"] for row in rows], [5.0, 14.0, 48.0])
        for row, angle in zip(rows, [-0.169142e-3, -0.472083e-3, -1.233447e-3]):
            self.assertAlmostEqual(row["output_angle"] / angle, 1.0, delta=1e-4)
        self.assertEqual(set(rows[0]), {"torque", "output_angle", "wave_generator_torque", "housing_torque",
                                        "cup_rotation", "teeth_loaded", "mesh_force_max", "wave_generator_force_sum",
                                        "residual", "stress", "stress_max"})

    def test_the_torques_on_the_gear_add_up_to_none(self):
        for row in self.succeed_json("stiffness", "--torques", "5,-48")["rows"]:
            self.assertAlmostEqual(row["housing_torque"] - row["wave_generator_torque"], row["torque"], delta=1e-6)
            self.assertLess(row["cup_rotation"] * row["torque"], 0.0)

    def test_csv_holds_every_tooth_at_every_torque(self):
        rows = self.succeed_json("stiffness", "--torques", "14,48", "--csv", "teeth.csv")["rows"]
        with open(self.path("teeth.csv")) as file:
            teeth = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        self.assertEqual([(tooth["torque"], tooth["tooth"]) for tooth in teeth],
                         [(torque, i) for torque in (14.0, 48.0) for i in range(200)])
        for row in rows:
            own = [tooth for tooth in teeth if tooth["torque"] == row["torque"]]
            self.assertEqual(max(abs(tooth["mesh_force"]) for tooth in own), row["mesh_force_max"])
            self.assertEqual(sum(tooth["mesh_force"] != 0.0 for tooth in own), row["teeth_loaded"])
            mean = sum(tooth["angle_deviation"] for tooth in own) / len(own)
            self.assertAlmostEqual(mean / row["cup_rotation"], 1.0, delta=1e-9)
        self.fail_with(1, ["teeth.csv exists; --force overwrites it"], "stiffness", "--torques", "14", "--csv",
                       "teeth.csv")

    def test_one_torque_is_enough_for_another_size(self):
        size_14 = ("--config", os.path.join(tool.CHECKOUT, "config/size_14.yaml"))
        alone = self.succeed_json("stiffness", "--torques", "100", *size_14)["rows"]
        among = self.succeed_json("stiffness", "--torques", "75,-20,100", *size_14)["rows"]
        self.assertEqual(alone[0], among[2])
        self.assertAlmostEqual(alone[0]["output_angle"], -14.038e-3, delta=1e-6)

    def test_a_gear_that_does_not_fit_is_named(self):
        done = self.fail_with(1, ["no equilibrium found for the row of torque 5 N.m: no output angle balances the load "
                                  "(DISENGAGED, no tooth touches)", "gear.rim_thickness"],
                              "stiffness", "--torques", "5", "--config", "golden.yaml", "--set",
                              "gear.rim_thickness=0.4e-3")
        self.assertNotIn("solver.max_iterations", done.stderr)
        done = self.run_tool("stiffness", "--torques", "5", "--config", "golden.yaml", "--set",
                             "gear.teeth_flexspline=160", "--set", "gear.teeth_circular_spline=162")
        self.assertEqual(done.returncode, 0)
        self.assertIn("warning: the teeth jam without load: 78 of 160 teeth are loaded, and the wave generator "
                      "carries 13519", done.stderr)
        self.assertEqual(self.succeed("stiffness", "--torques", "5").stderr, "")

    def test_torque_may_be_negative(self):
        forth = self.succeed_json("stiffness", "--torques", "14")["rows"][0]
        back = self.succeed_json("stiffness", "--torques", "-14")["rows"][0]
        self.assertAlmostEqual(back["output_angle"], -forth["output_angle"], delta=1e-9)

    def test_teeth_are_told_on_request(self):
        row = self.succeed_json("stiffness", "--torques", "48", "--teeth", "--config", "golden.yaml")["rows"][0]
        teeth = row["teeth"]
        self.assertEqual(set(teeth), {"tooth_x", "tooth_y", "radius", "angle_deviation", "wave_generator_force",
                                      "rim_tension", "bending_force", "mesh_force", "across", "depth", "tilt", "gap",
                                      "stress_tooth_space", "stress_transition", "stress_flange"})
        for name, values in teeth.items():
            self.assertEqual(len(values), 200, name)
        self.assertEqual(sum(force != 0.0 for force in teeth["mesh_force"]), row["teeth_loaded"])
        self.assertEqual(max(map(abs, teeth["mesh_force"])), row["mesh_force_max"])
        for force, gap, depth in zip(teeth["mesh_force"], teeth["gap"], teeth["depth"]):
            self.assertEqual(force != 0.0, gap < 0.0 < depth)
        for place, cycle in row["stress"].items():
            stresses = teeth["stress_" + place.replace(" ", "_")]
            self.assertEqual((min(stresses), max(stresses)), (cycle["lowest"], cycle["highest"]), place)
        self.assertEqual(row["stress_max"], max(cycle["notch"] for cycle in row["stress"].values()))
        # The flanks carry the load: their forces across, at the mean radius of the teeth, which changes by 1 %.
        across = sum(teeth["mesh_force"]) * math.cos(math.radians(17.0))
        self.assertAlmostEqual(across * 32.05e-3 / 48.0, 1.0, delta=0.01)
        self.fail_with(2, ["--teeth", "--json"], "stiffness", "--torques", "48", "--teeth")


class Profile(tool.ToolTest):
    def test_profiles_differ_but_share_full_engagement(self):
        seen = set()
        for profile in ["trapezoid", "involute", "cycloid", "double_arc"]:
            result = self.succeed_json("profile", "--set", f"mesh.profile={profile}")
            self.assertEqual(set(result), {"clearance", "tooth", "space"})
            clearance = result["clearance"]
            self.assertEqual((len(clearance["drop"]), clearance["drop"][0]), (101, 0.0))
            self.assertAlmostEqual(clearance["half_clearance"][0], -1.0e-6, delta=1e-15)
            self.assertEqual(len(result["tooth"]["below_tip"]), len(result["tooth"]["half_thickness"]))
            self.assertEqual(len(result["space"]["above_tip"]), len(result["space"]["half_width"]))
            seen.add(tuple(clearance["half_clearance"]))
        self.assertEqual(len(seen), 4)

    def test_unknown_profile_and_teeth_that_do_not_engage_are_named(self):
        self.fail_with(1, ["mesh.profile", "'round'", "trapezoid or involute or cycloid or double_arc"],
                       "profile", "--set", "mesh.profile=round")
        self.fail_with(1, ["mesh.profile needs teeth that reach into the circular spline"],
                       "profile", "--set", "mesh.profile=cycloid", "--set", "gear.tip_radius_circular_spline=33.0e-3")
        self.fail_with(1, ["do not reach into the circular spline"],
                       "profile", "--config", "golden.yaml", "--set", "gear.tip_radius_circular_spline=33.0e-3")

    def test_table_names_units(self):
        self.assertIn("half clearance [m]", self.succeed("profile").stdout)


class Ratchet(tool.ToolTest):
    KEYS = {"output_angle", "torque", "wave_amplitude", "lobe_force", "depth_max", "mesh_force_max",
            "wave_generator_force_max", "teeth_loaded", "snaps", "teeth_jumped"}

    def test_teeth_jump_from_a_soft_wave_generator_and_not_from_a_stiff_one(self):
        soft = self.succeed_json("ratchet", "--config", "golden.yaml", "--set", "contact.stiffness=3.0e+5")
        self.assertEqual(soft["end"], "teeth jumped")
        self.assertEqual(set(soft["peak"]), self.KEYS)
        self.assertEqual(soft["peak"]["torque"], max(row["torque"] for row in soft["rows"]))
        stiff = self.succeed_json("ratchet", "--torque-limit", 600)
        self.assertEqual(stiff["end"], "limit reached")
        self.assertGreater(stiff["peak"]["torque"], 600)
        self.assertEqual(stiff["peak"]["wave_amplitude"], 0.35e-3)

    def test_steep_flanks_push_the_lobes_in_and_the_double_arcs_pull_them_out(self):
        # A smaller wave also moves the teeth around, which the load resists: more than it pushes, below 11 degrees.
        for options, factor in [(["--config", "golden.yaml"], 1.0), (["--set", "mesh.tangent_angle=0.22"], 1.0),
                                ([], -1.0)]:
            with self.subTest(options):
                peak = self.succeed_json("ratchet", "--torque-limit", 300, "--lobe-stiffness", 1e7, *options)["peak"]
                self.assertLess(factor * (peak["wave_amplitude"] - 0.35e-3), -5e-6)
                self.assertAlmostEqual(peak["lobe_force"] / (1e7 * (0.35e-3 - peak["wave_amplitude"])), 1.0, delta=1e-5)
        self.assertRegex(self.succeed("ratchet", "--torque-limit", 100).stdout, r"largest torque +\d+\.\d+ N\.m")

    def test_a_search_that_gave_up_is_no_result(self):
        done = self.run_tool("ratchet", "--torque-limit", 20000, "--lobe-stiffness", 1e7, "--angle-step", 4e-4)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stdout, "end +gave up, no equilibrium")
        self.assertIn("the search ended", done.stderr)
        self.assertIn("lower bound", done.stderr)

    def test_wrong_usage(self):
        for arguments in [["--lobe-stiffness", "0"], ["--lobe-stiffness", "nan"], ["--angle-step", "0"],
                          ["--torque-limit", "-5"], ["--angle", "inf"]]:
            with self.subTest(arguments):
                self.fail_with(2, [], "ratchet", *arguments)


class Turn(tool.ToolTest):
    def test_output_follows_by_the_ratio_over_a_tooth_pitch(self):
        angle = 2 * math.pi / 200
        rows = self.succeed_json("turn", "--load", 20, "--angle-range", repr(angle), "--steps", 4)["rows"]
        self.assertEqual(set(rows[0]), {"wave_generator_angle", "output_angle", "kinematic_error",
                                        "wave_generator_torque", "housing_torque"})
        turned = rows[-1]["output_angle"] - rows[0]["output_angle"]
        self.assertAlmostEqual(turned, angle / 101, delta=1e-11)


if __name__ == "__main__":
    tool.main()
