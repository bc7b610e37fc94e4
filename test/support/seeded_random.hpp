// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <string>

#include <gtest/gtest.h>

namespace hjt
{
/// Random numbers whose seed is printed with every failure while they exist.
class SeededRandom : public std::mt19937
{
public:
  explicit SeededRandom(unsigned seed) : std::mt19937(seed), trace_(__FILE__, __LINE__, "seed " + std::to_string(seed))
  {
  }

  double uniform(double from = -1.0, double to = 1.0)
  {
    return std::uniform_real_distribution<double>(from, to)(*this);
  }

  /// Of mean 0 and variance 1.
  double normal() { return normal_(*this); }

private:
  std::normal_distribution<double> normal_;
  testing::ScopedTrace trace_;
};
}  // namespace hjt
