# SPDX-License-Identifier: BSD-3-Clause
"""The licence line stands on top of every file that can carry a comment."""
import os

import project

LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
# Files that say their licence otherwise, that are read as they are, or that have no comments.
EXEMPT_NAMES = {"LICENSE", "README.md", "CHANGELOG.rst", "package.xml", "py.typed", ".gitignore"}
EXEMPT_SUFFIXES = (".csv", ".ipynb", ".json", ".md", ".patch", ".png", ".supp", ".svg")
LINES_SEARCHED = 3  # after a shebang or an XML declaration


def check(root):
    problems = []
    for path in project.files(root):
        if os.path.basename(path) in EXEMPT_NAMES or path.endswith(EXEMPT_SUFFIXES):
            continue
        if not any(LICENCE in line for _, line in project.lines(root, path)[:LINES_SEARCHED]):
            problems.append(f"{path}:1: no line with {LICENCE}")
    return problems


if __name__ == "__main__":
    project.run(check)
