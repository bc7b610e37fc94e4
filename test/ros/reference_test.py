#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""`reference:=`: the node of an arm judges each joint against a report of the sound arm as compare does.

The made-up UR5 of ur5_test, and recordings of a sound UR5 where they are at hand, in HJT_TELEMETRY_DIR, else in
shared/telemetry beside the checkout."""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.parse

import numpy as np
import rosbag
import rosgraph
import rospy
import rostest
from sensor_msgs.msg import JointState

from harmonic_joint_twin.msg import Comparison, Verdict
from ros_support import LAUNCH_TIMEOUT, NO_PAGE, PACKAGE, Launch, Listener, executable, package_path, wait_until
from ur5_test import JOINTS, PERIOD, WAIT_OF_ARM, angles, run_robot
from verdict_test import MOVING, SECONDS

FASTER = 8.0  # played than stamped: the ranking of arms ends after the last row
RAISED = 1.3  # friction over that of the sound joint, in the base, which bears no weight
MOVING_SPEED = 0.05  # [rad/s]
DIRECTORY = os.environ.get("HJT_TELEMETRY_DIR", package_path("..", "shared", "telemetry"))
SOUND, LATER = (os.path.join(DIRECTORY, "ur5_cb", f"ur5_cb_{name}.csv") for name in ("no7", "no6"))
ORDER = list(JOINTS)  # of the columns too
REST = 125  # rows after a recording: the last ones of a stream are not judged


def recorded(path):
    """(seconds, angles, currents) of each row of a controller's table, and a rest after them."""
    with open(path, encoding="ascii") as file:
        rows = [(float(row["timestamp"]), [float(row[f"actual_q_{i}"]) for i in range(len(ORDER))],
                 [float(row[f"actual_current_{i}"]) for i in range(len(ORDER))]) for row in csv.DictReader(file)]
    end, *last = rows[-1]
    rows += [(end + PERIOD * (row + 1), *last) for row in range(REST)]
    return [(seconds - rows[0][0], position, current) for seconds, position, current in rows]


def raised(rows, joint="base"):
    """More of the friction that does not depend on the speed, by a share of all friction: the mean current in the
    direction of motion."""
    place = ORDER.index(joint)
    rows = list(rows)
    times, angles_of, currents = (np.array(values) for values in zip(
        *((seconds, position[place], current[place]) for seconds, position, current in rows)))
    speed = np.gradient(angles_of, times)
    direction = np.where(np.abs(speed) > MOVING_SPEED, np.sign(speed), 0.0)
    friction = np.mean((direction * currents)[direction != 0.0])
    for (seconds, position, current), added in zip(rows, (RAISED - 1.0) * friction * direction):
        yield seconds, position, [value + added if i == place else value for i, value in enumerate(current)]


