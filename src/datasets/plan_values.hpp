// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "output/ordered_json.hpp"
#include "params/field_table.hpp"

namespace hjt
{
/// A node of a plan's file. After reading it is constant and thread-safe.
struct PlanNode
{
  enum class Kind
  {
    SCALAR,
    LIST,
    MAP
  };
  using Entry = std::pair<std::string, PlanNode>;

  Kind kind{};
  std::string path;            ///< keys from the root, joined by dots
  std::string origin;          ///< file and line
  ParameterValue scalar;       ///< value of a SCALAR
  std::vector<Entry> entries;  ///< entries of a MAP, or of a LIST with the keys "0", "1", ...

  const PlanNode* find(std::string_view key) const;

  /// @throws InputError that names this node.
  [[noreturn]] void refuse(const std::string& what) const;
};

/// The value as a number; empty if it is no number.
std::optional<double> numberIn(const ParameterValue& value);

OrderedJson jsonOf(const ParameterValue& value);
OrderedJson jsonOf(const PlanNode& node);

/// Reads a plan. @throws InputError with file and line.
PlanNode readPlanFile(const std::string& path);

/// The values of the plan in one run, with a value for each variable. All members throw InputError with file, line,
/// key, value, unit and range.
class PlanValues
{
public:
  void set(const PlanNode& variable, ParameterValue value) { drawn_[&variable] = std::move(value); }

  // `otherwise`: default if the key is missing; without it the key is required.
  double number(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                std::optional<double> otherwise = std::nullopt) const;
  std::int64_t whole(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                     std::optional<std::int64_t> otherwise = std::nullopt) const;
  std::string text(const PlanNode& map, const std::string& key,
                   const std::optional<std::string>& otherwise = std::nullopt) const;
  bool flag(const PlanNode& map, const std::string& key) const;  ///< false if the key is missing

  /// A plain value, the value of a variable, or a list of numbers.
  ParameterValue value(const PlanNode& node) const;

private:
  std::map<const PlanNode*, ParameterValue> drawn_;
};

/// @throws InputError if the key is missing.
const PlanNode& required(const PlanNode& map, std::string_view key);
const PlanNode& required(const PlanNode& map, std::string_view key, PlanNode::Kind kind);

/// @throws InputError if the node is not a mapping, or has another key than these.
void allowOnly(const PlanNode& map, const std::vector<std::string>& keys);

/// A value of the plan that differs between runs: from a grid, or drawn at random.
///
/// A draw depends only on the plan's seed, the variable's name and the number of the run, but not on other variables,
/// the order of the runs or the number of workers. Philox4x32-10 gives the random words, Boost.Random the distribution.
class Variable
{
public:
  /// Whether a node is a variable: a mapping with the single key grid, uniform, log_uniform, normal, integer or choice.
  static bool stands(const PlanNode& node);

  /// @throws InputError if the list of numbers is invalid.
  explicit Variable(const PlanNode& node);

  const PlanNode& node() const { return *node_; }
  std::size_t gridSize() const { return distribution_ == Distribution::GRID ? choices_.size() : 1; }

  /// `digit`: index of a grid's value; draws do not depend on it.
  ParameterValue value(std::uint32_t seed, std::uint64_t run, std::size_t digit) const;

private:
  enum class Distribution
  {
    GRID,
    UNIFORM,      // lowest, highest
    LOG_UNIFORM,  // lowest, highest, > 0
    NORMAL,       // mean, standard deviation, lowest, highest: truncated distribution
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

/// Possible texts of a key over all runs. @throws InputError.
std::vector<std::string> textsOf(const PlanNode& map, const std::string& key);

/// A different random word for each run, as a seed of random quantities in it.
std::uint32_t drawnWord(std::uint32_t seed, const std::string& name, std::uint64_t run);
}  // namespace hjt
