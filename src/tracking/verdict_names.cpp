// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <string>

#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
struct FigureEntry
{
  const char* name;
  const char* unit;
};

/// In the order of Figure.
constexpr std::array<FigureEntry, FIGURE_COUNT> FIGURES{ { { "rows", "-" },
                                                           { "rows_touched", "-" },
                                                           { "span", "s" },
                                                           { "current_rms", "A" },
                                                           { "current_predicted_rms", "A" },
                                                           { "current_residual_rms", "A" },
                                                           { "current_unexplained_rms", "A" },
                                                           { "least_load", "N.m" },
                                                           { "most_load", "N.m" },
                                                           { "temperature", "degC" },
                                                           { "reference_temperature", "degC" },
                                                           { "highest_order", "-" },
                                                           { "friction_speeds", "-" },
                                                           { "lowest_speed", "rad/s" },
                                                           { "highest_speed", "rad/s" },
                                                           { "friction_of_twin", "-" },
                                                           { "friction_of_controller", "-" },
                                                           { "friction_of_own", "-" },
                                                           { "friction_of_arm", "-" },
                                                           { "friction_scatter", "-" },
                                                           { "friction_lowest_sound", "-" },
                                                           { "friction_highest_sound", "-" },
                                                           { "torsion_of_twin", "-" },
                                                           { "torsion_of_own", "-" },
                                                           { "torsion_tolerance", "-" },
                                                           { "torsion_tolerance_of_encoders", "-" },
                                                           { "encoder_error_alike", "rad" },
                                                           { "output_eccentricity", "rad" },
                                                           { "windows", "-" },
                                                           { "windows_here", "-" },
                                                           { "windows_needed", "-" },
                                                           { "alarm_time", "s" },
                                                           { "contact_since", "s" },
                                                           { "contact_lasted", "s" },
                                                           { "contact_torque", "N.m" },
                                                           { "largest_contact_since", "s" },
                                                           { "largest_contact_lasted", "s" },
                                                           { "largest_contact_torque", "N.m" } } };

/// In the order of Reason.
constexpr std::array<const char*, REASON_COUNT> REASONS{ "SOUND",
                                                         "FRICTION",
                                                         "TORSION",
                                                         "SIGNALS",
                                                         "SOLVER_FAILED",
                                                         "NO_STEADY_MOTION",
                                                         "ONE_DIRECTION",
                                                         "LOAD_UNKNOWN",
                                                         "LOAD_WRONG",
                                                         "CONTACT",
                                                         "EFFORT_NOT_CURRENT",
                                                         "EFFORT_TOO_LARGE",
                                                         "COMMON_FRICTION",
                                                         "TELEMETRY_UNSETTLED",
                                                         "ROW_RATE",
                                                         "STAMPS",
                                                         "ANGLE_UNIT",
                                                         "EFFORT_UNIT",
                                                         "EFFORT_CONSTANT",
                                                         "VELOCITY_SIGN",
                                                         "VELOCITY_SCALE",
                                                         "VELOCITY_LAG",
                                                         "NO_MOTOR_ANGLE",
                                                         "LOAD_CONSTANT",
                                                         "TOO_FEW_WINDOWS",
                                                         "NO_REFERENCE",
                                                         "TOO_SHORT",
                                                         "TWO_SOURCES",
                                                         "GEAR_RATIO",
                                                         "AT_REST",
                                                         "ONE_SPEED",
                                                         "NO_FRICTION",
                                                         "LESS_THAN_FAULTS",
                                                         "FRICTION_SCATTER",
                                                         "TORSION_NO_DRIVE" };
}  // namespace

const char* reasonName(Reason reason) noexcept
{
  return REASONS[static_cast<std::size_t>(reason)];
}

const char* figureName(Figure figure) noexcept
{
  return FIGURES[static_cast<std::size_t>(figure)].name;
}

const char* figureUnit(Figure figure) noexcept
{
  return FIGURES[static_cast<std::size_t>(figure)].unit;
}

const char* levelName(VerdictLevel level) noexcept
{
  return level == VerdictLevel::NOT_JUDGED ? "NOT JUDGED" : levelName(static_cast<HealthLevel>(level));
}

const char* subjectTitle(FindingSubject subject)
{
  switch (subject)
  {
    case FindingSubject::FRICTION:
      break;
    case FindingSubject::TORSION:
      return "Torsion";
    case FindingSubject::SIGNALS:
      return "Signals by windows";
  }
  return "Friction";
}

std::vector<NamedFigure> evidenceOf(const Verdict& verdict)
{
  std::vector<NamedFigure> all;
  for (std::size_t i = 0; i < FIGURE_COUNT; ++i)
  {
    if (std::isfinite(verdict.figures[i]))
    {
      all.push_back({ FIGURES[i].name, verdict.figures[i], FIGURES[i].unit });
    }
  }
  for (const Evidence& evidence : verdict.evidence)
  {
    const std::string name = indicatorName(evidence.indicator);
    all.push_back({ name, evidence.value, indicatorUnit(evidence.indicator) });
    all.push_back({ name + "_sound", evidence.expected, indicatorUnit(evidence.indicator) });
  }
  return all;
}
}  // namespace hjt
