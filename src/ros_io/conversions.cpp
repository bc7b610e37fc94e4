// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/conversions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "ros_io/time.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t MOTOR = 0;
constexpr std::size_t JOINT = 1;

// The arrays were sized by makeContactForces; a shorter source leaves the rest of the target as it was.
void copyArray(const std::vector<double>& from, std::vector<double>& to) noexcept
{
  std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
}

EffortStatus readEffort(const sensor_msgs::JointState& message, const std::string& name, double& effort) noexcept
{
  const auto found = std::find(message.name.begin(), message.name.end(), name);
  if (found == message.name.end())
  {
    return EffortStatus::UNKNOWN_JOINT;
  }
  const auto index = static_cast<std::size_t>(found - message.name.begin());
  if (index >= message.effort.size())
  {
    return EffortStatus::MISSING_EFFORT;
  }
  effort = message.effort[index];
  return EffortStatus::FOUND;
}

/// Where each indicator stands in the message.
struct IndicatorField
{
  double harmonic_joint_twin::Indicators::*field;
  std::size_t indicator;
};
struct PhaseField
{
  double harmonic_joint_twin::Indicators::*field;
  LineSignal signal;
  Line line;
};

constexpr std::size_t lineIndex(LineSignal signal, Line line)
{
  return amplitudeIndex(signal, index(line));
}

constexpr LineSignal ERROR_LINE = LineSignal::KINEMATIC_ERROR;
constexpr LineSignal TORQUE_LINE = LineSignal::MOTOR_TORQUE;
using IndicatorsMessage = harmonic_joint_twin::Indicators;

const std::array<IndicatorField, SCALAR_COUNT + LINE_SIGNALS * LINE_COUNT> INDICATOR_FIELDS{ {
    { &IndicatorsMessage::ratio_deviation, indexOf(ScalarIndicator::RATIO_DEVIATION) },
    { &IndicatorsMessage::kinematic_error, indexOf(ScalarIndicator::KINEMATIC_ERROR) },
    { &IndicatorsMessage::torsional_stiffness, indexOf(ScalarIndicator::TORSIONAL_STIFFNESS) },
    { &IndicatorsMessage::lost_motion, indexOf(ScalarIndicator::LOST_MOTION) },
    { &IndicatorsMessage::hysteresis_area, indexOf(ScalarIndicator::HYSTERESIS_AREA) },
    { &IndicatorsMessage::running_torque, indexOf(ScalarIndicator::RUNNING_TORQUE) },
    { &IndicatorsMessage::coulomb_torque, indexOf(ScalarIndicator::COULOMB_TORQUE) },
    { &IndicatorsMessage::viscous_friction, indexOf(ScalarIndicator::VISCOUS_FRICTION) },
    { &IndicatorsMessage::efficiency, indexOf(ScalarIndicator::EFFICIENCY) },
    { &IndicatorsMessage::residual_rms, indexOf(ScalarIndicator::RESIDUAL_RMS) },
    { &IndicatorsMessage::residual_kurtosis, indexOf(ScalarIndicator::RESIDUAL_KURTOSIS) },
    { &IndicatorsMessage::residual_crest, indexOf(ScalarIndicator::RESIDUAL_CREST) },
    { &IndicatorsMessage::error_wave_generator_1, lineIndex(ERROR_LINE, Line::WAVE_GENERATOR_1) },
    { &IndicatorsMessage::error_wave_generator_2, lineIndex(ERROR_LINE, Line::WAVE_GENERATOR_2) },
    { &IndicatorsMessage::error_wave_generator_4, lineIndex(ERROR_LINE, Line::WAVE_GENERATOR_4) },
    { &IndicatorsMessage::error_circular_spline_2, lineIndex(ERROR_LINE, Line::CIRCULAR_SPLINE_2) },
    { &IndicatorsMessage::error_cage, lineIndex(ERROR_LINE, Line::CAGE) },
    { &IndicatorsMessage::error_cage_lobes, lineIndex(ERROR_LINE, Line::CAGE_LOBES) },
    { &IndicatorsMessage::error_ball, lineIndex(ERROR_LINE, Line::BALL) },
    { &IndicatorsMessage::error_ball_double, lineIndex(ERROR_LINE, Line::BALL_DOUBLE) },
    { &IndicatorsMessage::error_outer, lineIndex(ERROR_LINE, Line::OUTER) },
    { &IndicatorsMessage::error_outer_below, lineIndex(ERROR_LINE, Line::OUTER_BELOW) },
    { &IndicatorsMessage::error_outer_above, lineIndex(ERROR_LINE, Line::OUTER_ABOVE) },
    { &IndicatorsMessage::error_inner, lineIndex(ERROR_LINE, Line::INNER) },
    { &IndicatorsMessage::error_inner_below, lineIndex(ERROR_LINE, Line::INNER_BELOW) },
    { &IndicatorsMessage::error_inner_above, lineIndex(ERROR_LINE, Line::INNER_ABOVE) },
    { &IndicatorsMessage::error_tooth_pass, lineIndex(ERROR_LINE, Line::TOOTH_PASS) },
    { &IndicatorsMessage::error_tooth_pass_above, lineIndex(ERROR_LINE, Line::TOOTH_PASS_ABOVE) },
    { &IndicatorsMessage::torque_wave_generator_1, lineIndex(TORQUE_LINE, Line::WAVE_GENERATOR_1) },
    { &IndicatorsMessage::torque_wave_generator_2, lineIndex(TORQUE_LINE, Line::WAVE_GENERATOR_2) },
    { &IndicatorsMessage::torque_wave_generator_4, lineIndex(TORQUE_LINE, Line::WAVE_GENERATOR_4) },
    { &IndicatorsMessage::torque_circular_spline_2, lineIndex(TORQUE_LINE, Line::CIRCULAR_SPLINE_2) },
    { &IndicatorsMessage::torque_cage, lineIndex(TORQUE_LINE, Line::CAGE) },
    { &IndicatorsMessage::torque_cage_lobes, lineIndex(TORQUE_LINE, Line::CAGE_LOBES) },
    { &IndicatorsMessage::torque_ball, lineIndex(TORQUE_LINE, Line::BALL) },
    { &IndicatorsMessage::torque_ball_double, lineIndex(TORQUE_LINE, Line::BALL_DOUBLE) },
    { &IndicatorsMessage::torque_outer, lineIndex(TORQUE_LINE, Line::OUTER) },
    { &IndicatorsMessage::torque_outer_below, lineIndex(TORQUE_LINE, Line::OUTER_BELOW) },
    { &IndicatorsMessage::torque_outer_above, lineIndex(TORQUE_LINE, Line::OUTER_ABOVE) },
    { &IndicatorsMessage::torque_inner, lineIndex(TORQUE_LINE, Line::INNER) },
    { &IndicatorsMessage::torque_inner_below, lineIndex(TORQUE_LINE, Line::INNER_BELOW) },
    { &IndicatorsMessage::torque_inner_above, lineIndex(TORQUE_LINE, Line::INNER_ABOVE) },
    { &IndicatorsMessage::torque_tooth_pass, lineIndex(TORQUE_LINE, Line::TOOTH_PASS) },
    { &IndicatorsMessage::torque_tooth_pass_above, lineIndex(TORQUE_LINE, Line::TOOTH_PASS_ABOVE) },
} };

