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
    "independent measurement": "measured or published elsewhere, nothing fitted to it",
    "fitted": "a parameter was fitted to it, or to figures of the same runs",
    "program of the thesis": "numbers of the thesis' own program, on its gear",
    "second program of this project": "the same laws, written a second time: that the code solves what it states",
    "identity": "what holds in any model of its kind: balances, symmetries, conservation, closed forms",
    "self-consistent": "one way of computing it beside another way of the same model",
}
