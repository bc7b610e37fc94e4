# SPDX-License-Identifier: BSD-3-Clause
"""Writes what docs/health.md and its table of kinds say of the wear that ends a life into
src/life/assessment_counts.hpp: how often it is found, and how good cause and severity are."""
import argparse
import csv
import pathlib
import re

PROJECT = pathlib.Path(__file__).resolve().parent.parent
PAGE, TABLE, HEADER = "docs/health.md", "docs/health_kinds.csv", "src/life/assessment_counts.hpp"
KINDS = ("tooth_wear", "interface_wear", "lubricant_degradation")
HEAD = """// SPDX-License-Identifier: BSD-3-Clause
// Written by lab/run assessment_counts from docs/health.md.
#pragma once

namespace hjt::assessment_counts
{
"""


def count(cell):
    """'3 of 5' as two numbers; nothing: none of none."""
    return tuple(map(int, cell.split(" of "))) if cell else (0, 0)


def total(cells):
    return tuple(map(sum, zip(*map(count, cells))))


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def header(page, table):
    """The text of the header by those of the page and of its table of kinds."""
    page = page.split("<!-- health:begin -->")[1].split("<!-- health:end -->")[0]
    head, *kinds = csv.reader(table.splitlines())
    rows = {row[0]: row for row in kinds}
    found = [place for place, name in enumerate(head) if name.startswith("found ")]
    severity = max(float(head[place].split()[-1]) for place in found)  # the only one that causes are judged at
    right, in_set, size, stated = (next(place for place, name in enumerate(head) if name.startswith(words))
                                   for words in ("named cause right", "true cause in", "severity less", "stated"))
    check_ups = re.search(r"(\d+) check-ups of \d+ sound gears gave (\d+) alarm", page)
    rest = page.split(check_ups.group(0))[1].splitlines()
    runs = [cells(line) for line in rest if re.match(r"\| (?!all )[^|]+ \| \d", line)]
    lines = []
    for kind in KINDS:
        seen, of = total(rows[kind][place] for place in found)
        estimate = 1.0 + float(rows[kind][size].split(" ± ")[0]) / severity
        name = kind.upper()
        lines += [f"constexpr double {name}_FOUND = {seen}.0;", f"constexpr double {name}_RUNS = {of}.0;",
                  f"constexpr double {name}_ESTIMATE = {estimate:.2f};  // mean estimated over true severity [-]"]
    mean, spread = map(float, rows["all"][size].split(" ± "))
    causes, alarms = total(rows[kind][right] for kind in KINDS)
    values = {"ALARMS": alarms, "RIGHT_CAUSES": causes, "IN_SETS": total(rows[kind][in_set] for kind in KINDS)[0],
              "SOUND_RUNS": int(check_ups.group(1)) + sum(int(row[1]) for row in runs),
              "SOUND_ALARMS": int(check_ups.group(2)) + sum(int(row[5]) for row in runs)}
    lines += [f"constexpr double {name} = {value}.0;" for name, value in values.items()]
    estimate, deviation = severity + mean, float(rows["all"][stated])
    lines += [f"constexpr double ESTIMATE_SPREAD = {spread / estimate:.2f};   // spread over mean of estimates [-]",
              f"constexpr double STATED_DEVIATION = {deviation / estimate:.2f};  // stated deviation over mean [-]"]
    return HEAD + "\n".join(lines) + "\n}  // namespace hjt::assessment_counts\n"


def main():
    argparse.ArgumentParser(description=__doc__).parse_args()
    text = header(*((PROJECT / file).read_text(encoding="utf-8") for file in (PAGE, TABLE)))
    (PROJECT / HEADER).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
