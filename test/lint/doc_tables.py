# SPDX-License-Identifier: BSD-3-Clause
"""Reads the tables of the documentation and checks docs/parameters.csv against the tool's own table.

usage: doc_tables.py JOINT_TWIN [--write]    (--write brings docs/parameters.csv up to date)
"""
import csv
import os
import re
import subprocess
import sys

import project

PARAMETERS = "docs/parameters.csv"
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


def parameter_rows(markdown):
    """Header and rows of the tool's table."""
    rows = [[cell.strip().strip("`") for cell in line.strip("|").split("|")] for line in markdown]
    return [row for row in rows if not set("".join(row)) <= set("-")]


def check_parameters(root, table):
    """Differences between the file of parameters and `table`, the rows of the tool's own."""
    shown = list(csv.reader(project.text(root, PARAMETERS).splitlines()))
    problems = [f"{PARAMETERS}: removed or changed in the code: {', '.join(row)}" for row in shown if row not in table]
    problems += [f"{PARAMETERS}: missing: {', '.join(row)}" for row in table if row not in shown]
    if not problems and shown != table:
        problems.append(f"{PARAMETERS}: parameters in another order than the tool's")
    return problems if table else ["the tool shows no parameters"]


def write_parameters(root, table):
    with open(os.path.join(root, PARAMETERS), "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(table)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--write"]):
        sys.exit(__doc__)
    printed = subprocess.run([sys.argv[1], "parameters", "--markdown"], stdout=subprocess.PIPE, universal_newlines=True,
                             check=True).stdout.strip().splitlines()
    rows = parameter_rows(printed)
    if len(sys.argv) == 3:
        write_parameters(project.ROOT, rows)
    project.run(lambda root: check_parameters(root, rows))
