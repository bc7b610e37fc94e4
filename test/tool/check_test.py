# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin check`: what of an arm's recording is usable, and the command to run next.

Recordings of a UR5 are used where they are at hand, in HJT_TELEMETRY_DIR, else in shared/telemetry beside the checkout.
"""
import csv
import glob
import json
import os
import shlex
import unittest

import genpy
import numpy as np
import rosbag
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState, Temperature
from std_msgs.msg import Float64

import tool
from recorded import GAINS, NAMES, sound, swinging, write_csv

DRIVER_ORDER = [2, 1, 0, 3, 4, 5]
DIRECTORY = os.environ.get("HJT_TELEMETRY_DIR", os.path.join(tool.CHECKOUT, "..", "shared", "telemetry"))
RECORDINGS = {os.path.basename(path)[7:-4]: path
              for path in sorted(glob.glob(os.path.join(DIRECTORY, "ur5_cb", "*.csv")))}
MAX_LINES, MAX_COLUMNS = 25, 100


def read_csv(path):
    with open(path, encoding="ascii") as file:
        rows = list(csv.reader(file))
    kept = [i for i, name in enumerate(rows[0]) if not name.startswith("target_") or "moment" in name]
    values = np.array([[row[i] for i in kept] for row in rows[1:]], dtype=float)
    return {rows[0][i]: values[:, column] for column, i in enumerate(kept)}


def write_driver_bag(path, columns, rate=500.0, names=tool.JOINT_NAMES, with_velocity=True, with_effort=True):
    """As a UR's driver publishes: the elbow first, effort in A, a gripper on the same topic, other topics beside it."""
    time = np.arange(columns["timestamp"][0], columns["timestamp"][-1], 1.0 / rate)
    rows = {(quantity, joint): np.interp(time, columns["timestamp"], columns[f"actual_{quantity}_{joint}"])
            for quantity in ("q", "qd", "current") for joint in range(6)}
    jitter = np.random.default_rng(5)
    with rosbag.Bag(path, "w") as bag:
        for row, seconds in enumerate(time):
            at = genpy.Time(tool.START) + genpy.Duration.from_sec(seconds)
            recorded = at + genpy.Duration.from_sec(0.0005 + 0.0005 * jitter.random())
            order = [joint for joint in DRIVER_ORDER if joint < len(names)]
            state = JointState(name=[names[joint] for joint in order],
                               position=[rows["q", joint][row] for joint in order],
                               velocity=[rows["qd", joint][row] for joint in order] if with_velocity else [],
                               effort=[rows["current", joint][row] for joint in order] if with_effort else [])
            state.header.stamp = at
            bag.write("/joint_states", state, recorded)
            if row % 5 == 0:
                gripper = JointState(name=["finger_joint"], position=[0.3], velocity=[0.0], effort=[0.0])
                gripper.header.stamp = at
                bag.write("/joint_states", gripper, recorded)
                wrench = WrenchStamped()
                wrench.header.stamp = at
                bag.write("/wrench", wrench, recorded)
                bag.write("/speed_slider", Float64(1.0), recorded)
    return path


