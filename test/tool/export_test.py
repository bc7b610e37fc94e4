# SPDX-License-Identifier: BSD-3-Clause
"""The joint for other simulators: every format is read by its parser, or as XML, and holds the twin's numbers."""
import ctypes
import math
import re
import shutil
import subprocess
import xml.etree.ElementTree

import tool

RATIO = 101.0


class MuJoCo:
    """A model in MuJoCo's own simulator, under constant torques at joints; skips the test where there is none."""

    def __init__(self, test, path):
        try:
            self.library = ctypes.CDLL("libmujoco.so")
        except OSError:
            test.skipTest("no MuJoCo here (libmujoco-dev)")
        self.library.mj_loadXML.restype = self.library.mj_makeData.restype = ctypes.c_void_p
        error = ctypes.create_string_buffer(1000)
        self.model = self.library.mj_loadXML(path.encode(), None, error, len(error))
        test.assertTrue(self.model, error.value)
        self.model = ctypes.c_void_p(self.model)
        self.data = ctypes.c_void_p(self.library.mj_makeData(self.model))
        self.report = path + ".txt"

    def angles(self, steps):
        """Angles of motor and torsion [rad] after as many steps more."""
        for _ in range(steps):
            self.library.mj_step(self.model, self.data)
        self.library.mj_printData(self.model, self.data, self.report.encode())
        with open(self.report, encoding="utf-8") as file:
            angles = re.search(r"^QPOS\n(.*?)\nQVEL", file.read(), re.M | re.S).group(1)
        return [float(angle) for angle in angles.split()]


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
        # Friction: that of steady turning, off the straight line by as much as stated.
        speeds = [float(limit["velocity"]) * (i + 1) / 20 for i in range(20)]
        rows = self.succeed_json("losses", "--speeds", ",".join(str(RATIO * speed) for speed in speeds), "--loads", "0",
                                 "--config", "joints/elbow.yaml")["rows"]
        off = max(abs(float(dynamics["friction"]) + speed * float(dynamics["damping"]) -
                      RATIO * (row["gear_loss"] + row["motor"])) for speed, row in zip(speeds, rows))
        stated = float(re.search(r"straight line over the speed \(up to (\S+)\s+N\.m\)", self.export("urdf")).group(1))
        self.assertAlmostEqual(off, stated, delta=0.05 * stated)
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
                (torsion.find("axis/dynamics/friction").text, parameters["cup"]["friction_torque"]),
                (mjcf_torsion["frictionloss"], parameters["cup"]["friction_torque"]),
                (links[0].find("inertial/inertia/izz").text, armature),
                (mjcf["damping"], urdf["damping"]), (mjcf["frictionloss"], urdf["friction"]),
                (mjcf["armature"], armature), (mjcf_torsion["stiffness"], stiffness)):
            self.assertTrue(math.isclose(float(found), float(wanted), rel_tol=1e-5), (found, wanted))

    def mujoco(self, torque, *options):
        """The exported joint with a torque at its output [N.m], and its time step [s]."""
        root = xml.etree.ElementTree.fromstring(self.export("mjcf", *options))
        for joint in root.iter("joint"):  # one at the output turns motor and torsion alike
            xml.etree.ElementTree.SubElement(root.find("actuator"), "general", joint=joint.get("name"), gainprm="0",
                                             biastype="affine", biasprm=f"{torque} 0 0")
        path = self.path("joint.xml")
        xml.etree.ElementTree.ElementTree(root).write(path)
        return MuJoCo(self, path), float(root.find("option").get("timestep"))

    def test_in_mujoco_friction_holds_what_is_below_it_and_nothing_above(self):
        root = self.root("mjcf")
        motor = next(root.iter("joint"))
        friction, damping = float(motor.get("frictionloss")), float(motor.get("damping"))
        inertia = float(motor.get("armature")) + float(list(root.iter("inertial"))[1].get("diaginertia").split()[0])
        joint, step = self.mujoco(0.3 * friction)
        begin = joint.angles(round(0.1 / step))[0]
        self.assertLess(abs(joint.angles(round(1.0 / step))[0] - begin), 1e-4)
        joint, step = self.mujoco(1.5 * friction)
        duration, decay = 0.5, damping / inertia
        expected = 0.5 * friction / damping * (duration - (1.0 - math.exp(-decay * duration)) / decay)
        # The report has two digits.
        self.assertAlmostEqual(joint.angles(round(duration / step))[0], expected, delta=0.06 * expected)

    def test_in_mujoco_a_light_output_stays_on_its_spring(self):
        light, step = self.mujoco(20.0, "--config", "recorded_load.yaml")  # in steps of MuJoCo's own 2 ms: 7 rad
        self.assertLess(abs(light.angles(round(0.2 / step))[1]), 1e-3)

    def test_what_a_format_cannot_hold_stands_in_it(self):
        self.assertIn("Not in this format: stiffness in series", self.export("urdf"))
        for form in "urdf", "sdf", "mjcf":
            self.assertIn("Not represented: effect of load and temperature on the friction", self.export(form))

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


if __name__ == "__main__":
    tool.main()
