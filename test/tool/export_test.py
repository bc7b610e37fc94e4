# SPDX-License-Identifier: BSD-3-Clause
"""The joint for other simulators: every format is read by its parser, or as XML, and holds the twin's numbers."""
import math
import shutil
import subprocess
import xml.etree.ElementTree

import tool

RATIO = 101.0


class Export(tool.ToolTest):
    def export(self, form, *options):
        return self.succeed("export", "--format", form, "--config", "joints/elbow.yaml", *options).stdout

    def parameters(self):
        return self.succeed_json("parameters", "--config", "joints/elbow.yaml")

    def root(self, form):
        return xml.etree.ElementTree.fromstring(self.export(form))

    def test_urdf(self):
        joint = self.root("urdf").find("joint")
        self.assertEqual(joint.get("name"), "elbow_joint")
        dynamics, limit = joint.find("dynamics").attrib, joint.find("limit").attrib
        motor = self.parameters()["motor"]
        self.assertAlmostEqual(float(limit["effort"]), RATIO * motor["torque_limit"], delta=0.01)
        self.assertAlmostEqual(float(limit["velocity"]), motor["speed_limit"] / RATIO, delta=1e-4)
        # Friction at half speed: that of steady turning, off the straight line by no more than stated.
        speed = 0.5 * float(limit["velocity"])
        row = self.succeed_json("losses", "--speeds", RATIO * speed, "--loads", "0", "--config",
                                "joints/elbow.yaml")["rows"][0]
        line = float(dynamics["friction"]) + speed * float(dynamics["damping"])
        self.assertAlmostEqual(line, RATIO * (row["gear_loss"] + row["motor"]), delta=2.0)
        if shutil.which("check_urdf"):
            with open(self.path("joint.urdf"), "w", encoding="utf-8") as file:
                file.write(self.export("urdf"))
            done = subprocess.run(["check_urdf", self.path("joint.urdf")], stdout=subprocess.PIPE, text=True,
                                  check=True)
            self.assertIn("Successfully Parsed", done.stdout)

    def test_sdf_and_mjcf_hold_inertia_and_stiffness_too(self):
        parameters = self.parameters()
        armature = RATIO**2 * (parameters["motor"]["rotor_inertia"] + parameters["motor"]["wave_generator_inertia"])
        rated = parameters["life"]["rated_torque"]
        rows = self.succeed_json("stiffness", "--torques", f"{-rated},{rated}", "--config", "joints/elbow.yaml")["rows"]
        stiffness = 2.0 * rated / (rows[0]["output_angle"] - rows[1]["output_angle"])
        urdf = self.root("urdf").find("joint/dynamics").attrib

        motor, torsion = self.root("sdf").iter("joint")
        links = list(self.root("sdf").iter("link"))
        mjcf, mjcf_torsion = (joint.attrib for joint in self.root("mjcf").iter("joint"))
        for found, wanted in (
                (motor.find("axis/dynamics/damping").text, urdf["damping"]),
                (motor.find("axis/dynamics/friction").text, urdf["friction"]),
                (torsion.find("axis/dynamics/spring_stiffness").text, stiffness),
                (links[0].find("inertial/inertia/izz").text, armature),
                (mjcf["damping"], urdf["damping"]), (mjcf["frictionloss"], urdf["friction"]),
                (mjcf["armature"], armature), (mjcf_torsion["stiffness"], stiffness)):
            self.assertTrue(math.isclose(float(found), float(wanted), rel_tol=1e-5), (found, wanted))

    def test_what_a_format_cannot_hold_stands_in_it(self):
        self.assertIn("Not in this format: stiffness in series", self.export("urdf"))
        for form in "urdf", "sdf", "mjcf":
            self.assertIn("Left out: friction by load and temperature", self.export(form))

    def test_any_name_makes_a_document(self):
        name = 'a<b> & "c" -- \'d\''
        for form in "urdf", "sdf", "mjcf":
            text = self.export(form, "--set", "joint.name=" + name)
            names = [joint.get("name") for joint in xml.etree.ElementTree.fromstring(text).iter("joint")]
            self.assertIn(name, names)

    def test_parameters_act(self):
        hot = xml.etree.ElementTree.fromstring(self.export("urdf", "--set", "input.temperature=60"))
        cold = self.root("urdf")
        damping = [float(root.find("joint/dynamics").get("damping")) for root in (hot, cold)]
        self.assertLess(damping[0], damping[1])
        self.fail_with(2, [], "export", "--format", "dae")


if __name__ == "__main__":
    tool.main()