const std::array<PhaseField, LINE_SIGNALS * PHASE_LOCKED> PHASE_FIELDS{ {
    { &IndicatorsMessage::error_wave_generator_1_phase, ERROR_LINE, Line::WAVE_GENERATOR_1 },
    { &IndicatorsMessage::error_wave_generator_2_phase, ERROR_LINE, Line::WAVE_GENERATOR_2 },
    { &IndicatorsMessage::error_wave_generator_4_phase, ERROR_LINE, Line::WAVE_GENERATOR_4 },
    { &IndicatorsMessage::error_circular_spline_2_phase, ERROR_LINE, Line::CIRCULAR_SPLINE_2 },
    { &IndicatorsMessage::torque_wave_generator_1_phase, TORQUE_LINE, Line::WAVE_GENERATOR_1 },
    { &IndicatorsMessage::torque_wave_generator_2_phase, TORQUE_LINE, Line::WAVE_GENERATOR_2 },
    { &IndicatorsMessage::torque_wave_generator_4_phase, TORQUE_LINE, Line::WAVE_GENERATOR_4 },
    { &IndicatorsMessage::torque_circular_spline_2_phase, TORQUE_LINE, Line::CIRCULAR_SPLINE_2 },
} };
}  // namespace

sensor_msgs::JointState makeJointStates(const JointNames& names)
{
  sensor_msgs::JointState message;
  message.header.frame_id = names.joint;
  message.name = { names.motor, names.joint };
  message.position.resize(2);
  message.velocity.resize(2);
  message.effort.resize(2);
  return message;
}

