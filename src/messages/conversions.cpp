// SPDX-License-Identifier: BSD-3-Clause
#include "messages/conversions.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>

#include "base/number_text.hpp"
#include "base/range.hpp"
#include "base/text.hpp"
#include "messages/time.hpp"
#include "statics/inertia_error.hpp"
#include "twin/growing_fault.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t MOTOR = 0;
constexpr std::size_t JOINT = 1;

EffortStatus readEffort(const sensor_msgs::JointState& message, const std::string& name, double& effort) noexcept
{
  const std::size_t index = placeOf(message, name);
  if (index >= message.name.size())
  {
    return EffortStatus::UNKNOWN_JOINT;
  }
  if (index >= message.effort.size())
  {
    return EffortStatus::MISSING_EFFORT;
  }
  effort = message.effort[index];
  return EffortStatus::FOUND;
}

/// Writes a value that may be missing. A missing value gives a field of 0 and a false flag.
template <class Flag>
void fillOptional(double value, double& field, Flag& valid) noexcept
{
  valid = std::isfinite(value);
  field = std::isfinite(value) ? value : 0.0;
}

double optionalValue(double field, bool valid) noexcept
{
  return valid ? field : std::numeric_limits<double>::quiet_NaN();
}
}  // namespace

std::size_t placeOf(const sensor_msgs::JointState& message, const std::string& name) noexcept
{
  const auto found = std::find(message.name.begin(), message.name.end(), name);
  return found == message.name.end() ? std::numeric_limits<std::size_t>::max() :
                                       static_cast<std::size_t>(found - message.name.begin());
}

sensor_msgs::JointState jointStatesOf(std::vector<std::string> names)
{
  sensor_msgs::JointState message;
  message.name = std::move(names);
  message.position.resize(message.name.size());
  message.velocity.resize(message.name.size());
  message.effort.resize(message.name.size());
  return message;
}

sensor_msgs::JointState makeJointStates(const Parameters& parameters)
{
  const JointNames names(parameters.joint.name);
  sensor_msgs::JointState message = jointStatesOf({ names.motor, names.joint });
  message.header.frame_id = parameters.joint.name;
  return message;
}

bool fillJointStates(Twin& twin, const SinceMessage& /*since*/, sensor_msgs::JointState& message) noexcept
{
  const JointOutputs& outputs = twin.outputs();
  const EncoderReadings readings = twin.encoders();
  message.header.stamp = toRosTime(outputs.stamp);
  message.position[MOTOR] = readings.motor_angle;
  message.position[JOINT] = readings.output_angle;
  message.velocity[MOTOR] = readings.motor_velocity;
  message.velocity[JOINT] = readings.output_velocity;
  message.effort[MOTOR] = outputs.motor_torque;
  message.effort[JOINT] = outputs.joint_torque;
  return true;
}

bool fillEncoders(Twin& twin, const SinceMessage& /*since*/, harmonic_joint_twin::Encoders& message) noexcept
{
  const JointOutputs& outputs = twin.outputs();
  fillEncoders(outputs.stamp, twin.encoders(), outputs.motor_angle, outputs.output_angle, message);
  return true;
}

void fillEncoders(Stamp stamp, const EncoderReadings& readings, double motor_angle, double output_angle,
                  harmonic_joint_twin::Encoders& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.motor_count = readings.motor_count;
  message.motor_angle = readings.motor_angle;
  message.motor_angle_true = motor_angle;
  message.output_count = readings.output_count;
  message.output_angle = readings.output_angle;
  message.output_angle_true = output_angle;
}

harmonic_joint_twin::ContactForces makeContactForces(const Parameters& parameters)
{
  auto message = makeMessage<harmonic_joint_twin::ContactForces>(parameters);
  for (auto* array : { &message.wave_generator_force, &message.rim_tension, &message.bending_force, &message.mesh_force,
                       &message.tooth_x, &message.tooth_y })
  {
    array->resize(static_cast<std::size_t>(parameters.gear.teeth_flexspline));
  }
  return message;
}

