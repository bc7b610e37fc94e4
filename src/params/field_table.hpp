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

template <class P, class Visitor>
void visitJoint(P& p, Visitor& visit)
{
  visit("joint.name", p.joint.name, ofOthers("name of the joint in JointState messages; the motor is NAME_motor"));
  visit("joint.hardware_id", p.joint.hardware_id, ofOthers("hardware id in /diagnostics (REP-107: the serial number)"));
}

template <class P, class Visitor>
void visitHealth(P& p, Visitor& visit)
{
  visit("health.stiffness_torque_span", "N.m", p.health.stiffness_torque_span, Range{ 1e-3, 1e5 },
        ofOthers("joint torque must have varied this much before a stiffness is estimated"));
  visit("health.averaging_time", "s", p.health.averaging_time, Range{ 1e-3, 1e4 },
        ofOthers("time constant over which efficiency and stiffness forget"));
}

template <class P, class Visitor>
void visitIndicators(P& p, Visitor& visit)
{
  visit("indicators.sample_rate", "Hz", p.indicators.sample_rate, Range{ 1.0, 1e6 },
        ofOthers("sample rate of the twin's own indicators; must divide solver.rate"));
  visit("indicators.window_turns", "-", p.indicators.window_turns, Range{ 2.0, 1e5 },
        ofOthers("motor turns at steady speed that make one window"));
  visit("indicators.window_time", "s", p.indicators.window_time, Range{ 0.1, 1e5 },
        ofOthers("a window ends after this even with fewer turns"));
  visit("indicators.least_speed", "rad/s", p.indicators.least_speed, Range{ 1e-3, 1e3 },
        ofOthers("motor speed below which the joint counts as standing"));
  visit("indicators.speed_change", "-", p.indicators.speed_change, Range{ 1e-3, 1.0 },
        ofOthers("speed is steady while it is within this share of its mean over half a turn"));
  visit("indicators.stiffness_torque", "N.m", p.indicators.stiffness_torque, Range{ 1e-2, 1e5 },
        ofOthers("K1 is the stiffness at joint torques below this"));
  visit("indicators.lost_motion_torque", "N.m", p.indicators.lost_motion_torque, Range{ 1e-2, 1e5 },
        ofOthers("lost motion is taken between plus and minus this torque; as wide a change passes from one branch of "
                 "the loop to the other"));
  visit("indicators.baseline_windows", "-", p.indicators.baseline_windows, Range{ 8, 10000 },
        ofOthers("windows at one operating point the healthy reference is learned from"));
  visit("indicators.baseline_classes", "-", p.indicators.baseline_classes, Range{ 1, 1000 },
        ofOthers("classes of operating points the healthy reference is learned of at most, 0.2 MB of memory each"));
  visit("indicators.least_spread", "-", p.indicators.least_spread, Range{ 0.0, 1.0 },
        ofOthers("repeatability of a sound drive from one recording to the next, as a share of each indicator"));
  visit("indicators.false_alarm_rate", "-", p.indicators.false_alarm_rate, Range{ 1e-12, 0.5 },
        ofOthers("chance that the mean of healthy windows shows any indicator or pattern beyond its threshold"));
  visit("indicators.evidence_windows", "-", p.indicators.evidence_windows, Range{ 1, 100 },
        ofOthers("windows of an operating point that a verdict is made of the mean of"));
  visit("indicators.error_factor", "-", p.indicators.error_factor, Range{ 1.0, 1e3 },
        ofOthers("a deviation of this many times the threshold is an error, not a warning"));
  visit("indicators.signatures", p.indicators.signatures,
        ofOthers("file with the signatures of this gear's faults: a name beside the default configuration, or a "
                 "path; none: no causes are named"));
}

