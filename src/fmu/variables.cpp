// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/variables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "health/indicator_table.hpp"
#include "params/choices.hpp"
#include "params/field_table.hpp"

#include "base/hash.hpp"
#include "base/number_text.hpp"
#include "gear/ratio.hpp"

namespace hjt::fmu
{
namespace
{
/// Parameters that are not variables of a unit. Some are only for the node. Of the last four, brake.engaged_at_start is
/// an input, and the others would change the description of the unit.
constexpr std::array LEFT_OUT{ "joint.",
                               "life.",
                               "input.",
                               "telemetry.",
                               "observer.",
                               "publish.",
                               "realtime.",
                               "comparison.",
                               "stress.",
                               "solver.rate",
                               "brake.engaged_at_start",
                               "gear.teeth_flexspline",
                               "gear.teeth_circular_spline" };

/// Parameters that are not variables of an arm's drives, because the arm determines their values.
constexpr std::array LEFT_OUT_IN_ARM{ "output.load_inertia", "output.gravity_" };

double finite(double value)
{
  return std::isfinite(value) ? value : 0.0;
}

template <ScalarIndicator INDICATOR>
double indicator(const Twin& twin, const JointOutputs&)
{
  return finite(twin.signalIndicators()[INDICATOR]);
}

double motorCurrent(const Twin& twin, const JointOutputs&)
{
  const TelemetryParameters& telemetry = twin.parameters().telemetry;
  return nominalRatio(twin.parameters().gear) * twin.motorTorqueReading() / telemetry.torque_per_current +
         telemetry.current_offset;
}

/// Makes a variable of the unit from each parameter.
struct ParameterMaker
{
  void operator()(const std::string& key, const char* unit, double value, const Range& range, const Meaning& meaning)
  {
    add({ key, unit, meaning.text, Causality::PARAMETER, Type::FLOAT64, { { value } }, range });
  }
  void operator()(const std::string& key, const char* unit, int value, const Range& range, const Meaning& meaning)
  {
    add({ key, unit, meaning.text, Causality::PARAMETER, Type::INT32, { { static_cast<double>(value) } }, range });
  }
  template <std::size_t N>
  void operator()(const std::string& key, const char* unit, const std::array<double, N>& values, const Range& range,
                  const Meaning& meaning)
  {
    add({ key,
          unit,
          meaning.text,
          Causality::PARAMETER,
          Type::FLOAT64,
          { { values.begin(), values.end() } },
          range,
          true });
  }
  void operator()(const std::string& key, bool value, const Meaning& meaning)
  {
    add({ key, "-", meaning.text, Causality::PARAMETER, Type::BOOLEAN, { { value ? 1.0 : 0.0 } } });
  }
  void operator()(const std::string& key, const std::string& value, const Meaning& meaning)
  {
    const auto* const* end = std::end(FILE_PARAMETERS);
    if (std::find(std::begin(FILE_PARAMETERS), end, key) == end)
    {
      add({ key, "-", meaning.text, Causality::PARAMETER, Type::STRING, { {}, value } });
    }
  }
  template <class Choice>
  std::enable_if_t<std::is_enum<Choice>::value> operator()(const std::string& key, Choice value, const Meaning& meaning)
  {
    for (const auto& [name, choice] : choiceNames(Choice{}))
    {
      if (choice == value)
      {
        add({ key, "-", meaning.text, Causality::PARAMETER, Type::STRING, { {}, name } });
      }
    }
  }

  void add(FmuVariable variable)
  {
    const auto begins = [&](const char* left_out) { return variable.name.rfind(left_out, 0) == 0; };
    const bool given = !prefix.empty() && std::any_of(LEFT_OUT_IN_ARM.begin(), LEFT_OUT_IN_ARM.end(), begins);
    if (!given && std::none_of(LEFT_OUT.begin(), LEFT_OUT.end(), begins))
    {
      variable.name = prefix + variable.name;
      all.push_back(std::move(variable));
    }
  }

