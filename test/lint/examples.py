# SPDX-License-Identifier: BSD-3-Clause
"""The worked examples of docs/extending.md, test/extending/*.patch, apply to the sources as they are.

The test `extending` builds and runs them.
"""
import os
import subprocess

import project


def check(root):
    problems = []
    for path in project.files(root, "test/extending", [".patch"]):
        applied = subprocess.run(["patch", "--dry-run", "--force", "--fuzz=0", "-p1", "-d", root, "-i",
                                  os.path.join(root, path)], capture_output=True, text=True, check=False)
        if applied.returncode != 0:
            problems.append(f"{path}:1: does not apply: {' '.join(applied.stdout.split())}")
    return problems


if __name__ == "__main__":
    project.run(check)
