# SPDX-License-Identifier: BSD-3-Clause
"""The shipped arms: masses of the maker, their weights against links in numpy, read from the URDF by this file alone,
and their check-ups."""
import glob
import math
import os
import re
import xml.etree.ElementTree as xml

import numpy as np
import yaml

import tool

ARMS = os.path.join(tool.CHECKOUT, "config/arms")
# Shoulder, upper arm, forearm, wrists [kg]: Universal Robots, DH Parameters for calculations of kinematics and
# dynamics; the forearm of the UR5 as its controller reckons.
MASSES = {
    "ur3": (2.0, 3.42, 1.26, 0.8, 0.8, 0.35),
    "ur3e": (1.98, 3.4445, 1.437, 0.871, 0.805, 0.261),
    "ur5": (3.7, 8.393, 2.275, 1.219, 1.219, 0.1879),
    "ur5e": (3.761, 8.058, 2.846, 1.37, 1.3, 0.365),
    "ur10": (7.1, 12.7, 4.27, 2.0, 2.0, 0.365),
    "ur10e": (7.369, 13.051, 3.989, 2.1, 1.98, 0.615),
    "ur16e": (7.369, 10.45, 4.321, 2.18, 2.033, 0.907),
    "ur15": (9.9883, 14.9255, 6.1015, 2.089, 2.0869, 1.0666),
    "ur18": (9.9883, 14.2009, 5.52, 2.089, 2.0869, 1.0666),
    "ur8long": (9.9883, 17.0738, 7.6393, 2.089, 2.0869, 1.0666),
}
# The makers' greatest payloads [kg] and torques of base and shoulder, elbow, wrists [N.m]: data sheets, "Max. joint
# torques" and universal_robot, ur_description. That of a UR8 Long's joints is not known: a UR15's.
PAYLOAD = {"ur3": 3.0, "ur3e": 3.0, "ur5": 5.0, "ur5e": 5.0, "ur10": 10.0, "ur10e": 12.5, "ur16e": 16.0, "ur15": 15.0,
           "ur18": 18.0, "ur8long": 8.0, "ur7e": 7.5, "ur12e": 12.5}
SMALL, MIDDLE, LARGE = (56.0, 28.0, 12.0), (150.0, 150.0, 28.0), (330.0, 150.0, 56.0)
STRONG = (433.0, 204.0, 70.0)
TORQUE = {"ur3": SMALL, "ur3e": SMALL, "ur5": MIDDLE, "ur5e": MIDDLE, "ur10": LARGE, "ur10e": LARGE, "ur16e": LARGE,
          "ur15": STRONG, "ur18": STRONG, "ur8long": STRONG, "ur7e": MIDDLE, "ur12e": LARGE}
# Their reach from the base's axis to the flange, without the offsets across the arm: a2 + a3 of the same page [m].
REACH = {"ur3": 0.4569, "ur3e": 0.45675, "ur5": 0.81725, "ur5e": 0.8172, "ur10": 1.1843, "ur10e": 1.18425,
         "ur16e": 0.8384, "ur15": 1.1639, "ur18": 0.8139, "ur8long": 1.6138}
# Arms with the lengths, masses and limits of another: further names of its file.
NAMESAKES = {"ur7e": "ur5e", "ur12e": "ur10e"}


def names():
    return sorted(os.path.basename(path)[:-len(".yaml")] for path in glob.glob(os.path.join(ARMS, "*.yaml"))
                  if not os.path.islink(path))


def description(name):
    with open(os.path.join(ARMS, name + ".yaml"), encoding="utf-8") as file:
        own = yaml.safe_load(file)
    return {**description(own["like"][:-len(".yaml")]), **own} if "like" in own else own


def turn(axis, angle):
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def pose(element):
    """Rotation and shift of an <origin>."""
    roll, pitch, yaw = (float(value) for value in element.get("rpy").split())
    rotation = turn((0, 0, 1), yaw) @ turn((0, 1, 0), pitch) @ turn((1, 0, 0), roll)
    return rotation, np.array([float(value) for value in element.get("xyz").split()])


