# SPDX-License-Identifier: BSD-3-Clause
"""What the indicators and the numbers of a signature are called in the source."""

SIGNALS = {"error": "KINEMATIC_ERROR", "torque": "MOTOR_TORQUE", "ripple": "MOTOR_RIPPLE"}


def line_of(name):
    """(signal, line) of "error_wave_generator_2"; None: it is a scalar."""
    signal, _, line = name.partition("_")
    if signal not in SIGNALS:
        return None
    return f"LineSignal::{SIGNALS[signal]}, index(Line::{line.upper()})"


def scalar(name):
    return f"indexOf(ScalarIndicator::{name.upper()})"


def indicator(name):
    """Its index: "torque_ball", "torque_wave_generator_2_cos"."""
    for end, function in (("_cos", "cosineIndex"), ("_sin", "sineIndex"), ("", "amplitudeIndex")):
        line = line_of(name[:len(name) - len(end)]) if name.endswith(end) else None
        if line:
            return f"{function}({line})"
    return scalar(name)


def signature_number(name):
    line = line_of(name)
    return f"signatureNumber({line})" if line else scalar(name)
