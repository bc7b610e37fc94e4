# SPDX-License-Identifier: BSD-3-Clause
"""The cells of the stress matrix: one-factor lines through the shipped parameters, maps of two factors, random
cells."""
import itertools
import random
from dataclasses import dataclass, field

# Steps [s] whose rates are whole; 1-2-5 as the runs need whole nanoseconds.
STEPS = [1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2]
SHIPPED_STEP = 1e-4
DURATION = 0.06  # s of every run: four swings of the shipped joint
RPM = 0.10471975511965977  # rad/s

SHIPPED = {
    "ring.tension_stiffness": 5e9, "ring.bending_stiffness": 258.0, "bearing.race_bending_stiffness": 670.0,
    "contact.stiffness": 1e8, "mesh.stiffness": 5e7, "cup.torsion_stiffness": (33.2e3, 56.1e3, 65.2e3),
    "cup.wall_stiffness": 305e3, "motor.rotor_inertia": 8.8e-5, "motor.wave_generator_inertia": 8.12e-5,
    "output.load_inertia": 0.5, "ring.tension_damping": 1e-2, "ring.tooth_damping": 1e-2, "contact.damping": 1e-2,
    "motor.viscous_friction": 6.6e-5,
}
# What one factor multiplies.
FACTORS = {
    "rim tension": ["ring.tension_stiffness"],
    "rim bending": ["ring.bending_stiffness", "bearing.race_bending_stiffness"],
    "springs under the rim": ["contact.stiffness"],
    "tooth mesh": ["mesh.stiffness"],
    "cup": ["cup.torsion_stiffness", "cup.wall_stiffness"],
    "all stiffness": ["ring.tension_stiffness", "ring.bending_stiffness", "bearing.race_bending_stiffness",
                      "contact.stiffness", "mesh.stiffness", "cup.torsion_stiffness", "cup.wall_stiffness"],
    "motor inertia": ["motor.rotor_inertia", "motor.wave_generator_inertia"],
    "load inertia": ["output.load_inertia"],
    "all inertia": ["motor.rotor_inertia", "motor.wave_generator_inertia", "output.load_inertia"],
    "damping": ["ring.tension_damping", "ring.tooth_damping", "contact.damping", "motor.viscous_friction"],
}
STIFFNESSES = ["all stiffness", "rim tension", "rim bending", "springs under the rim", "tooth mesh", "cup"]
INERTIAS = ["all inertia", "motor inertia", "load inertia"]


def scaled(factor, by):
    """Parameters of one factor times `by`. Balls have no stiffness to multiply: springs are in their place then."""
    def times(value):
        return tuple(by * v for v in value) if isinstance(value, tuple) else by * value

    changes = {key: times(SHIPPED[key]) for key in FACTORS[factor]}
    return {**changes, "contact.support": "springs"} if "contact.stiffness" in changes else changes


def load_steps(load):
    """Motor held by the brake; the load steps on, over to the other side, off. Rows: time, motor, load, brake."""
    return [(0.0, 0.0, 0.0, 1), (0.01, 0.0, load, 1), (0.03, 0.0, -load, 1), (0.05, 0.0, 0.0, 1)]


def reversal(torque):
    """Full torque up to the speed limit, then the other way."""
    return [(0.0, 0.0, 0.0, 0), (0.01, torque, 0.0, 0), (0.03, -torque, 0.0, 0)]


REST = [(0.0, 0.0, 0.0, 0)]


def at_speed(rpm):
    """Parameters of a drive that reaches this speed within 15 ms."""
    return {"motor.speed_limit": max(rpm * RPM, 1e-3), "motor.torque_limit": 12.0}


@dataclass
class Cell:
    """One run of the twin: what is changed, what drives it, at which step."""
    group: str
    labels: tuple  # where the cell lies on its line or map
    changes: dict = field(default_factory=dict)  # parameter to value
    drive: list = field(default_factory=lambda: load_steps(100.0))
    step: float = SHIPPED_STEP
    missing: tuple = ()
    cut: tuple = ()

    @property
    def name(self):
        return f"{self.group}: {', '.join(map(str, self.labels))}"


