# SPDX-License-Identifier: BSD-3-Clause
"""What a judged row is worth as evidence. Each row states its own, beside its bound."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Evidence:
    """Class of a row, and how its expected value and the configuration hang together."""
    title: str
    link: str = ""  # what was fitted to what; of a measurement: why what shares its source was not fitted to it


def measured(shares=""):
    """Measured or published elsewhere. `shares`: what of the configuration comes from the same source, and why the row
    is none of it."""
    return Evidence("independent measurement", shares)


def fitted(what):
    """`what` of the configuration was fitted to this very figure, or to others of the same runs."""
    return Evidence("fitted", what)


MEASUREMENT = measured()
THESIS_PROGRAM = Evidence("program of the thesis")
OWN_PROGRAM = Evidence("second program of this project")
IDENTITY = Evidence("identity")
SELF_CONSISTENT = Evidence("self-consistent")

CLASSES = {
    "independent measurement": "measured or published elsewhere; nothing was fitted to the figure",
    "fitted": "a parameter was fitted to this figure, or to figures of the same runs",
    "program of the thesis": "numbers of the thesis' own program, on the gear of the thesis",
    "second program of this project": "an independent program of the same laws, which shows that the code solves them",
    "identity": "balances, symmetries, conservation laws and closed forms, which hold in any model of this kind",
    "self-consistent": "two ways of computing the same quantity of the model",
}
