# SPDX-License-Identifier: BSD-3-Clause
"""The co-simulation unit: its description, and its library as a small importer runs it. Arguments: the tool, the
library that counts allocations."""
import math
import os
import pathlib
import random
import re
import shutil
import subprocess

import tool
from fmu_unit import COUNTED, ERROR, IMPORTER, OK, SCHEMAS, Fmu


class Description(Fmu):
    def test_follows_the_schema(self):
        schema = os.path.join(SCHEMAS, "fmi3", "fmi3ModelDescription.xsd")
        if not os.path.exists(schema) or not shutil.which("xmllint"):
            self.skipTest("no xmllint, or no schema in HJT_FMI_SCHEMAS = " + SCHEMAS)
        for options in ["--set", 'joint.name="a<b> & \\"c\\""'], ["--arm", "ur10e"]:
            self.unit(*options)
            done = subprocess.run(["xmllint", "--noout", "--schema", schema, self.path("a unit/modelDescription.xml")],
                                  stderr=subprocess.PIPE, universal_newlines=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_says_what_the_standard_wants_beyond_the_schema(self):
        self.check_description(self.unit("--arm", "ur5"))
        unit = self.unit()
        self.check_description(unit)
        limit = unit.variables["motor.torque_limit"]
        self.assertEqual((limit.get("unit"), limit.get("min")), ("N.m", "0.0"))
        self.assertEqual(float(limit.get("start")), self.succeed_json("parameters")["motor"]["torque_limit"])

    def check_description(self, unit):
        variables = list(unit.root.find("ModelVariables"))
        self.assertEqual(len(unit.variables), len(variables))
        self.assertEqual(len({each.get("valueReference") for each in variables}), len(variables))
        units = {each.get("name") for each in unit.root.find("UnitDefinitions")}
        by_causality = {}
        for each in variables:
            by_causality.setdefault(each.get("causality"), []).append(each)
            self.assertIn(each.get("unit", "m"), units)
            starts = each.get("start") is not None or each.find("Start") is not None
            self.assertEqual(starts, each.get("causality") in ("input", "parameter"), each.get("name"))
            continuous = each.tag == "Float64" and each.get("causality") != "parameter"
            self.assertEqual(each.get("variability") == "continuous",
                             continuous and "fault_" not in each.get("name"), each.get("name"))
        self.assertEqual([each.get("name") for each in by_causality["independent"]], ["time"])
        outputs = [each.get("valueReference") for each in by_causality["output"]]
        for part in "Output", "InitialUnknown":
            self.assertEqual([each.get("valueReference") for each in unit.root.find("ModelStructure").iter(part)],
                             outputs)
        self.assertEqual(unit.root.get("variableNamingConvention"), "structured")
        name = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*$")
        for each in variables:
            self.assertRegex(each.get("name"), name)
            is_number = each.tag in ("Float64", "Int32")
            starts = [float(value) for value in each.get("start", "").split()] if is_number else []
            self.assertIn(len(starts), (0, unit.size(each.get("name"))), each.get("name"))
            for value in starts:
                self.assertLessEqual(float(each.get("min", "-inf")), value, each.get("name"))
                self.assertGreaterEqual(float(each.get("max", "inf")), value, each.get("name"))

    def test_shows_the_functions_of_the_standard_alone(self):
        self.check_library(self.unit("--arm", "ur5"))
        self.check_library(self.unit())

    def check_library(self, unit):
        self.assertEqual(unit.version, "3.0")
        if not shutil.which("nm"):
            self.skipTest("no nm")
        symbols = subprocess.run(["nm", "-D", "--defined-only", "-f", "posix", unit.library], stdout=subprocess.PIPE,
                                 universal_newlines=True, check=True).stdout.splitlines()
        self.assertEqual([line for line in symbols if not line.startswith(("fmi2", "fmi3"))], [])
        needed = subprocess.run(["ldd", unit.library], stdout=subprocess.PIPE, universal_newlines=True,
                                check=True).stdout
        for other in "harmonic_joint_twin_core", "libkdl_parser", "libros":
            self.assertNotIn(other, needed)
        self.assertNotIn("not found", needed)

    def test_wants_a_file(self):
        self.fail_with(2, ["--out"], "export", "--format", "fmu")
        self.fail_with(2, ["--out"], "export", "--format", "urdf", "--out", self.path("joint.urdf"))
        self.fail_with(2, ["--arm"], "export", "--format", "urdf", "--arm", "ur5")
        self.fail_with(2, ["--arm"], "export", "--format", "fmu", "--out", "a.fmu", "--identified", self.directory)


class Run(Fmu):
    def test_gives_the_numbers_of_the_tool(self):
        """Values of the export, and values that the importer sets, are the same."""
        options = ["--set", "thermal.model=two_nodes", "--set", "sensors.motor_noise=1.0e-4", "--set",
                   "input.temperature=31", "--set", "cup.torsion_breakpoints=[20.0, 41.0]"]
        row = self.simulated("--torque", 0.35, "--load", 20, "--duration", 0.2, "--fault", "tooth_wear:0.3:20",
                             *options)
        unit = self.unit(*options)
        unit.start(motor_torque=0.35, load_torque=20.0, fault_tooth_wear=0.3, fault_tooth_wear_place=20)
        self.assertEqual(unit.call("step", 0, 0.0, 0.001, 200), OK)
        self.assert_same(unit, row)
        plain = self.unit()
        plain.start(motor_torque=0.35, load_torque=20.0, temperature=31.0, fault_tooth_wear=0.3,
                    fault_tooth_wear_place=20, thermal__model="two_nodes", sensors__motor_noise=1e-4,
                    cup__torsion_breakpoints=[20.0, 41.0])
        # Steps of another length, and not of whole steps of the twin.
        self.assertEqual(plain.call("step", 0, 0.0, 0.0008, 125), OK)
        self.assertEqual(plain.call("step", 0, 0.1, 0.00016, 625), OK)
        self.assert_same(plain, row)
        self.assertEqual(plain.get("thermal.model"), "two_nodes")
        self.assertEqual(plain.get("cup.torsion_breakpoints"), [20.0, 41.0])
        self.assertAlmostEqual(plain.get("time")[0], 0.2, delta=1e-12)
        for said in unit.close(), plain.close():
            self.assertEqual(said, "")

    def test_takes_inputs_as_they_change(self):
        """From their time on, as the rows of a profile."""
        profile = self.write("profile.csv", "time,motor_torque,load_torque,brake\n0,0.4,5,0\n"
                             "0.05,-0.4,30,0\n0.1,0,10,1\n0.15,0,10,1\n")
        row = self.simulated("--profile", profile)
        unit = self.unit()
        unit.start(motor_torque=0.4, load_torque=5.0, stop=0.15)
        self.assertEqual(unit.call("step", 0, 0.0, 0.01, 5), OK)
        unit.set("motor_torque", -0.4)
        unit.set("load_torque", 30.0)
        self.assertEqual(unit.call("step", 0, 0.05, 0.01, 5), OK)
        unit.set("motor_torque", 0.0)
        unit.set("load_torque", 10.0)
        unit.set("brake", 1)
        self.assertEqual(unit.call("step", 0, 0.1, 0.01, 5), OK)
        self.assert_same(unit, row)
        self.assertEqual(unit.call("step", 0, 0.15, 0.01), ERROR)
        self.assertIn("the stop time is 0.15 [s]", unit.close())

    def test_has_forces_on_teeth_and_faults_that_set_in(self):
        unit = self.unit()
        unit.start(load_torque=40.0, motor_torque=0.5)
        self.assertEqual(unit.call("step", 0, 0.0, 0.1), OK)
        forces = unit.get("tooth_mesh_force")
        self.assertEqual(len(forces), 200)
        self.assertEqual(sum(force != 0.0 for force in forces), unit.get("teeth_loaded")[0])
        self.assertTrue(all(math.isfinite(value) for values in unit.outputs().values() for value in values))
        before = unit.get("torsional_stiffness")[0]
        self.assertEqual(unit.set("fault_flange_crack", 0.9), OK)
        self.assertEqual(unit.call("step", 0, 0.1, 0.02), OK)
        self.assertLess(unit.get("torsional_stiffness")[0], before)
        self.assertEqual(unit.close(), "")


class States(Fmu):
    def test_instances_do_not_disturb_each_other(self):
        unit = self.unit()
        for instance in 0, 1, 2:
            unit.start(instance, motor_torque=0.4, load_torque=10.0 * (instance % 2))
        for i in range(20):
            for instance in 0, 1:
                self.assertEqual(unit.call("step", instance, 0.01 * i, 0.01), OK)
        self.assertEqual(unit.call("step", 2, 0.0, 0.01, 20), OK)
        self.assertEqual(unit.ask("allocations", 0), ["0"])
        self.assertEqual(unit.outputs(2), unit.outputs(0))
        self.assertNotEqual(unit.outputs(1), unit.outputs(0))
        unit.start(3, begin=-2.5, motor_torque=0.4)
        self.assertEqual(unit.get("time", 3), [-2.5])
        self.assertEqual(unit.call("step", 3, -2.5, 0.01, 20), OK)
        self.assertEqual(unit.get("output_angle", 3), unit.get("output_angle", 0))
        unit.call("free", 0)
        self.assertEqual(unit.call("step", 1, 0.2, 0.01), OK)
        unit.close()

    def test_a_state_outlives_its_instance(self):
        unit = self.unit()
        for instance in 0, 1:
            unit.start(instance, motor_torque=0.4)
        self.assertEqual(unit.call("step", 0, 0.0, 0.05), OK)
        self.assertEqual(unit.call("keep", 0, 0), OK)
        expected = unit.get("output_angle")
        unit.call("free", 0)
        self.assertEqual(unit.call("restore", 1, 0), OK)
        for _ in range(2):
            self.assertEqual(unit.call("drop", 1, 0), OK)
        self.assertEqual(unit.call("restore", 1, 0), ERROR)
        self.assertEqual(unit.get("output_angle", 1), expected)
        self.assertEqual(unit.call("step", 1, 0.05, 0.01), OK)
        self.assertRegex(unit.close(), "^.* FMUState is a null pointer\n$")

    def test_a_state_goes_into_another_process(self):
        """With what waits, was learned and was read on the way; from there on with the same bits."""
        options = ["--set", "sensors.motor_noise=1e-4", "--set", "indicators.window_time=0.1"]
        unit = self.unit(*options)
        unit.start(begin=0.5, stop=2.0, motor_torque=0.4, thermal__model="two_nodes", cup__friction_torque=3.0)
        self.assertEqual(unit.call("step", 0, 0.5, 0.0013, 100), OK)
        unit.get("indicator_kinematic_error")
        self.assertEqual(unit.call("step", 0, 0.63, 0.00001, 5000), OK)
        unit.get("tooth_mesh_force")
        unit.set("fault_tooth_wear", 0.4)
        unit.set("temperature", 40.0)
        self.assertEqual(unit.call("step", 0, 0.68, 0.00001, 5000), OK)
        unit.set("load_torque", 15.0)  # set, and not yet in force
        self.assertEqual(unit.call("keep", 0, 0), OK)
        self.assertEqual(unit.call("save", 0, 0, self.path("a state")), OK)
        other = self.unit(*options)
        self.assertEqual(other.call("new", 0), OK)
        self.assertEqual(other.call("load", 0, 0, self.path("a state")), OK)
        self.assertEqual(other.call("restore", 0, 0), OK)
        for one in unit, other:
            self.assertEqual(one.get("load_torque"), [15.0])
            self.assertEqual(one.set("motor.torque_limit", 1.0), ERROR)
            self.assertEqual(one.call("step", 0, 0.73, 0.01, 20), OK)
        self.assertEqual(other.outputs(), unit.outputs())
        self.assertGreater(unit.get("indicator_windows")[0], 1.0)  # from the first read on
        for one, name in (unit, "one"), (other, "two"):
            self.assertEqual(one.call("keep", 0, 0), OK)
            self.assertEqual(one.call("save", 0, 0, self.path(name)), OK)
        self.assertEqual(pathlib.Path(self.path("two")).read_bytes(), pathlib.Path(self.path("one")).read_bytes())
        self.assertEqual(other.call("step", 0, 0.93, 1.2), ERROR)  # behind the stop
        unit.close()
        self.assertIn("the stop time is 2.0 [s]", other.close())

    def test_a_state_with_too_much_behind_it_is_not_serialised(self):
        unit = self.unit()
        unit.start(motor_torque=0.4)
        self.assertEqual(unit.call("step", 0, 0.0, 1e-9, 6200000), OK)
        self.assertEqual(unit.call("keep", 0, 0), OK)
        self.assertEqual(unit.call("save", 0, 0, self.path("state")), ERROR)
        self.assertIn("exceed 64 MB", unit.close())

    def test_a_state_of_no_start_yet_is_serialised(self):
        unit = self.unit()
        unit.start(1, motor__torque_limit=0.3, motor_torque=0.4)
        self.assertEqual(unit.call("new", 0), OK)
        unit.set("motor.torque_limit", 0.3)
        unit.set("motor_torque", 0.4)
        self.assertEqual(unit.call("keep", 0, 0), OK)
        self.assertEqual(unit.call("save", 0, 0, self.path("state")), OK)
        self.assertEqual(unit.call("reset", 0), OK)
        self.assertEqual(unit.call("load", 0, 1, self.path("state")), OK)
        self.assertEqual(unit.call("restore", 0, 1), OK)
        self.assertEqual(unit.call("enter", 0, 0.0, "nan"), OK)
        self.assertEqual(unit.call("exit", 0), OK)
        for instance in 0, 1:
            self.assertEqual(unit.call("step", instance, 0.0, 0.05), OK)
        self.assertEqual(unit.outputs(0), unit.outputs(1))
        unit.close()

    def test_bytes_that_are_no_state_of_the_unit_are_refused(self):
        unit = self.unit()
        unit.start(motor_torque=0.4)
        self.assertEqual(unit.call("step", 0, 0.0, 0.01, 5), OK)
        self.assertEqual(unit.call("save", 0, 0, self.path("none")), ERROR)
        self.assertEqual(unit.call("keep", 0, 0), OK)
        self.assertEqual(unit.call("save", 0, 0, self.path("state")), OK)
        whole = pathlib.Path(self.path("state")).read_bytes()
        generator = random.Random(4)
        wrong = [b"", whole[:7], whole[:8], whole[:-1], whole + b"\0", b"<xml/>" * 100]
        for _ in range(40):
            place = generator.randrange(len(whole))
            wrong.append(whole[:place])
            wrong.append(whole[:place] + bytes([whole[place] ^ 1 << generator.randrange(8)]) + whole[place + 1:])
        before = unit.outputs()
        for data in wrong:
            pathlib.Path(self.path("wrong")).write_bytes(data)
            self.assertEqual(unit.call("load", 0, 1, self.path("wrong")), ERROR, len(data))
        self.assertEqual(unit.call("restore", 0, 1), ERROR)
        self.assertEqual(unit.outputs(), before)
        self.assertEqual(unit.call("load", 0, 1, self.path("state")), OK)
        said = unit.close()
        for part in "is incomplete", "incomplete or damaged":
            self.assertIn(part, said)
        other = self.unit("--set", "motor.torque_limit=1.0")
        self.assertEqual(other.call("new", 0), OK)
        self.assertEqual(other.call("load", 0, 0, self.path("state")), ERROR)
        self.assertIn("belongs to the unit", other.close())

    def test_a_reset_instance_is_as_new(self):
        unit = self.unit()
        unit.start(0)
        unit.start(1, motor_torque=0.4, fault_tooth_wear=0.5, motor__torque_limit=0.3)
        self.assertEqual(unit.call("step", 1, 0.0, 0.05), OK)
        self.assertEqual(unit.call("terminate", 1), OK)
        self.assertEqual(unit.get("motor_torque_applied", 1), [0.3])
        self.assertEqual(unit.call("reset", 1), OK)
        self.assertEqual(unit.call("enter", 1, 0.0, "nan"), OK)
        self.assertEqual(unit.outputs(1), unit.outputs(0))
        self.assertEqual(unit.call("exit", 1), OK)
        for instance in 0, 1:
            self.assertEqual(unit.call("step", instance, 0.0, 0.05), OK)
        self.assertEqual(unit.outputs(1), unit.outputs(0))
        unit.close()

    def test_wrong_calls_are_errors_and_change_nothing(self):
        unit = self.unit()
        self.assertEqual(unit.call("new", 0), OK)
        torque = unit.variables["motor_torque"].get("valueReference")
        angle = unit.variables["output_angle"].get("valueReference")
        wrong = [("exit", 0), ("step", 0, 0.0, 0.1), ("terminate", 0), ("enter", 0, "nan", 1.0), ("enter", 0, 2.0, 1.0),
                 ("set", 0, "Float64", 99999, 1, 1.0), ("set", 0, "Float64", torque, 2, 1.0, 1.0),
                 ("set", 0, "Float64", torque, 1, "nan"), ("set", 0, "Int32", torque, 1, 1),
                 ("set", 0, "Float64", angle, 1, 1.0), ("set", 0, "Float64", 0, 1, 1.0),
                 ("call", 0, "fmi3EnterEventMode"), ("call", 0, "fmi3SetTime"),
                 ("exit", 5), ("step", 5, 0.0, 0.1), ("reset", 5), ("keep", 5, 0)]
        for words in wrong:
            self.assertEqual(unit.call(*words), ERROR, words)
        self.assertEqual(unit.ask("get", 0, "Float64", angle, 1), ["3"])
        self.assertEqual(unit.set("temperature", 1000.0), ERROR)
        self.assertEqual(unit.set("fault_tooth_wear", 1.5), ERROR)
        self.assertEqual(unit.set("motor.torque_limit", -1.0), ERROR)
        self.assertEqual(unit.set("thermal.model", "hot#1"), OK)
        self.assertEqual(unit.call("enter", 0, 0.0, "nan"), OK)
        self.assertEqual(unit.call("exit", 0), ERROR)
        switches = [(0, "logStatusWarning"), (1, "logStatusWarning"), (1, "logStatusError")]  # off is off for all
        for number, (on, category) in enumerate(switches):
            self.assertEqual(unit.call("logging", 0, on, category), OK)
            self.assertEqual(unit.set("temperature", 2000.0 + number), ERROR)
        self.assertEqual(unit.set("thermal.model", "none"), OK)
        self.assertEqual(unit.call("exit", 0), OK)
        self.assertEqual(unit.call("new", 6, "events"), 1)
        for words in [("step", 0, 0.5, 0.1), ("step", 0, 0.0, 0.0), ("step", 0, 0.0, "nan"), ("step", 0, 0.0, -0.1),
                      ("exit", 0), ("enter", 0, 0.0, 1.0)]:
            self.assertEqual(unit.call(*words), ERROR, words)
        self.assertEqual(unit.set("motor.torque_limit", 1.0), ERROR)
        self.assertEqual(unit.call("step", 0, 0.0, 1e-17), OK)  # what rounding leaves of an importer's step
        self.assertEqual(unit.call("step", 0, 0.0, 0.01), OK)
        said = unit.close()
        for hidden in "temperature = 2000.0", "temperature = 2001.0":
            self.assertNotIn(hidden, said)
        for part in ("temperature = 1000.0 [degC] out of range, allowed: -40 ... 150", "temperature = 2002.0",
                     "thermal.model = 'hot##1'", "DoStep is not allowed in state Instantiated",
                     "setting output_angle is not allowed in state Instantiated"):
            self.assertIn(part, said)

    def test_wants_its_own_token_and_resources(self):
        unit = self.unit()
        unit.close()
        own = unit.root.get("instantiationToken")
        uri = pathlib.Path(self.path("a unit/resources")).as_uri()
        for token, resources, answer in (("another", self.path("a unit/resources"), "1"),
                                         (own, self.path("no#where"), "1"), (own, uri, "0"),
                                         (own, uri.replace("file://", "file:"), "0")):
            done = subprocess.run([*IMPORTER, unit.library, token, resources], input="new 0\n", stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, universal_newlines=True, check=True, env=COUNTED)
            self.assertEqual(done.stdout.split(), ["3.0", answer])
            self.assertEqual("logStatusError" in done.stderr, answer == "1")
            self.assertNotRegex(done.stderr, "[^#]#[^#]")


if __name__ == "__main__":
    tool.main()
