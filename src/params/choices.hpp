// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <utility>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Texts in the configuration for the values of an enumeration. The type of the enumeration selects the overload.
template <class Choice, std::size_t N>
using ChoiceNames = std::array<std::pair<const char*, Choice>, N>;

constexpr ChoiceNames<BendingLaw, 2> choiceNames(BendingLaw)
{
  return { { { "absolute", BendingLaw::ABSOLUTE }, { "curvature", BendingLaw::CURVATURE } } };
}

constexpr ChoiceNames<ContactLaw, 2> choiceNames(ContactLaw)
{
  return { { { "polar", ContactLaw::POLAR }, { "normal", ContactLaw::NORMAL } } };
}

constexpr ChoiceNames<SupportKind, 3> choiceNames(SupportKind)
{
  return { { { "springs", SupportKind::SPRINGS },
             { "balls", SupportKind::BALLS },
             { "single_balls", SupportKind::SINGLE_BALLS } } };
}

constexpr ChoiceNames<ProfileKind, 4> choiceNames(ProfileKind)
{
  return { { { "trapezoid", ProfileKind::TRAPEZOID },
             { "involute", ProfileKind::INVOLUTE },
             { "cycloid", ProfileKind::CYCLOID },
             { "double_arc", ProfileKind::DOUBLE_ARC } } };
}

constexpr ChoiceNames<ThermalModel, 2> choiceNames(ThermalModel)
{
  return { { { "none", ThermalModel::NONE }, { "two_nodes", ThermalModel::TWO_NODES } } };
}

constexpr ChoiceNames<SceneKind, 2> choiceNames(SceneKind)
{
  return { { { "full_ring", SceneKind::FULL_RING }, { "auto", SceneKind::AUTO } } };
}

constexpr ChoiceNames<InputMode, 4> choiceNames(InputMode)
{
  return { { { "commands", InputMode::COMMANDS },
             { "torque", InputMode::TORQUE },
             { "motion", InputMode::MOTION },
             { "observer", InputMode::OBSERVER } } };
}

constexpr ChoiceNames<EffortUnit, 3> choiceNames(EffortUnit)
{
  return { { { "current", EffortUnit::CURRENT },
             { "joint_torque", EffortUnit::JOINT_TORQUE },
             { "motor_torque", EffortUnit::MOTOR_TORQUE } } };
}

constexpr ChoiceNames<LoadSource, 4> choiceNames(LoadSource)
{
  return { { { "model", LoadSource::MODEL },
             { "load_torque", LoadSource::LOAD_TORQUE },
             { "target_moment", LoadSource::TARGET_MOMENT },
             { "arm", LoadSource::ARM } } };
}
}  // namespace hjt
