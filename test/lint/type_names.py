# SPDX-License-Identifier: BSD-3-Clause
"""No two types of one name at namespace scope: the linker would take one for the other without a word."""
import re

import project

TYPE = re.compile(r"(?:struct|class|enum(?: class)?|union)\s+(?:\[\[\w+\]\]\s+)?(\w+)\b(?!::)(?![^;{]*;)")
OPEN_ANONYMOUS = re.compile(r"namespace\s*\{?$")
CLOSE_ANONYMOUS = re.compile(r"\}\s*// (anonymous )?namespace$")


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


def check(root):
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


if __name__ == "__main__":
    project.run(check)
