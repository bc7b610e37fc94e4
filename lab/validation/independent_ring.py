# SPDX-License-Identifier: BSD-3-Clause
"""The insertion of the wave generator by the equations of the thesis' chapter 5, written for this page from the text
alone: nothing of the twin is used. Statics by Newton's method on the positions of the teeth."""
import numpy as np

from thesis_forms import foot

TEETH = 200
PITCH = 2.0 * np.pi / TEETH
REACH = 2  # a tooth's forces depend on the positions of so many teeth to either side
COLOURS = 2 * REACH + 1  # columns of the tangent so far apart share no row: all of a colour come from one difference


def wrapped(angle):
    """To -pi ... pi."""
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


class IndependentRing:
    """The rim on the wave generator at rest, without circular spline. `radius` [m]; stiffness of contact and tension
    [N/m], of bending [N.m/rad].

    `contact_law`: "polar" is eq. 5.11, "normal" the true foot of the normal. `bending_law`: "absolute" is eq. 5.47 to
    5.53, "one_force" the same with a single bending force on each tooth, as eq. 5.1 and 5.2 print it, "curvature"
    resists the change of angle between neighbouring segments."""

    def __init__(self, radius, stiffness, contact_law="polar", bending_law="absolute"):
        self.radius = radius
        self.contact, self.tension, self.bending = stiffness
        self.contact_law, self.bending_law = contact_law, bending_law
        self.wave = 0.0
        self.position = radius * np.concatenate((np.cos(PITCH * np.arange(TEETH)), np.sin(PITCH * np.arange(TEETH))))

    def points(self):
        """x and y of all teeth [m]."""
        return self.position[:TEETH], self.position[TEETH:]

    def contact_forces(self, x, y):
        """Size of the wave generator's force on each tooth [N], and its direction [rad]."""
        a, b = self.radius + self.wave, self.radius - self.wave
        if self.contact_law == "polar":  # eq. 5.11, 5.15
            polar, normal = np.arctan2(y, x), np.arctan2(a * a * y, b * b * x)
            foot_x, foot_y = a * np.cos(polar), b * np.sin(polar)
        else:
            foot_x, foot_y = foot(a, b, x, y)
            normal = np.arctan2(a * a * foot_y, b * b * foot_x)
        overlap = (foot_x - x) * np.cos(normal) + (foot_y - y) * np.sin(normal)  # eq. 5.22
        return self.contact * np.maximum(overlap, 0.0), normal  # eq. 5.23

    def segments(self, x, y):
        """From each tooth to the next: tension [N], bending force [N], direction [rad]."""
        dx, dy = np.roll(x, -1) - x, np.roll(y, -1) - y
        length, slope = np.hypot(dx, dy), np.arctan2(dy, dx)
        tension = self.tension * (length - 2.0 * self.radius * np.sin(0.5 * PITCH))  # eq. 5.33
        turn = wrapped(slope - PITCH * (np.arange(TEETH) + 0.5) - 0.5 * np.pi)  # eq. 5.48
        if self.bending_law == "curvature":
            moment = self.bending * wrapped(turn - np.roll(turn, 1))
            return tension, (moment - np.roll(moment, -1)) / length, slope
        return tension, self.bending * turn / length, slope  # eq. 5.51-5.52

    def unbalanced(self, position):
        """Force left on each tooth: x of all, then y [N]."""
        x, y = position[:TEETH], position[TEETH:]
        force, normal = self.contact_forces(x, y)
        tension, bending, slope = self.segments(x, y)
        after = (tension * np.cos(slope) - bending * np.sin(slope), tension * np.sin(slope) + bending * np.cos(slope))
        before = (tension * np.cos(slope), tension * np.sin(slope)) if self.bending_law == "one_force" else after
        return np.concatenate((force * np.cos(normal) + after[0] - np.roll(before[0], 1),
                               force * np.sin(normal) + after[1] - np.roll(before[1], 1)))

    def tangent(self, position):
        """Derivative of `unbalanced`, by central differences [N/m]."""
        step = 1e-9
        tangent = np.zeros((2 * TEETH, 2 * TEETH))
        for colour in range(COLOURS):
            moved = np.arange(colour, TEETH, COLOURS)
            for column in (moved, moved + TEETH):
                shift = np.zeros(2 * TEETH)
                shift[column] = step
                change = (self.unbalanced(position + shift) - self.unbalanced(position - shift)) / (2.0 * step)
                for distance in range(-REACH, REACH + 1):
                    row = (moved + distance) % TEETH
                    tangent[row, column] = change[row]
                    tangent[row + TEETH, column] = change[row + TEETH]
        return tangent

    def insert(self, wave, steps=50, tolerance=1e-5):
        """Grows the wave to this amplitude [m] in steps. Returns itself.
        @raises RuntimeError: no equilibrium within `tolerance` [N]."""
        for self.wave in wave * np.arange(1, steps + 1) / steps:
            for _ in range(60):
                left = self.unbalanced(self.position)
                if np.max(np.abs(left)) < tolerance:
                    break
                self.position = self.position - np.linalg.solve(self.tangent(self.position), left)
            else:
                raise RuntimeError(f"no equilibrium at a wave of {1e3 * self.wave:.4f} mm: "
                                   f"{np.max(np.abs(left)):.3g} N are left")
        return self