namespace
{
void swapArrays(ToothForces& forces, harmonic_joint_twin::ContactForces& message) noexcept
{
  forces.wave_generator_force.swap(message.wave_generator_force);
  forces.rim_tension.swap(message.rim_tension);
  forces.bending_force.swap(message.bending_force);
  forces.mesh_force.swap(message.mesh_force);
  forces.tooth_x.swap(message.tooth_x);
  forces.tooth_y.swap(message.tooth_y);
}
}  // namespace

bool fillContactForces(Twin& twin, const SinceMessage& /*since*/, harmonic_joint_twin::ContactForces& message) noexcept
{
  const JointOutputs& outputs = twin.outputs();
  message.header.stamp = toRosTime(outputs.stamp);
  message.wave_generator_angle = outputs.motor_angle;
  message.output_angle = outputs.output_angle;
  message.mesh_force_error = expectedMeshForceError(twin.parameters().ring, twin.parameters().gear,
                                                    outputs.motor_velocity, outputs.joint_torque);
  ToothForces forces;
  swapArrays(forces, message);  // the twin writes into the arrays of the message
  const bool found = twin.toothForces(forces);
  swapArrays(forces, message);
  return found;
}

void fillContactForces(Stamp stamp, const MeasuredGear& gear, harmonic_joint_twin::ContactForces& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.wave_generator_angle = gear.motorAngle();
  message.output_angle = gear.position();
  ToothForces forces;
  swapArrays(forces, message);
  gear.fill(forces);
  swapArrays(forces, message);
}

harmonic_joint_twin::Stress makeStress(const Parameters& parameters)
{
  auto message = makeMessage<harmonic_joint_twin::Stress>(parameters);
  message.places.assign(STRESS_PLACE_NAMES.begin(), STRESS_PLACE_NAMES.end());
  message.place.assign(std::strlen(STRESS_PLACE_NAMES[0]), ' ');  // space for the longest of the names
  for (auto* array : { &message.amplitudes, &message.means, &message.shears, &message.endurance_shares })
  {
    array->resize(STRESS_PLACES);
  }
  for (auto* array : { &message.tooth_space, &message.transition, &message.flange })
  {
    array->resize(static_cast<std::size_t>(parameters.gear.teeth_flexspline));
  }
  return message;
}

namespace
{
/// Fills a message. `source(stress)` fills its arrays. @returns false if `source` could not fill them.
template <class Source>
bool fillStress(Stamp stamp, const StressParameters& parameters, const FatigueLaw& fatigue_law,
                harmonic_joint_twin::Stress& message, const Source& source) noexcept
{
  ToothStress stress;
  const auto swap_arrays = [&]
  {
    stress.normal[0].swap(message.tooth_space);
    stress.normal[1].swap(message.transition);
    stress.normal[2].swap(message.flange);
  };
  swap_arrays();  // the source writes into the arrays of the message
  const bool found = source(stress);
  message.header.stamp = toRosTime(stamp);
  message.largest = 0.0;
  message.place.assign(STRESS_PLACE_NAMES[0]);
  message.tooth = 0;
  message.endurance_share = 0.0;
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    const StressCycle cycle = stress.cycle(place);
    message.amplitudes[place] = cycle.amplitude();
    message.means[place] = cycle.mean();
    message.shears[place] = cycle.shear;
    message.endurance_shares[place] = fatigue_law.enduranceShare(place, cycle);
    message.endurance_share = std::max(message.endurance_share, message.endurance_shares[place]);
    const double largest = parameters.concentration[place] * cycle.largest();
    if (largest > message.largest)
    {
      message.largest = largest;
      message.place.assign(STRESS_PLACE_NAMES[place]);
      message.tooth = static_cast<std::int32_t>(stress.worstTooth(place));
    }
  }
  swap_arrays();
  return found;
}
}  // namespace

bool fillStress(Twin& twin, const SinceMessage& /*since*/, harmonic_joint_twin::Stress& message) noexcept
{
  const Parameters& parameters = twin.parameters();
  return fillStress(twin.stamp(), parameters.stress, FatigueLaw(parameters.life, parameters.stress), message,
                    [&](ToothStress& stress) { return twin.toothStress(stress); });
}