class Check(tool.ToolTest):
    def check(self, recording, *more, exit_code=0):
        done = self.run_tool("check", recording, *more, "--json")
        self.assertEqual(done.returncode, exit_code, done.stdout + done.stderr)
        return json.loads(done.stdout)

    def kinds(self, found):
        return [finding["kind"] for finding in found["findings"]]

    def lines(self, recording, *more):
        """What it prints for people, within a page."""
        printed = self.run_tool("check", recording, *more).stdout.splitlines()
        self.assertLessEqual(len(printed), MAX_LINES, printed)
        self.assertLessEqual(max(len(line) for line in printed if "joint_twin" not in line), MAX_COLUMNS, printed)
        return printed

    def run_all_next(self, found):
        for command in found["next"]:
            words = shlex.split(command)
            self.assertEqual(words[0], "joint_twin")
            done = self.run_tool(*words[1:])
            # identify answers 1 where nothing could be identified
            self.assertIn(done.returncode, (0, 1) if words[1] == "identify" else (0,), (command, done.stderr))
            self.assertTrue(done.returncode == 0 or "identif" in done.stdout + done.stderr, (command, done.stderr))

    def test_a_sound_recording_is_usable_as_it_is(self):
        write_csv(self.path("arm.csv"), sound(self))
        found = self.check("arm.csv")
        self.assertTrue(found["usable"])
        self.assertEqual((found["arm"], found["load"]), ("ur5", "arm"))
        self.assertEqual(found["arms"], ["ur10", "ur10e", "ur15", "ur16e", "ur18", "ur3", "ur3e", "ur5",
                                         "ur5e", "ur8long"])
        self.assertAlmostEqual(found["stamp_factor"], 1.0, delta=0.005)
        self.assertAlmostEqual(found["period"], 0.008, places=6)
        self.assertLessEqual(set(found["arms_alike"]), {"ur5e"})
        self.assertEqual([joint["name"] for joint in found["joints"]], NAMES)
        self.assertEqual([joint["judged"] for joint in found["joints"]], [True] * 6)
        self.assertEqual(found["next"], ["joint_twin identify arm.csv --arm ur5 --out my_arm",
                                         "joint_twin compare arm.csv --arm ur5 --report report",
                                         "joint_twin follow arm.csv --arm ur5 --out rows"])
        os.rename(self.path("arm.csv"), self.path("my arm.csv"))
        with open(self.path("none.yaml"), "w", encoding="ascii") as file:
            file.write("motor: {}\n")
        self.assertEqual(self.check("my arm.csv", "--arm", "ur5", "--config", "none.yaml")["next"][1],
                         "joint_twin compare 'my arm.csv' --arm ur5 --config none.yaml --report report")
        os.rename(self.path("my arm.csv"), self.path("arm.csv"))
        printed = self.lines("arm.csv", "--arm", "ur5e")
        self.assertIn("arm         ur5e", printed)
        self.assertEqual(sum(line.startswith(tuple(f"{name} " for name in NAMES)) for line in printed), 6)

    def test_stamps_of_another_period_are_named_and_mended(self):
        columns = sound(self, period=0.016)
        columns["timestamp"] = columns["timestamp"] / 2.0
        write_csv(self.path("fast.csv"), columns)
        found = self.check("fast.csv", exit_code=1)
        self.assertEqual(self.kinds(found), ["stamps"])
        self.assertAlmostEqual(found["stamp_factor"], 2.0, delta=0.02)
        self.assertEqual(found["next"][0], "joint_twin check fast.csv --arm ur5 --time-scale 2")
        self.assertTrue(any("--time-scale 2" in line for line in self.lines("fast.csv")))
        mended = self.check("fast.csv", "--time-scale", 2)
        self.assertTrue(mended["usable"])
        self.assertAlmostEqual(mended["period"], 0.016, places=6)
        self.assertIn("--time-scale 2", mended["next"][0])
        arm = self.succeed_json("compare", "fast.csv", "--arm", "ur5")
        self.assertEqual((arm["level"], {joint["level"] for joint in arm["joints"]}), ("NOT JUDGED", {"NOT JUDGED"}))
        self.assertIn("--time-scale 2", arm["text"])
        done = self.succeed("follow", "fast.csv", "--arm", "ur5")
        self.assertIn("--time-scale 2", done.stderr)
        self.assertNotIn("--time-scale", self.succeed("follow", "fast.csv", "--arm", "ur5", "--time-scale", 2).stderr)

    def test_a_joint_that_does_not_fit_is_named_and_not_judged(self):
        columns = sound(self)
        columns["actual_current_0"][:] = 0.0
        columns["actual_qd_1"] *= -1.0
        columns["actual_qd_2"] = np.roll(columns["actual_qd_2"], 20)
        columns["actual_qd_3"][:] = 0.0
        columns["actual_q_5"][:] = 1.0
        columns["actual_qd_5"][:] = 0.0
        write_csv(self.path("arm.csv"), columns)
        found = self.check("arm.csv")
        self.assertEqual([[finding["kind"] for finding in joint["findings"]] for joint in found["joints"]],
                         [["effort_constant"], ["velocity_sign"], ["lag"], ["velocity_zero"], [], ["at_rest"]])
        self.assertEqual([joint["judged"] for joint in found["joints"]], [False, False, False, True, True, False])
        reasons = ["EFFORT_CONSTANT", "VELOCITY_SIGN", "VELOCITY_LAG", "SOUND", "SOUND", "AT_REST"]
        self.assertEqual([joint["verdict"]["reason"] for joint in found["joints"]], reasons)
        self.assertAlmostEqual(found["joints"][2]["velocity_lag"], 0.16, delta=0.01)
        self.lines("arm.csv")
        arm = self.succeed_json("compare", "arm.csv", "--arm", "ur5")
        levels = [joint["level"] for joint in arm["joints"]]
        self.assertEqual(levels[:3], ["NOT JUDGED"] * 3)
        self.assertEqual([joint["verdict"]["reason"] for joint in arm["joints"]], reasons)
        self.assertEqual([joint["verdict"]["friction_measured"] for joint in arm["joints"]],
                         [False] * 3 + [True] * 2 + [False])
        self.assertIn("Not judged: base. The effort is zero.", arm["text"])
        done = self.succeed("follow", "arm.csv", "--arm", "ur5")
        for part in ("base: the effort is zero", "shoulder: angle and velocity differ in sign",
                     "elbow: velocity 0.1"):
            self.assertIn(part, done.stderr)

    def test_a_bag_without_effort_or_without_a_known_arm(self):
        columns = sound(self)
        write_driver_bag(self.path("mute.bag"), columns, rate=125.0, with_effort=False)
        found = self.check("mute.bag", exit_code=1)
        self.assertEqual((found["joints"], found["usable"], found["next"]), ([], False, []))
        self.assertEqual(found["missing_joints"], tool.JOINT_NAMES)
        self.assertTrue(any(line.startswith("effort      none") for line in self.lines("mute.bag")))

        write_driver_bag(self.path("crane.bag"), swinging(), rate=125.0, names=["slew", "lift"])
        found = self.check("crane.bag")
        self.assertEqual((found["arm"], found["load"], found["arms"]), (None, "unknown", []))
        self.assertEqual({joint["name"]: joint["judged"] for joint in found["joints"] if not joint["judged"]},
                         {"finger_joint": False})
        self.assertEqual({joint["name"] for joint in found["joints"]}, {"slew", "lift", "finger_joint"})
        self.assertEqual(found["next"], ["joint_twin compare crane.bag --joint lift --report report"])

        write_driver_bag(self.path("short.bag"), columns, rate=125.0, names=tool.JOINT_NAMES[:5])
        for more in ((), ("--arm", "ur5")):
            found = self.check("short.bag", *more, exit_code=1)
            self.assertEqual((found["missing_joints"], found["load"]), (["wrist_3_joint"], "unknown"))
        self.assertTrue(any("the effort of wrist_3_joint" in line for line in self.lines("short.bag", "--arm", "ur5")))
        self.fail_with(1, ["no messages on /states", "/joint_states"], "check", "short.bag", "--topic", "/states")

    def test_velocity_may_be_empty_and_a_temperature_is_found(self):
        write_driver_bag(self.path("arm.bag"), sound(self), rate=125.0, with_velocity=False)
        with rosbag.Bag(self.path("arm.bag"), "a") as bag:
            bag.write("/elbow/temperature", Temperature(temperature=31.0), genpy.Time(tool.START))
        found = self.check("arm.bag")
        self.assertEqual({joint["has_velocity"] for joint in found["joints"]}, {False})
        self.assertEqual([joint["judged"] for joint in found["joints"]], [True] * 6)
        self.assertEqual(found["temperature"], "/elbow/temperature")
        self.assertIsNone(found["stamp_factor"])

    def test_gains_that_the_controller_states_count_unless_set(self):
        columns = swinging()
        rows = len(columns["timestamp"])
        gains = [11.98, 11.98, 9.84, 10.76, 10.76, 10.76]
        for joint, gain in enumerate(gains):
            rests = columns["timestamp"] < 2.0
            speed = columns[f"actual_qd_{joint}"]
            columns[f"target_qd_{joint}"] = np.where(rests, 0.0, speed)
            moment = np.full(rows, 0.0 if joint == 5 else 3.0 + joint)
            columns[f"target_moment_{joint}"] = moment
            # Moving, the controller adds friction.
            columns[f"target_current_{joint}"] = moment / gain + np.where(rests, 0.0, 0.5 * np.sign(speed))
        write_csv(self.path("arm.csv"), columns)
        # Currents that hold no load are not judged.
        joints = self.check("arm.csv", "--arm", "ur5", exit_code=1)["joints"]
        for joint, gain in zip(joints[:5], gains):
            self.assertAlmostEqual(joint["torque_per_current_stated"], gain, places=6)
            self.assertEqual(joint["torque_per_current"], joint["torque_per_current_stated"])
        self.assertEqual((joints[5]["torque_per_current_stated"], joints[5]["torque_per_current"]), (None, GAINS[5]))
        self.assertIn("\ngains       base 11.98, ", self.run_tool("check", "arm.csv").stdout)
        of_options = self.check("arm.csv", "--arm", "ur5", "--set", "telemetry.torque_per_current=8.5",
                                exit_code=1)["joints"]
        self.assertEqual({joint["torque_per_current"] for joint in of_options}, {8.5})

    @unittest.skipUnless("no5" in RECORDINGS, "no recording of a UR5 at rest")
    def test_a_ur5_states_the_gains_of_its_file(self):
        joints = self.check(RECORDINGS["no5"])["joints"]
        for joint, gain in list(zip(joints, GAINS))[1:5]:
            self.assertLess(abs(joint["torque_per_current_stated"] / gain - 1.0), 0.005, joint)
        # The base of a standing arm bears nothing at rest, the last wrist next to nothing.
        self.assertEqual([joints[i]["torque_per_current_stated"] for i in (0, 5)], [None, None])

    @unittest.skipUnless(RECORDINGS, f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_sound_recordings_have_nothing_that_stops_judging(self):
        for name, path in RECORDINGS.items():
            found = self.check(path)
            print(f"{name:10} stamps {found['stamp_factor']:.4f}, effort {found['effort_factor']}, lags",
                  [None if joint["velocity_lag"] is None else round(joint["velocity_lag"], 3)
                   for joint in found["joints"]])
            findings = found["findings"] + [finding for joint in found["joints"] for finding in joint["findings"]]
            self.assertEqual([finding for finding in findings if finding["stops"]], [], name)
            # A push is no load that the arm's motion explains.
            self.assertIn(found["effort"], ("current", None) if "pushed" in name else ("current",), name)
            self.assertTrue(found["usable"] and found["load_recorded"], name)
            self.lines(path)

    @unittest.skipUnless("no5" in RECORDINGS, f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_effort_in_newton_metres_is_recognised_from_gravity(self):
        for unit, factors in (("joint_torque", GAINS), ("motor_torque", [gain / 101.0 for gain in GAINS])):
            columns = read_csv(RECORDINGS["no5"])
            for joint, factor in enumerate(factors):
                columns[f"actual_current_{joint}"] *= factor
            write_csv(self.path("torque.csv"), columns)
            found = self.check("torque.csv", exit_code=1)
            self.assertEqual((self.kinds(found), found["effort"]), (["effort_unit"], unit))
            self.assertIn(f"--set telemetry.effort={unit}", found["next"][0])
            mended = self.check("torque.csv", "--set", f"telemetry.effort={unit}")
            self.assertEqual((self.kinds(mended), mended["effort"]), ([], unit))
        follow = ("follow", "torque.csv", "--arm", "ur5", "--set", f"telemetry.effort={unit}")
        mended = self.succeed_json(*follow)["joints"]
        for one, same in zip(self.succeed_json("follow", RECORDINGS["no5"], "--arm", "ur5")["joints"], mended):
            # The gains that the controller states are not in the other file: 0.3 % apart at most.
            self.assertAlmostEqual(one["current_residual_rms"] / same["current_residual_rms"], 1.0, delta=0.01)

    @unittest.skipUnless("no5" in RECORDINGS, "no recording of a UR5 with slow motion")
    def test_a_drivers_bag_at_500_hz_works_as_it_is(self):
        write_driver_bag(self.path("ur.bag"), read_csv(RECORDINGS["no5"]))
        found = self.check("ur.bag")
        self.assertTrue(found["usable"])
        self.assertEqual((found["arm"], found["effort"], self.kinds(found)), ("ur5", "current", []))
        self.assertEqual([joint["judged"] for joint in found["joints"]], [True] * 6)
        self.assertAlmostEqual(found["period"], 0.002, places=6)
        self.lines("ur.bag")
        self.run_all_next(found)
        self.assertEqual(sorted(os.listdir(self.path("my_arm"))), sorted(f"{name}.yaml" for name in NAMES))
        with open(self.path("report/arm.json"), encoding="utf-8") as file:
            arm = json.load(file)
        self.assertEqual(arm["level"], "OK", arm)
        plain = self.succeed_json("follow", RECORDINGS["no5"], "--arm", "ur5")["joints"]
        for joint, same in zip(self.succeed_json("follow", "ur.bag", "--arm", "ur5")["joints"], plain):
            print(f"{joint['joint']:9} {joint['current_residual_rms']:.3f} A, at 125 Hz "
                  f"{same['current_residual_rms']:.3f} A")
            # Between two rows a line holds less of their noise than each of them.
            ratio = joint["current_residual_rms"] / same["current_residual_rms"]
            self.assertTrue(0.8 < ratio < 1.02, (joint, same))


if __name__ == "__main__":
    tool.main()
