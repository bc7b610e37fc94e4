# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of the pages that the validation computes are those of its rows (docs/validation.csv).

Behind such a number stands `<!-- value: ROW -->`, or `<!-- value: ROW * FACTOR -->` where the page has another unit.
The number is the row's value, rounded to the digits shown. `rows` counts all rows, `rows.CLASS` those of a class,
`rows.CLASS.hold` those of them that hold, `rows.fail` those that do not.
"""
import csv
import re

import project

VALUES = "docs/validation.csv"
MARK = "<!-- value:"
CODE_SPAN = re.compile(r"`[^`]*`")
MARKED = re.compile(r"(?P<number>-?\d+(?:\.(?P<digits>\d+))?)"
                    r"<!-- value: (?P<row>[\w.]+)(?: \* (?P<factor>[\d.e-]+))? -->")


def values(root):
    """Row to value, and the counts of rows."""
    rows = list(csv.DictReader(project.text(root, VALUES).splitlines()))
    known = {row["row"]: float(row["value"]) for row in rows}
    rows = [row for row in rows if row["holds"]]  # the others are values alone
    known.update({"rows": len(rows), "rows.fail": sum(row["holds"] == "no" for row in rows)})
    for name in {row["class"] for row in rows}:
        own = [row for row in rows if row["class"] == name]
        known[f"rows.{name.replace(' ', '_')}"] = len(own)
        known[f"rows.{name.replace(' ', '_')}.hold"] = sum(row["holds"] == "yes" for row in own)
    return known


def fault(found, known):
    """What is wrong with one marked number; None if nothing is."""
    if found["row"] not in known:
        return f"no row {found['row']} in {VALUES}"
    value = known[found["row"]] * float(found["factor"] or 1.0)
    digits = len(found["digits"] or "")
    if abs(float(found["number"]) - value) > 0.5000001 * 10.0 ** -digits:
        return f"{found['number']} is shown, {found['row']} has {value:.{digits + 2}f}"
    return None


def check(root):
    known = values(root)
    problems, marked = [], 0
    for path in project.files(root, "", [".md"]):
        for number, line in project.lines(root, path):
            line = CODE_SPAN.sub("", line)
            found = list(MARKED.finditer(line))
            marked += len(found)
            if line.count(MARK) != len(found):
                problems.append(f"{path}:{number}: no number before '{MARK}', or an unknown form of it")
            problems += [f"{path}:{number}: {problem}" for problem in (fault(one, known) for one in found) if problem]
    return problems if marked else ["no marked number found"]


if __name__ == "__main__":
    project.run(check)
