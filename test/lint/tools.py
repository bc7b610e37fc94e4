# SPDX-License-Identifier: BSD-3-Clause
"""The sources by tools: package.xml and CMakeLists.txt by catkin_lint, every notice counted as an error, offline: the
names of system dependencies are not looked up in rosdep's lists; Python files by flake8 with the rules of setup.cfg;
shell scripts, which are the executables without a suffix, by shellcheck.

usage: tools.py catkin_lint|python|shell
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import project

PACKAGE = "harmonic_joint_twin"
OLDEST_SHELLCHECK = (0, 8)  # that follows `source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"`


def output(*command, root=project.ROOT):
    return subprocess.run(command, cwd=root, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                          check=False).stdout


def catkin_lint(root):
    """It wants the folder named like the package: a checkout may be called anything."""
    with tempfile.TemporaryDirectory() as folder:
        link = os.path.join(folder, PACKAGE)
        os.symlink(root, link)
        result = subprocess.run(["catkin_lint", "--offline", "--strict", "-W2", link], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, universal_newlines=True, check=False)
    return result.stdout.splitlines() if result.returncode else []


def python(root):
    paths = project.files(root, suffixes=[".py"])
    return output(sys.executable, "-m", "flake8", "--config", "setup.cfg", *paths).splitlines()


def is_shell(root, path):
    with open(os.path.join(root, path), "rb") as file:
        return path.endswith(".sh") or file.readline().rstrip() == b"#!/usr/bin/env bash"


def shell(root):
    if not shutil.which("shellcheck"):
        return ["no shellcheck here"]
    version = re.search(r"version: (\S+)", output("shellcheck", "--version")).group(1)
    if tuple(map(int, version.split(".")[:2])) < OLDEST_SHELLCHECK:
        project.skip(f"needs shellcheck {'.'.join(map(str, OLDEST_SHELLCHECK))} or later, here is {version}")
    paths = [path for path in project.files(root) if is_shell(root, path)]
    return output("shellcheck", "-x", "-P", "SCRIPTDIR", *paths).splitlines()


if __name__ == "__main__":
    project.run({"catkin_lint": catkin_lint, "python": python, "shell": shell}[sys.argv[1]])
