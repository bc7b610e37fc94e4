# SPDX-License-Identifier: BSD-3-Clause
"""The short page of the validation, and the values of its rows, against which test/lint/doc_values.py holds the numbers
of other pages."""
import csv
import os
import re
import shutil

from bounds import number
from page import markdown_table, with_unit

# What a row compares the twin with, by its name; the first that fits.
CLASSES = [
    ("independent measurement", "measured or published elsewhere, nothing fitted to it",
     r"catalogue\.(hysteresis|lost_motion|back_driving|efficiency|load_dependent_loss|oil)|teeth\.(involute_in_mesh|"
     r"trapezoid_in_mesh|double_arc_|shipped_in_mesh|pressure_angle|interference_angle|jump_)|stress\.(pressure_angle|"
     r"endurance|cycles)|published\.|manufacture\.(as_built|series)|drives\.(torsion|"
     r"ur10e\.(load_loss\.(elbow|shoulder\.2)|payload|friction\.(elbow|base)))|heat\.ur|"
     r"size14\.(hysteresis|lost_motion)|"
     r"family\.(efficiency|back_driving|hysteresis)"),
    ("fitted", "a parameter was fitted to it",
     r"catalogue\.(torsion|no_load|starting)|drives\.|heat\.time_constant|"
     r"size14\.(torsion|no_load|starting|efficiency)|family\.torsion|stress\.finite_elements"),
    ("identity", "what holds in any model of its kind: balances, symmetries, conservation, closed forms",
     r"thesis\.(ratio_|torque_|fmeca_|backup_|inertia_|perimeter|balance|output_balance|condition_735|equilibrium_|"
     r"\w+_law|contact_point|rotation_|symmetric_|drift_|mean_torque)|teeth\.virtual_work|dynamics\.energy|"
     r"manufacture\.(perfect|closure|work|reproducible|sampling|averaged_|\w+_not_the_other|beat|table_)"),
    ("independent program", "numbers of the thesis' own program, or of one that shares nothing with the twin",
     r"thesis\.|stress\.(flange|transition|coning|warping|tooth_space)"),
    ("self-consistent", "one way of computing it beside another way of the same model", r""),
]

# Rows that a reader asks for first.
CHOSEN = [
    "thesis.force_max", "catalogue.torsion.14", "catalogue.torsion.67", "catalogue.torsion.150", "catalogue.hysteresis",
    "catalogue.no_load", "catalogue.starting", "catalogue.back_driving", "catalogue.efficiency",
    "catalogue.efficiency.0.1", "teeth.shipped_in_mesh_150", "teeth.jump_as_shipped", "stress.endurance_67",
    "manufacture.perfect", "manufacture.as_built_range", "drives.ur5.base", "drives.ur5.shoulder", "drives.ur5.elbow",
    "drives.torsion_residual", "heat.ur3.shoulder", "size14.efficiency", "size14.torsion.20", "family.back_driving.20",
    "dynamics.60rad_100Nm_mesh_force", "dynamics.317rad_20Nm_mesh_force",
]
FIGURES = ["catalogue_torsion", "catalogue_efficiency", "drives_ur5e", "quasi_static_error"]

HEAD = """# Validation

Written by `lab/run validate`; do not edit. Results of the twin beside the thesis it grew from (C. Costantino, *Sviluppo
di un modello multibody di un harmonic drive a fini diagnostici e prognostici*, Politecnico di Torino, 2021), the
gear maker's catalogue and recordings of real drives. Each row has a source, an expected value, the
twin's value and a tolerance with its reason.

```sh
lab/run validate                                     # every row, in a few minutes: the complete table in out/validation
lab/run validate --set contact.stiffness=1.1e+8      # the effect of another parameter
```

The complete table, with the runs, their commands, all figures and the errors found in the thesis, is
`out/validation/validation.md`. The exit code is 0 if every row holds or is one of those below that are known not to;
else the rows that fail are named. The values of all rows are in [validation.csv](validation.csv). The recordings of
real drives are not part of the project: without them the sections *Real drives* and *Heat* cannot be recomputed.
"""


def class_of(name):
    return next(title for title, _, pattern in CLASSES if re.match(pattern, name))


def anchor(title):
    return "".join(c for c in title.lower().replace(" ", "-") if c.isalnum() or c in "-_")


def row_table(rows):
    return markdown_table(["row", "quantity", "source", "expected", "twin"],
                          [[f"`{row.name}`", row.quantity, row.source, with_unit(row.bound.expected(), row.unit),
                            with_unit(f"{row.value:.4g}", row.unit)] for row in rows])


def counts(groups):
    return [[title, len(rows), sum(row.holds for row in rows)] for title, rows in groups]


def missing(rows):
    """What does not hold, and why: a line a row."""
    return markdown_table(["row", "quantity", "expected", "twin", "why"],
                          [[f"`{row.name}`", row.quantity, with_unit(row.bound.expected(), row.unit),
                            with_unit(f"{row.value:.4g}", row.unit), row.known or "**unexpected**"]
                           for row in rows if not row.holds])


def write(docs, complete, pages, titles):
    """docs/validation.md and docs/validation.csv out of `pages`; figures are taken from the complete page's folder."""
    rows = [row for page in pages for row in page.rows]
    classes = [(f"{title}: {meaning}", [row for row in rows if class_of(row.name) == title])
               for title, meaning, _ in CLASSES]
    holding = sum(row.holds for row in rows)
    lines = [HEAD, f"**{len(rows)} rows: {holding} hold, {len(rows) - holding} do not.**", ""]
    lines += markdown_table(["section", "rows", "hold"],
                            counts((titles[page.section], page.rows) for page in pages if page.rows))
    lines += ["", "## What a row is worth", "",
              "Rows that hold are evidence of different weight; each has its class in "
              "[validation.csv](validation.csv). Only the first class compares the twin with "
              "something that it was not made from. The rows of the thesis' chapters 6 and 7 are run on its gear "
              "(`config/golden.yaml`), not on the shipped one. Its claim that the number of loaded teeth grows with "
              "the load does not hold everywhere as shipped: [gear_study.md](gear_study.md).", ""]
    lines += markdown_table(["class", "rows", "hold"], counts(classes))
    lines += ["", "## What does not hold", ""] + missing(rows)
    lines += ["", "## Some of the rows", ""] + row_table([row for row in rows if row.name in CHOSEN]) + [""]
    images = os.path.join("images", "validation")
    shutil.rmtree(os.path.join(docs, images), ignore_errors=True)
    os.makedirs(os.path.join(docs, images))
    captions = [line for page in pages for line in page.lines if line.startswith("![")]
    for name in FIGURES:
        file = os.path.join(images, name + ".png")
        shutil.copyfile(os.path.join(complete, file), os.path.join(docs, file))
        lines += [next(line for line in captions if f"/{name}.png)" in line), ""]
        lines += [f"*{lines[-2][2:].split('](')[0]}*", ""]
    with open(os.path.join(docs, "validation.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines).rstrip() + "\n")
    with open(os.path.join(docs, "validation.csv"), "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["row", "value", "unit", "expected", "holds", "class"])
        table.writerows([row.name, number(row.value), row.unit, row.bound.expected(), "yes" if row.holds else "no",
                         class_of(row.name)]
                        for row in rows)
        table.writerows([name, number(value), unit, "", "", ""] for page in pages for name, value, unit in page.values)
