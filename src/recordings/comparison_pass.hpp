// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recordings/joint_comparison.hpp"

namespace hjt
{
constexpr const char* ARM_FILE = "arm.json";

/// The joints beside their twins after a pass through the recording.
struct ComparisonPass
{
  std::vector<std::unique_ptr<JointComparison>> joints;
  MotionFindings found;
  std::vector<Misfit> misfits;  // of each
  ArmFriction friction;
  std::optional<IdentifiedPayload> payload;
};

/// Reads the recording; files of the reports are opened. @throws ParameterError, InputError.
ComparisonPass passThrough(const ComparisonOptions& options, const ArmRecording& recording);
}  // namespace hjt
