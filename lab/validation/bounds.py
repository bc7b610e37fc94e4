# SPDX-License-Identifier: BSD-3-Clause
"""What a judged quantity has to keep to. A value that is no number keeps to nothing."""
from dataclasses import dataclass


def number(value):
    """Six digits, no more zeros than needed."""
    return f"{value:.6g}"


@dataclass
class Within:
    """An expected value and how far from it is still right: absolute, relative, or both (the wider counts)."""
    target: float
    absolute: float = 0.0
    relative: float = 0.0

    def holds(self, value):
        return abs(value - self.target) <= max(self.absolute, self.relative * abs(self.target))

    def expected(self):
        return number(self.target)

    def tolerance(self, unit):
        parts = []
        if self.absolute:
            parts.append(f"± {number(self.absolute)} {unit}".strip())
        if self.relative:
            parts.append(f"± {number(100.0 * self.relative)} %")
        return " or ".join(parts) if parts else "exact"


@dataclass
class Between:
    low: float
    high: float

    def holds(self, value):
        return self.low <= value <= self.high

    def expected(self):
        return f"{number(self.low)} … {number(self.high)}"

    def tolerance(self, _unit):
        return "the band"


@dataclass
class AtMost:
    limit: float

    def holds(self, value):
        return value <= self.limit

    def expected(self):
        return f"≤ {number(self.limit)}"

    def tolerance(self, _unit):
        return "a limit"


@dataclass
class AtLeast:
    limit: float

    def holds(self, value):
        return value >= self.limit

    def expected(self):
        return f"≥ {number(self.limit)}"

    def tolerance(self, _unit):
        return "a limit"