class Reference(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp(prefix="reference_test_")
        self.addCleanup(shutil.rmtree, self.directory)

    def path(self, name):
        return os.path.join(self.directory, name)

    def launch(self, reference):
        port = urllib.parse.urlparse(rosgraph.get_master_uri()).port
        launch = Launch(self.path("launch.log"), "arm.launch", f"reference:={reference}", port=port)
        self.addCleanup(launch.interrupt)
        return launch

    def compare(self, recording, *arguments):
        done = subprocess.run([executable("joint_twin"), "compare", recording, "--arm", "ur5", *arguments], check=True,
                              stdout=subprocess.PIPE, text=True,
                              env={**os.environ, **NO_PAGE})
        return {joint["joint"]: joint["verdict"] for joint in json.loads(done.stdout)["joints"]}

    def play(self, rows, name):
        """Plays rows as a driver does, and writes them to a bag."""
        publisher = rospy.Publisher("/joint_states", JointState, queue_size=1000)
        self.addCleanup(publisher.unregister)
        verdicts = {joint: Listener(f"/{joint}/joint_twin/verdict", Verdict) for joint in JOINTS}
        comparisons = Listener("/wrist_3/joint_twin/comparison", Comparison)
        wait_until(lambda: publisher.get_num_connections() == 1, "the node", LAUNCH_TIMEOUT)
        comparisons.wait_for_connection()
        begin = rospy.Time.now()
        count = 0
        with rosbag.Bag(self.path(name), "w") as bag:
            for seconds, position, current in rows:
                time.sleep(max(0.0, (begin - rospy.Time.now()).to_sec() + seconds / FASTER))
                message = JointState(name=[JOINTS[joint] for joint in ORDER], position=position, effort=current)
                message.header.stamp = begin + rospy.Duration.from_sec(seconds)
                publisher.publish(message)
                bag.write("/joint_states", message, message.header.stamp)
                count += 1
        comparisons.wait_for(int(0.98 * count) - WAIT_OF_ARM, patience=60.0)
        return verdicts

    def check(self, rows, levels):
        """What the node says of the rows, which are later ones than those of the report `sound`, is what compare says
        of them."""
        launch = self.launch(self.path("sound/arm.json"))
        verdicts = self.play(rows, "later.bag")
        offline = self.compare(self.path("later.bag"), "--reference", self.path("sound"), "--json")
        self.assertEqual({joint: verdict["level"] for joint, verdict in offline.items()}, levels)
        fields = ("text", "friction_factor", "friction_lower", "friction_upper", "friction_has_interval")
        for joint, expected in offline.items():
            def is_said(joint=joint, expected=expected):
                last = verdicts[joint].messages()[-1:]
                return last and all(getattr(last[0], field) == expected[field] for field in fields)
            wait_until(lambda is_said=is_said: is_said(), f"{joint}: {expected['text']}")
            said = verdicts[joint].messages()
            worst = max(message.level for message in said if message.level != Verdict.NOT_JUDGED)
            self.assertEqual(worst, getattr(Verdict, levels[joint]), (joint, [message.text for message in said]))
            self.assertIn("friction_of_own", said[-1].evidence_names)
        launch.interrupt()  # flushes what it said
        self.assertIn("reference: " + self.path("sound/arm.json"), launch.log())
        return offline

    def test_a_joint_is_judged_by_its_own_friction(self):
        made_up = [(PERIOD * row, position, current) for row, (position, current) in enumerate(
            run_robot(self.directory, lambda seconds: angles(min(seconds, MOVING)), SECONDS, 0.0))]
        with rosbag.Bag(self.path("sound.bag"), "w") as bag:
            for seconds, position, current in made_up:
                stamp = rospy.Time.from_sec(1.0e9 + seconds)
                message = JointState(name=list(JOINTS.values()), position=position, effort=current)
                message.header.stamp = stamp
                bag.write("/joint_states", message, stamp)
        self.compare(self.path("sound.bag"), "--report", self.path("sound"), "--json")
        self.check(made_up, dict.fromkeys(ORDER, "OK"))
        worn = self.check(raised(made_up), {**dict.fromkeys(ORDER, "OK"), "base": "WARN"})
        self.assertAlmostEqual(worn["base"]["friction_factor"], RAISED, delta=0.05)

    @unittest.skipUnless(os.path.exists(SOUND), f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_a_ur5_is_judged_by_its_own_friction(self):
        self.compare(SOUND, "--report", self.path("sound"), "--json")
        self.check(recorded(LATER), dict.fromkeys(ORDER, "OK"))
        worn = self.check(raised(recorded(LATER)), {**dict.fromkeys(ORDER, "OK"), "base": "WARN"})
        self.assertAlmostEqual(worn["base"]["friction_factor"], RAISED, delta=0.1)

    def test_what_is_no_report_ends_the_node_with_the_reason(self):
        with open(self.path("arm.json"), "w", encoding="ascii") as file:
            file.write("{}\n")
        launch = self.launch(self.path("arm.json"))
        reason = self.path("base") + " holds no report of `joint_twin compare` as it is needed here"
        wait_until(lambda: "FATAL" in launch.log(), "the error", LAUNCH_TIMEOUT)
        self.assertIn(reason, launch.log())


if __name__ == "__main__":
    rospy.init_node("reference_test")
    rostest.rosrun(PACKAGE, "reference", Reference, sys.argv)
