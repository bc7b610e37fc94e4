# SPDX-License-Identifier: BSD-3-Clause
"""Cup of the flexspline as a thin shell of revolution: stresses along it where the wave generator bends its rim.

Linear finite elements along the axis for the second harmonic around it: u cos 2a along the axis, v sin 2a around, w cos
2a outwards. Linear u and v, cubic w; membrane and bending energy after Sanders. Nothing in common with the twin's ring.
"""
from dataclasses import dataclass

import numpy

POISSON = 0.3
HARMONIC = 2
ELEMENTS = 240  # of the wall; half as many of the toothed rim
U, V, W, SLOPE = range(4)  # of a node


@dataclass
class Cup:
    """Lengths in m."""
    radius: float = 31.0e-3
    length: float = 30.8e-3
    face_width: float = 11.6e-3
    wall: float = 0.4e-3
    rim: float = 0.8e-3
    amplitude: float = 0.35e-3
    modulus: float = 210e9
    race: tuple = (5.8e-3, 5.8e-3)  # from the open end: where the rim stands out by the amplitude
    built_in: bool = False  # at the flange; otherwise it holds the circle and lets the end warp and turn

    @property
    def to_middle(self):
        return self.length - 0.5 * self.face_width

    @property
    def to_teeth(self):
        return self.length - self.face_width


def strains(cup, place, height):
    """Rows that give membrane strains (along, around, shear) and changes of curvature of an element's eight numbers."""
    s, n, r = place, HARMONIC, cup.radius
    rows = numpy.zeros((7, 8))
    u, du, v, dv, w, dw, ddw = rows
    u[[U, 4 + U]], du[[U, 4 + U]] = (1 - s, s), (-1 / height, 1 / height)
    v[[V, 4 + V]], dv[[V, 4 + V]] = u[[U, 4 + U]], du[[U, 4 + U]]
    cubic = [W, SLOPE, 4 + W, 4 + SLOPE]
    w[cubic] = 1 - 3 * s**2 + 2 * s**3, height * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3, height * (s**3 - s**2)
    dw[cubic] = numpy.array([-6 * s + 6 * s**2, height * (1 - 4 * s + 3 * s**2), 6 * s - 6 * s**2,
                             height * (3 * s**2 - 2 * s)]) / height
    ddw[cubic] = numpy.array([-6 + 12 * s, height * (-4 + 6 * s), 6 - 12 * s, height * (6 * s - 2)]) / height**2
    membrane = numpy.array([du, (n * v + w) / r, dv - n * u / r])
    bending = numpy.array([-ddw, (n * n * w + n * v) / r**2, (2 * n * dw + 1.5 * dv + 0.5 * n * u / r) / r])
    return membrane, bending


def solve(cup):
    """For each element: distance of its middle from the flange and thickness [m], membrane and bending stress along the
    axis [Pa]."""
    nodes = numpy.concatenate([numpy.linspace(0, cup.to_teeth, ELEMENTS + 1),
                               numpy.linspace(cup.to_teeth, cup.length, ELEMENTS // 2 + 1)[1:]])
    thickness = numpy.where(0.5 * (nodes[1:] + nodes[:-1]) > cup.to_teeth, cup.rim, cup.wall)
    plane = numpy.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, 0.5 * (1 - POISSON)]])
    stiffness = numpy.zeros((4 * len(nodes), 4 * len(nodes)))
    for e, t in enumerate(thickness):
        height = nodes[e + 1] - nodes[e]
        of = slice(4 * e, 4 * e + 8)
        scale = cup.modulus * t / (1 - POISSON**2)
        for place, weight in zip(*numpy.polynomial.legendre.leggauss(3)):
            membrane, bending = strains(cup, 0.5 * (1 + place), height)
            stiffness[of, of] += 0.5 * weight * height * scale * (membrane.T @ plane @ membrane
                                                                  + t**2 / 12 * bending.T @ plane @ bending)
    fixed = {V: 0.0, W: 0.0}
    if cup.built_in:
        fixed.update({U: 0.0, SLOPE: 0.0})
    first, last = (numpy.argmin(numpy.abs(cup.length - nodes - end)) for end in cup.race[::-1])
    for node in range(first, last + 1):
        fixed[4 * node + W] = cup.amplitude
    held = numpy.array(sorted(fixed))
    free = numpy.setdiff1d(numpy.arange(4 * len(nodes)), held)
    shape = numpy.zeros(4 * len(nodes))
    shape[held] = [fixed[k] for k in held]
    shape[free] = numpy.linalg.solve(stiffness[numpy.ix_(free, free)], -stiffness[numpy.ix_(free, held)] @ shape[held])
    result = []
    for e, t in enumerate(thickness):
        membrane, bending = strains(cup, 0.5, nodes[e + 1] - nodes[e])
        own = shape[4 * e:4 * e + 8]
        scale = cup.modulus / (1 - POISSON**2)
        result.append((0.5 * (nodes[e] + nodes[e + 1]), t, scale * (plane @ membrane @ own)[0],
                       0.5 * t * scale * (plane @ bending @ own)[0]))
    return numpy.array(result)


def at_transition(cup):
    """Bending stress along the axis in the last of the wall before the teeth [Pa]."""
    rows = solve(cup)
    return abs(rows[rows[:, 1] == cup.wall][-1, 3])


def at_flange(cup):
    """Membrane and bending stress along the axis where the cup is held [Pa]."""
    return abs(solve(cup)[0, 2:]).sum()