template <class P, class Visitor>
void visitLife(P& p, Visitor& visit)
{
  visit("life.rated_torque", "N.m", p.life.rated_torque, Range{ 1e-3, 1e5 },
        ofOthers("rated output torque of the catalogue, at which the bearing's lives are given"));
  visit("life.repeated_peak_torque", "N.m", p.life.repeated_peak_torque, Range{ 1e-3, 1e5 },
        ofOthers("limit of the catalogue for torques of starting and stopping"));
  visit("life.momentary_peak_torque", "N.m", p.life.momentary_peak_torque, Range{ 1e-3, 1e5 },
        "limit of the catalogue for a collision");
  visit("life.momentary_peak_cycles", "-", p.life.momentary_peak_cycles, Range{ 1.0, 1e15 },
        ofOthers("deflections of the flexspline that the catalogue allows under momentary peaks"));
  visit("life.rated_speed", "rad/s", p.life.rated_speed, Range{ 1e-3, 1e4 },
        ofOthers("rated motor speed of the catalogue, at which the bearing's lives are given"));
  visit("life.bearing_l10", "h", p.life.bearing_l10, Range{ 1.0, 1e6 },
        ofOthers("hours at rated torque and speed after which 10 % of the wave generator's bearings have failed"));
  visit("life.bearing_l50", "h", p.life.bearing_l50, Range{ 1.0, 1e6 },
        ofOthers("hours at rated torque and speed after which half of them have failed; more than bearing_l10"));
  visit("life.spall_growth", "-", p.life.spall_growth, Range{ 1e-3, 10.0 },
        ofOthers("share of the bearing's life, in turns, from its first spall to the end of use"));
  visit("life.spall_spread", "-", p.life.spall_spread, Range{ 0.0, 3.0 },
        ofOthers("standard deviation of its logarithm from drive to drive"));
  visit("life.face_width", "m", p.life.face_width, Range{ 1e-4, 1.0 }, ofOthers("length of the flexspline's teeth"));
  visit("life.elastic_modulus", "Pa", p.life.elastic_modulus, Range{ 1e9, 1e12 }, ofOthers("of the flexspline"));
  visit("life.flank_wear_coefficient", "1/Pa", p.life.flank_wear_coefficient, Range{ 0.0, 1e-12 },
        ofOthers("Archard's k of the tooth flanks in fresh grease: worn volume by force times sliding"));
  visit("life.interface_wear_coefficient", "1/Pa", p.life.interface_wear_coefficient, Range{ 0.0, 1e-12 },
        ofOthers("the same between the bearing's outer race and the flexspline"));
  visit("life.wear_spread", "-", p.life.wear_spread, Range{ 0.0, 3.0 },
        ofOthers("standard deviation of the logarithm of both coefficients from drive to drive"));
  visit("life.flank_wear_limit", "m", p.life.flank_wear_limit, Range{ 1e-7, 1e-3 },
        ofOthers("depth worn off both flanks of a pair at which the drive is at its end"));
  visit("life.interface_wear_limit", "m", p.life.interface_wear_limit, Range{ 1e-7, 1e-3 },
        ofOthers("depth worn off race and rim at which the drive is at its end"));
  visit("life.grease_turns", "-", p.life.grease_turns, Range{ 1.0, 1e15 },
        ofOthers("turns of the motor between two changes of grease at grease_temperature"));
  visit("life.grease_temperature", "degC", p.life.grease_temperature, Range{ -40.0, 150.0 },
        ofOthers("temperature grease_turns holds for"));
  visit("life.grease_halving", "K", p.life.grease_halving, Range{ 1.0, 100.0 },
        ofOthers("rise of temperature that halves the life of the grease"));
  visit("life.grease_wear_factor", "-", p.life.grease_wear_factor, Range{ 1.0, 1e4 },
        ofOthers("wear in grease due for a change over wear in fresh grease"));
  visit("life.ultimate_strength", "Pa", p.life.ultimate_strength, Range{ 1e7, 1e10 },
        ofOthers("tensile strength of the flexspline; more than endurance_limit"));
  visit("life.endurance_limit", "Pa", p.life.endurance_limit, Range{ 1e6, 1e10 },
        ofOthers("amplitude without mean stress that half of all flexsplines bear for ever"));
  visit("life.endurance_cycles", "-", p.life.endurance_cycles, Range{ 1e3, 1e12 },
        ofOthers("cycles at which the S-N curve reaches it"));
  visit("life.fatigue_exponent", "-", p.life.fatigue_exponent, Range{ 1.0, 50.0 },
        ofOthers("k of the S-N curve: cycles fall with this power of the amplitude"));
  visit("life.fatigue_spread", "-", p.life.fatigue_spread, Range{ 0.0, 1.0 },
        ofOthers("standard deviation of the logarithm of the fatigue strength from drive to drive"));
  visit("life.flaw_depth", "m", p.life.flaw_depth, Range{ 0.0, 1e-3 },
        ofOthers("depth of a crack at a tooth root of the new drive; 0: none"));
  visit("life.crack_coefficient", "m", p.life.crack_coefficient, Range{ 0.0, 1e-3 },
        ofOthers("C of Paris' law: growth by one cycle at a range of 1 MPa sqrt(m)"));
  visit("life.crack_exponent", "-", p.life.crack_exponent, Range{ 1.0, 20.0 }, ofOthers("m of Paris' law"));
  visit("life.crack_threshold", "MPa sqrt(m)", p.life.crack_threshold, Range{ 0.0, 100.0 },
        ofOthers("range of the stress intensity below which a flaw does not grow"));
  visit("life.use_record", p.life.use_record,
        ofOthers("live: none, or the absolute path of the file that keeps the drive's use from one start to the next"));
  visit("life.forecast_period", "s", p.life.forecast_period, Range{ 0.1, 1e5 },
        ofOthers("live: time between two forecasts of the remaining life, and between two writes of the record"));
}