  const std::string& prefix;
  std::vector<FmuVariable>& all;
};

/// Configured fault of a kind that acts from the start on. If there is none: severity 0 at the first allowed place.
Fault startingFault(FaultKind kind, const Parameters& parameters)
{
  const auto found = std::find_if(parameters.faults.begin(), parameters.faults.end(),
                                  [&](const Fault& fault) { return fault.kind == kind && fault.isActiveAtStart(); });
  return found != parameters.faults.end() ? *found : Fault{ kind, 0.0, firstPlace(kind) };
}

void addInputs(const Parameters& parameters, const std::string& prefix, std::vector<FmuVariable>& all)
{
  const double load = parameters.output.load_torque_limit;
  const auto add = [&](const char* name, const char* unit, const char* meaning, double start, const Range& range)
  {
    all.push_back({ prefix + name, unit, meaning, Causality::INPUT, Type::FLOAT64, { { start } }, range });
    all.back().is_clamped = all.back().unit == "N.m";
  };
  add("motor_torque", "N.m",
      prefix.empty() ? "commanded torque of the motor, clamped to motor.torque_limit" :
                       "commanded torque of the motor if the arm has no controller, clamped to motor.torque_limit",
      0.0, { -1e6, 1e6 });
  add("load_torque", "N.m", "external torque at the output, > 0 resists positive motion", 0.0, { -load, load });
  add("temperature", "degC", "temperature of the drive, or of its surroundings with thermal.model = two_nodes",
      parameters.input.temperature, { MIN_TEMPERATURE, MAX_TEMPERATURE });
  all.push_back({ prefix + "brake",
                  "-",
                  "true engages the brake; the brake acts after brake.delay",
                  Causality::INPUT,
                  Type::BOOLEAN,
                  { { parameters.brake.engaged_at_start ? 1.0 : 0.0 } } });
  for (const FaultDescription& kind : FAULT_DESCRIPTIONS)
  {
    all.push_back({ prefix + "fault_" + kind.name,
                    "-",
                    std::string("severity of the fault; 1: ") + kind.severity,
                    Causality::INPUT,
                    Type::FLOAT64,
                    { { startingFault(kind.kind, parameters).severity } },
                    Range{ 0.0, 1.0 },
                    false,
                    true });
  }
}

void addOutputs(const Parameters& parameters, const std::string& prefix, std::vector<FmuVariable>& all)
{
  for (const ScalarOutput& output : scalarOutputs())
  {
    all.push_back({ prefix + output.name, output.unit, output.description, Causality::OUTPUT, output.type });
  }
  const auto teeth = static_cast<std::size_t>(parameters.gear.teeth_flexspline);
  for (const ToothOutput& output : toothOutputs())
  {
    all.push_back({ prefix + output.name,
                    "N",
                    output.description,
                    Causality::OUTPUT,
                    Type::FLOAT64,
                    { std::vector<double>(teeth, 0.0) },
                    {},
                    true });
  }
}
std::vector<ScalarOutput> driveOutputs()
{
  using T = const Twin&;
  using O = const JointOutputs&;
  constexpr Type F = Type::FLOAT64;
  return {
    { "motor_angle", "rad", "true angle of the wave generator", F, [](T, O o) { return o.motor_angle; } },
    { "motor_velocity", "rad/s", "true speed of the wave generator", F, [](T, O o) { return o.motor_velocity; } },
    { "output_angle", "rad", "true angle of the circular spline", F, [](T, O o) { return o.output_angle; } },
    { "output_velocity", "rad/s", "true speed of the circular spline", F, [](T, O o) { return o.output_velocity; } },
    { "motor_angle_encoder", "rad", "reading of the motor's encoder", F,
      [](T t, O) { return t.encoders().motor_angle; } },
    { "motor_velocity_encoder", "rad/s", "speed of the motor from the readings of its encoder", F,
      [](T t, O) { return t.encoders().motor_velocity; } },
    { "output_angle_encoder", "rad", "reading of the output's encoder, over several turns", F,
      [](T t, O) { return t.encoders().output_angle; } },
    { "output_velocity_encoder", "rad/s", "speed of the output from the readings of its encoder", F,
      [](T t, O) { return t.encoders().output_velocity; } },
    { "motor_current", "A", "motor current as the drive reads it, from the torque by telemetry.torque_per_current", F,
      motorCurrent },
    { "motor_torque_reading", "N.m", "motor torque as the drive estimates it from the current", F,
      [](T t, O) { return t.motorTorqueReading(); } },
    { "motor_torque_applied", "N.m", "motor torque that acts, after limits and current loop", F,
      [](T, O o) { return o.motor_torque; } },
    { "wave_generator_torque", "N.m", "torque of the wave generator on the flexspline", F,
      [](T, O o) { return o.wave_generator_torque; } },
    { "joint_torque", "N.m", "torque of the mesh on the circular spline", F, [](T, O o) { return o.joint_torque; } },
    { "friction_torque", "N.m", "torque at the motor shaft that has the power of all friction, >= 0", F,
      [](T, O o) { return o.friction_torque; } },
    { "torsional_stiffness", "N.m/rad", "local stiffness with the wave generator locked", F,
      [](T, O o) { return o.torsional_stiffness; } },
    { "energy_residual", "J", "supplied - stored - dissipated - released energy since the start", F,
      [](T, O o) { return o.energy_residual; } },
    { "grease_temperature", "degC", "temperature of the grease, which determines the friction", F,
      [](T, O o) { return o.temperature; } },
    { "housing_temperature", "degC", "temperature of the housing", F, [](T, O o) { return o.housing_temperature; } },
    { "brake_engaged", "-", "whether the brake holds the motor within brake.play", Type::BOOLEAN,
      [](T, O o) { return o.brake_engaged ? 1.0 : 0.0; } },
    { "converged", "-", "false: the solver found no equilibrium, and the twin keeps its last converged state",
      Type::BOOLEAN, [](T, O o) { return o.converged ? 1.0 : 0.0; } },
  };
}

std::vector<ScalarOutput> healthOutputs()
{
  using T = const Twin&;
  using O = const JointOutputs&;
  using S = ScalarIndicator;
  constexpr Type F = Type::FLOAT64;
  constexpr const char* LAST_WINDOW = "value in the last window that gave a value of the indicator; 0: none yet";
  return {
    { "transmission_ratio", "-",
      "change of the motor angle / change of the output angle, over the last motor turn; 0: no value yet", F,
      [](T t, O) { return t.health().motion.transmission_ratio.value; } },
    { "torsion", "rad", "motor angle / nominal ratio - output angle", F,
      [](T t, O) { return t.health().motion.torsion; } },
    { "running_stiffness", "N.m/rad", "slope of the joint torque over the torsion during motion; 0: no value yet", F,
      [](T t, O) { return t.health().motion.torsional_stiffness.value; } },
    { "running_efficiency", "-", "output power / input power of the last motion; 0: no value yet", F,
      [](T t, O) { return t.health().motion.efficiency.value; } },
    { "running_kinematic_error", "rad", "torsion, peak to peak over the last motor turn; 0: no value yet", F,
      [](T t, O) { return t.health().motion.kinematic_error.value; } },
    { "teeth_loaded", "-", "number of teeth that carry mesh force", Type::INT32,
      [](T t, O) { return static_cast<double>(t.health().lobes.teeth_loaded); } },
    { "lobe_force_0", "N", "sum of mesh forces near lobe 0", F, [](T t, O) { return t.health().lobes.mesh_force[0]; } },
    { "lobe_force_1", "N", "sum of mesh forces near lobe 1", F, [](T t, O) { return t.health().lobes.mesh_force[1]; } },
    { "bearing_force", "N", "sum of the wave generator's forces on all teeth, which its bearing carries", F,
      [](T t, O) { return t.health().lobes.wave_generator_force; } },
    { "assessment_level", "-", "level of the assessment: 0 OK, 1 WARN, 2 ERROR", Type::INT32,
      [](T t, O) { return static_cast<double>(t.assessment().level); }, true },
    { "assessment_state", "-",
      "state of the assessment: 0 waiting, 1 learning, 2 assessed, 3 no reference, 4 too few windows, 5 other payload",
      Type::INT32, [](T t, O) { return static_cast<double>(t.assessment().state); }, true },
    { "assessment_cause", "-",
      "most likely cause: 0: none; 1, 2, ...: the fault of the first, second, ... input fault_*; the last number: a "
      "tooth of the circular spline",
      Type::INT32, [](T t, O) { return static_cast<double>(t.assessment().cause); }, true },
    { "assessment_confidence", "-", "probability of assessment_cause", F,
      [](T t, O) { return t.assessment().confidence; }, true },
    { "assessment_severity", "-", "mean severity of the fault assessment_cause", F,
      [](T t, O) { return t.assessment().severity; }, true },
    { "indicator_windows", "-", "number of windows for which indicators were computed", Type::INT32,
      [](T t, O) { return static_cast<double>(t.signalIndicators().windows); }, true },
    { "indicator_kinematic_error", "rad", LAST_WINDOW, F, indicator<S::KINEMATIC_ERROR>, true },
    { "indicator_torsional_stiffness", "N.m/rad", LAST_WINDOW, F, indicator<S::TORSIONAL_STIFFNESS>, true },
    { "indicator_lost_motion", "rad", LAST_WINDOW, F, indicator<S::LOST_MOTION>, true },
    { "indicator_hysteresis", "rad", LAST_WINDOW, F, indicator<S::HYSTERESIS>, true },
    { "indicator_hysteresis_area", "J", LAST_WINDOW, F, indicator<S::HYSTERESIS_AREA>, true },
    { "indicator_running_torque", "N.m", LAST_WINDOW, F, indicator<S::RUNNING_TORQUE>, true },
    { "indicator_coulomb_torque", "N.m", LAST_WINDOW, F, indicator<S::COULOMB_TORQUE>, true },
    { "indicator_viscous_friction", "N.m.s/rad", LAST_WINDOW, F, indicator<S::VISCOUS_FRICTION>, true },
    { "indicator_efficiency", "-", LAST_WINDOW, F, indicator<S::EFFICIENCY>, true },
    { "indicator_residual_rms", "rad", LAST_WINDOW, F, indicator<S::RESIDUAL_RMS>, true },
  };
}
}  // namespace

const std::vector<ScalarOutput>& scalarOutputs()
{
  static const std::vector<ScalarOutput> OUTPUTS = []
  {
    std::vector<ScalarOutput> outputs = driveOutputs();
    const std::vector<ScalarOutput> health = healthOutputs();
    outputs.insert(outputs.end(), health.begin(), health.end());
    return outputs;
  }();
  return OUTPUTS;
}

const std::vector<ToothOutput>& toothOutputs()
{
  static const std::vector<ToothOutput> OUTPUTS{
    { "tooth_mesh_force", "normal force on the flank of each tooth, > 0 leading, < 0 trailing flank",
      &ToothForces::mesh_force },
    { "tooth_wave_generator_force", "force of the wave generator on each tooth", &ToothForces::wave_generator_force },
    { "tooth_rim_tension", "tension of the rim from each tooth to the next", &ToothForces::rim_tension },
    { "tooth_bending_force", "bending force of the segment from each tooth to the next", &ToothForces::bending_force },
  };
  return OUTPUTS;
}

std::size_t placeReference(std::size_t kind)
{
  return FIRST_OUTPUT + scalarOutputs().size() + toothOutputs().size() + kind;
}

FmuVariable timeVariable()
{
  return { "time", "s", "simulated time", Causality::INDEPENDENT, Type::FLOAT64 };
}

std::vector<FmuVariable> driveVariables(const Parameters& parameters)
{
  std::vector<FmuVariable> all{ timeVariable() };
  addDrive(parameters, "", all);
  return all;
}

void addDrive(const Parameters& parameters, const std::string& prefix, std::vector<FmuVariable>& all)
{
  addInputs(parameters, prefix, all);
  addOutputs(parameters, prefix, all);
  for (const FaultDescription& kind : FAULT_DESCRIPTIONS)
  {
    const Range places{ static_cast<double>(firstPlace(kind.kind)),
                        static_cast<double>(lastPlace(kind.kind, parameters)) };
    all.push_back({ prefix + "fault_" + kind.name + "_place",
                    "-",
                    placeText(kind.kind, parameters),
                    Causality::PARAMETER,
                    Type::INT32,
                    { { static_cast<double>(startingFault(kind.kind, parameters).place) } },
                    places });
  }
  ParameterMaker maker{ prefix, all };
  visitFields(parameters, maker);
}

std::string instantiationToken(const std::string& text)
{
  TextStream token;
  token << "harmonic_joint_twin " << HJT_VERSION << ' ' << std::hex << textHash(text);
  return token.str();
}

void requireToken(const std::string& token, const std::string& text)
{
  if (token != instantiationToken(text))
  {
    throw InputError("the instantiation token is '" + token + "', but this library and its resources have '" +
                     instantiationToken(text) + "'");
  }
}
}  // namespace hjt::fmu
