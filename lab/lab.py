# SPDX-License-Identifier: BSD-3-Clause
"""What the programs of the laboratory share: the measured part of a page that is written by hand otherwise, between
`<!-- NAME:begin -->` and `<!-- NAME:end -->`, and the drawing style of the package's own figures."""
import csv
import pathlib
import re
import sys
import textwrap

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent
WIDTH = 150  # of a line of a page
STOPPED = 5  # exit code of `joint_twin arm` after a protective stop

sys.path.append(str(CHECKOUT / "scripts"))
from drawing import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, STYLE, plt  # noqa: E402, F401  (after its folder)


# Tables that nobody reads line by line: by the name of their part, the files beside the page that hold all of their
# rows, in the order of the tables, and which rows the page shows (None: no table).
APART = {
    "arm_faults": [("arm_faults_worst.csv", "interface|lubricant|tooth_wear|wave|pitting|ratcheting")],
    "bound": [("health_bound.csv", None)],
    "carried": [("health_carried.csv", None)],
    "constants": [("signature_effects.csv", None)],
    "cycle": [("performance.csv", "reversing")],
    "health": [("health_runs.csv", None), ("health_kinds.csv", r"^\| all ")],
    "life": [("life_fatigue.csv", None), ("life_scores.csv", None), ("life_tenths.csv", None),
             ("life_ends.csv", None)],
    "motions": [("health_motions.csv", "three gears|another model|a further model"), ("health_missed.csv", None)],
    "options": [("performance_options.csv", None)],
    "others": [("faults_others.csv", r"\| none|0\.02 N|\b1 counts|1 mrad|\b5 %")],
    "repeats": [("health_references.csv", None), ("health_repeats.csv", None)],
    "read": [("life_read.csv", "all check-ups")],
    "risk": [("faults_risk.csv", None)],
    "seen": [("health_robots.csv", r"\b[12], |, [12]\b|\| (none|named|true)")],
    "series": [("health_series.csv", r"^\| all ")],
    "signatures": [("signatures_runs.csv", None), ("signatures.csv", None)],
}


def wrapped(text):
    """Paragraphs in lines of WIDTH; headings, tables, figures, lists and code as they are. A table ends at the first
    line that does not begin with a bar."""
    return "\n\n".join(part if part.lstrip().startswith(("#", "|", "!", "- ", "```")) else
                       textwrap.fill(" ".join(part.split()), WIDTH, break_long_words=False, break_on_hyphens=False)
                       for part in re.split(r"\n\n+|(?<=\|)\n(?!\|)", text.strip("\n"))) + "\n"


def apart(folder, name, lines):
    """`lines`, their tables written to the files that APART gives; a link to the file stands below each, or
    one line of links below several."""
    files = list(APART.get(name, []))
    found, row = [], 0
    while row < len(lines):
        table = []
        while row < len(lines) and lines[row].startswith("|"):
            table.append(lines[row])
            row += 1
        if not table or not files:
            found += table or [lines[row]]
            row += not table
            continue
        file, shown = files.pop(0)
        cells = [[cell.strip().replace("`", "") for cell in line.strip("|").split("|")] for line in table]
        with open(folder / file, "w", encoding="utf-8", newline="") as out:
            csv.writer(out, lineterminator="\n").writerows(cells[:1] + cells[2:])
        found += table[:2] + [line for line in table[2:] if re.search(shown, line)] + [""] if shown else []
        if len(found) > 1 and found[-2].startswith("All rows: ") and not found[-1]:
            found[-2:] = [f"{found[-2][:-1]}, [{file}]({file})."]
        else:
            found.append(f"All rows: [{file}]({file}).")
    return found


def write(path, name, lines):
    path = pathlib.Path(path)
    lines = apart(path.parent, name, "\n".join(lines).split("\n"))
    begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
    before, rest = path.read_text(encoding="utf-8").split(begin)
    after = rest.split(end)[1]
    path.write_text(before + "\n".join([begin, "", *lines, "", end]) + after, encoding="utf-8")


def write_or_print(docs, page, name, lines):
    """Into `page` of the folder `docs`; without a folder, printed."""
    if docs:
        write(docs / page, name, lines)
    else:
        print("\n".join(lines))
