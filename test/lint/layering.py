# SPDX-License-Identifier: BSD-3-Clause
"""Data flows one way: a folder includes itself and the folders to its left, and ROS stays in ros_io.

Debian keeps ROS' headers in /usr/include, where no include path can keep them from the core.
"""
import re

import project

FOLDERS = ["params", "gear", "elements", "model", "solver", "sensors", "health", "twin", "ros_io"]
FIRST_WITH_ROS = FOLDERS.index("ros_io")
# The core may use the standard library and these; everything else is taken for ROS or an application's library.
CORE_LIBRARIES = re.compile(r"<([a-z_0-9]+|(Eigen|Random123|boost|libfccp|yaml-cpp)/[\w/.-]+)>$")
INCLUDE = re.compile(r'\s*#\s*include\s*(<[^>]+>|"[^"]+")')
OWN_HEADER = re.compile(r'"harmonic_joint_twin/(\w+)/[\w/]+\.hpp"$')
MESSAGE_HEADER = re.compile(r'[<"]harmonic_joint_twin/[A-Z]\w*\.h[>"]$')


def folder_of(path):
    parts = path.split("/")
    return parts[1] if parts[0] == "src" else parts[2] if len(parts) > 3 else ""


def fault(folder, header):
    """Why `folder` must not include `header`; None if it may."""
    rank = FOLDERS.index(folder)
    own = OWN_HEADER.match(header)
    if own:
        if own.group(1) not in FOLDERS:
            return f"{header} lies in no known folder"
        if FOLDERS.index(own.group(1)) > rank:
            return f"{folder} must not include {header}: {own.group(1)} lies to its right"
        return None
    if header.startswith('"') and not MESSAGE_HEADER.match(header):
        return f"{header}: own headers are included as \"harmonic_joint_twin/FOLDER/NAME.hpp\""
    if rank < FIRST_WITH_ROS and not CORE_LIBRARIES.match(header):
        return f"{folder} must not include {header}: the core knows no ROS, only {CORE_LIBRARIES.pattern}"
    return None


def check(root):
    problems = []
    sources = project.files(root, "include", [".hpp", ".h"]) + project.files(root, "src", [".hpp", ".h", ".cpp"])
    for path in sources:
        folder = folder_of(path)
        if folder == "apps":  # executables: they stand to the right of everything
            continue
        if folder not in FOLDERS:
            problems.append(f"{path}:1: not in one of the folders {', '.join(FOLDERS)}, apps")
            continue
        for number, line in project.lines(root, path):
            include = INCLUDE.match(line)
            reason = fault(folder, include.group(1)) if include else None
            if reason:
                problems.append(f"{path}:{number}: {reason}")
    return problems if sources else ["include, src: no sources found"]


if __name__ == "__main__":
    project.run(check)
