// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "params/gear_fields.hpp"

namespace hjt
{
template <class P, class Visitor>
void visitMotor(P& p, Visitor& visit)
{
  visit("motor.rotor_inertia", "kg.m^2", p.motor.rotor_inertia, Range{ 1e-9, 10.0 },
        ofOthers("moment of inertia of the motor's rotor"));
  visit("motor.wave_generator_inertia", "kg.m^2", p.motor.wave_generator_inertia, Range{ 0.0, 10.0 },
        ofOthers("moment of inertia of the wave generator"));
  visit("motor.coulomb_torque", "N.m", p.motor.coulomb_torque, Range{ 0.0, 1e3 },
        ofOthers("Coulomb friction at the motor shaft, in addition to the friction of bearing, outer race and flanks"));
  visit("motor.stribeck_torque", "N.m", p.motor.stribeck_torque, Range{ 0.0, 1e3 },
        ofOthers("friction at the motor shaft at standstill, added to motor.coulomb_torque and bearing friction"));
  visit("motor.stribeck_velocity", "rad/s", p.motor.stribeck_velocity, Range{ 1e-6, 1e4 },
        ofOthers("motor speed at which motor.stribeck_torque has decayed to 1/e"));
  visit("motor.presliding_angle", "rad", p.motor.presliding_angle, Range{ 0.0, 1.0 },
        ofOthers("motor angle after a reversal over which friction at the shaft builds up; 0 = at once"));
  visit("motor.viscous_friction", "N.m.s/rad", p.motor.viscous_friction, Range{ 0.0, 1e3 },
        ofOthers("viscous friction at the motor shaft"));
  visit("motor.copper_loss", "W/(N.m)^2", p.motor.copper_loss, Range{ 0.0, 1e4 },
        ofOthers("heat of the motor's winding over the square of the motor's torque"));
  visit("motor.torque_limit", "N.m", p.motor.torque_limit, Range{ 0.0, 1e4 },
        "limit of the commanded torque; the twin clamps and counts larger commands");
  visit("motor.speed_limit", "rad/s", p.motor.speed_limit, Range{ 1e-3, 1e5 },
        ofOthers("motor speed above which the motor has no accelerating torque"));
  visit("motor.current_bandwidth", "Hz", p.motor.current_bandwidth, Range{ 0.0, 1e6 },
        ofOthers("bandwidth of the current loop, a first-order lag; 0 = no lag"));
  visit("motor.torque_temperature_coefficient", "1/K", p.motor.torque_temperature_coefficient, Range{ -0.01, 0.01 },
        ofOthers("relative change of the torque per current for each kelvin of the magnets above 25 degC"));
  visit("motor.torque_ripple", "-", p.motor.torque_ripple, Range{ 0.0, 0.5 },
        ofOthers("amplitude of the torque ripple at six times the electrical frequency, relative to the torque"));
  visit("motor.pole_pairs", "-", p.motor.pole_pairs, Range{ 1, 1000 },
        ofOthers("number of pairs of poles, which is the number of electrical periods in a turn"));
  visit("motor.cogging_torque", "N.m", p.motor.cogging_torque, Range{ 0.0, 1e3 },
        ofOthers("amplitude of the cogging torque between magnets and slots"));
  visit("motor.cogging_periods", "-", p.motor.cogging_periods, Range{ 1, 10000 },
        ofOthers("number of periods of the cogging torque in a turn, the least common multiple of poles and slots"));
}

template <class P, class Visitor>
void visitOutput(P& p, Visitor& visit)
{
  visit("output.circular_spline_inertia", "kg.m^2", p.output.circular_spline_inertia, Range{ 1e-7, 100.0 },
        ofOthers("moment of inertia of the circular spline and of the parts inside the joint that turn with it"));
  visit("output.load_inertia", "kg.m^2", p.output.load_inertia, Range{ 0.0, 1e4 },
        ofOthers("moment of inertia of the load"));
  visit("output.viscous_friction", "N.m.s/rad", p.output.viscous_friction, Range{ 0.0, 1e6 },
        ofOthers("viscous friction at the joint"));
  visit("output.coulomb_torque", "N.m", p.output.coulomb_torque, Range{ 0.0, 1e4 },
        ofOthers("dry friction of the output's bearing and seals, at the joint"));
  visit("output.tilting_moment", "N.m", p.output.tilting_moment, Range{ 0.0, 1e5 },
        ofOthers("tilting moment on the output's bearing"));
  visit("output.tilting_friction", "-", p.output.tilting_friction, Range{ 0.0, 1.0 },
        ofOthers("dry friction of the output's bearing over the tilting moment"));
  visit("output.gravity_torque", "N.m", p.output.gravity_torque, Range{ 0.0, 1e5 },
        ofOthers("largest torque of the load's weight, m g l; 0 = no weight"));
  visit("output.gravity_angle", "rad", p.output.gravity_angle, Range{ -6.2831853071795865, 6.2831853071795865 },
        ofOthers("joint angle at which the load hangs straight down"));
  visit("output.torque_limit", "N.m", p.output.torque_limit, Range{ 0.0, 1e6 },
        ofOthers("torque at the joint above which the twin counts an overload and warns"));
  visit("output.load_torque_limit", "N.m", p.output.load_torque_limit, Range{ 0.0, 1e6 },
        "limit of the external torque; the twin clamps and counts larger torques");
}

template <class P, class Visitor>
void visitBrake(P& p, Visitor& visit)
{
  visit("brake.holding_torque", "N.m", p.brake.holding_torque, Range{ 0.0, 1e4 },
        ofOthers("torque at the motor shaft above which the brake slips"));
  visit("brake.play", "rad", p.brake.play, Range{ 0.0, 6.2831853071795865 },
        ofOthers("range of motor angle in which the pin of the engaged brake does not hold the motor"));
  visit("brake.delay", "s", p.brake.delay, Range{ 0.0, 10.0 },
        ofOthers("delay from the command to engagement or release of the brake"));
  visit("brake.engaged_at_start", p.brake.engaged_at_start,
        ofOthers("whether the brake is engaged after start and reset"));
}

template <class P, class Visitor>
void visitThermal(P& p, Visitor& visit)
{
  visit("thermal.model", p.thermal.model,
        ofOthers("none: the drive has the temperature input.temperature; two_nodes: the losses warm grease and "
                 "housing, and input.temperature is that of the surroundings"));
  visit("thermal.grease_capacity", "J/K", p.thermal.grease_capacity, Range{ 1e-2, 1e6 },
        ofOthers("heat capacity of grease, wave generator, flexspline and rotor"));
  visit("thermal.housing_capacity", "J/K", p.thermal.housing_capacity, Range{ 1e-2, 1e6 },
        ofOthers("heat capacity of the housing and the parts fixed to it"));
  visit("thermal.internal_conductance", "W/K", p.thermal.internal_conductance, Range{ 1e-4, 1e4 },
        ofOthers("heat flow from grease to housing per kelvin of temperature difference"));
  visit("thermal.ambient_conductance", "W/K", p.thermal.ambient_conductance, Range{ 0.0, 1e4 },
        ofOthers("heat flow from housing to surroundings per kelvin of temperature difference; 0 = insulated"));
  visit("thermal.standby_power", "W", p.thermal.standby_power, Range{ 0.0, 1e4 },
        ofOthers("heat of the electronics and the released brake, which flows into the housing"));
  visit("thermal.grease_rise", "K", p.thermal.grease_rise, Range{ -100.0, 150.0 },
        ofOthers("temperature of the grease minus that of the surroundings, at start and reset"));
  visit("thermal.housing_rise", "K", p.thermal.housing_rise, Range{ -100.0, 150.0 },
        ofOthers("temperature of the housing minus that of the surroundings, at start and reset"));
}

template <class P, class Visitor>
void visitSolver(P& p, Visitor& visit)
{
  visit("solver.rate", "Hz", p.solver.rate, Range{ 100.0, 1e6 },
        ofOthers("steps per simulated second; a step must be a whole number of nanoseconds"));
  visit("solver.force_tolerance", "N", p.solver.force_tolerance, Range{ 1e-9, 1.0 },
        ofOthers("largest allowed out-of-balance force on a tooth; a step of motion may leave ten times this force"));
  visit("solver.max_iterations", "-", p.solver.max_iterations, Range{ 1, 1000 },
        ofOthers("largest number of Newton iterations of a solve; 20 when a response surface is built"));
  visit("solver.max_step_cuts", "-", p.solver.max_step_cuts, Range{ 0, 30 },
        ofOthers("largest number of halvings of a step that does not converge; 8 when a response surface is built"));
  visit("solver.stiction_velocity", "rad/s", p.solver.stiction_velocity, Range{ 1e-12, 1e3 },
        ofOthers("motor speed below which friction is regularised"));
  visit("solver.scene", p.solver.scene,
        ofOthers("full_ring: every step solves all teeth; auto: a step uses the response surface if the angles are in "
                 "its range"));
}

template <class P, class Visitor>
void visitSensors(P& p, Visitor& visit)
{
  visit("sensors.motor_counts_per_turn", "-", p.sensors.motor_counts_per_turn, Range{ 1, 1 << 30 },
        ofOthers("counts of the motor encoder in a turn, after quadrature"));
  visit("sensors.output_counts_per_turn", "-", p.sensors.output_counts_per_turn, Range{ 2, 1 << 30 },
        ofOthers("counts of the absolute output encoder in a turn"));
  visit("sensors.velocity_window", "s", p.sensors.velocity_window, Range{ 1e-6, 10.0 },
        ofOthers("time between the two angles from which a velocity of the encoders is computed"));
  visit("sensors.motor_eccentricity", "rad", p.sensors.motor_eccentricity, Range{ -0.1, 0.1 },
        ofOthers("amplitude of the motor encoder's error once per turn, in phase with the sine of the motor angle"));
  visit("sensors.motor_lines", "rad", p.sensors.motor_lines, Range{ -0.1, 0.1 },
        ofOthers("amplitudes of the motor encoder's errors twice and four times per turn"));
  visit("sensors.motor_noise", "rad", p.sensors.motor_noise, Range{ 0, 0.1 },
        ofOthers("rms noise of the motor encoder's angle in each step, before the angle is rounded to counts"));
  visit("sensors.output_eccentricity", "rad", p.sensors.output_eccentricity, Range{ -0.1, 0.1 },
        ofOthers("amplitude of the output encoder's error once per turn, in phase with the sine of the output angle"));
  visit("sensors.output_lines", "rad", p.sensors.output_lines, Range{ -0.1, 0.1 },
        ofOthers("amplitudes of the output encoder's errors twice and four times per turn"));
  visit("sensors.output_noise", "rad", p.sensors.output_noise, Range{ 0, 0.1 },
        ofOthers("rms noise of the output encoder's angle in each step, before the angle is rounded to counts"));
  visit("sensors.torque_noise", "N.m", p.sensors.torque_noise, Range{ 0, 1000 },
        ofOthers("rms noise of the motor torque estimated from the current, in each step"));
  visit("sensors.torque_resolution", "N.m", p.sensors.torque_resolution, Range{ 0, 1000 },
        ofOthers("resolution of the motor torque estimated from the current; 0 = no rounding"));
  visit("sensors.delay", "s", p.sensors.delay, Range{ 0, 0.1 },
        ofOthers("delay of all sensor readings, rounded to whole steps"));
  visit("sensors.noise_seed", "-", p.sensors.noise_seed, Range{ 0, 2147483647 },
        ofOthers("seed of the noise; equal seeds give equal noise at equal stamps"));
}

template <class P, class Visitor>
void visitJoint(P& p, Visitor& visit)
{
  visit("joint.name", p.joint.name, ofOthers("name of the joint in JointState messages; its motor is NAME_motor"));
  visit("joint.hardware_id", p.joint.hardware_id, ofOthers("hardware id in /diagnostics (REP-107: the serial number)"));
}

template <class P, class Visitor>
void visitHealth(P& p, Visitor& visit)
{
  visit("health.stiffness_torque_span", "N.m", p.health.stiffness_torque_span, Range{ 1e-3, 1e5 },
        ofOthers("least variation of the joint torque for an estimate of the stiffness"));
  visit("health.averaging_time", "s", p.health.averaging_time, Range{ 1e-3, 1e4 },
        ofOthers("time constant of the averages of efficiency and stiffness"));
}

template <class P, class Visitor>
void visitIndicators(P& p, Visitor& visit)
{
  visit("indicators.sample_rate", "Hz", p.indicators.sample_rate, Range{ 1.0, 1e6 },
        ofOthers("sample rate of the twin's signals for its indicators; must divide solver.rate"));
  visit("indicators.window_turns", "-", p.indicators.window_turns, Range{ 2.0, 1e5 },
        ofOthers("number of motor turns at steady speed in a window"));
  visit("indicators.window_time", "s", p.indicators.window_time, Range{ 0.1, 1e5 },
        ofOthers("longest duration of a window; after this time a window ends with any number of turns"));
  visit("indicators.least_speed", "rad/s", p.indicators.least_speed, Range{ 1e-3, 1e3 },
        ofOthers("motor speed below which the joint counts as at rest"));
  visit("indicators.speed_change", "-", p.indicators.speed_change, Range{ 1e-3, 1.0 },
        ofOthers("largest relative deviation of a steady speed from its mean over half a turn"));
  visit("indicators.stiffness_torque", "N.m", p.indicators.stiffness_torque, Range{ 1e-2, 1e5 },
        ofOthers("joint torque below which the stiffness is K1"));
  visit("indicators.lost_motion_torque", "N.m", p.indicators.lost_motion_torque, Range{ 1e-2, 1e5 },
        ofOthers("the lost motion is the torsion between plus and minus this torque; after a reversal, a change of the "
                 "torque by this value leads to the other branch of the hysteresis loop"));
  visit("indicators.baseline_windows", "-", p.indicators.baseline_windows, Range{ 8, 10000 },
        ofOthers("number of windows at an operating point from which the twin learns the reference"));
  visit("indicators.baseline_classes", "-", p.indicators.baseline_classes, Range{ 1, 1000 },
        ofOthers("largest number of classes of operating points with a reference; each needs 0.2 MB of memory"));
  visit("indicators.least_spread", "-", p.indicators.least_spread, Range{ 0.0, 1.0 },
        ofOthers("relative spread of a sound drive's indicators from one recording to the next"));
  visit("indicators.false_alarm_rate", "-", p.indicators.false_alarm_rate, Range{ 1e-12, 0.5 },
        ofOthers("probability that the mean of sound windows has an indicator or pattern beyond its threshold"));
  visit("indicators.evidence_windows", "-", p.indicators.evidence_windows, Range{ 1, 100 },
        ofOthers("number of windows of an operating point whose mean the assessment compares with the reference"));
  visit("indicators.error_factor", "-", p.indicators.error_factor, Range{ 1.0, 1e3 },
        ofOthers("multiple of the threshold above which a deviation is an ERROR and not a WARN"));
  visit("indicators.signatures", p.indicators.signatures,
        ofOthers("file with the signatures of this gear's faults, relative to the default configuration or as a path; "
                 "none: the assessment names no causes"));
}

template <class P, class Visitor>
void visitLife(P& p, Visitor& visit)
{
  visit("life.rated_torque", "N.m", p.life.rated_torque, Range{ 1e-3, 1e5 },
        ofOthers("rated output torque of the catalogue, for which bearing_l10 and bearing_l50 hold"));
  visit("life.repeated_peak_torque", "N.m", p.life.repeated_peak_torque, Range{ 1e-3, 1e5 },
        ofOthers("limit of the catalogue for repeated torques, for example at starts and stops"));
  visit("life.momentary_peak_torque", "N.m", p.life.momentary_peak_torque, Range{ 1e-3, 1e5 },
        "limit of the catalogue for momentary torques, for example in a collision");
  visit("life.momentary_peak_cycles", "-", p.life.momentary_peak_cycles, Range{ 1.0, 1e15 },
        ofOthers("number of deflections of the flexspline that the catalogue allows under the momentary peak torque"));
  visit("life.rated_speed", "rad/s", p.life.rated_speed, Range{ 1e-3, 1e4 },
        ofOthers("rated motor speed of the catalogue, for which bearing_l10 and bearing_l50 hold"));
  visit("life.bearing_l10", "h", p.life.bearing_l10, Range{ 1.0, 1e6 },
        ofOthers("time at rated torque and speed after which 10 % of the wave generator's bearings have failed"));
  visit("life.bearing_l50", "h", p.life.bearing_l50, Range{ 1.0, 1e6 },
        ofOthers("time at rated torque and speed after which half of the bearings have failed; more than bearing_l10"));
  visit("life.spall_growth", "-", p.life.spall_growth, Range{ 1e-3, 10.0 },
        ofOthers("turns from a bearing's first spall to the end of its use, over the turns before this spall"));
  visit("life.spall_spread", "-", p.life.spall_spread, Range{ 0.0, 3.0 },
        ofOthers("standard deviation, from drive to drive, of the logarithm of spall_growth"));
  visit("life.face_width", "m", p.life.face_width, Range{ 1e-4, 1.0 }, ofOthers("length of the flexspline's teeth"));
  visit("life.elastic_modulus", "Pa", p.life.elastic_modulus, Range{ 1e9, 1e12 },
        ofOthers("elastic modulus of the flexspline"));
  visit("life.flank_wear_coefficient", "1/Pa", p.life.flank_wear_coefficient, Range{ 0.0, 1e-12 },
        ofOthers("Archard's k of the tooth flanks in fresh grease: worn volume over force times sliding distance"));
  visit("life.interface_wear_coefficient", "1/Pa", p.life.interface_wear_coefficient, Range{ 0.0, 1e-12 },
        ofOthers("Archard's k of the contact of the bearing's outer race with the flexspline in fresh grease"));
  visit("life.wear_spread", "-", p.life.wear_spread, Range{ 0.0, 3.0 },
        ofOthers("standard deviation, from drive to drive, of the logarithm of both wear coefficients"));
  visit("life.flank_wear_limit", "m", p.life.flank_wear_limit, Range{ 1e-7, 1e-3 },
        ofOthers("wear depth of both flanks of a tooth pair at which the drive's life ends"));
  visit("life.interface_wear_limit", "m", p.life.interface_wear_limit, Range{ 1e-7, 1e-3 },
        ofOthers("wear depth of outer race and rim at which the drive's life ends"));
  visit("life.grease_turns", "-", p.life.grease_turns, Range{ 1.0, 1e15 },
        ofOthers("number of turns of the motor between two changes of grease at grease_temperature"));
  visit("life.grease_temperature", "degC", p.life.grease_temperature, Range{ -40.0, 150.0 },
        ofOthers("temperature for which grease_turns holds"));
  visit("life.grease_halving", "K", p.life.grease_halving, Range{ 1.0, 100.0 },
        ofOthers("rise of temperature that halves the life of the grease"));
  visit("life.grease_wear_factor", "-", p.life.grease_wear_factor, Range{ 1.0, 1e4 },
        ofOthers("wear in grease that is due for a change, divided by wear in fresh grease"));
  visit("life.ultimate_strength", "Pa", p.life.ultimate_strength, Range{ 1e7, 1e10 },
        ofOthers("tensile strength of the flexspline; more than endurance_limit"));
  visit("life.endurance_limit", "Pa", p.life.endurance_limit, Range{ 1e6, 1e10 },
        ofOthers("stress amplitude that half of all flexsplines endure without limit, at zero mean stress"));
  visit("life.endurance_cycles", "-", p.life.endurance_cycles, Range{ 1e3, 1e12 },
        ofOthers("number of cycles at which the S-N curve reaches the endurance limit"));
  visit("life.fatigue_exponent", "-", p.life.fatigue_exponent, Range{ 1.0, 50.0 },
        ofOthers("k of the S-N curve: the number of endured cycles is proportional to amplitude^-k"));
  visit("life.fatigue_spread", "-", p.life.fatigue_spread, Range{ 0.0, 1.0 },
        ofOthers("standard deviation, from drive to drive, of the logarithm of the fatigue strength"));
  visit("life.flaw_depth", "m", p.life.flaw_depth, Range{ 0.0, 1e-3 },
        ofOthers("depth of a crack at a tooth root of the new drive; 0 = no crack"));
  visit("life.crack_coefficient", "m", p.life.crack_coefficient, Range{ 0.0, 1e-3 },
        ofOthers("C of Paris' law: growth of a crack in a cycle at a range of stress intensity of 1 MPa sqrt(m)"));
  visit("life.crack_exponent", "-", p.life.crack_exponent, Range{ 1.0, 20.0 }, ofOthers("exponent m of Paris' law"));
  visit("life.crack_threshold", "MPa sqrt(m)", p.life.crack_threshold, Range{ 0.0, 100.0 },
        ofOthers("range of stress intensity below which a crack does not grow"));
  visit("life.use_record", p.life.use_record,
        ofOthers("live: absolute path of the file that stores the drive's use between two runs, or none"));
  visit("life.forecast_period", "s", p.life.forecast_period, Range{ 0.1, 1e5 },
        ofOthers("live: time between two forecasts of the remaining life, and between two writes of life.use_record"));
}

template <class P, class Visitor>
void visitInput(P& p, Visitor& visit)
{
  visit("input.mode", p.input.mode,
        ofOthers("signals that drive the twin; commands: commanded torques; torque: the robot's measured torque; "
                 "motion: the robot's measured motion; observer: measured torque and motion"));
  visit("input.command_timeout", "s", p.input.command_timeout, Range{ 1e-3, NO_LIMIT },
        ofOthers("age above which a torque command counts as zero"));
  visit("input.delay", "s", p.input.delay, Range{ 0.0, 10.0 },
        ofOthers("live: time by which the twin is behind the clock, so that stamped commands arrive in time"));
  visit("input.wait_for_first_input", p.input.wait_for_first_input,
        ofOthers("true: the twin starts at the stamp of the first input, for replay; false: the twin starts at the "
                 "clock's first instant"));
  visit("input.temperature", "degC", p.input.temperature, Range{ MIN_TEMPERATURE, MAX_TEMPERATURE },
        ofOthers("temperature of the drive or, if thermal.model is two_nodes, that of its surroundings"));
}

template <class P, class Visitor>
void visitTelemetry(P& p, Visitor& visit)
{
  visit("telemetry.torque_per_current", "N.m/A", p.telemetry.torque_per_current, Range{ 1e-6, 1e6 },
        ofOthers("torque at the joint over the measured motor current (gain)"));
  visit("telemetry.current_offset", "A", p.telemetry.current_offset, Range{ -1000.0, 1000.0 },
        ofOthers("offset of the measured current"));
  visit("telemetry.presliding_angle", "rad", p.telemetry.presliding_angle, Range{ 1e-9, 1.0 },
        ofOthers("motor angle after a reversal over which friction builds up, including the torsion of the gear"));
  visit("telemetry.lasting_share", "-", p.telemetry.lasting_share, Range{ 0.0, 1.0 },
        ofOthers("share of the friction that remains at rest and that a small motion does not reverse"));
  visit("telemetry.inertia_in_load", "kg.m^2", p.telemetry.inertia_in_load, Range{ 0.0, 10.0 },
        ofOthers("part of the motor's inertia whose torque the recorded load torque already contains"));
  visit("telemetry.ripple_circular_spline_2", "N.m", p.telemetry.ripple_circular_spline_2, Range{ -1000.0, 1000.0 },
        ofOthers("kinematic error times stiffness: amplitudes of cosine and sine at 2 cycles per turn of the motor "
                 "relative to the circular spline"));
  visit("telemetry.ripple_flexspline_2", "N.m", p.telemetry.ripple_flexspline_2, Range{ -1000.0, 1000.0 },
        ofOthers("kinematic error times stiffness: amplitudes of cosine and sine at 2 cycles per turn of the motor "
                 "relative to the flexspline"));
  visit("telemetry.ripple_circular_spline_4", "N.m", p.telemetry.ripple_circular_spline_4, Range{ -1000.0, 1000.0 },
        ofOthers("kinematic error times stiffness: amplitudes of cosine and sine at 4 cycles per turn of the motor "
                 "relative to the circular spline"));
  visit("telemetry.ripple_flexspline_4", "N.m", p.telemetry.ripple_flexspline_4, Range{ -1000.0, 1000.0 },
        ofOthers("kinematic error times stiffness: amplitudes of cosine and sine at 4 cycles per turn of the motor "
                 "relative to the flexspline"));
  visit("telemetry.ripple_resonance", "Hz", p.telemetry.ripple_resonance, Range{ 0.1, 1000.0 },
        ofOthers("resonance of the load on the joint's stiffness; far below this frequency the load follows the "
                 "kinematic error, far above it the load is at rest"));
  visit("telemetry.ripple_damping", "-", p.telemetry.ripple_damping, Range{ 0.001, 10.0 },
        ofOthers("damping ratio of the resonance of telemetry.ripple_resonance"));
  visit("telemetry.ripple_lag", "s", p.telemetry.ripple_lag, Range{ -1.0, 1.0 },
        ofOthers("time by which the ripple of the current lags behind the angle"));
  visit("telemetry.ripple_fastest", "rad/s", p.telemetry.ripple_fastest, Range{ 0.0, 100.0 },
        ofOthers("largest joint speed at which the twin predicts the ripple"));
  visit("telemetry.current_deviation", "A", p.telemetry.current_deviation, Range{ 0.0, 1000.0 },
        ofOthers("rms difference between measured and predicted current of a sound joint"));
  visit("telemetry.effort", p.telemetry.effort,
        ofOthers("effort of a measured joint; current: current of the motor [A]; joint_torque: torque of the motor "
                 "times the ratio [N.m]; motor_torque: torque of the motor at its shaft [N.m]"));
  visit("telemetry.load", p.telemetry.load,
        ofOthers("load of a measured joint; model: weight and inertia from section output; load_torque: weight, "
                 "inertia and the received load torque; target_moment: only the received torque; arm: torque of links "
                 "and payload from the motion of all joints"));
}

template <class P, class Visitor>
void visitObserver(P& p, Visitor& visit)
{
  visit("observer.output_angle_noise", "rad", p.observer.output_angle_noise, Range{ 1e-9, 1.0 },
        ofOthers("rms noise of the measured joint angle"));
  visit("observer.motor_angle_noise", "rad", p.observer.motor_angle_noise, Range{ 1e-9, 1.0 },
        ofOthers("rms noise of the motor angle, if it is measured"));
  visit("observer.torque_noise", "N.m.sqrt(s)", p.observer.torque_noise, Range{ 0.0, 1e3 },
        ofOthers("white noise of the motor torque estimated from the current: rms noise of a reading times the square "
                 "root of the sampling period"));
  visit("observer.load_noise", "N.m.sqrt(s)", p.observer.load_noise, Range{ 0.0, 1e6 },
        ofOthers("white noise of the load torque: rms noise of a reading times sqrt(sampling period)"));
  visit("observer.disturbance_growth", "N.m/sqrt(s)", p.observer.disturbance_growth, Range{ 1e-9, 1e3 },
        ofOthers("rms change of the unmodelled torque at the motor in a second"));
}

template <class P, class Visitor>
void visitComparison(P& p, Visitor& visit)
{
  visit("comparison.friction_tolerance", "-", p.comparison.friction_tolerance, Range{ 0.01, 10.0 },
        ofOthers("largest relative difference of a sound joint's friction from that of the twin"));
  visit("comparison.compliance_tolerance", "-", p.comparison.compliance_tolerance, Range{ 0.01, 10.0 },
        ofOthers("largest relative difference of a sound joint's torsion from that of the twin"));
  visit("comparison.repeat_tolerance", "-", p.comparison.repeat_tolerance, Range{ 0.01, 10.0 },
        ofOthers("largest relative change of a sound joint's torsion between two recordings, and largest relative "
                 "deviation of its friction factor from the median of the joints"));
}

template <class P, class Visitor>
void visitPublish(P& p, Visitor& visit)
{
  visit("publish.joint_states_rate", "Hz", p.publish.joint_states_rate, Range{ 1e-3, 1e6 },
        ofOthers("rate of joint_states; must divide solver.rate"));
  visit("publish.encoders_rate", "Hz", p.publish.encoders_rate, Range{ 1e-3, 1e6 },
        ofOthers("rate of ~encoders; must divide solver.rate"));
  visit("publish.contact_forces_rate", "Hz", p.publish.contact_forces_rate, Range{ 1e-3, 1e6 },
        ofOthers("rate of ~contact_forces; must divide solver.rate"));
  visit("publish.health_rate", "Hz", p.publish.health_rate, Range{ 1e-3, 1e6 },
        ofOthers("rate of ~health; must divide solver.rate"));
  visit("publish.stress_rate", "Hz", p.publish.stress_rate, Range{ 1e-3, 1e6 },
        ofOthers("rate of ~stress; must divide solver.rate"));
  visit("publish.indicators_rate", "Hz", p.publish.indicators_rate, Range{ 1e-3, 1e6 },
        ofOthers("rate of ~indicators; must divide solver.rate"));
}

template <class P, class Visitor>
void visitRealtime(P& p, Visitor& visit)
{
  visit("realtime.deadline", "s", p.realtime.deadline, Range{ 1e-6, 1e4 },
        ofOthers("live: largest delay of a simulated instant; a cycle of the loop with a larger delay has missed its "
                 "deadline"));
  visit("realtime.priority", "-", p.realtime.priority, Range{ 0, 99 },
        ofOthers("live: priority of the loop's thread under SCHED_FIFO; 0: default scheduling"));
  visit("realtime.lock_memory", p.realtime.lock_memory,
        ofOthers("live: whether the node locks its memory in RAM (mlockall)"));
  visit("realtime.processor", "-", p.realtime.processor, Range{ -1, 1023 },
        ofOthers("live: processor of the loop's thread, counted from 0; -1: any"));
}

/// Table of all parameters, for reading, range checks, the printed parameters and docs/parameters.csv.
///
/// The function calls `visit(key, unit, value, range, meaning)` for each number or array of numbers, and
/// `visit(key, value, meaning)` for each boolean, text or choice. `P` is `Parameters` or `const Parameters`.
template <class P, class Visitor>
void visitFields(P& p, Visitor&& visit)
{
  visitJoint(p, visit);
  visitGear(p, visit);
  visitManufacture(p, visit);
  visitRing(p, visit);
  visitContact(p, visit);
  visitMesh(p, visit);
  visitCup(p, visit);
  visitBearing(p, visit);
  visitMotor(p, visit);
  visitOutput(p, visit);
  visitBrake(p, visit);
  visitThermal(p, visit);
  visitSolver(p, visit);
  visitSensors(p, visit);
  visitHealth(p, visit);
  visitIndicators(p, visit);
  visitStress(p, visit);
  visitLife(p, visit);
  visitInput(p, visit);
  visitTelemetry(p, visit);
  visitObserver(p, visit);
  visitComparison(p, visit);
  visitPublish(p, visit);
  visitRealtime(p, visit);
  visitFaultScale(p, visit);
}

/// Hash of the parameters and faults that determine a response surface (FNV-1a, 64 bits).
std::uint64_t surfaceParametersHash(const Parameters& parameters);

/// Text of the parameters that determine a response surface, one per line. `faulty`: for a drive with faults.
std::string describeSurfaceParameters(const Parameters& parameters, bool faulty);

/// Row of the table of parameters, with the value of the parameter.
struct FieldRow
{
  std::string key;
  std::string type;  ///< type: float, int, N floats, bool or text
  std::string unit;
  std::optional<Range> range;        ///< range of the number; none for another type
  std::vector<std::string> choices;  ///< allowed texts of a choice; empty for another type
  std::string value;                 ///< value as text of YAML
  Meaning meaning;
};

std::vector<FieldRow> fieldRows(const Parameters& parameters);
}  // namespace hjt
