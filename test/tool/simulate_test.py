# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin simulate`."""
import os
import signal
import subprocess
import sys

import rosbag

import tool


class Simulate(tool.ToolTest):
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

    def test_duration_defaults_to_the_profiles(self):
        self.write("p.csv", "time,motor_torque\n0,0.1\n0.05,0.2\n")
        self.assertEqual(self.succeed_json("simulate", "--profile", "p.csv", "--out", "a.bag")["simulated_time"], 0.05)

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

    def test_a_full_disk_keeps_what_was_recorded(self):
        limit = 2000000  # of a file [byte]
        for name in ("out.bag", "out.csv"):
            done = self.run_with_file_limit(limit, "simulate", "--torque", 0.2, "--duration", 10, "--out", name)
            self.assertEqual((done.returncode, done.stdout), (1, ""), done.stderr)
            self.assertIn(f"{name} cannot be written", done.stderr)
            self.assertFalse(os.path.exists(self.path(name)))
            if name == "out.bag":  # readable once it is indexed, and without its last chunk alone
                self.assertIn(f"{name}.active has {limit} bytes of ", done.stderr)
                self.assertIn("rosbag reindex", done.stderr)
                with rosbag.Bag(self.path(name + ".active"), "a", allow_unindexed=True) as bag:
                    for _ in bag.reindex():
                        pass
                reported = int(done.stderr.split(" bytes of ")[1].split()[0])
                self.assertGreater(len(tool.raw_messages(self.path(name + ".active"))), 0.3 * reported)

    def test_interrupts_close_the_bag(self):
        for number in [signal.SIGTERM, signal.SIGINT]:
            name = f"{int(number)}.bag"
            code, errors = self.interrupt_while_writing(name, number, "simulate", "--duration", "1000",
                                                        "--torque", "0.4", "--out", name)
            self.assertEqual(code, 128 + number)
            self.assertIn(b"contains everything up to the interrupt", errors)
            self.assertGreater(len(tool.raw_messages(self.path(name))), 10)


if __name__ == "__main__":
    tool.main()
