# SPDX-License-Identifier: BSD-3-Clause
"""launch/: every argument that can be given to a launch file says what it is for; a node with parameters clears those
that an earlier launch has left below its name."""
import os
import xml.etree.ElementTree as xml

import project


def check(root):
    problems = []
    paths = project.files(root, "launch", [".launch"])
    for path in paths:
        tree = xml.parse(os.path.join(root, path))
        handed_on = {arg for include in tree.iter("include") for arg in include.iter("arg")}
        for arg in tree.iter("arg"):
            constant = arg.get("value") is not None
            if arg not in handed_on and not constant and not arg.get("doc", "").strip():
                problems.append(f"{path}: argument '{arg.get('name')}' has no doc")
        for node in tree.iter("node"):
            has_parameters = node.find("param") is not None or node.find("rosparam") is not None
            if has_parameters and node.get("clear_params") != "true":
                problems.append(f"{path}: node '{node.get('name')}' has parameters and no clear_params=\"true\"")
    return problems if paths else ["launch: no launch files found"]


if __name__ == "__main__":
    project.run(check)