void fillStress(Stamp stamp, const MeasuredGear& gear, const StressParameters& parameters,
                const FatigueLaw& fatigue_law, harmonic_joint_twin::Stress& message) noexcept
{
  fillStress(stamp, parameters, fatigue_law, message,
             [&](ToothStress& stress)
             {
               gear.fill(stress);
               return true;
             });
}

void fillSpan(const SignalSpan& span, double& least, double& mean, double& greatest) noexcept
{
  least = span.least();
  mean = span.mean();
  greatest = span.greatest();
}

bool fillHealth(Twin& twin, const SinceMessage& since, harmonic_joint_twin::Health& message) noexcept
{
  const JointOutputs& outputs = twin.outputs();
  const HealthReport report = twin.health(since.stamp);
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
  message.mesh_force_error = report.mesh_force_error;
  message.wave_generator_load = report.lobes.wave_generator_force;
  message.friction_torque = outputs.friction_torque;
  message.grease_temperature = outputs.temperature;
  message.housing_temperature = outputs.housing_temperature;
  message.efficiency_valid = report.motion.efficiency.valid;
  message.efficiency = report.motion.efficiency.value;
  message.kinematic_error_valid = report.motion.kinematic_error.valid;
  message.kinematic_error = report.motion.kinematic_error.value;
  message.motor_torque = outputs.motor_torque;
  message.joint_torque = outputs.joint_torque;
  fillSpan(since.torsion, message.torsion_min, message.torsion_mean, message.torsion_max);
  fillSpan(since.motor_torque, message.motor_torque_min, message.motor_torque_mean, message.motor_torque_max);
  fillSpan(since.joint_torque, message.joint_torque_min, message.joint_torque_mean, message.joint_torque_max);
  message.energy_residual = outputs.energy_residual;
  message.solver_state = static_cast<std::uint8_t>(report.solver_state);
  message.on_response_surface = twin.onSurface();
  message.solver_iterations = outputs.iterations;
  message.solver_residual = outputs.residual;
  message.solver_failures = twin.counters().solver_failures;
  return true;
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

std::string readFault(const harmonic_joint_twin::Fault& message, const Parameters& parameters,
                      std::vector<Fault>& steps)
{
  const std::optional<FaultKind> kind = faultNamed(message.kind);
  if (!kind)
  {
    return "kind = '" + printable(message.kind) + "' is unknown, allowed: " + faultNames();
  }
  const GrowingFault growing{ { *kind, message.severity, message.place, 0.0 }, message.ramp };
  if (const Range range{ 0.0, GrowingFault::MAX_RAMP }; !isWithin(growing.ramp, range))
  {
    return outOfRangeText("ramp", growing.ramp, "s", range);
  }
  steps = growing.steps();
  return faultErrors(growing.fault, parameters, "");
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

std::size_t writeEvidence(const Assessment& assessment, char* text, std::size_t size) noexcept
{
  std::size_t length = 0;
  for (std::size_t i = 0; i < assessment.evidence_count && length < size; ++i)
  {
    const Evidence& evidence = assessment.evidence[i];
    // These short strings need no allocation.
    const std::string value = roundedText(evidence.value, 3);
    const std::string expected = roundedText(evidence.expected, 3);
    const std::string score = fixedText(std::min(evidence.score, 1e9), 1);
    const int written = std::snprintf(text + length, size - length, "%s%s %s %s, healthy %s (score %s)",
                                      i == 0 ? "" : "; ", indicatorName(evidence.indicator), value.c_str(),
                                      indicatorUnit(evidence.indicator), expected.c_str(), score.c_str());
    length = std::min(length + static_cast<std::size_t>(std::max(written, 0)), size - 1);
  }
  return length;
}

std::size_t writeAlternatives(const Assessment& assessment, char* text, std::size_t size) noexcept
{
  std::size_t length = 0;
  for (std::size_t i = 0; i < assessment.alternative_count && length < size; ++i)
  {
    const Alternative& alternative = assessment.alternatives[i];
    const int written = std::snprintf(text + length, size - length, "%s%s %.0f %%", i == 0 ? "" : "; ",
                                      causeName(alternative.cause), 100.0 * alternative.confidence);
    length = std::min(length + static_cast<std::size_t>(std::max(written, 0)), size - 1);
  }
  return length;
}

harmonic_joint_twin::Assessment makeAssessment(const Parameters& parameters)
{
  auto message = makeMessage<harmonic_joint_twin::Assessment>(parameters);
  message.cause.assign(EVIDENCE_LENGTH, ' ');
  message.alternatives.assign(EVIDENCE_LENGTH, ' ');
  message.evidence.assign(EVIDENCE_LENGTH, ' ');
  return message;
}

void fillAssessment(Stamp stamp, const Assessment& assessment, harmonic_joint_twin::Assessment& message) noexcept
{
  message.header.stamp = toRosTime(stamp);
  message.window_end = toRosTime(assessment.stamp);
  message.windows = assessment.windows;
  message.state = static_cast<std::uint8_t>(assessment.state);
  message.windows_here = static_cast<std::uint32_t>(assessment.windows_here);
  message.windows_needed = static_cast<std::uint32_t>(assessment.windows_needed);
  message.level = static_cast<std::uint8_t>(assessment.level);
  message.cause.assign(causeName(assessment.cause));
  message.confidence = assessment.confidence;
  message.severity = assessment.severity;
  message.severity_deviation = assessment.severity_deviation;
  message.largest_score = assessment.largest_score;
  std::array<char, EVIDENCE_LENGTH> text{};
  message.evidence.assign(text.data(), writeEvidence(assessment, text.data(), text.size()));
  message.alternatives.assign(text.data(), writeAlternatives(assessment, text.data(), text.size()));
}

harmonic_joint_twin::Indicators makeIndicators(const Parameters& parameters)
{
  auto message = makeMessage<harmonic_joint_twin::Indicators>(parameters);
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    message.names.emplace_back(indicatorName(i));
  }
  message.values.resize(INDICATOR_COUNT);
  message.valid.resize(INDICATOR_COUNT);
  message.errors.resize(INDICATOR_COUNT);
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
  fillOptional(indicators.point.load, message.load, message.load_valid);
  message.load_constant = message.load_valid ? indicators.point.load_constant : 0.0;
  message.load_sine = message.load_valid ? indicators.point.load_sine : 0.0;
  message.load_cosine = message.load_valid ? indicators.point.load_cosine : 0.0;
  fillOptional(indicators.point.temperature, message.temperature, message.temperature_valid);
  message.inertia = indicators.point.inertia;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    fillOptional(indicators.values[i], message.values[i], message.valid[i]);
    message.errors[i] = indicators.uncertainty[i];
  }
}

SignalIndicators readIndicators(const harmonic_joint_twin::Indicators& message)
{
  SignalIndicators indicators;
  indicators.stamp = fromRosTime(message.window_end);
  indicators.windows = message.windows;
  indicators.turns = message.turns;
  indicators.point = { message.speed,
                       message.direction,
                       optionalValue(message.load, message.load_valid),
                       optionalValue(message.temperature, message.temperature_valid),
                       optionalValue(message.load_constant, message.load_valid),
                       optionalValue(message.load_sine, message.load_valid),
                       optionalValue(message.load_cosine, message.load_valid),
                       message.inertia };
  const std::size_t count = std::min({ message.names.size(), message.values.size(), message.valid.size() });
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    const auto name = std::find(message.names.begin(), message.names.end(), indicatorName(i));
    const auto place = static_cast<std::size_t>(name - message.names.begin());
    if (place < count)
    {
      indicators.values[i] = optionalValue(message.values[place], message.valid[place] != 0);
      indicators.uncertainty[i] = place < message.errors.size() ? message.errors[place] : 0.0;
    }
  }
  return indicators;
}
}  // namespace hjt
