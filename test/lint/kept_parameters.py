# SPDX-License-Identifier: BSD-3-Clause
"""No class keeps all of `Parameters`: its members say what it needs of them. Exceptions are the model and the twin,
which are made anew from them, and the files below, each with its reason."""
import re

import project

KEEPERS = ("src/model/", "include/harmonic_joint_twin/model/", "src/twin/", "include/harmonic_joint_twin/twin/")

HOLDERS = {
    "src/python/configuration.hpp": "Python's object of all parameters: any of them is read and set",
    "src/fmu/drive_unit.cpp": "a unit for co-simulation: the importer sets any parameter of each instance",
    "src/fmu/arm_unit.cpp": "the same for each drive of an arm",
    "src/datasets/plan.hpp": "a plan of runs: the parameters of each are those of the first with changes",
    "src/recordings/arm_recording.hpp": "a recording with the parameters that its joints' twins are made of",
}

# A data member with its type: what ends in an underscore belongs to a class, plain structs hand values over.
MEMBER = re.compile(r"^\s*(?:(?:const|mutable|static|inline)\s+)*[\w:<>,\s*&\[\]]*\bParameters\b[\w:<>,\s*&\[\]]*?"
                    r"\b(\w+_)\s*(?:\{[^;]*\}|=[^;(]*)?;", re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*")


def kept(root, path):
    """Pairs of line number and name of the members of the file that hold all parameters."""
    text = COMMENT.sub("", project.text(root, path))
    for match in MEMBER.finditer(text):
        yield text.count("\n", 0, match.start(1)) + 1, match.group(1)


def check(root):
    problems = []
    for top in ("include", "src"):
        for path in project.files(root, top, [".hpp", ".cpp"]):
            found = list(kept(root, path))
            if path in HOLDERS and not found:
                problems.append(f"{path}:1: keeps no Parameters any more: strike it from the list")
            if path not in HOLDERS and not path.startswith(KEEPERS):
                problems += [f"{path}:{line}: {name} keeps all of Parameters: keep the groups that are needed"
                             for line, name in found]
    return problems


if __name__ == "__main__":
    project.run(check)
