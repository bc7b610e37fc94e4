#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the node reads from the parameter server: every shipped file starts it, every bad value ends it at once."""
import os
import signal
import sys
import tempfile
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest

from ros_support import (PACKAGE, Node, all_configuration_files, configuration_files, load_parameters, package_path,
                         wait_until)

NODE = "/twin_under_test"
EXIT_TIME = 5.0  # [s], from a signal to the end of the process


class Parameters(unittest.TestCase):
    def setUp(self):
        self.node = None

    def tearDown(self):
        if self.node is not None:
            self.node.kill()

    def start(self, files, changes=None, arguments=()):
        load_parameters(NODE, files, changes)
        self.node = Node(NODE.lstrip("/"), *arguments)

    def check_refusal(self, changes, *expected, files=None):
        self.start(configuration_files() if files is None else files, changes)
        self.assertEqual(self.node.wait_for_exit(), 1)
        self.check_output("FATAL", *expected)

    def check_output(self, *expected):
        output = self.node.output()
        for text in expected:
            self.assertTrue(text in output, f"missing: {text}; the node's last words: {output[-500:]}")

    def check_start(self, files):
        self.start(files)
        wait_until(lambda: self.node.process.poll() is not None or self.is_publishing(), "the node to publish")
        self.assertIsNone(self.node.process.poll(), self.node.output())

    def is_publishing(self):
        """The process started last, not one before it of the same name that the master still lists."""
        publishers, _, _ = rosgraph.Master("/test").getSystemState()
        if not any(topic == f"{NODE}/health" and NODE in nodes for topic, nodes in publishers):
            return False
        try:
            _, _, pid = xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(NODE)).getPid("/test")
        except (OSError, rosgraph.MasterException):
            return False
        return pid == self.node.process.pid

    def check_clean_exit(self, signal_number):
        code, duration = self.node.stop(signal_number)
        self.assertEqual(code, 0, self.node.output())
        self.assertLess(duration, EXIT_TIME)

    def test_every_joint_starts_dumps_its_parameters_and_ends_cleanly_on_sigint(self):
        names = {"base": "shoulder_pan_joint", "shoulder": "shoulder_lift_joint", "elbow": "elbow_joint"}
        for joint, name in names.items():
            with self.subTest(joint=joint):
                self.check_start(configuration_files(joint))
                self.check_clean_exit(signal.SIGINT)
                self.check_output(f'joint.name: "{name}"', "mesh.stiffness: 5.0e+7  # [N/m]")

    def test_every_other_file_starts_and_ends_cleanly(self):
        for overlays in (["recorded_load.yaml", "beside_robot.yaml"], ["as_built.yaml"], ["golden.yaml"],
                         ["size_14.yaml"], ["joints/ur5e_elbow.yaml"], ["size_11.yaml", "joints/size_0.yaml"],
                         ["size_17.yaml", "joints/size_2.yaml"], ["size_32.yaml", "joints/size_4.yaml"]):
            with self.subTest(overlays=overlays):
                self.check_start(configuration_files("elbow", overlays))
                self.check_clean_exit(signal.SIGTERM)

    def test_the_laws_of_the_thesis_are_for_the_offline_analysis_only(self):
        self.check_refusal({}, "contact.law", "polar", "normal",
                           files=configuration_files("elbow", ["thesis_insertion.yaml"]))

    def test_no_shipped_file_has_been_forgotten_here(self):
        tested = configuration_files("base") + configuration_files("shoulder") + configuration_files("elbow")
        overlays = ["as_built", "beside_robot", "golden", "real_sensors", "recorded_load", "size_14",
                    "size_11", "size_17", "size_32", "thesis_insertion", *(f"joints/size_{size}" for size in (0, 2, 4)),
                    *(f"joints/ur5e_{joint}" for joint in ("base", "shoulder", "elbow")),
                    *(f"joints/ur15_{joint}" for joint in ("base", "elbow", "wrist"))]
        tested += [package_path("config", f"{name}.yaml") for name in overlays]
        self.assertEqual(all_configuration_files(), sorted(set(tested)))

    def test_without_a_configuration_it_is_the_default_one_under_the_command_line(self):
        self.start([], {}, ["_joint/name:=mine", "_diagnostic_period:=0.5"])
        wait_until(lambda: self.node.process.poll() is not None or self.is_publishing(), "the node to publish")
        self.check_clean_exit(signal.SIGINT)
        self.check_output('joint.name: "mine"', "mesh.stiffness: 5.0e+7  # [N/m]")
        for key, value in [("joint/name", "mine"), ("mesh/stiffness", 5.0e7), ("diagnostic_period", 0.5)]:
            self.assertEqual(rospy.get_param(f"{NODE}/{key}"), value)

    def test_stages_left_out_are_refused(self):
        self.check_refusal({}, "mesh.stiffness", "missing", files=[package_path("config", "gear.yaml")])

    def test_what_is_wrong_is_named(self):
        """Missing, misspelt, out of range, of another type, and what contradicts another parameter."""
        for key, value, *parts in (
                ("motor/torque_limit", None, "[N.m]", "0 ... 10000"),
                ("motor/torqe_limit", 1.0, "unknown"),
                ("mesh/flank_angle", 17.0, "17", "[rad]", "0 ... 1.4"),
                ("motor/rotor_inertia", "1e-3 kg", "1e-3 kg", "[kg.m^2]"),
                ("brake/engaged_at_start", "false", "false"),
                ("gear/teeth_flexspline", 200.5, "200.5"),
                ("ring/bending_law", "straight", "straight", "curvature"),
                ("cup/torsion_breakpoints", [14.0, "high"], "not a number"),
                ("cup/torsion_stiffness", [31.0e3, 50.0e3], "[N.m/rad]"),
                ("manufacture/flexspline_pitch_table", "/nowhere.csv", "/nowhere.csv", "cannot be read"),
                ("solver", 3, "= 3 must be keys and values, for example solver."),
                ("faults", 3, "= 3 must be a list of {kind:"),
                ("publish/encoders_rate", 3000, "3000", "[Hz]", "10000")):
            with self.subTest(key=key, value=value):
                self.check_refusal({key: value}, key.replace("/", "."), *parts)

    def test_numbers_that_yaml_reads_as_texts_are_numbers(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write("mesh: {stiffness: 5e7}\nmotor: {rotor_inertia: 1e-04}\n"
                       "cup: {torsion_breakpoints: [14, 4.8e1]}\n")
            file.flush()
            self.check_start(configuration_files("elbow", [file.name]))
        self.check_clean_exit(signal.SIGINT)
        self.check_output("mesh.stiffness: 5.0e+7", "motor.rotor_inertia: 0.0001",
                          "cup.torsion_breakpoints: [14.0, 48.0]")

    def warning(self, files, changes, *arguments):
        """The line about what the server had before, of a node that ends at once."""
        self.start(files, changes, arguments)
        self.assertEqual(self.node.wait_for_exit(), 1)
        lines = [line for line in self.node.output().splitlines() if "has values from before this start" in line]
        return "\n".join(lines)

    def test_what_the_server_had_before_is_named_where_it_departs_from_the_shipped_files(self):
        changes = {"telemetry/effort": "joint_torque", "motor/torqe_limit": 1.0}
        files = configuration_files()[:-1]  # without the joint's own
        named = "motor/torqe_limit = 1.0, telemetry/effort = 'joint_torque'. "
        self.assertIn(f"that differ from the shipped ones: {named}", self.warning(files, changes))
        self.assertIn("that differ from the shipped ones: motor/torqe_limit = 1.0. ",
                      self.warning(files, changes, "_telemetry/effort:=joint_torque"))
        self.assertEqual(self.warning(files, changes, "--params-cleared"), "")

    def test_what_the_server_had_before_is_named_for_an_arm(self):
        left = {"arm": "ur5", "input/mode": "still", "telemetry/torque_per_current": 10.7}
        self.assertIn("that differ from the shipped ones: arm = 'ur5', input/mode = 'still', "
                      "telemetry/torque_per_current = 10.7. ",
                      self.warning([], left))
        many = configuration_files("elbow", ["size_11.yaml"])
        self.assertRegex(self.warning(many, left), "shipped ones: arm = 'ur5', (.* = .*, ){11}[0-9]+ more[.] ")

    def test_what_is_wrong_in_an_arms_file_is_named(self):
        like = "like: " + package_path("config", "arms", "ur5.yaml") + "\n"
        with tempfile.TemporaryDirectory() as folder:
            os.mkfifo(os.path.join(folder, "pipe.urdf"))
            path = os.path.join(folder, "arm.yaml")
            for text, expected in (("payload: {mass: .nan, centre: [0, 0, 0]}", "arm.yaml:2: payload.mass = .nan"),
                                   ("description: pipe.urdf", "pipe.urdf cannot be read: it is a directory")):
                with open(path, "w") as file:
                    file.write(like + text)
                self.check_refusal({"arm": path}, expected, files=[])

    def test_what_makes_no_name_with_that_of_a_joint_is_refused(self):
        for key, value in (("prefix", "a b"), ("prefix", "/../"), ("prefix", 5), ("prefix", "1_"), ("suffix", "\u00e9"),
                           ("suffix", ["_b"])):
            with self.subTest(key=key, value=value):
                self.check_refusal({"arm": "ur5", "input/mode": "motion", key: value}, f"~{key}",
                                   "must be a text of letters, digits, '_' and '/'", files=[])


if __name__ == "__main__":
    rospy.init_node("parameters_test")
    with tempfile.NamedTemporaryFile("w", suffix=".config") as console:
        console.write(f"log4j.logger.ros.{PACKAGE}=DEBUG\n")  # the parameters that the node has read
        console.flush()
        os.environ["ROSCONSOLE_CONFIG_FILE"] = console.name
        rostest.rosrun(PACKAGE, "parameters", Parameters, sys.argv)
