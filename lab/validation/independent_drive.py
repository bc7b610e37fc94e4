# SPDX-License-Identifier: BSD-3-Clause
"""The loaded drive with the wave generator locked, written for this page from the laws in docs/model.md: nothing of the
twin is used. The ring of `independent_ring.py` with the flanks' energy, the cup on the mean rotation, and the output's
angle under a load; derivatives of the flanks' energy by complex steps."""
import numpy as np
from independent_ring import PITCH, TEETH, IndependentRing, wrapped

SPACES = 202
COMPLEX = 1e-25  # m or rad
# Thesis, Tables 3.4 and 3.6, w0 of 5.1 [m]: rim, tooth, tip radius of the circular spline, wave.
RIM, TOOTH, TIP, WAVE = 0.8e-3, 0.5e-3, 31.95e-3, 0.35e-3
# Straight flanks: stiffness of a pair along the normal [N/m], angle [rad], half clearance and depth of engagement [m].
STIFFNESS, ANGLE, CLEARANCE, DEPTH = 5.0e7, np.radians(17.0), -1.0e-6, 20.0e-6
BREAKPOINTS = (14.0, 48.0)  # of the cup, thesis, Table 7.1 [N.m]
LONGEST = 1e-5  # way of a tooth in a step of Newton's method [m]
COLOURS = 4  # teeth so far apart share no flank


def real_max(value):
    """<value>+, by the real part."""
    return np.where(value.real > 0.0, value, 0.0)


