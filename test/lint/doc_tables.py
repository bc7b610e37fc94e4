# SPDX-License-Identifier: BSD-3-Clause
"""Reads the tables of the documentation and checks that of docs/parameters.md against the tool's own.

usage: doc_tables.py JOINT_TWIN [--write]    (--write brings docs/parameters.md up to date)
"""
import os
import re
import subprocess
import sys

import project

PARAMETERS = "docs/parameters.md"
PARAMETERS_BEGIN, PARAMETERS_END = "<!-- parameters:begin -->", "<!-- parameters:end -->"
ROW = re.compile(r"\| *`([~/\w]+)` *\| *([\w/]+) *\|")


def section(page, title):
    """Lines below the heading `title`, up to the next heading."""
    found = re.search(rf"^#+ {re.escape(title)}$(.*?)(?=^#|\Z)", page, re.MULTILINE | re.DOTALL)
    if not found:
        raise ValueError(f"no section '{title}'")
    return found.group(1).strip().splitlines()


def names_and_types(page, title):
    """First two columns of the section's table: name to type."""
    rows = [ROW.match(line) for line in section(page, title)]
    return {row.group(1): row.group(2) for row in rows if row}


def parameter_table(page):
    if PARAMETERS_BEGIN not in page or PARAMETERS_END not in page:
        return []
    return page.split(PARAMETERS_BEGIN)[1].split(PARAMETERS_END)[0].strip().splitlines()


def check_parameters(root, table):
    """Differences between the page's parameter table and `table`, the tool's own."""
    shown = parameter_table(project.text(root, PARAMETERS))
    problems = [f"{PARAMETERS}: removed or changed in the code: {line}" for line in shown if line not in table]
    problems += [f"{PARAMETERS}: missing: {line}" for line in table if line not in shown]
    if not problems and shown != table:
        problems.append(f"{PARAMETERS}: parameters in another order than the tool's")
    return problems if table else ["the tool shows no parameters"]


def write_parameters(root, table):
    path = os.path.join(root, PARAMETERS)
    before, rest = project.text(root, PARAMETERS).split(PARAMETERS_BEGIN)
    after = rest.split(PARAMETERS_END)[1]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([before + PARAMETERS_BEGIN, *table, PARAMETERS_END]) + after)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--write"]):
        sys.exit(__doc__)
    printed = subprocess.run([sys.argv[1], "parameters", "--markdown"], stdout=subprocess.PIPE, universal_newlines=True,
                             check=True).stdout.strip().splitlines()
    if len(sys.argv) == 3:
        write_parameters(project.ROOT, printed)
    project.run(lambda root: check_parameters(root, printed))
