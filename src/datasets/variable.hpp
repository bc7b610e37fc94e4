// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "datasets/plan_node.hpp"

namespace hjt
{
/// A value of the plan that is not the same in every run: from a grid, or drawn.
///
/// A draw depends on the plan's seed, the variable's name and the number of the run alone, not on the other
/// variables, the order of the runs or the number of workers: Philox4x32-10 gives the words, Boost.Random the
/// distribution.
class Variable
{
public:
  /// Whether a place of the plan is one: a mapping with the one key grid, uniform, log_uniform, normal, integer or
  /// choice.
  static bool stands(const PlanNode& node);

  /// @throws InputError on a wrong list of numbers.
  explicit Variable(const PlanNode& node);

  const PlanNode& node() const { return *node_; }
  std::size_t gridSize() const { return distribution_ == Distribution::GRID ? choices_.size() : 1; }

  /// `digit`: index of the grid's value; draws do not depend on it.
  ParameterValue value(std::uint32_t seed, std::uint64_t run, std::size_t digit) const;

private:
  enum class Distribution
  {
    GRID,
    UNIFORM,      // lowest, highest
    LOG_UNIFORM,  // lowest, highest, > 0
    NORMAL,       // mean, standard deviation, lowest, highest: truncated to that range
    INTEGER,      // lowest, highest
    CHOICE
  };

  void readNumbers(const PlanNode& list, std::size_t count);
  void readChoices(const PlanNode& list);

  const PlanNode* node_;
  Distribution distribution_{};
  std::array<double, 4> numbers_{};
  std::vector<ParameterValue> choices_;
};

/// Possible values of a key with a text, over all runs. @throws InputError.
std::vector<std::string> textsOf(const PlanNode& map, const std::string& key);

/// A word of its own for each run: seeds of what is random within it.
std::uint32_t drawnWord(std::uint32_t seed, const std::string& name, std::uint64_t run);
}  // namespace hjt
