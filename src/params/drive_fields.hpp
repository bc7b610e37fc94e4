// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "params/field_meaning.hpp"

/// @file Rows of the field table (params/field_table.hpp): of the drive around the gear, its solver and its sensors.

namespace hjt
{
template <class P, class Visitor>
void visitMotor(P& p, Visitor& visit)
{
  visit("motor.rotor_inertia", "kg.m^2", p.motor.rotor_inertia, Range{ 1e-9, 10.0 }, ofOthers("motor's rotor"));
  visit("motor.wave_generator_inertia", "kg.m^2", p.motor.wave_generator_inertia, Range{ 0.0, 10.0 },
        ofOthers("wave generator"));
  visit("motor.coulomb_torque", "N.m", p.motor.coulomb_torque, Range{ 0.0, 1e3 },
        ofOthers("Coulomb friction at the motor shaft beyond bearing, outer race and flanks"));
  visit("motor.stribeck_torque", "N.m", p.motor.stribeck_torque, Range{ 0.0, 1e3 },
        ofOthers("by which friction at the shaft exceeds this and that of the bearing at standstill"));
  visit("motor.stribeck_velocity", "rad/s", p.motor.stribeck_velocity, Range{ 1e-6, 1e4 },
        ofOthers("motor speed at which 1/e of that is left"));
  visit("motor.presliding_angle", "rad", p.motor.presliding_angle, Range{ 0.0, 1.0 },
        ofOthers("motor's angle after a reversal over which friction at the shaft builds up; 0 = at once"));
  visit("motor.viscous_friction", "N.m.s/rad", p.motor.viscous_friction, Range{ 0.0, 1e3 },
        ofOthers("viscous friction, motor side"));
  visit("motor.copper_loss", "W/(N.m)^2", p.motor.copper_loss, Range{ 0.0, 1e4 },
        ofOthers("heat of the motor's winding over the square of its torque"));
  visit("motor.torque_limit", "N.m", p.motor.torque_limit, Range{ 0.0, 1e4 },
        "larger commands are clamped and counted");
  visit("motor.speed_limit", "rad/s", p.motor.speed_limit, Range{ 1e-3, 1e5 },
        ofOthers("the drive gives no torque that would speed the motor up beyond this"));
  visit("motor.current_bandwidth", "Hz", p.motor.current_bandwidth, Range{ 0.0, 1e6 },
        ofOthers("bandwidth of the current loop, first order; 0 = the torque follows the command at once"));
  visit("motor.torque_temperature_coefficient", "1/K", p.motor.torque_temperature_coefficient, Range{ -0.01, 0.01 },
        ofOthers("change of torque per current over the one at 25 degC, of the magnets"));
  visit("motor.torque_ripple", "-", p.motor.torque_ripple, Range{ 0.0, 0.5 },
        ofOthers("amplitude of the ripple six times per electrical period over the torque"));
  visit("motor.pole_pairs", "-", p.motor.pole_pairs, Range{ 1, 1000 },
        ofOthers("pairs of poles: electrical periods per turn"));
  visit("motor.cogging_torque", "N.m", p.motor.cogging_torque, Range{ 0.0, 1e3 },
        ofOthers("amplitude of the torque between magnets and slots"));
  visit("motor.cogging_periods", "-", p.motor.cogging_periods, Range{ 1, 10000 },
        ofOthers("periods of it per turn: least common multiple of poles and slots"));
}

template <class P, class Visitor>
void visitOutput(P& p, Visitor& visit)
{
  visit("output.circular_spline_inertia", "kg.m^2", p.output.circular_spline_inertia, Range{ 1e-7, 100.0 },
        ofOthers("circular spline and the parts that turn with it inside the joint"));
  visit("output.load_inertia", "kg.m^2", p.output.load_inertia, Range{ 0.0, 1e4 }, ofOthers("inertia of the load"));
  visit("output.viscous_friction", "N.m.s/rad", p.output.viscous_friction, Range{ 0.0, 1e6 },
        ofOthers("viscous friction, joint side"));
  visit("output.coulomb_torque", "N.m", p.output.coulomb_torque, Range{ 0.0, 1e4 },
        ofOthers("dry friction of the output's bearing and seals, joint side"));
  visit("output.tilting_moment", "N.m", p.output.tilting_moment, Range{ 0.0, 1e5 },
        ofOthers("moment across its axis that the output's bearing carries"));
  visit("output.tilting_friction", "-", p.output.tilting_friction, Range{ 0.0, 1.0 },
        ofOthers("dry friction of that bearing per tilting moment"));
  visit("output.gravity_torque", "N.m", p.output.gravity_torque, Range{ 0.0, 1e5 },
        ofOthers("m g l of the load; 0 = none"));
  visit("output.gravity_angle", "rad", p.output.gravity_angle, Range{ -6.2831853071795865, 6.2831853071795865 },
        ofOthers("joint angle at which the load hangs straight down"));
  visit("output.torque_limit", "N.m", p.output.torque_limit, Range{ 0.0, 1e6 },
        ofOthers("larger torques at the joint are counted, with a warning"));
  visit("output.load_torque_limit", "N.m", p.output.load_torque_limit, Range{ 0.0, 1e6 },
        "larger external torques are clamped and counted");
}

template <class P, class Visitor>
void visitBrake(P& p, Visitor& visit)
{
  visit("brake.holding_torque", "N.m", p.brake.holding_torque, Range{ 0.0, 1e4 },
        ofOthers("motor side; above it the brake slips"));
  visit("brake.play", "rad", p.brake.play, Range{ 0.0, 6.2831853071795865 },
        ofOthers("turn of the motor in which the pin of the engaged brake finds nothing to hold"));
  visit("brake.delay", "s", p.brake.delay, Range{ 0.0, 10.0 },
        ofOthers("from its command to the brake's engagement or release"));
  visit("brake.engaged_at_start", p.brake.engaged_at_start, ofOthers("state of the brake after start and reset"));
}

template <class P, class Visitor>
void visitThermal(P& p, Visitor& visit)
{
  visit("thermal.model", p.thermal.model,
        ofOthers("none: the drive has input.temperature; two_nodes: grease and housing warm up by the losses, and "
                 "input.temperature is that of the surroundings"));
  visit("thermal.grease_capacity", "J/K", p.thermal.grease_capacity, Range{ 1e-2, 1e6 },
        ofOthers("heat capacity of grease, wave generator, flexspline and rotor"));
  visit("thermal.housing_capacity", "J/K", p.thermal.housing_capacity, Range{ 1e-2, 1e6 },
        ofOthers("heat capacity of the housing with what is fixed to it"));
  visit("thermal.internal_conductance", "W/K", p.thermal.internal_conductance, Range{ 1e-4, 1e4 },
        ofOthers("heat flow from grease to housing per difference of temperature"));
  visit("thermal.ambient_conductance", "W/K", p.thermal.ambient_conductance, Range{ 0.0, 1e4 },
        ofOthers("heat flow from housing to surroundings per difference of temperature; 0 = insulated"));
  visit("thermal.standby_power", "W", p.thermal.standby_power, Range{ 0.0, 1e4 },
        ofOthers("heat of electronics and released brake, into the housing"));
  visit("thermal.grease_rise", "K", p.thermal.grease_rise, Range{ -100.0, 150.0 },
        ofOthers("temperature of the grease above that of the surroundings at start and reset"));
  visit("thermal.housing_rise", "K", p.thermal.housing_rise, Range{ -100.0, 150.0 },
        ofOthers("temperature of the housing above that of the surroundings at start and reset"));
}

template <class P, class Visitor>
void visitSolver(P& p, Visitor& visit)
{
  visit("solver.rate", "Hz", p.solver.rate, Range{ 100.0, 1e6 },
        ofOthers("steps per simulated second; must divide 1e9 ns evenly"));
  visit("solver.force_tolerance", "N", p.solver.force_tolerance, Range{ 1e-9, 1.0 },
        ofOthers("largest out-of-balance force on any tooth; ten times that in a step of motion"));
  visit("solver.max_iterations", "-", p.solver.max_iterations, Range{ 1, 1000 },
        ofOthers("Newton iterations per attempt; 20 for a response surface"));
  visit("solver.max_step_cuts", "-", p.solver.max_step_cuts, Range{ 0, 30 },
        ofOthers("halvings of a step that does not converge; 8 for a response surface"));
  visit("solver.stiction_velocity", "rad/s", p.solver.stiction_velocity, Range{ 1e-12, 1e3 },
        ofOthers("motor speed below which friction is regularised"));
  visit("solver.scene", p.solver.scene,
        ofOthers("full_ring: every tooth at every step; auto: a response surface built at start, where it holds"));
}

template <class P, class Visitor>
void visitSensors(P& p, Visitor& visit)
{
  visit("sensors.motor_counts_per_turn", "-", p.sensors.motor_counts_per_turn, Range{ 1, 1 << 30 },
        ofOthers("counts of the motor encoder after quadrature"));
  visit("sensors.output_counts_per_turn", "-", p.sensors.output_counts_per_turn, Range{ 2, 1 << 30 },
        ofOthers("counts of the absolute output encoder"));
  visit("sensors.velocity_window", "s", p.sensors.velocity_window, Range{ 1e-6, 10.0 },
        ofOthers("encoder velocities are differences over this time"));
  visit("sensors.motor_eccentricity", "rad", p.sensors.motor_eccentricity, Range{ -0.1, 0.1 },
        ofOthers("error of the motor encoder once a turn, sine of the motor angle: amplitude"));
  visit("sensors.motor_lines", "rad", p.sensors.motor_lines, Range{ -0.1, 0.1 },
        ofOthers("errors of the motor encoder two and four times a turn: amplitudes"));
  visit("sensors.motor_noise", "rad", p.sensors.motor_noise, Range{ 0, 0.1 },
        ofOthers("noise of the motor encoder at every step, before it is resolved into counts, rms"));
  visit("sensors.output_eccentricity", "rad", p.sensors.output_eccentricity, Range{ -0.1, 0.1 },
        ofOthers("error of the output encoder once a turn, sine of the output angle: amplitude"));
  visit("sensors.output_lines", "rad", p.sensors.output_lines, Range{ -0.1, 0.1 },
        ofOthers("errors of the output encoder two and four times a turn: amplitudes"));
  visit("sensors.output_noise", "rad", p.sensors.output_noise, Range{ 0, 0.1 },
        ofOthers("noise of the output encoder at every step, before it is resolved into counts, rms"));
  visit("sensors.torque_noise", "N.m", p.sensors.torque_noise, Range{ 0, 1000 },
        ofOthers("noise of the motor torque estimated from the current, at every step, rms"));
  visit("sensors.torque_resolution", "N.m", p.sensors.torque_resolution, Range{ 0, 1000 },
        ofOthers("resolution of the motor torque estimated from the current; 0 = none"));
  visit("sensors.delay", "s", p.sensors.delay, Range{ 0, 0.1 }, ofOthers("delay of all readings, in whole steps"));
  visit("sensors.noise_seed", "-", p.sensors.noise_seed, Range{ 0, 2147483647 },
        ofOthers("of the noise: the same seed gives the same noise at the same stamps"));
}
}  // namespace hjt
