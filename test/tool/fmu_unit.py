# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of co-simulation units share: units, unpacked and run by a small importer. Arguments: the tool, the
library that counts allocations. The schema is looked for in HJT_FMI_SCHEMAS, else in shared/fmi beside the checkout."""
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree
import zipfile

import tool

IMPORTER = [sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)), "fmu_importer.py")]
COUNTED = {**os.environ, "LD_PRELOAD": sys.argv.pop(2)}
SCHEMAS = os.environ.get("HJT_FMI_SCHEMAS", os.path.join(os.path.dirname(tool.CHECKOUT), "shared", "fmi"))
RATE = 10000.0
OK, ERROR = 0, 3


class Unit:
    """A unit that has been unpacked, and one process that has loaded its library."""

    def __init__(self, folder):
        self.root = xml.etree.ElementTree.parse(os.path.join(folder, "modelDescription.xml")).getroot()
        self.variables = {each.get("name"): each for each in self.root.find("ModelVariables")}
        model = self.root.find("CoSimulation").get("modelIdentifier")
        self.library = os.path.join(folder, "binaries", os.listdir(os.path.join(folder, "binaries"))[0], model + ".so")
        self.process = subprocess.Popen(
            [*IMPORTER, self.library, self.root.get("instantiationToken"),
             os.path.join(os.path.basename(folder), "resources", "")], cwd=os.path.dirname(folder),
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
            env=COUNTED)
        self.version = self.process.stdout.readline().strip()

    def close(self):
        """What the unit said to its log."""
        _, said = self.process.communicate(timeout=60)
        assert self.process.returncode == 0, said
        return said

    def stop(self):
        self.process.kill()
        self.process.wait()
        for pipe in self.process.stdin, self.process.stdout, self.process.stderr:
            pipe.close()

    def ask(self, *words):
        print(*words, file=self.process.stdin, flush=True)
        return self.process.stdout.readline().split()

    def call(self, *words):
        """The status."""
        answer = self.ask(*words)
        assert len(answer) == 1, answer
        return int(answer[0])

    def size(self, name):
        dimension = self.variables[name].find("Dimension")
        return 1 if dimension is None else int(dimension.get("start"))

    def get(self, name, instance=0):
        variable = self.variables[name]
        status, *values = self.ask("get", instance, variable.tag, variable.get("valueReference"), self.size(name))
        assert status == "0", (name, status)
        return values[0] if variable.tag == "String" else [float.fromhex(value) for value in values]

    def set(self, name, *values, instance=0):
        variable = self.variables[name]
        return self.call("set", instance, variable.tag, variable.get("valueReference"), len(values), *values)

    def outputs(self, instance=0):
        return {name: self.get(name, instance) for name, variable in self.variables.items()
                if variable.get("causality") == "output"}

    def start(self, instance=0, begin=0.0, stop="nan", **values):
        """An instance that has been initialised with these values."""
        assert self.call("new", instance) == OK
        for name, value in values.items():
            assert self.set(name.replace("__", "."), *(value if isinstance(value, list) else [value]),
                            instance=instance) == OK, name
        assert self.call("enter", instance, begin, stop) == OK
        assert self.call("exit", instance) == OK


class Fmu(tool.ToolTest):
    def unit(self, *options):
        if tool.SLOWER != 1.0:
            self.skipTest("a library with a sanitizer wants it in its importer too")
        file = self.path("joint.fmu")
        self.succeed("export", "--format", "fmu", "--out", file, "--force", *options)
        folder = self.path("a unit")  # importers unpack into folders with blanks
        shutil.rmtree(folder, ignore_errors=True)
        with zipfile.ZipFile(file) as archive:
            self.assertIn(b"BSD 3-Clause", archive.read("documentation/licenses/license.txt"))
            self.assertIsNone(archive.testzip())
            archive.extractall(folder)
        unit = Unit(folder)
        self.addCleanup(unit.stop)
        return unit

    def simulated(self, *options):
        """Last row of a run of the tool by the names of the unit."""
        self.succeed("simulate", "--out", self.path("run.csv"), "--force", *options)
        row = self.rows("run.csv")[-1]
        names = {"motor_torque": "motor_torque_applied", "temperature": "grease_temperature", "brake": "brake_engaged"}
        return {names.get(name, name): [value] for name, value in row.items()
                if name not in ("time", "load_torque")}

    def assert_same(self, unit, row, instance=0):
        outputs = unit.outputs(instance)
        self.assertEqual({name: outputs[name] for name in row}, row)
