# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin simulate`."""
import csv
import glob
import math
import os
import signal
import subprocess
import sys

import rosbag

import tool


class Simulate(tool.ToolTest):
    def rows(self, name):
        with open(self.path(name)) as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def test_bag_holds_the_nodes_topics_at_their_rates(self):
        self.succeed("simulate", "--duration", 0.2, "--torque", 0.4, "--out", "a.bag")
        with rosbag.Bag(self.path("a.bag")) as bag:
            counts = {topic: info.message_count for topic, info in bag.get_type_and_topic_info().topics.items()}
        self.assertEqual(counts, {"/joint_twin/joint_states": 200, "/joint_twin/encoders": 200,
                                  "/joint_twin/contact_forces": 20, "/joint_twin/health": 2,
                                  "/joint_twin/stress": 2})
        for _, message in tool.series(self.path("a.bag"), "/joint_twin/joint_states"):
            self.assertEqual(message.name, ["joint_motor", "joint"])

    def test_an_output_without_a_row_is_an_error(self):
        self.fail_with(1, ["a.csv would be empty, because the run of 0.2 s is shorter than a period of "
                           "publish.joint_states_rate = 0.001 Hz"], "simulate", "--duration", 0.2, "--torque", 0.4,
                       "--set", "publish.joint_states_rate=0.001", "--out", "a.csv")

    def test_constant_torque_does_not_time_out(self):
        summary = self.succeed_json("simulate", "--duration", 0.3, "--torque", 0.25, "--out", "a.csv")
        self.assertEqual(summary["command_timeouts"], 0)
        rows = self.rows("a.csv")
        self.assertEqual(len(rows), 300)
        self.assertEqual({row["motor_torque"] for row in rows}, {0.25})
        self.assertEqual(rows[-1]["time"], 0.3)
        self.assertGreater(rows[-1]["motor_angle"], 1.0)
        self.assertEqual(rows[-1]["motor_angle"], summary["motor_angle"])

    def test_report_of_a_bag(self):
        bag = self.path("run.bag")
        self.succeed("simulate", "--torque", 0.2, "--duration", 0.2, "--out", bag)
        report = subprocess.run([sys.executable, os.path.join(tool.CHECKOUT, "scripts", "report_bag.py"), bag],
                                stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
        self.assertRegex(report, r"on the response surface +0  %")
        self.assertRegex(report, r"solver +every step converged")

    def test_losses_warm_the_drive_in_csv_and_bag_alike(self):
        run = ("simulate", "--duration", 0.4, "--torque", 0.5, "--set", "publish.health_rate=100.0")
        for model, warmer in (("none", False), ("two_nodes", True)):
            for kind in ("csv", "bag"):
                self.succeed(*run, "--set", f"thermal.model={model}", "--out", f"{model}.{kind}")
            rows = {round(row["time"], 6): row for row in self.rows(f"{model}.csv")}
            self.assertEqual(max(rows[0.4]["temperature"], rows[0.4]["housing_temperature"]) > 25.0, warmer)
            self.assertEqual(rows[0.05]["temperature"], 25.0)  # until the end of the first period
            messages = [message for _, message in tool.series(self.path(f"{model}.bag"), "/joint_twin/health")]
            self.assertEqual(messages[-1].grease_temperature, rows[0.4]["temperature"])
            self.assertEqual(messages[-1].housing_temperature, rows[0.4]["housing_temperature"])

    def test_a_torque_at_the_joint_beyond_its_limit_is_counted(self):
        for load, is_beyond in ((60, False), (200, True)):
            done = self.succeed("simulate", "--duration", 0.1, "--torque", 0, "--load", load, "--set",
                                "brake.engaged_at_start=true", "--out", f"{load}.csv")
            self.assertEqual("beyond output.torque_limit" in done.stderr, is_beyond, done.stderr)
            self.assertNotIn("clamped", done.stderr)

    def test_a_row_of_a_profile_acts_from_its_time_on(self):
        self.write("p.csv", "motor_torque,time,load_torque,brake\n0.4,0,2.5,0\n-0.2,0.1,-1.5,0\n0.3,0.2,0,1\n")
        self.succeed("simulate", "--profile", "p.csv", "--duration", 0.25, "--out", "a.csv")
        for row in self.rows("a.csv"):
            until = row["time"] - 1e-9  # what acted in the step that ends then
            expected = (0.4, 2.5, 0.0) if until < 0.1 else (-0.2, -1.5, 0.0) if until < 0.2 else (0.3, 0.0, 1.0)
            self.assertEqual((row["motor_torque"], row["load_torque"], row["brake"]), expected, row["time"])

    def test_scenes_agree(self):
        """The same profile on the full ring and on the response surface: the torsion and the joint's torque."""
        self.write("p.csv", "time,motor_torque,load_torque,brake\n0,0.2,0,0\n0.1,0.3,15,0\n0.3,-0.1,15,0\n"
                            "0.5,0,15,1\n0.7,-0.25,-15,0\n")
        series = {}
        for scene in ["full_ring", "auto"]:
            done = self.run_tool("simulate", "--profile", "p.csv", "--duration", 1.0, "--out", f"{scene}.csv",
                                 "--set", f"solver.scene={scene}", environment={"XDG_CACHE_HOME": self.directory})
            self.assertEqual(done.returncode, 0, done.stderr)
            tables = glob.glob(self.path("harmonic_joint_twin/surface_*.bin"))
            self.assertEqual(len(tables), 1 if scene == "auto" else 0)
            series[scene] = self.rows(f"{scene}.csv")
        self.assertNotEqual(series["full_ring"], series["auto"])

        def difference(value):
            pairs = zip(series["full_ring"], series["auto"])
            return (sum((value(full) - value(auto)) ** 2 for full, auto in pairs) / len(series["auto"])) ** 0.5

        arc_second = math.pi / 180 / 3600
        self.assertLess(difference(lambda row: row["motor_angle"] / 101 - row["output_angle"]), 0.5 * arc_second)
        self.assertLess(difference(lambda row: row["joint_torque"]), 1e-3 * 108)

    def test_duration_defaults_to_the_profiles(self):
        self.write("p.csv", "time,motor_torque\n0,0.1\n0.05,0.2\n")
        self.assertEqual(self.succeed_json("simulate", "--profile", "p.csv", "--out", "a.bag")["simulated_time"], 0.05)

    def test_same_input_gives_the_same_bytes(self):
        for name in ["a", "b"]:
            for kind in ["bag", "csv"]:
                self.succeed("simulate", "--duration", 0.1, "--torque", 0.4, "--load", 3, "--out", f"{name}.{kind}")
        for kind in ["bag", "csv"]:
            self.assertEqual(tool.read_bytes(self.path(f"a.{kind}")), tool.read_bytes(self.path(f"b.{kind}")))

    def test_torque_beyond_the_limit_is_clamped_and_counted(self):
        for sign in (1.0, -1.0):
            done = self.succeed("simulate", "--duration", 0.02, "--torque", 1e9 * sign, "--load", 1e9 * sign, "--out",
                                f"{sign}.csv")
            self.assertIn("200 steps had a motor torque command beyond motor.torque_limit", done.stderr)
            self.assertIn("200 steps had a load torque beyond output.load_torque_limit", done.stderr)
            self.assertEqual({(row["motor_torque"], row["load_torque"]) for row in self.rows(f"{sign}.csv")},
                             {(2.87 * sign, 284.0 * sign)})

    def test_bad_profiles_are_refused_with_their_place(self):
        for text, parts in [("time,motor_torque\n0,0.1\n0.1,\n", [":3: column 'motor_torque' is empty"]),
                            ("time,motor_torque\n0,0.1\n0.1\n", [":3: too few columns"]),
                            ("time,motor_torque\n0,0.1,7\n", [":2: too many columns"]),
                            ("time,motor_torque\n0,nan\n", [":2: column 'motor_torque': 'nan' is not a finite"]),
                            ("time,motor_torque\n0,zero\n", ["'zero' is not a finite number"]),
                            ("time,motor_torque\n0,1\n0,1\n", [":3: column 'time' must be >= 0"]),
                            ("time,motor_torque\n-1,1\n", [":2: column 'time' must be >= 0"]),
                            ("time,motor_torque\n0,1\n9.3e9,1\n",
                             [":3: column 'time' = 9.3e+9 [s] is out of range, allowed: 0 ... 1.0e+9 [s]"]),
                            ("time,motor_torque\n0,1\n1e300,1\n", [":3: column 'time' = 1.0e+300 [s] is out of range"]),
                            ("time,motor_torque,brake\n0,1,2\n", [":2: column 'brake' must be 0 or 1"]),
                            ("time,torque\n0,1\n", [":1: column 'motor_torque' is missing"]),
                            ("time,motor_torque\n", ["has no rows"]), ("", ["p.csv"])]:
            with self.subTest(text):
                self.write("p.csv", text)
                self.fail_with(1, parts, "simulate", "--profile", "p.csv", "--out", "a.bag", "--json")
                self.assertFalse(os.path.exists(self.path("a.bag")))
        self.fail_with(1, ["nowhere.csv cannot be read"], "simulate", "--profile", "nowhere.csv", "--out", "a.bag")

    def test_existing_output_is_kept_without_force(self):
        arguments = ["simulate", "--duration", 0.01, "--torque", 0.1, "--out"]
        for name in ["a.bag", "a.csv"]:
            self.write(name, "precious")
            self.fail_with(1, [f"{name} exists; --force overwrites it"], *arguments, name)
            self.assertEqual(tool.read_bytes(self.path(name)), b"precious")
            self.succeed(*arguments, name, "--force")
        self.fail_with(1, ["cannot be written"], *arguments, "nowhere/a.bag")

    def test_interrupts_close_the_bag(self):
        for number in [signal.SIGTERM, signal.SIGINT]:
            name = f"{int(number)}.bag"
            code, errors = self.interrupt_while_writing(name, number, "simulate", "--duration", "1000",
                                                        "--torque", "0.4", "--out", name)
            self.assertEqual(code, 128 + number)
            self.assertIn(b"readable up to here", errors)
            self.assertGreater(len(tool.raw_messages(self.path(name))), 10)


if __name__ == "__main__":
    tool.main()
