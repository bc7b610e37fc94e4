// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <optional>

#include "harmonic_joint_twin/twin/twin.hpp"
#include "python/bindings.hpp"

namespace hjt
{
namespace
{
std::optional<double> optional(const Indicator& indicator)
{
  return indicator.valid ? std::optional<double>(indicator.value) : std::nullopt;
}

const char* solverStateName(SolverState state)
{
  switch (state)
  {
    case SolverState::OK:
      break;
    case SolverState::DEGRADED:
      return "DEGRADED";
    case SolverState::FAILED:
      return "FAILED";
  }
  return "OK";
}

const char* assessmentStateName(AssessmentState state)
{
  switch (state)
  {
    case AssessmentState::WAITING:
      break;
    case AssessmentState::LEARNING:
      return "LEARNING";
    case AssessmentState::ASSESSED:
      return "ASSESSED";
    case AssessmentState::NO_REFERENCE:
      return "NO_REFERENCE";
    case AssessmentState::TOO_FEW_WINDOWS:
      return "TOO_FEW_WINDOWS";
    case AssessmentState::OTHER_PAYLOAD:
      return "OTHER_PAYLOAD";
  }
  return "WAITING";
}

py::dict byName(const std::array<double, INDICATOR_COUNT>& values)
{
  py::dict named;
  for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
  {
    named[indicatorName(i)] = values[i];
  }
  return named;
}

py::list evidenceOf(const Assessment& assessment)
{
  py::list evidence;
  for (std::size_t i = 0; i < assessment.evidence_count; ++i)
  {
    evidence.append(assessment.evidence[i]);
  }
  return evidence;
}

py::dict alternativesOf(const Assessment& assessment)
{
  py::dict alternatives;
  for (std::size_t i = 0; i < assessment.alternative_count; ++i)
  {
    alternatives[causeName(assessment.alternatives[i].cause)] = assessment.alternatives[i].confidence;
  }
  return alternatives;
}

void bindReport(py::module& module)
{
  auto health = py::class_<HealthReport>(
      module, "Health", "Health of the simulated drive at one instant, as in Health.msg. An invalid value is None.");
  health
      .def_property_readonly(
          "transmission_ratio", [](const HealthReport& self) { return optional(self.motion.transmission_ratio); },
          "change of the motor angle / change of the joint angle, over the last motor turn [-] or None")
      .def_property_readonly(
          "torsion", [](const HealthReport& self) { return self.motion.torsion; },
          "motor angle / nominal ratio - joint angle [rad]")
      .def_property_readonly(
          "torsional_stiffness", [](const HealthReport& self) { return optional(self.motion.torsional_stiffness); },
          "slope of the joint torque over the torsion, by regression [N.m/rad] or None")
      .def_property_readonly(
          "efficiency", [](const HealthReport& self) { return optional(self.motion.efficiency); },
          "output power over input power [-] or None")
      .def_property_readonly(
          "kinematic_error", [](const HealthReport& self) { return optional(self.motion.kinematic_error); },
          "peak to peak of the torsion over the last motor turn [rad] or None")
      .def_property_readonly(
          "teeth_loaded", [](const HealthReport& self) { return self.lobes.teeth_loaded; },
          "number of teeth that carry mesh force [-]")
      .def_property_readonly(
          "lobe_mesh_force", [](const HealthReport& self) { return py::tuple(py::cast(self.lobes.mesh_force)); },
          "sum of mesh forces at each lobe of the wave generator [N]: tuple of 2")
      .def_property_readonly(
          "lobe_asymmetry", [](const HealthReport& self) { return self.lobes.asymmetry; },
          "(first - second) / (first + second) of lobe_mesh_force; 0 without load [-]")
      .def_readonly(
          "mesh_force_error", &HealthReport::mesh_force_error,
          "expected rms error of a loaded tooth's force at this speed and load, because the ring has no inertia [N]")
      .def_property_readonly(
          "wave_generator_load", [](const HealthReport& self) { return self.lobes.wave_generator_force; },
          "sum of the wave generator's contact forces [N]")
      .def_property_readonly(
          "solver_state", [](const HealthReport& self) { return solverStateName(self.solver_state); },
          "state of the solver: 'OK'; 'DEGRADED': a step was divided or too long, or a tooth jumped; 'FAILED': a step "
          "did not converge");
  addText(health);
}

void bindIndicators(py::module& module)
{
  auto indicators = py::class_<SignalIndicators>(
      module, "SignalIndicators",
      "Indicators of one window, computed from encoders and torque, as in Indicators.msg (docs/indicators.md).");
  indicators.def_readonly("stamp", &SignalIndicators::stamp, "end of the window [ns]")
      .def_readonly("windows", &SignalIndicators::windows,
                    "number of windows completed since start or reset; 0: none yet [-]")
      .def_readonly("turns", &SignalIndicators::turns, "turns of the motor at constant speed in the window [-]")
      .def_property_readonly(
          "speed", [](const SignalIndicators& self) { return self.point.speed; },
          "mean magnitude of the motor's speed [rad/s]")
      .def_property_readonly(
          "direction", [](const SignalIndicators& self) { return self.point.direction; },
          "share of forward travel - share of backward travel, -1 ... 1 [-]")
      .def_property_readonly(
          "load", [](const SignalIndicators& self) { return self.point.load; },
          "mean magnitude of the load torque; nan: unknown [N.m]")
      .def_property_readonly(
          "load_constant", [](const SignalIndicators& self) { return self.point.load_constant; },
          "part of the load torque that does not depend on the output angle; nan: unknown [N.m]")
      .def_property_readonly(
          "load_sine", [](const SignalIndicators& self) { return self.point.load_sine; },
          "coefficient of the load torque for the sine of the output angle; nan: unknown [N.m]")
      .def_property_readonly(
          "load_cosine", [](const SignalIndicators& self) { return self.point.load_cosine; },
          "coefficient of the load torque for the cosine of the output angle; nan: unknown [N.m]")
      .def_property_readonly(
          "inertia", [](const SignalIndicators& self) { return self.point.inertia; },
          "inertia at the joint, including that of the drive: motor torque / acceleration [kg.m^2]")
      .def_property_readonly(
          "temperature", [](const SignalIndicators& self) { return self.point.temperature; },
          "mean temperature; nan: not measured [degC]")
      .def_property_readonly(
          "values", [](const SignalIndicators& self) { return byName(self.values); },
          "dict of indicator name to value, in the units of indicator_units(); nan: not determined by the window")
      .def_property_readonly(
          "uncertainty", [](const SignalIndicators& self) { return byName(self.uncertainty); },
          "dict of indicator name to standard error of the fit; 0: not known");
  addText(indicators);
  module.def(
      "indicator_units",
      []
      {
        py::dict units;
        for (std::size_t i = 0; i < INDICATOR_COUNT; ++i)
        {
          units[indicatorName(i)] = indicatorUnit(i);
        }
        return units;
      },
      "Returns the names of all signal indicators with their units: dict of str to str (docs/indicators.md).");
}

void bindAssessment(py::module& module)
{
  auto evidence =
      py::class_<Evidence>(module, "Evidence", "An indicator whose deviation supports the level of an Assessment.");
  evidence
      .def_property_readonly(
          "indicator", [](const Evidence& self) { return indicatorName(self.indicator); }, "name of the indicator")
      .def_readonly("value", &Evidence::value, "value in the indicator's unit")
      .def_readonly("expected", &Evidence::expected,
                    "mean of a sound drive at this operating point, in the indicator's unit")
      .def_readonly("score", &Evidence::score, "deviation as a standard normal deviate [-]");
  addText(evidence);

  auto assessment =
      py::class_<Assessment>(module, "Assessment", "Assessment of the drive by its indicators, as in Assessment.msg.");
  assessment.def_readonly("stamp", &Assessment::stamp, "end of the last window [ns]")
      .def_readonly("windows", &Assessment::windows, "number of completed windows [-]")
      .def_property_readonly(
          "state", [](const Assessment& self) { return assessmentStateName(self.state); },
          "state of the assessment: 'WAITING', 'LEARNING', 'ASSESSED', 'NO_REFERENCE', 'TOO_FEW_WINDOWS' or "
          "'OTHER_PAYLOAD'. The level 'OK' means that the drive is sound only in the state 'ASSESSED'")
      .def_readonly(
          "windows_here", &Assessment::windows_here,
          "number of windows at the last operating point: in the reference while LEARNING, later compared with it [-]")
      .def_readonly("windows_needed", &Assessment::windows_needed,
                    "number of windows that a reference or a verdict needs [-]")
      .def_property_readonly(
          "level", [](const Assessment& self) { return levelName(self.level); }, "'OK', 'WARN' or 'ERROR'")
      .def_property_readonly(
          "cause", [](const Assessment& self) { return causeName(self.cause); },
          "most likely cause; 'none' at level OK, or if no known fault explains the deviation")
      .def_readonly("confidence", &Assessment::confidence, "probability of the cause, 0 at level OK [-]")
      .def_readonly("severity", &Assessment::severity,
                    "mean severity of the fault `cause`; 0 if the cause is 'none' [-]")
      .def_readonly("severity_deviation", &Assessment::severity_deviation, "standard deviation of the severity [-]")
      .def_property_readonly("alternatives", &alternativesOf,
                             "likely causes after `cause`, until all add up to 90 %: {cause: probability [-]}")
      .def_readonly(
          "largest_score", &Assessment::largest_score,
          "score of the last windows' mean / its threshold, largest of all indicators; beyond 1: an alarm [-]")
      .def_property_readonly("evidence", &evidenceOf,
                             "indicators whose scores exceed the threshold, largest score first: list of Evidence");
  addText(assessment);
}
}  // namespace

void bindHealth(py::module& module)
{
  bindReport(module);
  bindIndicators(module);
  bindAssessment(module);
}
}  // namespace hjt