def lines():
    """One factor at a time; the rest as shipped."""
    for step in STEPS[:1] + STEPS[3:]:
        yield Cell("step, load steps of 100 N.m", (step,), step=step)
        yield Cell("step, reversal at 3030 rpm", (step,), at_speed(3030), reversal(12.0), step)
    for factor in STIFFNESSES:
        for by in [0.01, 0.1, 0.3, 3.0, 10.0, 100.0]:
            yield Cell(f"{factor}", (by,), scaled(factor, by))
    for factor in INERTIAS:
        for by in [0.02, 0.1, 10.0, 50.0]:
            yield Cell(f"{factor}", (by,), scaled(factor, by))
            yield Cell(f"{factor}, reversal", (by,), {**scaled(factor, by), **at_speed(3030)}, reversal(12.0))
    for by in [0.0, 10.0, 100.0, 1000.0]:
        yield Cell("damping", (by,), scaled("damping", by))
        yield Cell("damping, reversal", (by,), {**scaled("damping", by), **at_speed(3030)}, reversal(12.0))
    for rpm in [0, 1, 100, 1000, 3030, 5000, 7500]:
        yield Cell("speed, reversal", (rpm,), at_speed(rpm), reversal(12.0))
    for load in [0.0, 1e-3, 1.0, 10.0, 50.0, 150.0, 284.0, -284.0]:
        yield Cell("load steps", (load,), drive=load_steps(load))
    for teeth in [8, 12, 20, 50, 100, 160, 240, 400, 1000, 2000]:
        yield Cell("teeth", (teeth,), {"gear.teeth_flexspline": teeth, "gear.teeth_circular_spline": teeth + 2})
    for clearance in [-200e-6, -50e-6, -20e-6, -5e-6, 0.0, 5e-6, 50e-6]:
        yield Cell("flank clearance", (clearance,), {"mesh.flank_clearance": clearance})
    for amplitude in [0.0, 5e-324, 1e-9, 0.05e-3, 0.089e-3, 0.2e-3, 0.5e-3, 0.7e-3]:
        yield Cell("wave amplitude", (amplitude,), {"gear.wave_amplitude": amplitude})
    yield from options()
    for missing in [1, 5, 20, 100, 200]:
        yield Cell("missing teeth", (missing,), missing=tuple(range(missing)))
        yield Cell("missing teeth, reversal", (missing,), at_speed(3030), reversal(12.0), missing=tuple(range(missing)))
    for cut in [1, 2, 10]:
        yield Cell("rim cut", (cut,), cut=tuple(range(40, 40 + cut)))
        yield Cell("rim cut, reversal", (cut,), at_speed(3030), reversal(12.0), cut=tuple(range(40, 40 + cut)))


# What is off or neutral as shipped: values up to the ends of the ranges.
OPTIONS = {
    "contact.fit": [-1e-4, -1e-5, 2e-6, 1e-5, 1e-4],
    "contact.temperature_difference": [-100.0, 100.0],
    "bearing.race_bending_stiffness": [0.0, 67.0, 6.7e3, 6.7e5],
    "ring.loss_factor": [1e-3, 1.0],
    "cup.friction_angle": [0.0, 1e-6, 1e-2, 1.0],
    "output.coulomb_torque": [1.0, 100.0, 1e4],
    "output.tilting_moment": [1e5],
    "motor.stribeck_torque": [0.05, 5.0],
    "motor.presliding_angle": [1e-3, 3e-3, 1.0],
    "motor.torque_ripple": [0.5],
    "motor.cogging_torque": [0.01, 0.1, 1.0],
    "brake.play": [0.1, 6.28],
}
WITH = {"output.tilting_moment": {"output.tilting_friction": 1e-3},
        "motor.stribeck_torque": {"motor.stribeck_velocity": 1e-3}}


def options():
    """Each support of the rim, and each value above, under load steps and at a reversal."""
    for support in ["springs", "balls", "single_balls"]:
        for load in [14.0, 150.0, 284.0]:
            yield Cell("support", (support, load), {"contact.support": support}, load_steps(load))
        yield Cell("support, reversal", (support,), {"contact.support": support, **at_speed(3030)}, reversal(12.0))
        for fit in [-1e-5, 1e-5, 1e-4]:
            yield Cell("support and fit", (support, fit), {"contact.support": support, "contact.fit": fit})
    for key, values in OPTIONS.items():
        for value in values:
            changes = {key: value, **WITH.get(key, {})}
            yield Cell(key, (value,), changes)
            yield Cell(f"{key}, reversal", (value,), {**changes, **at_speed(3030)}, reversal(12.0))