template <class P, class Visitor>
void visitInput(P& p, Visitor& visit)
{
  visit("input.mode", p.input.mode,
        ofOthers("commands: the twin alone; beside a robot, driven by its measured torque, motion or both (observer)"));
  visit("input.command_timeout", "s", p.input.command_timeout, Range{ 1e-3, NO_LIMIT },
        ofOthers("a torque command older than this counts as zero"));
  visit("input.delay", "s", p.input.delay, Range{ 0.0, 10.0 },
        ofOthers("live, the twin stays this far behind the clock, so that stamped commands arrive in time"));
  visit(
      "input.wait_for_first_input", p.input.wait_for_first_input,
      ofOthers("true: the twin starts at the stamp of the first input (replay); false: at the clock's first instant"));
  visit("input.temperature", "degC", p.input.temperature, Range{ MIN_TEMPERATURE, MAX_TEMPERATURE },
        ofOthers("temperature of the drive, or of its surroundings where thermal.model is not none"));
}

template <class P, class Visitor>
void visitTelemetry(P& p, Visitor& visit)
{
  visit("telemetry.torque_per_current", "N.m/A", p.telemetry.torque_per_current, Range{ 1e-6, 1e6 },
        ofOthers("torque at the joint per measured motor current"));
  visit("telemetry.current_offset", "A", p.telemetry.current_offset, Range{ -1000.0, 1000.0 },
        ofOthers("offset of the measured current"));
  visit("telemetry.presliding_angle", "rad", p.telemetry.presliding_angle, Range{ 1e-9, 1.0 },
        ofOthers("motor angle over which friction builds up after a reversal, torsion and cup included"));
  visit("telemetry.lasting_share", "-", p.telemetry.lasting_share, Range{ 0.0, 1.0 },
        ofOthers("share of the friction that a small motion does not reverse and that remains at rest"));
  visit("telemetry.inertia_in_load", "kg.m^2", p.telemetry.inertia_in_load, Range{ 0.0, 10.0 },
        ofOthers("part of the motor's inertia that a recorded load torque already contains"));
  visit(
      "telemetry.ripple_circular_spline_2", "N.m", p.telemetry.ripple_circular_spline_2, Range{ -1000.0, 1000.0 },
      ofOthers(
          "kinematic error times stiffness, cos and sin of two waves a turn of the motor against the circular spline"));
  visit("telemetry.ripple_flexspline_2", "N.m", p.telemetry.ripple_flexspline_2, Range{ -1000.0, 1000.0 },
        ofOthers("the same against the flexspline"));
  visit("telemetry.ripple_circular_spline_4", "N.m", p.telemetry.ripple_circular_spline_4, Range{ -1000.0, 1000.0 },
        ofOthers("four waves against the circular spline"));
  visit("telemetry.ripple_flexspline_4", "N.m", p.telemetry.ripple_flexspline_4, Range{ -1000.0, 1000.0 },
        ofOthers("four waves against the flexspline"));
  visit(
      "telemetry.ripple_resonance", "Hz", p.telemetry.ripple_resonance, Range{ 0.1, 1000.0 },
      ofOthers("resonance of the load on the joint's stiffness: far below it the load follows the kinematic error, far "
               "above it stands still"));
  visit("telemetry.ripple_damping", "-", p.telemetry.ripple_damping, Range{ 0.001, 10.0 },
        ofOthers("damping ratio of that resonance"));
  visit("telemetry.ripple_lag", "s", p.telemetry.ripple_lag, Range{ -1.0, 1.0 },
        ofOthers("lag of the current's ripple behind the angle"));
  visit("telemetry.ripple_fastest", "rad/s", p.telemetry.ripple_fastest, Range{ 0.0, 100.0 },
        ofOthers("speed of the joint up to which its ripple is known; beyond, none is predicted"));
  visit("telemetry.current_deviation", "A", p.telemetry.current_deviation, Range{ 0.0, 1000.0 },
        ofOthers("rms difference between measured and predicted current of a healthy joint"));
  visit("telemetry.effort", p.telemetry.effort,
        ofOthers("effort of a measured joint: current: of the motor, in A; joint_torque: of the motor through the gear "
                 "without its losses, in N.m; motor_torque: at the motor's shaft, in N.m"));
  visit(
      "telemetry.load", p.telemetry.load,
      ofOthers("load of a measured joint: model: weight and inertia below output; load_torque: weight and inertia plus "
               "the received load torque; target_moment: only the received torque; arm: of links and payload, from the "
               "motion of all joints"));
}

