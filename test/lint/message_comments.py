# SPDX-License-Identifier: BSD-3-Clause
"""msg/: each field has a comment with its unit in [..], each constant a comment."""
import re

import project

FIELD = re.compile(r"\s*[\w/]+(\[\d*\])?\s+\w+\s*(?P<constant>=[^#]*)?(#(?P<comment>.*))?$")
UNIT = re.compile(r"\[[^\]]+\]")


def check(root):
    problems = []
    paths = project.files(root, "msg", [".msg"])
    for path in paths:
        for number, line in project.lines(root, path):
            if not line.strip() or line.lstrip().startswith("#"):
                continue
            field = FIELD.match(line)
            comment = (field.group("comment") or "").strip() if field else ""
            if not field:
                problems.append(f"{path}:{number}: not understood: {line}")
            elif field.group("constant") and not comment:
                problems.append(f"{path}:{number}: constant without a comment")
            elif not field.group("constant") and not UNIT.search(comment):
                problems.append(f"{path}:{number}: field without a [unit] in its comment")
    return problems if paths else ["msg: no messages found"]


if __name__ == "__main__":
    project.run(check)
