# SPDX-License-Identifier: BSD-3-Clause
"""The thesis the twin grew from, chapter by chapter."""
import thesis_drive
import thesis_errata
import thesis_gear
import thesis_insertion

LEAD = """
The twin grew from a master's thesis: C. Costantino, *Sviluppo di un modello multibody di un harmonic drive a fini
diagnostici e prognostici*, Politecnico di Torino, 2021. Its chapter 3 describes the gear, chapter 6 gives numbers for
the insertion of the wave generator, chapter 7 lays down the working drive as theory only. Below each is run; the last
part lists where the thesis contradicts itself or its own results, each with a number.
"""


def build(page):
    page.text(LEAD)
    for chapter in (thesis_gear, thesis_insertion, thesis_drive, thesis_errata):
        chapter.build(page)
