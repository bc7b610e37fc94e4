# SPDX-License-Identifier: BSD-3-Clause
"""package.xml and CMakeLists.txt by catkin_lint, every notice counted as an error.

Offline: the names of system dependencies are not looked up in rosdep's lists.
"""
import os
import subprocess
import sys
import tempfile

import project

PACKAGE = "harmonic_joint_twin"


def lint(root):
    """Exit code and output of catkin_lint, which wants the folder named like the package: a checkout may be called
    anything."""
    with tempfile.TemporaryDirectory() as folder:
        link = os.path.join(folder, PACKAGE)
        os.symlink(root, link)
        result = subprocess.run(["catkin_lint", "--offline", "--strict", "-W2", link], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, universal_newlines=True, check=False)
    return result.returncode, result.stdout


if __name__ == "__main__":
    code, text = lint(project.ROOT)
    print(text, end="")
    sys.exit(code)