class IndependentDrive(IndependentRing):
    """Straight flanks, springs under the teeth. `radius`, `stiffness`: of the ring; `slopes`: of the cup's torque over
    its mean rotation [N.m/rad]."""

    def __init__(self, radius, stiffness, slopes):
        super().__init__(radius, stiffness, "normal", "curvature")
        self.slopes = slopes
        self.output = 0.0  # angle of the circular spline [rad]
        self.load = 0.0  # N.m
        self.space = np.zeros(TEETH)

    def flanks(self, x, y, output):
        """Of each tooth: energy [J] and force along the flank's normal [N]."""
        dx, dy = np.roll(x, -1) - np.roll(x, 1), np.roll(y, -1) - np.roll(y, 1)
        chord = np.sqrt(dx * dx + dy * dy)
        px, py = x + (RIM + 0.5 * TOOTH) * dy / chord, y - (RIM + 0.5 * TOOTH) * dx / chord
        axis = self.space + output
        along, across = px * np.cos(axis) + py * np.sin(axis), py * np.cos(axis) - px * np.sin(axis)
        clearance = CLEARANCE + (self.radius + RIM + 0.5 * TOOTH + WAVE - along) * np.tan(ANGLE)
        depth = (along + 0.5 * TOOTH - TIP) / DEPTH
        u = np.where(depth.real < 1.0, real_max(depth), 1.0)
        stiffness = STIFFNESS * np.cos(ANGLE) ** 2 * u * u * (3.0 - 2.0 * u)
        ahead, behind = real_max(across - clearance), real_max(-across - clearance)
        force = stiffness.real * (ahead - behind).real / np.cos(ANGLE)
        return 0.5 * stiffness * (ahead * ahead + behind * behind), force

    def pair(self):
        """Each tooth with the space that it points to."""
        x, y = self.points()
        pitch = 2.0 * np.pi / SPACES
        self.space = pitch * np.round((np.arctan2(y, x) - self.output) / pitch)

    def flank_forces(self, position):
        """On the teeth, x of all, then y [N]."""
        force = np.zeros(2 * TEETH)
        for colour in range(COLOURS):
            moved = np.arange(colour, TEETH, COLOURS)
            for half in (0, TEETH):
                shifted = position.astype(complex)
                shifted[moved + half] += 1j * COMPLEX
                slope = self.flanks(shifted[:TEETH], shifted[TEETH:], self.output)[0].imag / COMPLEX
                force[moved + half] = -(np.roll(slope, 1) + slope + np.roll(slope, -1))[moved]
        return force

    def output_torque(self, position):
        """Of the flanks on the circular spline [N.m]."""
        return -np.sum(self.flanks(position[:TEETH] + 0j, position[TEETH:] + 0j,
                                   self.output + 1j * COMPLEX)[0].imag) / COMPLEX

    def rotation(self, position):
        """Mean of the teeth's angles from rest [rad], and its derivative by the positions."""
        x, y = position[:TEETH], position[TEETH:]
        turned = wrapped(np.arctan2(y, x) - PITCH * np.arange(TEETH))
        return np.mean(turned), np.concatenate((-y, x)) / np.tile(x * x + y * y, 2) / TEETH

    def cup_torque(self, rotation):
        """And its slope: three straight pieces [N.m], [N.m/rad]."""
        torque, start, left = 0.0, 0.0, abs(rotation)
        for slope, end in zip(self.slopes, (*BREAKPOINTS, np.inf)):
            piece = min(left, (end - start) / slope)
            torque, left, start = torque + slope * piece, left - piece, end
            if left <= 0.0:
                break
        return np.copysign(torque, rotation), slope

    def unbalanced(self, position):
        rotation, by_position = self.rotation(position)
        held = self.held if self.held is not None else self.cup_torque(rotation)[0]
        return super().unbalanced(position) + self.flank_forces(position) - held * by_position

    held = None  # torque of the cup while the tangent is taken: its change is of all teeth [N.m]

    def solve(self, tolerance=1e-6, iterations=60):
        """To equilibrium at the present wave and load. @raises RuntimeError: there is none within the tolerance [N]."""
        self.pair()
        for _ in range(iterations):
            left = self.unbalanced(self.position)
            torque = self.output_torque(self.position) - self.load
            if np.max(np.abs(left)) < tolerance and abs(torque) < tolerance * self.radius:
                return self
            rotation, by_position = self.rotation(self.position)
            self.held, slope = self.cup_torque(rotation)
            tangent = self.tangent(self.position) - slope * np.outer(by_position, by_position)
            self.held = None
            step = 1e-9
            self.output += step
            ahead = self.flank_forces(self.position), self.output_torque(self.position)
            self.output -= 2.0 * step
            back = self.flank_forces(self.position), self.output_torque(self.position)
            self.output += step
            column = (ahead[0] - back[0]) / (2.0 * step)
            bordered = np.block([[tangent, column[:, None]],
                                 [column[None, :], np.array([[(ahead[1] - back[1]) / (2.0 * step)]])]])
            change = np.linalg.solve(bordered, np.concatenate((left, [torque])))
            change *= min(1.0, LONGEST / np.max(np.abs(change[:-1])))
            self.position, self.output = self.position - change[:-1], self.output - change[-1]
        raise RuntimeError(f"no equilibrium at {self.load} N.m: {np.max(np.abs(left)):.3g} N are left")

    def start_from(self, ring):
        """The circular spline is put around a ring on its wave generator, without load."""
        self.wave, self.position, self.load = ring.wave, ring.position.copy(), 0.0
        return self.solve()

    def carry(self, load, most=50.0):
        """To a load on the output, > 0 resists positive motion [N.m], in steps of at most `most`."""
        for self.load in np.linspace(self.load, load, int(np.ceil(abs(load - self.load) / most)) + 1)[1:]:
            self.solve()
        return self

    def flank_force(self):
        """Of each tooth, along the flank's normal [N]."""
        x, y = self.points()
        return self.flanks(x + 0j, y + 0j, self.output)[1]

    def wave_generator_torque(self):
        """That holds it [N.m]."""
        x, y = self.points()
        force, normal = self.contact_forces(x, y)
        return -float(np.sum(force * (x * np.sin(normal) - y * np.cos(normal))))
