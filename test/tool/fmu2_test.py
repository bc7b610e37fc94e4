# SPDX-License-Identifier: BSD-3-Clause
"""Units of FMI 2.0 beside those of 3.0: loaded here by their C functions. Arguments: those of fmu_unit."""
import ctypes
import glob
import os
import pathlib
import shutil
import subprocess
import tempfile
import xml.etree.ElementTree
import zipfile

import tool
from fmu_arm_test import POSE, ROWS, set_points
from fmu_unit import SCHEMAS, Fmu

OK, ERROR = 0, 3
LOGGER = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
KINDS = {"Real": ctypes.c_double, "Integer": ctypes.c_int, "Boolean": ctypes.c_int, "String": ctypes.c_char_p}


class Callbacks(ctypes.Structure):
    _fields_ = [("log", LOGGER)] + [(name, ctypes.c_void_p) for name in ("allocate", "free", "finished", "environment")]


class Unit2:
    """One instance of an unpacked unit. Names of arrays stand for all their elements."""

    def __init__(self, folder):
        self.description = os.path.join(folder, "modelDescription.xml")
        self.root = xml.etree.ElementTree.parse(self.description).getroot()
        self.variables = {}
        for each in self.root.find("ModelVariables"):
            self.variables.setdefault(each.get("name").split("[")[0], []).append(each)
        library, = glob.glob(os.path.join(glob.escape(folder), "binaries", "*", "harmonic_joint_twin*.so"))
        self.library = ctypes.CDLL(library)
        self.library.fmi2Instantiate.restype = ctypes.c_void_p
        self.library.fmi2GetVersion.restype = ctypes.c_char_p
        self.said = []
        self.callbacks = Callbacks(log=LOGGER(lambda *words: self.said.append(words[4].decode())))
        self.resources = pathlib.Path(folder, "resources").as_uri().encode()
        self.instance = ctypes.c_void_p(self.instantiate())

    def instantiate(self, kind=1):
        return self.library.fmi2Instantiate(b"drive", kind, self.root.get("guid").encode(), self.resources,
                                            ctypes.byref(self.callbacks), 0, 1)

    def call(self, name, *words):
        return getattr(self.library, "fmi2" + name)(self.instance, *words)

    def values(self, call, name, values=()):
        variables = self.variables[name]
        kind = variables[0][0].tag
        references = (ctypes.c_uint * len(variables))(*(int(each.get("valueReference")) for each in variables))
        array = (KINDS[kind] * len(variables))(*values)
        return self.call(call + kind, references, ctypes.c_size_t(len(variables)), array), list(array)

    def set(self, name, *values):
        return self.values("Set", name, values)[0]

    def get(self, name):
        status, values = self.values("Get", name)
        assert status == OK, name
        return values

    def start(self, **values):
        for name, value in values.items():
            assert self.set(name.replace("__", "."), *(value if isinstance(value, list) else [value])) == OK, name
        assert self.call("SetupExperiment", 0, ctypes.c_double(), ctypes.c_double(0.0), 0, ctypes.c_double()) == OK
        assert self.call("EnterInitializationMode") == OK
        assert self.call("ExitInitializationMode") == OK

    def step(self, time, length):
        return self.call("DoStep", ctypes.c_double(time), ctypes.c_double(length), 1)

    def outputs(self):
        return {name: self.get(name) for name, each in self.variables.items() if each[0].get("causality") == "output"}