def odd():
    """Single cells that stand at the edge of a range."""
    tiny = 5e-324  # the smallest denormal number
    soft = {"contact.stiffness": 1e6, "ring.tension_stiffness": 5e7, "mesh.flank_angle": 1.0,
            "mesh.engagement_depth": 200e-6, "output.load_torque_limit": 3000.0}
    free = {"gear.wave_amplitude": 0.0}
    yield Cell("edge", ("at rest",), drive=REST)
    yield Cell("edge", ("circular spline free: w0 = 0, no load",), free, REST)
    yield Cell("edge", ("circular spline free: no teeth, no load",), {"mesh.stiffness": 0.0}, REST)
    yield Cell("edge", ("circular spline free: no teeth, motor turns",), {**at_speed(3030), "mesh.stiffness": 0.0},
               reversal(12.0))
    yield Cell("edge", ("output locked",), {"output.load_inertia": 1e4}, reversal(2.87))
    yield Cell("edge", ("output of 3e-4 kg.m^2",), {"output.load_inertia": 0.0})
    yield Cell("edge", ("ratcheting: 600 N.m on a soft gear",), soft, load_steps(600.0))
    yield Cell("edge", ("ratcheting: 3000 N.m on a soft gear",), soft, load_steps(3000.0))
    yield Cell("edge", ("1000 N.m on the shipped gear",), {"output.load_torque_limit": 1000.0}, load_steps(1000.0))
    yield Cell("edge", ("load beyond its limit",), drive=load_steps(1e300))
    yield Cell("edge", ("denormal load",), drive=load_steps(tiny))
    yield Cell("edge", ("denormal stiffness of the mesh",), {"mesh.stiffness": tiny})
    yield Cell("edge", ("denormal damping and friction",),
               {**{key: tiny for key in FACTORS["damping"]}, "motor.coulomb_torque": tiny, "cup.friction_torque": tiny,
                "mesh.friction_static": tiny, "mesh.friction_kinetic": tiny})
    yield Cell("edge", ("no friction at all",),
               {**{key: 0.0 for key in FACTORS["damping"]}, "motor.coulomb_torque": 0.0, "cup.friction_torque": 0.0,
                "mesh.friction_static": 0.0, "mesh.friction_kinetic": 0.0, "contact.friction_coefficient": 0.0})
    yield Cell("edge", ("no bending stiffness",), {"ring.bending_stiffness": 0.0})
    yield Cell("edge", ("bending 300 N.m/rad, w0 0.089 mm: near lift-off",),
               {"ring.bending_stiffness": 300.0, "gear.wave_amplitude": 0.089e-3})
    yield Cell("edge", ("smoothed contacts, 284 N.m",), {"mesh.smoothing": 1e-6, "contact.smoothing": 1e-6},
               load_steps(284.0))
    yield Cell("edge", ("law `absolute`",), {"ring.bending_law": "absolute"})
    yield Cell("edge", ("law `polar`",), {"contact.law": "polar"})
    yield Cell("edge", ("one Newton iteration",), {"solver.max_iterations": 1, "solver.max_step_cuts": 0},
               load_steps(284.0))


# Maps of two factors: name, axes, a cell for each pair of values.
MAP_STEPS = [1e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 1e-2]


def maps():
    for step, by in itertools.product(MAP_STEPS, [0.01, 0.1, 1.0, 10.0, 100.0]):
        yield Cell("map: step and stiffness", (step, by), scaled("all stiffness", by), step=step)
    for step, rpm in itertools.product(MAP_STEPS, [100, 1000, 3030, 7500]):
        yield Cell("map: step and speed, five teeth missing", (step, rpm), at_speed(rpm), reversal(12.0), step,
                   missing=(0, 1, 2, 3, 4))
    for load, by in itertools.product([1.0, 30.0, 150.0, 284.0], [0.01, 0.1, 1.0, 10.0, 100.0]):
        yield Cell("map: load and stiffness", (load, by), scaled("all stiffness", by), load_steps(load))
    for bending, contact in itertools.product([0.01, 0.1, 1.0, 10.0, 100.0], repeat=2):
        yield Cell("map: bending and contact stiffness", (bending, contact),
                   {**scaled("rim bending", bending), **scaled("springs under the rim", contact)})


def drawn(seed):
    """A random cell: every factor at once, over its whole range in the logarithm."""
    draw = random.Random(seed)
    changes = {}
    for factor in ["rim tension", "rim bending", *draw.choice([[], ["springs under the rim"]]), "tooth mesh", "cup"]:
        changes |= scaled(factor, 10.0 ** draw.uniform(-2.0, 2.0))
    for factor in ["motor inertia", "load inertia"]:
        changes |= scaled(factor, 50.0 ** draw.uniform(-1.0, 1.0))
    changes |= scaled("damping", draw.choice([0.0, 10.0 ** draw.uniform(0.0, 3.0)]))
    changes["mesh.flank_clearance"] = draw.choice([0.0, draw.uniform(-20e-6, 20e-6)])
    changes["gear.wave_amplitude"] = draw.choice([0.35e-3, draw.uniform(0.0, 0.7e-3)])
    drive = load_steps(draw.uniform(-284.0, 284.0))
    if draw.random() < 0.5:
        changes |= at_speed(draw.uniform(0.0, 7500.0))
        drive = reversal(draw.uniform(1.0, 12.0))
    teeth = tuple(draw.sample(range(200), draw.choice([0, 0, 1, 5, 20])))
    cut = tuple(draw.sample(range(200), draw.choice([0, 0, 0, 1])))
    return Cell("random", (f"seed {seed}",), changes, drive, draw.choice(STEPS[3:]), teeth, cut)


def matrix(seeds):
    return [*lines(), *odd(), *maps(), *(drawn(seed) for seed in range(1, seeds + 1))]
