# SPDX-License-Identifier: BSD-3-Clause
"""What the thesis prints (C. Costantino, Politecnico di Torino, 2021), and the runs that its chapters share."""
import math
from dataclasses import dataclass

import numpy as np

INSERTION = ("--config", "thesis_insertion.yaml")
GOLDEN = ("--config", "golden.yaml")
# The set of the table of loads: the cup as Table 7.1 gives it, straight flanks.
OPERATION = (*GOLDEN, "--set", "cup.torsion_stiffness=[31.0e+3,50.0e+3,57.0e+3]", "--set",
             "cup.torsion_breakpoints=[14.0,48.0]", "--set", "mesh.flank_angle=0.29670597283903605", "--set",
             "mesh.engagement_depth=20.0e-6")
LOADS = (0.0, 5.0, 14.0, 48.0, 100.0, 150.0)  # N.m, of that table and none
TEETH_FS, TEETH_CS, RATIO = 200, 202, 101
PITCH = 2.0 * math.pi / TEETH_FS  # rad


@dataclass(frozen=True)
class Measured:
    """Tables 3.1 to 3.6: the parts on the calliper. [m], [kg/m^3], [kg]"""
    balls: int = 23
    outer_race_inner_radius: float = 29.4e-3
    outer_race_thickness: float = 1.6e-3
    ball_circle_radius: float = 26.67e-3
    ball_diameter: float = 5.47e-3
    race_depth: float = 9e-3
    inner_race_inner_radius: float = 22.45e-3
    inner_race_thickness: float = 1.5e-3
    shaft_radius: float = 16.2e-3
    major_semi_axis: float = 31e-3
    minor_semi_axis: float = 30.33e-3
    density: float = 7500.0
    wave_generator_mass: float = 0.1527
    flexspline_density: float = 7850.0
    flexspline_mass: float = 0.038
    flexspline_radius: float = 30.65e-3
    rim_thickness: float = 0.8e-3
    tooth_height: float = 0.5e-3
    tooth_length: float = 11.6e-3
    tooth_base: float = 0.56e-3
    young_modulus: float = 210e9  # Pa, Table 3.3
    circular_spline_mass: float = 0.595
    circular_spline_outer_radius: float = 42.5e-3
    circular_spline_inner_radius: float = 33.5e-3
    circular_spline_length: float = 13e-3
    circular_spline_tooth_height: float = 0.6e-3
    circular_spline_tip_radius: float = 31.95e-3
    circular_spline_mean_radius: float = 32.15e-3  # of the teeth


MEASURED = Measured()


def read_columns(path):
    """A CSV file as arrays by column name."""
    table = np.genfromtxt(path, delimiter=",", names=True)
    return {name: table[name] for name in table.dtype.names}


class Ring:
    """One equilibrium: what the thesis' chapter 5 makes of the tooth points alone, beside the tool's own columns in
    `teeth`. [m], [rad], [N]"""

    def __init__(self, teeth, parameters, angle=0.0):
        gear, ring, contact = parameters["gear"], parameters["ring"], parameters["contact"]
        radius, w0 = gear["flexspline_inner_radius"], gear["wave_amplitude"]
        self.teeth = teeth
        self.a, self.b = radius + w0, radius - w0
        self.psi0 = PITCH * np.arange(TEETH_FS)
        self.x0, self.y0 = radius * np.cos(self.psi0), radius * np.sin(self.psi0)
        self.x, self.y = teeth["tooth_x"], teeth["tooth_y"]
        # In the ellipse's axes, eq. 7.22.
        cos, sin = math.cos(angle), math.sin(angle)
        self.own_x, self.own_y = cos * self.x + sin * self.y, cos * self.y - sin * self.x
        self.psi = np.arctan2(self.own_y, self.own_x)
        self.rho = np.hypot(self.x, self.y)
        self.normal = np.arctan2(self.a**2 * self.own_y, self.b**2 * self.own_x)  # eq. 5.15, 7.21
        self.gamma = wrapped(self.psi - self.normal)  # eq. 7.26
        self.contact_stiffness = contact["stiffness"]
        dx, dy = np.roll(self.x, -1) - self.x, np.roll(self.y, -1) - self.y
        self.distance = np.hypot(dx, dy)
        self.rest_distance = 2.0 * radius * math.sin(0.5 * PITCH)
        self.tension = ring["tension_stiffness"] * (self.distance - self.rest_distance)  # eq. 5.33
        self.slope = np.arctan2(dy, dx)  # eq. 5.31
        self.turn = wrapped(self.slope - self.psi0 - 0.5 * PITCH - 0.5 * math.pi)  # eq. 5.48
        self.bending = ring["bending_stiffness"] * self.turn / self.distance  # eq. 5.51-5.52

    def overlap(self):
        """Relative displacement by eq. 5.11 and 5.22."""
        return ((self.a * np.cos(self.psi) - self.own_x) * np.cos(self.normal) +
                (self.b * np.sin(self.psi) - self.own_y) * np.sin(self.normal))

    def contact_force(self):
        """Eq. 5.23 at rest."""
        return self.contact_stiffness * np.maximum(self.overlap(), 0.0)

    def out_of_balance(self):
        """Largest force left over on a tooth by eq. 5.1-5.2 at rest, no circular spline; with the bending force of
        either segment."""
        force = self.contact_force()
        sx = self.tension * np.cos(self.slope) - self.bending * np.sin(self.slope)  # eq. 5.41, 5.53
        sy = self.tension * np.sin(self.slope) + self.bending * np.cos(self.slope)
        return float(
            np.max(
                np.hypot(force * np.cos(self.normal) + sx - np.roll(sx, 1),
                         force * np.sin(self.normal) + sy - np.roll(sy, 1))))


def wrapped(angle):
    """To -pi ... pi."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def parameters(page, *arguments):
    return page.tool("parameters", *arguments)


def insertion(page, name, *arguments):
    """`joint_twin insert`: its numbers and its ring."""
    path = f"{name}.csv"
    numbers = page.tool("insert", *arguments, "--csv", path)
    return numbers, Ring(read_columns(page.scratch(path)), parameters(page, *arguments))


def thesis_insertion(page):
    return insertion(page, "insertion", *INSERTION)


def locked(page, name, torques, angle=0.0):
    """`joint_twin stiffness` with that set: its rows and the ring of each."""
    path = f"{name}.csv"
    arguments = ("--angle", repr(angle)) if angle else ()
    rows = page.tool("stiffness", "--torques", ",".join(f"{torque:g}" for torque in torques), *arguments, *OPERATION,
                     "--csv", path)["rows"]
    columns = read_columns(page.scratch(path))
    given = parameters(page, *OPERATION)
    rings = []
    for i in range(len(rows)):
        part = slice(i * TEETH_FS, (i + 1) * TEETH_FS)
        rings.append(Ring({key: values[part] for key, values in columns.items()}, given, angle))
    return rows, rings


def locked_table(page):
    return locked(page, "locked", LOADS)


def turn(page):
    """One turn of the wave generator at 20 N.m, 32 steps a tooth pitch: arrays, and steps a pitch."""
    steps = 32
    rows = page.tool("turn", "--load", "20", "--angle-range", repr(2.0 * math.pi), "--steps", steps * TEETH_FS,
                     *OPERATION)["rows"]
    return {key: np.array([row[key] for row in rows]) for key in rows[0]}, steps