void fillJointStates(const JointOutputs& outputs, const EncoderReadings& readings,
                     sensor_msgs::JointState& message) noexcept
{
  message.header.stamp = toRosTime(outputs.stamp);
  message.position[MOTOR] = readings.motor_angle;
  message.position[JOINT] = readings.output_angle;
  message.velocity[MOTOR] = readings.motor_velocity;
  message.velocity[JOINT] = readings.output_velocity;
  message.effort[MOTOR] = outputs.motor_torque;
  message.effort[JOINT] = outputs.joint_torque;
}

harmonic_joint_twin::Encoders makeEncoders(const JointNames& names)
{
  harmonic_joint_twin::Encoders message;
  message.header.frame_id = names.joint;
  return message;
}

void fillEncoders(const JointOutputs& outputs, const EncoderReadings& readings,
                  harmonic_joint_twin::Encoders& message) noexcept
{
  message.header.stamp = toRosTime(outputs.stamp);
  message.motor_count = readings.motor_count;
  message.motor_angle = readings.motor_angle;
  message.motor_angle_true = outputs.motor_angle;
  message.output_count = readings.output_count;
  message.output_angle = readings.output_angle;
  message.output_angle_true = outputs.output_angle;
}

harmonic_joint_twin::ContactForces makeContactForces(const JointNames& names, int teeth)
{
  harmonic_joint_twin::ContactForces message;
  message.header.frame_id = names.joint;
  const auto size = static_cast<std::size_t>(teeth);
  for (auto* array : { &message.wave_generator_force, &message.rim_tension, &message.bending_force, &message.mesh_force,
                       &message.tooth_x, &message.tooth_y })
  {
    array->resize(size);
  }
  return message;
}

void fillContactForces(const JointOutputs& outputs, const ToothForces& forces,
                       harmonic_joint_twin::ContactForces& message) noexcept
{
  message.header.stamp = toRosTime(outputs.stamp);
  message.wave_generator_angle = outputs.motor_angle;
  message.output_angle = outputs.output_angle;
  copyArray(forces.wave_generator_force, message.wave_generator_force);
  copyArray(forces.rim_tension, message.rim_tension);
  copyArray(forces.bending_force, message.bending_force);
  copyArray(forces.mesh_force, message.mesh_force);
  copyArray(forces.tooth_x, message.tooth_x);
  copyArray(forces.tooth_y, message.tooth_y);
}

harmonic_joint_twin::Health makeHealth(const JointNames& names)
{
  harmonic_joint_twin::Health message;
  message.header.frame_id = names.joint;
  return message;
}

void fillHealth(const Twin& twin, Stamp since, harmonic_joint_twin::Health& message) noexcept
{
  const JointOutputs& outputs = twin.outputs();
  const HealthReport report = twin.health(since);
  message.header.stamp = toRosTime(outputs.stamp);
  message.transmission_ratio_valid = report.motion.transmission_ratio.valid;
  message.transmission_ratio = report.motion.transmission_ratio.value;
  message.torsion = report.motion.torsion;
  message.torsional_stiffness_valid = report.motion.torsional_stiffness.valid;
  message.torsional_stiffness = report.motion.torsional_stiffness.value;
  message.torsional_stiffness_model = outputs.torsional_stiffness;
  message.teeth_loaded = static_cast<std::uint32_t>(report.lobes.teeth_loaded);
  std::copy(report.lobes.mesh_force.begin(), report.lobes.mesh_force.end(), message.lobe_mesh_force.begin());
  message.lobe_asymmetry = report.lobes.asymmetry;
  message.wave_generator_load = report.lobes.wave_generator_force;
  message.friction_torque = outputs.friction_torque;
  message.efficiency_valid = report.motion.efficiency.valid;
  message.efficiency = report.motion.efficiency.value;
  message.kinematic_error_valid = report.motion.kinematic_error.valid;
  message.kinematic_error = report.motion.kinematic_error.value;
  message.motor_torque = outputs.motor_torque;
  message.joint_torque = outputs.joint_torque;
  message.energy_residual = outputs.energy_residual;
  message.solver_state = static_cast<std::uint8_t>(report.solver_state);
  message.solver_iterations = outputs.iterations;
  message.solver_residual = outputs.residual;
  message.solver_failures = twin.counters().solver_failures;
}

std::size_t writeEvidence(const Assessment& assessment, char* text, std::size_t size) noexcept
{
  std::size_t length = 0;
  for (std::size_t i = 0; i < assessment.evidence_count && length < size; ++i)
  {
    const Evidence& evidence = assessment.evidence[i];
    const int written = std::snprintf(text + length, size - length, "%s%s %.3g %s, healthy %.3g (score %.1f)",
                                      i == 0 ? "" : "; ", indicatorName(evidence.indicator), evidence.value,
                                      indicatorUnit(evidence.indicator), evidence.expected, evidence.score);
    length = std::min(length + static_cast<std::size_t>(std::max(written, 0)), size - 1);
  }
  return length;
}