class Fmu2(Fmu):
    def unit2(self, *options):
        if tool.SLOWER != 1.0:
            self.skipTest("a library with a sanitizer wants it in its importer too")
        self.succeed("export", "--format", "fmu2", "--out", self.path("joint2.fmu"), "--force", *options)
        folder = tempfile.mkdtemp(prefix="a unit ", dir=self.directory)
        with zipfile.ZipFile(self.path("joint2.fmu")) as archive:
            archive.extractall(folder)
        return Unit2(folder)

    def test_descriptions_follow_the_schema_and_have_the_variables_of_3_0(self):
        schema = os.path.join(SCHEMAS, "fmi2", "fmi2ModelDescription.xsd")
        for options in [], ["--arm", "ur5"]:
            unit, other = self.unit2(*options), self.unit(*options)
            sizes = {name: len(each) for name, each in unit.variables.items()}
            self.assertEqual(sizes, {name: other.size(name) for name in other.variables})
            all_of_them = list(unit.root.find("ModelVariables"))
            self.assertEqual(len({each.get("valueReference") for each in all_of_them}), len(all_of_them))
            for part in "Outputs", "InitialUnknowns":
                named = {all_of_them[int(each.get("index")) - 1] for each in unit.root.find("ModelStructure/" + part)}
                self.assertEqual(named, {each for each in all_of_them if each.get("causality") == "output"})
            for name, (first, *_) in unit.variables.items():
                start = other.variables[name].get("start", "").split()
                self.assertEqual(first[0].get("start"), start[0] if start else
                                 getattr(other.variables[name].find("Start"), "attrib", {}).get("value"), name)
            if os.path.exists(schema) and shutil.which("xmllint"):
                done = subprocess.run(["xmllint", "--noout", "--schema", schema, unit.description],
                                      stderr=subprocess.PIPE, universal_newlines=True, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_drive_gives_the_numbers_of_3_0(self):
        values = {"motor_torque": 0.4, "load_torque": 20.0, "fault_tooth_wear": 0.3, "fault_tooth_wear_place": 20,
                  "cup__torsion_breakpoints": [20.0, 41.0]}
        unit, other = self.unit2(), self.unit()
        unit.start(thermal__model=b"two_nodes", **values)
        other.start(thermal__model="two_nodes", **values)
        self.assertEqual(unit.library.fmi2GetVersion(), b"2.0")
        state = ctypes.c_void_p()
        for k in range(10):
            if k == 5:
                self.assertEqual(unit.call("GetFMUstate", ctypes.byref(state)), OK)
                self.assertEqual([unit.set("brake", 1), other.set("brake", 1)], [OK, OK])
            self.assertEqual([unit.step(0.01 * k, 0.01), other.call("step", 0, 0.01 * k, 0.01)], [OK, OK])
        ends = unit.outputs()
        self.assertEqual(ends, other.outputs())
        self.assertEqual(unit.get("thermal.model"), [b"two_nodes"])
        self.assertEqual(unit.call("SetFMUstate", state), OK)
        self.assertEqual(unit.get("brake"), [0])
        unit.set("brake", 1)
        for k in range(5, 10):
            self.assertEqual(unit.step(0.01 * k, 0.01), OK)
        self.assertEqual(unit.outputs(), ends)
        self.check_serialised(unit, state)
        self.assertEqual(unit.call("FreeFMUstate", ctypes.byref(state)), OK)
        self.assertEqual(unit.call("Terminate"), OK)
        self.assertEqual(unit.said, [])

    def check_serialised(self, unit, state):
        size = ctypes.c_size_t()
        self.assertEqual(unit.call("SerializedFMUstateSize", state, ctypes.byref(size)), OK)
        data = (ctypes.c_ubyte * size.value)()
        self.assertEqual(unit.call("SerializeFMUstate", state, data, size), OK)
        copy = ctypes.c_void_p()
        self.assertEqual(unit.call("DeSerializeFMUstate", data, size, ctypes.byref(copy)), OK)
        ends = []
        for each in state, copy:
            self.assertEqual(unit.call("SetFMUstate", each), OK)
            self.assertEqual(unit.step(0.05, 0.02), OK)
            ends.append(unit.outputs())
        self.assertEqual(ends[0], ends[1])
        self.assertEqual(unit.call("FreeFMUstate", ctypes.byref(copy)), OK)

    def test_an_arm_gives_the_numbers_of_3_0(self):
        unit, other = self.unit2("--arm", "ur5"), self.unit("--arm", "ur5")
        unit.start(start_q=POSE, target_q=POSE)
        other.start(start_q=POSE, target_q=POSE)
        for k in range(8):
            for name, values in zip(("target_q", "target_qd", "target_qdd"), set_points((k + 1) / ROWS)):
                self.assertEqual([unit.set(name, *values), other.set(name, *values)], [OK, OK])
            self.assertEqual([unit.step(k / ROWS, 1.0 / ROWS), other.call("step", 0, k / ROWS, 1.0 / ROWS)], [OK, OK])
        for name in "actual_q", "actual_current", "tool_error", "elbow.motor_current", "elbow.tooth_mesh_force":
            self.assertEqual(unit.get(name), other.get(name), name)

    def test_wrong_calls_are_errors(self):
        unit = self.unit2()
        self.assertIsNone(unit.instantiate(kind=0))
        self.assertEqual(unit.step(0.0, 0.01), ERROR)
        self.assertEqual(unit.set("temperature", 1000.0), ERROR)
        self.assertEqual(unit.set("joint_torque", 1.0), ERROR)
        reference = (ctypes.c_uint * 1)(5 << 16 | 1)
        self.assertEqual(unit.call("GetReal", reference, ctypes.c_size_t(1), (ctypes.c_double * 1)()), ERROR)
        self.assertEqual(unit.call("GetDirectionalDerivative"), ERROR)
        self.assertEqual(unit.set("thermal.model", b"100%s#1"), OK)
        self.assertEqual(unit.call("EnterInitializationMode"), OK)
        self.assertEqual(unit.call("ExitInitializationMode"), ERROR)
        said = "\n".join(unit.said)
        for part in ("fmuType", "DoStep is not allowed in state Instantiated", "temperature = 1000.0 [degC] out of ra",
                     "no variable has the value reference 327681", "thermal.model = '100%%s##1'"):
            self.assertIn(part, said)
        unit.library.fmi2FreeInstance(unit.instance)


if __name__ == "__main__":
    tool.main()
