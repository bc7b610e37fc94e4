# SPDX-License-Identifier: BSD-3-Clause
"""Rules of the C++ sources that no tool knows: numbers do not depend on the locale, type names differ, no class keeps
all of `Parameters`."""
import re

import project

DEPENDENT = re.compile(r"\b(strto(?:d|f|ld)|std::sto(?:d|f|ld)|atof|sscanf|std::ostringstream)\b|\bas<(?:double|float)>"
                       r"|%(?![-+#0-9*]*\.0f)[-+#0-9*]*(?:\.[0-9*]+)?[efgEFG]\b")
ALLOWED = ("src/base/number_text.cpp", "src/base/number_text.hpp")

TYPE = re.compile(r"(?:struct|class|enum(?: class)?|union)\s+(?:\[\[\w+\]\]\s+)?(\w+)\b(?!::)(?![^;{]*;)")
OPEN_ANONYMOUS = re.compile(r"namespace\s*\{?$")
CLOSE_ANONYMOUS = re.compile(r"\}\s*// (anonymous )?namespace$")

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


def number_locale(root):
    """Numbers are read and written by src/base alone, which keeps them apart from the program's locale: elsewhere there
    is no strtod, no printf of a number with a decimal point, no std::ostringstream, no as<double> of yaml-cpp."""
    problems = []
    for top in ("include", "src"):
        for path in project.files(root, top, [".hpp", ".cpp"]):
            if path in ALLOWED:
                continue
            for number, line in project.lines(root, path):
                match = DEPENDENT.search(line.split("//")[0])
                if match:
                    problems.append(f"{path}:{number}: {match.group(0)} depends on the program's locale; use "
                                    "base/number_text.hpp")
    return problems


def types(root, path):
    """Pairs of line number and name of the types with external linkage that the file defines; they stand at column
    0."""
    anonymous = False
    for number, line in project.lines(root, path):
        if OPEN_ANONYMOUS.match(line):
            anonymous = True
        elif CLOSE_ANONYMOUS.match(line):
            anonymous = False
        elif not anonymous:
            match = TYPE.match(line)
            if match:
                yield number, match.group(1)


def type_names(root):
    """No two types of one name at namespace scope: the linker would take one for the other without a word."""
    first = {}
    problems = []
    for top in ("include", "src"):
        for path in project.files(root, top, [".hpp", ".cpp"]):
            for number, name in types(root, path):
                if name in first:
                    problems.append(f"{path}:{number}: type {name} is defined in {first[name]} too")
                else:
                    first[name] = f"{path}:{number}"
    return problems


def kept(root, path):
    """Pairs of line number and name of the members of the file that hold all parameters."""
    text = COMMENT.sub("", project.text(root, path))
    for match in MEMBER.finditer(text):
        yield text.count("\n", 0, match.start(1)) + 1, match.group(1)


def kept_parameters(root):
    """No class keeps all of `Parameters`: its members say what it needs of them. Exceptions are the model and the twin,
    which are made anew from them, and HOLDERS, each with its reason."""
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
    project.run(lambda root: number_locale(root) + type_names(root) + kept_parameters(root))