harmonic_joint_twin::Assessment makeAssessment(const JointNames& names)
{
  harmonic_joint_twin::Assessment message;
  message.header.frame_id = names.joint;
  message.cause.assign(EVIDENCE_LENGTH, ' ');
  message.evidence.assign(EVIDENCE_LENGTH, ' ');
  return message;
}

void fillAssessment(Stamp stamp, const Assessment& assessment, harmonic_joint_twin::Assessment& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.window_end = toRosTime(assessment.stamp);
  message.windows = assessment.windows;
  message.state = static_cast<std::uint8_t>(assessment.state);
  message.level = static_cast<std::uint8_t>(assessment.level);
  message.cause.assign(causeName(assessment.cause));
  message.confidence = assessment.confidence;
  message.largest_score = assessment.largest_score;
  std::array<char, EVIDENCE_LENGTH> text{};
  message.evidence.assign(text.data(), writeEvidence(assessment, text.data(), text.size()));
}

harmonic_joint_twin::Indicators makeIndicators(const JointNames& names)
{
  harmonic_joint_twin::Indicators message;
  message.header.frame_id = names.joint;
  return message;
}

void fillIndicators(Stamp stamp, const SignalIndicators& indicators, harmonic_joint_twin::Indicators& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.window_end = toRosTime(indicators.stamp);
  message.windows = indicators.windows;
  message.turns = indicators.turns;
  message.speed = indicators.point.speed;
  message.direction = indicators.point.direction;
  message.load = indicators.point.load;
  message.temperature = indicators.point.temperature;
  for (const IndicatorField& entry : INDICATOR_FIELDS)
  {
    message.*entry.field = indicators.values[entry.indicator];
  }
  for (const PhaseField& entry : PHASE_FIELDS)
  {
    message.*entry.field = indicators.phase(entry.signal, entry.line);
  }
}

SignalIndicators readIndicators(const harmonic_joint_twin::Indicators& message) noexcept
{
  SignalIndicators indicators;
  indicators.stamp = fromRosTime(message.window_end);
  indicators.windows = message.windows;
  indicators.turns = message.turns;
  indicators.point = { message.speed, message.direction, message.load, message.temperature };
  for (const IndicatorField& entry : INDICATOR_FIELDS)
  {
    indicators.values[entry.indicator] = message.*entry.field;
  }
  for (const PhaseField& entry : PHASE_FIELDS)
  {
    const std::size_t line = index(entry.line);
    const double amplitude = indicators.values[amplitudeIndex(entry.signal, line)];
    indicators.values[cosineIndex(entry.signal, line)] = amplitude * std::cos(message.*entry.field);
    indicators.values[sineIndex(entry.signal, line)] = -amplitude * std::sin(message.*entry.field);
  }
  return indicators;
}

harmonic_joint_twin::Faults makeFaults(const JointNames& names, Stamp stamp, const FaultList& faults)
{
  harmonic_joint_twin::Faults message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = names.joint;
  for (const ActiveFault& active : faults)
  {
    harmonic_joint_twin::Fault fault;
    fault.header = message.header;
    fault.header.stamp = fault.since = toRosTime(active.since);
    fault.kind = describe(active.fault.kind).name;
    fault.severity = active.fault.severity;
    fault.place = active.fault.place;
    message.faults.push_back(fault);
  }
  return message;
}

std::string readFault(const harmonic_joint_twin::Fault& message, const Parameters& parameters, Fault& fault)
{
  const std::optional<FaultKind> kind = faultNamed(message.kind);
  if (!kind)
  {
    return "kind = '" + message.kind + "' is unknown, allowed: " + faultNames();
  }
  fault = { *kind, message.severity, message.place, 0.0 };
  return faultErrors(fault, parameters, "");
}

EffortStatus readMotorTorque(const sensor_msgs::JointState& message, const JointNames& names, double& torque) noexcept
{
  const EffortStatus status = readEffort(message, names.joint, torque);
  return status == EffortStatus::UNKNOWN_JOINT ? readEffort(message, names.motor, torque) : status;
}

EffortStatus readLoadTorque(const sensor_msgs::JointState& message, const JointNames& names, double& torque) noexcept
{
  return readEffort(message, names.joint, torque);
}
}  // namespace hjt
