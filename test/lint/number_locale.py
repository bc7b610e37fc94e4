# SPDX-License-Identifier: BSD-3-Clause
"""Numbers are read and written by src/base alone, which keeps them apart from the program's locale.

Elsewhere there is no strtod, no printf of a number with a decimal point, no std::ostringstream, no as<double> of
yaml-cpp.
"""
import re

import project

DEPENDENT = re.compile(r"\b(strto(?:d|f|ld)|std::sto(?:d|f|ld)|atof|sscanf|std::ostringstream)\b|\bas<(?:double|float)>"
                       r"|%(?![-+#0-9*]*\.0f)[-+#0-9*]*(?:\.[0-9*]+)?[efgEFG]\b")
ALLOWED = ("src/base/number_text.cpp", "src/base/number_text.hpp")


def check(root):
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


if __name__ == "__main__":
    project.run(check)
