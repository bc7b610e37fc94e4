# SPDX-License-Identifier: BSD-3-Clause
"""Reads and writes files of signatures (config/signatures/)."""
import re

import yaml

UNITS = {"error": "rad", "torque": "N.m", "ripple": "rad"}  # of lines, by the signal they stand in
HEAD = """\
# SPDX-License-Identifier: BSD-3-Clause
# What faults change in the health indicators of a gear, found in the twin's own runs
# (docs/indicators.md, "Signatures").
# Written by `scripts/evaluate_health`.
format: 2
gear: {gear}

# Errors by the law of docs/indicators.md [-]: of each number of a signature and of its length on another gear in
# another motion, share of the sound drive's lines that a fault of severity 1 changes, weight of the evidence, of the
# severity.
errors:
{errors}

# Indicators that the signatures are known for, in the order of the columns below, and their units.
indicators:
{indicators}

# Values of the sound drive in the check-up, in these units.
sound:
{sound}

# What the indicators of a sound drive less a model's differ by from one motion to another: [deviation in the
# indicator's unit, share of what drive and model differ by, degrees of freedom]. Not known of what is missing here.
carried:
{carried}

# A row each: cause, motion, speed of the motor [rad/s] and share of travel one way less the other [-] (magnitudes; 0 0:
# any motion), severity [-], then the change of each of the indicators; of stiffness, lost motion and loop, and of
# friction by thicker grease, as a share of the sound value [-].
signatures: |
{rows}
"""


def header_number(value):
    """Spelt so that every YAML reader takes it for a number; the shortest that reads back the same."""
    text = repr(float(value))
    return text if "." in text else text.replace("e", ".0e")


def short(value, digits=3):
    """As short as can be: -2.44e-5."""
    return re.sub(r"e([+-])0*", lambda sign: "e" + sign[1].strip("+"), f"{value:.{digits}g}")


def read(path):
    """The file as a dict; "signatures": rows of words."""
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    content["signatures"] = [row.split() for row in content["signatures"].splitlines()]
    return content


def write(path, content):
    """What `read` gives."""
    def lines(key, text):
        return "\n".join(f"  {name}: {text(value)}" for name, value in content[key].items())
    path.write_text(HEAD.format(
        gear=content["gear"], errors=lines("errors", header_number), sound=lines("sound", header_number),
        indicators=lines("indicators", lambda unit: '"-"' if unit == "-" else unit),
        carried=lines("carried", lambda numbers: f"[{', '.join(map(header_number, numbers))}]"),
        rows="\n".join("  " + " ".join(row) for row in content["signatures"])), encoding="utf-8")


def unit_of(name, content):
    """Of a line by its signal, of a scalar as in the file so far."""
    signal = name.split("_")[0]
    if name not in content["indicators"] and signal not in UNITS:
        raise SystemExit(f"evaluate_health: name the unit of {name} below 'indicators' in the file of signatures first")
    return content["indicators"].get(name) or UNITS[signal]
