# SPDX-License-Identifier: BSD-3-Clause
"""Tables of README.md: what they say, and the check of the parameters against the tool's own table.

usage: readme_tables.py JOINT_TWIN [--write]    (--write brings README.md up to date)
"""
import os
import re
import subprocess
import sys

import project

PARAMETERS_BEGIN, PARAMETERS_END = "<!-- parameters:begin -->", "<!-- parameters:end -->"
ROW = re.compile(r"\| *`([~/\w]+)` *\| *([\w/]+) *\|")


def section(readme, title):
    """Lines below the heading `title`, up to the next heading."""
    found = re.search(rf"^#+ {re.escape(title)}$(.*?)(?=^#|\Z)", readme, re.MULTILINE | re.DOTALL)
    if not found:
        raise ValueError(f"README.md: no section '{title}'")
    return found.group(1).strip().splitlines()


def names_and_types(readme, title):
    """First two columns of the section's table: name to type."""
    rows = [ROW.match(line) for line in section(readme, title)]
    return {row.group(1): row.group(2) for row in rows if row}


def parameter_table(readme):
    if PARAMETERS_BEGIN not in readme or PARAMETERS_END not in readme:
        return []
    return readme.split(PARAMETERS_BEGIN)[1].split(PARAMETERS_END)[0].strip().splitlines()


def check_parameters(root, table):
    """Problems of the README's parameter table against `table`, the tool's own."""
    shown = parameter_table(project.text(root, "README.md"))
    problems = [f"README.md: not a parameter any more, or said otherwise: {line}" for line in shown if line not in table]
    problems += [f"README.md: missing: {line}" for line in table if line not in shown]
    if not problems and shown != table:
        problems.append("README.md: parameters in another order than the tool's")
    return problems if table else ["the tool shows no parameters"]


def write_parameters(root, table):
    path = os.path.join(root, "README.md")
    before, rest = project.text(root, "README.md").split(PARAMETERS_BEGIN)
    after = rest.split(PARAMETERS_END)[1]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([before + PARAMETERS_BEGIN, *table, PARAMETERS_END]) + after)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--write"]):
        sys.exit(__doc__)
    said = subprocess.run([sys.argv[1], "parameters", "--markdown"], stdout=subprocess.PIPE, universal_newlines=True,
                          check=True).stdout
    if len(sys.argv) == 3:
        write_parameters(project.ROOT, said.strip().splitlines())
    project.run(lambda root: check_parameters(root, said.strip().splitlines()))