class Bodies:
    """The links of an arm in a pose, in the frame of the base."""

    def __init__(self, name):
        root = xml.parse(os.path.join(ARMS, description(name)["description"])).getroot()
        self.links = {link.get("name"): link.find("inertial") for link in root.iter("link")}
        self.joints = [joint for joint in root.iter("joint") if joint.get("type") != "fixed"]
        self.masses = [float(self.links[joint.find("child").get("link")].find("mass").get("value"))
                       for joint in self.joints]

    def place(self, angles):
        """Of each joint: its point and axis; mass and centre of the link that it moves."""
        rotation, point, placed = np.eye(3), np.zeros(3), []
        for joint, angle in zip(self.joints, angles):
            turned, shift = pose(joint.find("origin"))
            point = point + rotation @ shift
            axis = np.array([float(value) for value in joint.find("axis").get("xyz").split()])
            rotation = rotation @ turned @ turn(axis, angle)
            inertial = self.links[joint.find("child").get("link")]
            _, centre = pose(inertial.find("origin"))
            placed.append((point, rotation @ axis, float(inertial.find("mass").get("value")),
                           point + rotation @ centre))
        return placed

    def weight(self, joint, angles, gravity):
        """Torque of one joint at rest [N.m]."""
        placed = self.place(angles)
        point, axis = placed[joint][:2]
        return -sum(mass * np.cross(axis, centre - point) @ gravity for _, _, mass, centre in placed[joint:])


class Arms(tool.ToolTest):
    def test_have_the_makers_masses_and_lengths(self):
        self.assertEqual(names(), sorted(MASSES))
        for name in names():
            bodies = Bodies(name)
            self.assertEqual(tuple(bodies.masses), MASSES[name], name)
            placed = bodies.place([0.0] * 6)
            self.assertAlmostEqual(placed[1][0][0] - placed[3][0][0], REACH[name], places=9, msg=name)

    def level_torques(self, name, payload=0.0):
        """Of all joints at rest, stretched level from the first angle of a check-up [N.m], at any torque."""
        arm = description(name)
        own = {**arm, "description": os.path.join(ARMS, arm["description"]),
               "payload": {"mass": payload, "centre": [0.0, 0.0, 0.0]},
               "joints": [{**joint, "check_up": [0.0] * 6, "limits": {"speed": 10.0, "torque": 1000.0}}
                          for joint in arm["joints"]]}
        own.pop("like", None)  # has done its work
        self.write("level.yaml", yaml.safe_dump(own))
        self.succeed("checkup", "--arm", "level.yaml", "--out", "level.csv", "--force")
        first = self.rows("level.csv")[0]
        return [first[joint["short_name"] + "_torque"] for joint in arm["joints"]]

    def test_the_joints_hold_the_makers_payload_stretched_level(self):
        """The maker's torques, apart from the files' limits. Of a UR7e and UR12e too, which are names of others."""
        for name, payload in PAYLOAD.items():
            base, elbow, wrist = TORQUE[name]
            for torque, greatest in zip(self.level_torques(name, payload), (base, base, elbow, wrist, wrist, wrist)):
                self.assertLess(abs(torque), greatest, name)

    def test_further_names_lead_to_the_same_file(self):
        for name, namesake in NAMESAKES.items():
            self.assertEqual(os.readlink(os.path.join(ARMS, name + ".yaml")), namesake + ".yaml")
            for arm in (name, namesake):
                self.succeed("checkup", "--arm", arm, "--joint", "elbow", "--out", arm + ".csv")
            with open(self.path(name + ".csv"), "rb") as one, open(self.path(namesake + ".csv"), "rb") as other:
                self.assertEqual(one.read(), other.read())

    def test_stretched_arms_weigh_what_their_masses_do(self):
        """At rest, in a check-up that begins stretched and level."""
        for name in names():
            arm, bodies = description(name), Bodies(name)
            for number, torque in enumerate(self.level_torques(name)):
                wanted = bodies.weight(number, [0.0] * 6, np.array(arm["gravity"]))
                self.assertAlmostEqual(torque, wanted, delta=1e-6, msg=f"{name} joint {number}")

    def test_check_ups_stay_within_the_limits(self):
        for name in names():
            arm = description(name)
            for joint in arm["joints"]:
                self.succeed("checkup", "--arm", name, "--joint", joint["short_name"], "--out", "a.csv", "--force")
                rows = self.rows("a.csv")
                own, short = joint["limits"], joint["short_name"]
                speed = max(abs(row[short + "_velocity"]) for row in rows)
                self.assertTrue(0.8 * min(own["speed"], 3.1) < speed < own["speed"], f"{name} {short}: {speed}")
                for other in arm["joints"]:
                    torque = max(abs(row[other["short_name"] + "_torque"]) for row in rows)
                    self.assertLessEqual(torque, other["limits"]["torque"], f"{name} {other['name']}")


