# SPDX-License-Identifier: BSD-3-Clause
"""Cup of the flexspline as a thin shell of revolution: stresses along it where the wave generator bends its rim.

Linear finite elements along the axis for the second harmonic around it: u cos 2a along the axis, v sin 2a around, w cos
2a outwards. Linear u and v, cubic w; membrane and bending energy after Sanders. Nothing in common with the twin's ring.
In the rim may lie the bearing's outer race, a shell of its own that follows the rim outwards, and the cup may end in a
plate, its diaphragm, clamped at a boss.
"""
from dataclasses import dataclass, replace

import numpy

POISSON = 0.3
HARMONIC = 2
ELEMENTS = 240  # of the wall; half as many of the toothed rim
RINGS = 60  # of the diaphragm
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
    race_section: tuple = (0.0, 1.3e-3, 10.3e-3, 30.2e-3)  # thickness, 0: none; ends from the open end; radius
    diaphragm: tuple = (0.0, 0.0)  # thickness, 0: none; radius of the boss

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


def gauss(points):
    """Places on 0 ... 1 and weights."""
    places, weights = numpy.polynomial.legendre.leggauss(points)
    return zip(0.5 * (1 + places), 0.5 * weights)


def plane_stress():
    return numpy.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, 0.5 * (1 - POISSON)]])


def shell_element(cup, thickness, height):
    """Stiffness of an element's eight numbers, for a radian around."""
    total = numpy.zeros((8, 8))
    for place, weight in gauss(3):
        membrane, bending = strains(cup, place, height)
        total += weight * (membrane.T @ plane_stress() @ membrane
                           + thickness**2 / 12 * bending.T @ plane_stress() @ bending)
    return total * height * cup.radius * cup.modulus * thickness / (1 - POISSON**2)


def plate_element(cup, inner, outer):
    """The same of a ring of the diaphragm: deflection along the axis and its slope outwards at both radii."""
    height, n = outer - inner, HARMONIC
    total = numpy.zeros((4, 4))
    for s, weight in gauss(4):
        r = inner + s * height
        f = numpy.array([1 - 3 * s**2 + 2 * s**3, height * (s - 2 * s**2 + s**3), 3 * s**2 - 2 * s**3,
                         height * (s**3 - s**2)])
        df = numpy.array([-6 * s + 6 * s**2, height * (1 - 4 * s + 3 * s**2), 6 * s - 6 * s**2,
                          height * (3 * s**2 - 2 * s)]) / height
        ddf = numpy.array([-6 + 12 * s, height * (-4 + 6 * s), 6 - 12 * s, height * (6 * s - 2)]) / height**2
        curved = numpy.array([ddf, df / r - n * n * f / r**2, 2 * n * (df / r - f / r**2)])
        total += weight * height * r * curved.T @ plane_stress() @ curved
    return total * cup.modulus * cup.diaphragm[0]**3 / 12 / (1 - POISSON**2)


def parts(cup, nodes, thickness):
    """Element matrices with the numbers of what they act on; -1: held at the boss. Beyond 4 a node come the race's
    own u and v, then the diaphragm's deflections and slopes from the boss outwards."""
    for e, t in enumerate(thickness):
        yield shell_element(cup, t, nodes[e + 1] - nodes[e]), list(range(4 * e, 4 * e + 8))
    added = 4 * len(nodes)
    section, front, back, radius = cup.race_section
    if section:
        first, last = (int(numpy.argmin(numpy.abs(cup.length - nodes - end))) for end in (back, front))
        race = replace(cup, radius=radius)
        for e in range(first, last):
            yield shell_element(race, section, nodes[e + 1] - nodes[e]), [
                number for k in (e, e + 1)
                for number in (added + 2 * (k - first), added + 2 * (k - first) + 1, 4 * k + W, 4 * k + SLOPE)]
        added += 2 * (last - first + 1)
    if cup.diaphragm[0]:
        radii = numpy.linspace(cup.diaphragm[1], cup.radius, RINGS + 1)
        numbers = [[-1, -1], *([added + 2 * k, added + 2 * k + 1] for k in range(RINGS - 1)), [U, SLOPE]]
        for k in range(RINGS):
            matrix = plate_element(cup, radii[k], radii[k + 1])
            if k == RINGS - 1:  # the corner stays a right angle: the plate's slope is the wall's, sign reversed
                turned = numpy.diag([1, 1, 1, -1])
                matrix = turned @ matrix @ turned
            yield matrix, numbers[k] + numbers[k + 1]


def solve(cup):
    """For each element: distance of its middle from the flange and thickness [m], membrane and bending stress along the
    axis [Pa]."""
    nodes = numpy.concatenate([numpy.linspace(0, cup.to_teeth, ELEMENTS + 1),
                               numpy.linspace(cup.to_teeth, cup.length, ELEMENTS // 2 + 1)[1:]])
    thickness = numpy.where(0.5 * (nodes[1:] + nodes[:-1]) > cup.to_teeth, cup.rim, cup.wall)
    elements = list(parts(cup, nodes, thickness))
    size = 1 + max(max(numbers) for _, numbers in elements)
    stiffness = numpy.zeros((size + 1, size + 1))  # the last stands for what is held at the boss
    for matrix, numbers in elements:
        stiffness[numpy.ix_(numbers, numbers)] += matrix
    fixed = {V: 0.0, W: 0.0, size: 0.0}
    if cup.built_in:
        fixed.update({U: 0.0, SLOPE: 0.0})
    first, last = (numpy.argmin(numpy.abs(cup.length - nodes - end)) for end in cup.race[::-1])
    for node in range(first, last + 1):
        fixed[4 * node + W] = cup.amplitude
    held = numpy.array(sorted(fixed))
    free = numpy.setdiff1d(numpy.arange(size + 1), held)
    shape = numpy.zeros(size + 1)
    shape[held] = [fixed[k] for k in held]
    force = -stiffness[numpy.ix_(free, held)] @ shape[held]
    shape[free] = numpy.linalg.solve(stiffness[numpy.ix_(free, free)], force)
    scale = cup.modulus / (1 - POISSON**2)
    result = []
    for e, t in enumerate(thickness):
        membrane, bending = strains(cup, 0.5, nodes[e + 1] - nodes[e])
        own = shape[4 * e:4 * e + 8]
        result.append((0.5 * (nodes[e] + nodes[e + 1]), t, scale * (plane_stress() @ membrane @ own)[0],
                       0.5 * t * scale * (plane_stress() @ bending @ own)[0]))
    return numpy.array(result)


def at_transition(cup):
    """Bending stress along the axis in the last of the wall before the teeth [Pa]."""
    rows = solve(cup)
    return abs(rows[rows[:, 1] == cup.wall][-1, 3])


def at_flange(cup):
    """Membrane and bending stress along the axis where the cup is held [Pa]."""
    return abs(solve(cup)[0, 2:]).sum()


def coning_restraint(cup):
    """How far the race's section takes the stress at the transition from that of a rim that cones freely to that of
    one held straight. Rim and race touch all along, which they need not: an upper bound."""
    alone = replace(cup, race_section=Cup.race_section)
    free, held = at_transition(alone), at_transition(replace(alone, race=cup.race_section[1:3]))
    return (at_transition(cup) - free) / (held - free)


def warping_restraint(cup):
    """Share of a built-in end's stress that a diaphragm makes."""
    return at_flange(cup) / at_flange(replace(cup, built_in=True, diaphragm=Cup.diaphragm))
