// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/health/assessment.hpp"

namespace hjt
{
/// One window and what was made of it.
struct WindowResult
{
  std::string recording;
  const char* origin;      ///< what the window was made of, in words
  const char* parameters;  ///< and with whose parameters
  SignalIndicators indicators;
  Deviations deviations;
  WindowResidual residual;
  Assessment assessment;
};

/// A CSV file with a row per window; no path: none.
void writeWindows(const std::string& path, const std::vector<WindowResult>& windows);

void printDocument(const std::vector<WindowResult>& windows, double threshold);

/// The last window, for people.
void printSummary(const std::vector<WindowResult>& windows);
}  // namespace hjt
