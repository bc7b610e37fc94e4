# SPDX-License-Identifier: BSD-3-Clause
"""config/: numbers are spelt so that rosparam takes them for numbers, each key says its unit in the comment above, and
the launch file loads the stages of the default configuration.

To YAML 1.1, which rosparam reads, 1.0e-3 is a number and 1e-3, 1e3 and 1.0e4 are texts. A node
reads those as well, but `rosparam get` would show them in quotes.
"""
import os
import re

import yaml

import project

UNIT = re.compile(r"\[[^\]]+\]")
LAUNCHED = re.compile(r'file="\$\(arg config\)/(\w+\.yaml)"')


def is_number(text):
    try:
        float(text)
        return True
    except ValueError:
        return False


def leaves(node, name=""):
    """All (key, key's line from 0, value node) below a mapping that hold a value or a list."""
    for key, value in node.value:
        key_name = f"{name}.{key.value}" if name else key.value
        if isinstance(value, yaml.MappingNode):
            yield from leaves(value, key_name)
        else:
            yield key_name, key.start_mark.line, value


def scalars(node):
    return node.value if isinstance(node, yaml.SequenceNode) else [node]


def comment_above(all_lines, line):
    comment = []
    while line > 0 and all_lines[line - 1].lstrip().startswith("#"):
        line -= 1
        comment.insert(0, all_lines[line])
    return " ".join(comment)


def check_stages(root):
    """The launch file's list beside that of every other reader."""
    if not os.path.exists(os.path.join(root, "config/stages")):
        return []
    stages = [line for line in project.text(root, "config/stages").splitlines() if not line.startswith("#")]
    loaded = LAUNCHED.findall(project.text(root, "launch/twin.launch"))
    return [] if loaded == stages else [f"launch/twin.launch: loads {', '.join(loaded)}; "
                                        f"config/stages lists {', '.join(stages)}"]


def check(root):
    problems = []
    # Files of signatures are tables, made by a program.
    paths = [path for path in project.files(root, "config", [".yaml"]) if not path.startswith("config/signatures/")]
    for path in paths:
        content = project.text(root, path)
        document = yaml.compose(content, Loader=yaml.SafeLoader)
        if not isinstance(document, yaml.MappingNode):
            problems.append(f"{path}:1: not a mapping of sections to keys")
            continue
        for key, line, node in leaves(document):
            for scalar in scalars(node):
                plain = isinstance(scalar, yaml.ScalarNode) and scalar.style is None
                if plain and scalar.tag == "tag:yaml.org,2002:str" and is_number(scalar.value):
                    problems.append(f"{path}:{scalar.start_mark.line + 1}: {key}: {scalar.value} is a text to "
                                    f"rosparam, "
                                    "which wants a dot and a signed exponent: 1.0e-3")
            if not UNIT.search(comment_above(content.splitlines(), line)):
                problems.append(f"{path}:{line + 1}: {key}: no [unit] in the comment above it")
    problems += check_stages(root)
    return problems if paths else ["config: no YAML files found"]


if __name__ == "__main__":
    project.run(check)
