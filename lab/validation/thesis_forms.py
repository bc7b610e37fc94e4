# SPDX-License-Identifier: BSD-3-Clause
"""Formulas of the thesis as it prints them, and the right ones beside them."""
import math

import numpy as np


def foot(a, b, x, y):
    """Foot on the ellipse of the normal through (x, y), by Newton on its parameter."""
    angle = np.arctan2(a * y, b * x)
    for _ in range(50):
        cos, sin = np.cos(angle), np.sin(angle)
        value = (a * a - b * b) * cos * sin - a * x * sin + b * y * cos
        slope = (a * a - b * b) * (cos**2 - sin**2) - a * x * cos - b * y * sin
        angle = angle - value / slope
    return a * np.cos(angle), b * np.sin(angle)


def quartic_root(a, b, x, y, leading):
    """Eq. 5.9-5.10 with a given coefficient A: the real root nearest to x."""
    second = 2.0 * a**2 * x * (b**2 - a**2)
    third = a**4 * x**2
    roots = np.roots([leading, second, third + b**2 * a**2 * y**2 - a**2 * leading, -a**2 * second, -a**2 * third])
    real = roots[np.abs(roots.imag) < 1e-9 * np.abs(roots)].real
    return float(real[np.argmin(np.abs(real - x))]) if len(real) else float("nan")


def palmgren(speed, viscosity, diameter, factor=1.5):
    """Eq. 7.32a for rpm, mm^2/s, mm. [N.m]"""
    return 1e-3 * factor * (viscosity * speed)**(2.0 / 3.0) * diameter**3 * 1e-7


def ray_point(a, b, theta, psi):
    """Where the ray at psi meets the ellipse turned by theta."""
    radius = a * b / math.hypot(b * math.cos(psi - theta), a * math.sin(psi - theta))
    return radius * math.cos(psi), radius * math.sin(psi)


def printed_height(a, b, theta, x):
    """Eq. 7.18-7.19 as printed. [m]"""
    cos, sin = math.cos(theta), math.sin(theta)
    square = a**2 * cos**2 + b**2 * sin**2
    inside = square - x**2 * (cos**4 + sin**4 + 2.0 * cos**2 * sin**2) + (a**2 - b**2) * x * cos * sin
    return a * b * math.sqrt(inside) / square
