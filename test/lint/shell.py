# SPDX-License-Identifier: BSD-3-Clause
"""Every shell script by shellcheck."""
import os
import re
import shutil
import subprocess

import project

OLDEST = (0, 8)  # that follows `source "$(dirname "${BASH_SOURCE[0]}")/lib.sh"`


def is_shell(root, path):
    with open(os.path.join(root, path), "rb") as file:
        return path.endswith(".sh") or file.readline().rstrip() == b"#!/usr/bin/env bash"


def output(command, root):
    return subprocess.run(command, cwd=root, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                          check=False).stdout


def check(root):
    if not shutil.which("shellcheck"):
        return ["no shellcheck here"]
    version = re.search(r"version: (\S+)", output(["shellcheck", "--version"], root)).group(1)
    if tuple(map(int, version.split(".")[:2])) < OLDEST:
        project.skip(f"needs shellcheck {'.'.join(map(str, OLDEST))} or later, here is {version}")
    paths = [path for path in project.files(root) if is_shell(root, path)]
    return output(["shellcheck", "-x", "-P", "SCRIPTDIR", *paths], root).splitlines() if paths else ["no scripts found"]


if __name__ == "__main__":
    project.run(check)
