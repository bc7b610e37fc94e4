# SPDX-License-Identifier: BSD-3-Clause
"""The short page of the validation, and the values of its rows, against which test/lint/pages.py holds the numbers
of other pages."""
import csv
import os
import shutil

from bounds import number
from evidence import CLASSES
from page import markdown_table, with_unit
from lab import wrapped  # its folder is known from page

FIGURES = ["catalogue_torsion", "catalogue_efficiency", "drives_ur5e", "quasi_static_error"]

HEAD = """# Validation

`lab/run validate` writes this page. The page compares the twin with figures from three kinds of sources. The first is
the thesis that the twin grew from (C. Costantino, *Sviluppo di un modello multibody di un harmonic drive a fini
diagnostici e prognostici*, Politecnico di Torino, 2021). The second are the catalogues of two makers (Harmonic Drive
HFUS-25 for stiffness and ratings, Schaeffler RT1-H-CS-25 for friction and efficiency). The third are recordings of real
drives. A row is one comparison, with a source, an expected value, the twin's value, and a tolerance with its reason.

```sh
lab/run validate                                     # every row, in a few minutes: the complete table in out/validation
lab/run validate --set contact.stiffness=1.1e+8      # the effect of another parameter
```

The complete table is in `out/validation/validation.md`, with the commands of all runs and the errors found in the
thesis. [validation.csv](validation.csv) has the values of all rows. The exit code of `lab/run validate` is 0 if all
rows hold except those in [What does not hold](#what-does-not-hold). If another row fails, the program names this row.
The recordings of real drives are not part of the project. Without these recordings the program cannot recompute the
sections *Real drives* and *Heat*.
"""


def anchor(title):
    return "".join(c for c in title.lower().replace(" ", "-") if c.isalnum() or c in "-_")


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
    classes = [(f"{title}: {meaning}", [row for row in rows if row.evidence.title == title])
               for title, meaning in CLASSES.items()]
    holding = sum(row.holds for row in rows)
    lines = [wrapped(HEAD), f"**{len(rows)} rows: {holding} hold, {len(rows) - holding} do not.**", ""]
    with open(os.path.join(docs, "validation_sections.csv"), "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([["section", "rows", "hold"], *counts(
            (titles[page.section], page.rows) for page in pages if page.rows)])
    lines += ["[validation_sections.csv](validation_sections.csv) counts the rows of each section, and the rows that "
              "hold.",
              "", "## What a row is worth", "",
              "How strongly a row within its tolerance supports the model depends on the source of the row. "
              "[validation.csv](validation.csv) states the class of evidence of each row, and which parameter was "
              "fitted to which figure. Only the class *independent measurement* compares the twin with figures that no "
              "part of the twin was fitted to. The table does not count quantities that only a broken gear would miss, "
              "but the CSV file shows the values of these quantities. The rows of the thesis' chapters 6 and 7 are for "
              "the gear of the thesis "
              "(`config/golden.yaml`), not for the shipped gear. The thesis claims that the number of loaded teeth "
              "grows with the load. On the shipped gear this claim does not hold everywhere "
              "([gear_study.md](gear_study.md)).", ""]
    lines += markdown_table(["class", "rows", "hold"], counts(classes))
    lines += ["", "## What does not hold", ""] + missing(rows)
    lines += ["", "## Figures", ""]
    images = os.path.join("images", "validation")
    shutil.rmtree(os.path.join(docs, images), ignore_errors=True)
    os.makedirs(os.path.join(docs, images))
    captions = [line for page in pages for line in page.lines if line.startswith("![")]
    for name in FIGURES:
        file = os.path.join(images, name + ".png")
        shutil.copyfile(os.path.join(complete, file), os.path.join(docs, file))
        lines += [next(line for line in captions if f"/{name}.png)" in line)]
        lines += [f"*{lines[-1][2:].split('](')[0]}*", ""]
    with open(os.path.join(docs, "validation.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines).rstrip() + "\n")
    with open(os.path.join(docs, "validation.csv"), "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["row", "value", "unit", "expected", "holds", "class", "source", "link"])
        table.writerows([row.name, number(row.value), row.unit, row.bound.expected(), "yes" if row.holds else "no",
                         row.evidence.title, row.source, row.evidence.link] for row in rows)
        table.writerows([name, number(value), unit, "", "", "", "", ""]
                        for page in pages for name, value, unit in page.values)
