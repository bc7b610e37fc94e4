# SPDX-License-Identifier: BSD-3-Clause
"""The shipped arms: masses of the maker, and the torques of their check-ups against rigid bodies in numpy, read from
the URDF by this file alone."""
import csv
import glob
import os
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
        """Of each joint: its point and axis; mass, centre and tensor about it of the link that it moves."""
        rotation, point, placed = np.eye(3), np.zeros(3), []
        for joint, angle in zip(self.joints, angles):
            turned, shift = pose(joint.find("origin"))
            point = point + rotation @ shift
            axis = np.array([float(value) for value in joint.find("axis").get("xyz").split()])
            rotation = rotation @ turned @ turn(axis, angle)
            inertial = self.links[joint.find("child").get("link")]
            own, centre = pose(inertial.find("origin"))
            i = {key: float(value) for key, value in inertial.find("inertia").attrib.items()}
            tensor = np.array([[i["ixx"], i["ixy"], i["ixz"]], [i["ixy"], i["iyy"], i["iyz"]],
                               [i["ixz"], i["iyz"], i["izz"]]])
            tensor = rotation @ own @ tensor @ own.T @ rotation.T
            placed.append((point, rotation @ axis, float(inertial.find("mass").get("value")),
                           point + rotation @ centre, tensor))
        return placed

    def torque(self, joint, angles, acceleration, gravity):
        """Of one joint that turns alone, the others at rest [N.m]."""
        placed = self.place(angles)
        point, axis = placed[joint][:2]
        torque = 0.0
        for _, _, mass, centre, tensor in placed[joint:]:
            arm = np.cross(axis, centre - point)
            torque += (mass * arm @ arm + axis @ tensor @ axis) * acceleration - mass * arm @ gravity
        return torque


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
        with open(self.path("level.csv"), newline="", encoding="utf-8") as file:
            first = next(csv.DictReader(file))
        return [float(first[joint["short_name"] + "_torque"]) for joint in arm["joints"]]

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
                wanted = bodies.torque(number, [0.0] * 6, 0.0, np.array(arm["gravity"]))
                self.assertAlmostEqual(torque, wanted, delta=1e-6, msg=f"{name} joint {number}")

    def test_check_ups_stay_within_the_limits_and_move_rigid_bodies(self):
        for name in names():
            arm, bodies = description(name), Bodies(name)
            for number, joint in enumerate(arm["joints"]):
                self.succeed("checkup", "--arm", name, "--joint", joint["short_name"], "--out", "a.csv", "--force")
                with open(self.path("a.csv"), newline="", encoding="utf-8") as file:
                    rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
                own, short = joint["limits"], joint["short_name"]
                speed = max(abs(row[short + "_velocity"]) for row in rows)
                self.assertTrue(0.8 * min(own["speed"], 3.1) < speed < own["speed"], f"{name} {short}: {speed}")
                for row in rows[::400]:
                    angles = [row[other["short_name"] + "_position"] for other in arm["joints"]]
                    wanted = bodies.torque(number, angles, row[short + "_acceleration"], np.array(arm["gravity"]))
                    self.assertAlmostEqual(row[short + "_torque"], wanted, delta=1e-6 + 1e-6 * abs(wanted))
                for other in arm["joints"]:
                    torque = max(abs(row[other["short_name"] + "_torque"]) for row in rows)
                    self.assertLessEqual(torque, other["limits"]["torque"], f"{name} {other['name']}")

    def test_an_arm_is_like_another_but_for_its_keys(self):
        self.write("tilted.yaml", f"like: {ARMS}/ur10.yaml\ngravity: [0.0, 9.82, 0.0]\n")
        summary = self.succeed_json("checkup", "--arm", "tilted.yaml", "--joint", "base", "--out", "a.csv")
        self.assertGreater(summary["largest_torque"], 100.0)  # the base carries weight
        self.write("twice.yaml", f"like: {ARMS}/ur10e.yaml\ngravity: [0.0, 9.82, 0.0]\n")
        self.succeed("checkup", "--arm", "twice.yaml", "--joint", "base", "--out", "twice.csv")
        for text, parts in (("like: no.yaml\n", ["no.yaml cannot be read"]),
                            ("like: bad.yaml\n", ["bad.yaml", "more than 8 files in a row"]),
                            (f"like: {ARMS}/ur3.yaml\nweight: 3\n", ["bad.yaml:2: unknown parameter weight = 3"]),
                            ("- 3\n", ["keys and values expected"])):
            self.write("bad.yaml", text)
            self.fail_with(1, parts, "checkup", "--arm", "bad.yaml", "--out", "b.csv")


if __name__ == "__main__":
    tool.main()