class Checkup(tool.ToolTest):
    def test_the_joint_alone_moves_within_the_limits_and_its_load_swings_through_zero(self):
        summary = self.succeed_json("checkup", "--arm", "ur5", "--joint", "shoulder", "--out", "a.csv")
        rows = self.rows("a.csv")
        self.assertAlmostEqual(rows[-1]["time"], summary["duration"], delta=1e-9)
        self.assertLessEqual(max(abs(row["shoulder_velocity"]) for row in rows), math.pi)
        torques = [row["shoulder_torque"] for row in rows]
        self.assertTrue(-150.0 < min(torques) < -50.0 and 50.0 < max(torques) < 150.0)
        self.assertEqual({(row["base_velocity"], row["elbow_position"]) for row in rows}, {(0.0, 0.0)})
        self.assertEqual(rows[0]["shoulder_velocity"], 0.0)
        self.assertAlmostEqual(rows[-1]["shoulder_position"], rows[0]["shoulder_position"], delta=1e-9)

    def test_all_joints_come_one_after_the_other_and_the_program_makes_the_same_moves(self):
        one = self.succeed_json("checkup", "--arm", "ur5", "--joint", "base", "--out", "one.csv")
        summary = self.succeed_json("checkup", "--arm", "ur5", "--out", "a.script", "--format", "urscript")
        self.assertGreater(summary["duration"], 5.9 * one["duration"])
        with open(self.path("a.script"), encoding="utf-8") as file:
            moves = re.findall(r"movej\(\[([^\]]*)\], a=([^,]*), v=(.*)\)", file.read())
        self.assertEqual(len(moves), summary["moves"])
        self.assertTrue(all(len(move[0].split(",")) == 6 and float(move[2]) <= math.pi for move in moves))

    def test_the_bag_holds_the_table_as_a_trajectory(self):
        for name, how in (("a.csv", "csv"), ("a.bag", "bag")):
            self.succeed("checkup", "--arm", "ur5", "--joint", "elbow", "--out", name, "--format", how)
        rows = self.rows("a.csv")
        [(_, trajectory)] = tool.series(self.path("a.bag"), "/joint_trajectory")
        self.assertEqual(trajectory.joint_names, tool.JOINT_NAMES)
        self.assertEqual(len(trajectory.points), len(rows))
        for row, point in zip(rows, trajectory.points):
            self.assertAlmostEqual(point.time_from_start.to_sec(), row["time"], delta=1e-8)
            self.assertEqual((point.positions[2], point.velocities[2], point.accelerations[2]),
                             (row["elbow_position"], row["elbow_velocity"], row["elbow_acceleration"]))

    def write_arm(self, name, *changes):
        """The UR5's file, with texts replaced."""
        urdf = os.path.join(tool.CHECKOUT, "config/arms/ur5.urdf")
        with open(os.path.join(tool.CHECKOUT, "config/arms/ur5.yaml"), encoding="utf-8") as file:
            text = file.read().replace("description: ur5.urdf", f"description: {urdf}")
        for before, after in changes:
            self.assertIn(before, text)
            text = text.replace(before, after)
        self.write(name, text)

    def test_no_program_is_written_without_limits_or_for_hours(self):
        wrists = "limits: {speed: 3.141592653589793, torque: 28.0, feedback: 14.0}"
        for before, after, text in ((wrists, "", "wrist_1_joint has no limits"),
                                    ("torque: 150.0", "torque: .nan", "arm.yaml:31: joints.0.limits.torque = .nan"),
                                    ("[0.0, -1.5707963267948966,", "[0.0, -100.0,", "joints.1.check_up = [0.0, -100.0"),
                                    ("speed: 3.141592653589793", "speed: 0.001",
                                     "take more than 3600 s: it moves at 0.000833 rad/s")):
            self.write_arm("arm.yaml", (before, after))
            self.fail_with(1, [text], "checkup", "--arm", "arm.yaml", "--joint", "base", "--out", "a.script",
                           "--format", "urscript")
            self.assertFalse(os.path.exists(self.path("a.script")))

    def test_a_payload_beyond_the_torque_limit_is_refused_by_the_joint(self):
        self.write_arm("heavy.yaml", ("mass: 0.0", "mass: 15.0"))
        self.fail_with(1, ["shoulder_lift_joint", "limit is 150"], "checkup", "--arm", "heavy.yaml", "--joint",
                       "shoulder", "--out", "a.csv")
        self.fail_with(1, ["no joint 'knee'"], "checkup", "--arm", "ur5", "--joint", "knee", "--out", "a.csv")


if __name__ == "__main__":
    tool.main()