template <class P, class Visitor>
void visitObserver(P& p, Visitor& visit)
{
  visit("observer.output_angle_noise", "rad", p.observer.output_angle_noise, Range{ 1e-9, 1.0 },
        ofOthers("of the measured joint angle, rms"));
  visit("observer.motor_angle_noise", "rad", p.observer.motor_angle_noise, Range{ 1e-9, 1.0 },
        ofOthers("of the measured motor angle, rms, where there is one"));
  visit("observer.torque_noise", "N.m.sqrt(s)", p.observer.torque_noise, Range{ 0.0, 1e3 },
        ofOthers("white noise of the motor torque estimated from the current: rms of one reading times the root of its "
                 "period"));
  visit("observer.load_noise", "N.m.sqrt(s)", p.observer.load_noise, Range{ 0.0, 1e6 },
        ofOthers("of the load torque, white, likewise"));
  visit("observer.disturbance_growth", "N.m/sqrt(s)", p.observer.disturbance_growth, Range{ 1e-9, 1e3 },
        ofOthers("rms change of the unmodelled torque at the motor within a second"));
}

template <class P, class Visitor>
void visitComparison(P& p, Visitor& visit)
{
  visit("comparison.friction_tolerance", "-", p.comparison.friction_tolerance, Range{ 0.01, 10.0 },
        ofOthers("share by which a sound joint's friction may differ from the twin's"));
  visit("comparison.compliance_tolerance", "-", p.comparison.compliance_tolerance, Range{ 0.01, 10.0 },
        ofOthers("share by which a sound joint's torsion may differ from the twin's"));
  visit("comparison.repeat_tolerance", "-", p.comparison.repeat_tolerance, Range{ 0.01, 10.0 },
        ofOthers("share within which torsion repeats and the friction of an arm's joints agrees"));
}

template <class P, class Visitor>
void visitPublish(P& p, Visitor& visit)
{
  visit("publish.joint_states_rate", "Hz", p.publish.joint_states_rate, Range{ 1e-3, 1e6 },
        ofOthers("must divide solver.rate"));
  visit("publish.encoders_rate", "Hz", p.publish.encoders_rate, Range{ 1e-3, 1e6 },
        ofOthers("must divide solver.rate"));
  visit("publish.contact_forces_rate", "Hz", p.publish.contact_forces_rate, Range{ 1e-3, 1e6 },
        ofOthers("must divide solver.rate"));
  visit("publish.health_rate", "Hz", p.publish.health_rate, Range{ 1e-3, 1e6 }, ofOthers("must divide solver.rate"));
  visit("publish.stress_rate", "Hz", p.publish.stress_rate, Range{ 1e-3, 1e6 }, ofOthers("must divide solver.rate"));
  visit("publish.indicators_rate", "Hz", p.publish.indicators_rate, Range{ 1e-3, 1e6 },
        ofOthers("must divide solver.rate"));
}

template <class P, class Visitor>
void visitRealtime(P& p, Visitor& visit)
{
  visit("realtime.deadline", "s", p.realtime.deadline, Range{ 1e-6, 1e4 },
        ofOthers("live: a cycle of the loop that simulates an instant later than this after it was due has missed its "
                 "deadline"));
  visit("realtime.priority", "-", p.realtime.priority, Range{ 0, 99 },
        ofOthers("live: priority of the loop's thread under SCHED_FIFO; 0: as every other thread"));
  visit("realtime.lock_memory", p.realtime.lock_memory,
        ofOthers("live: true: the node's memory stays in RAM (mlockall); false: it may be paged out"));
  visit("realtime.processor", "-", p.realtime.processor, Range{ -1, 1023 },
        ofOthers("live: processor that the loop's thread is bound to, counted from 0; -1: any"));
}

/// The one table of all parameters. Reading, range checks, the dump at start and the README table all walk it.
///
/// `visit(key, unit, value, range, meaning)` is called for numbers and arrays of numbers,
/// `visit(key, value, meaning)` for booleans, texts and choices.
/// `P` is `Parameters` or `const Parameters`.
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

/// Of the values and faults that shape a response surface or its faults (FNV-1a, 64 bits).
std::uint64_t surfaceParametersHash(const Parameters& parameters);

/// The parameters that shape a response surface, a line each; `faulty`: also those that shape its faults.
std::string describeSurfaceParameters(const Parameters& parameters, bool faulty);

/// A row of the field table with its value, as texts.
struct FieldRow
{
  std::string key;
  std::string type;  ///< float, int, N floats, bool or text
  std::string unit;
  std::optional<Range> range;        ///< of numbers
  std::vector<std::string> choices;  ///< of a text that is a choice
  std::string value;                 ///< as YAML has it
  Meaning meaning;
};

std::vector<FieldRow> fieldRows(const Parameters& parameters);
}  // namespace hjt
