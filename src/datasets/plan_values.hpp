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
/// A node of a plan's file. It is constant and thread-safe once the file was read.
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
  std::string path;            ///< keys from the root to this node, joined by dots
  std::string origin;          ///< file and line of the node
  ParameterValue scalar;       ///< value of a node of kind SCALAR
  std::vector<Entry> entries;  ///< entries of a MAP or a LIST; the keys of a LIST are "0", "1", ...

  const PlanNode* find(std::string_view key) const;

  /// @throws InputError that names this node. `what` says what is wrong with it.
  [[noreturn]] void refuse(const std::string& what) const;
};

/// The value as a number; empty if it is not a number.
std::optional<double> numberIn(const ParameterValue& value);

OrderedJson jsonOf(const ParameterValue& value);
OrderedJson jsonOf(const PlanNode& node);

/// Reads a plan from its file. @throws InputError with file and line.
PlanNode readPlanFile(const std::string& path);

/// Reads the values of the plan for one run, including the values of its variables in this run. All members throw
/// InputError with file, line, key, value, unit and range.
class PlanValues
{
public:
  void set(const PlanNode& variable, ParameterValue value) { drawn_[&variable] = std::move(value); }

  // `otherwise`: default if the key is missing. If no default is given, the key is required.
  double number(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                std::optional<double> otherwise = std::nullopt) const;
  std::int64_t whole(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                     std::optional<std::int64_t> otherwise = std::nullopt) const;
  std::string text(const PlanNode& map, const std::string& key,
                   const std::optional<std::string>& otherwise = std::nullopt) const;
  bool flag(const PlanNode& map, const std::string& key) const;  ///< a flag is false if its key is missing

  /// Value of a node: a plain value, the value of a variable in this run, or a list of numbers.
  ParameterValue value(const PlanNode& node) const;

private:
  std::map<const PlanNode*, ParameterValue> drawn_;
};

/// The node with this key. @throws InputError if the key is missing.
const PlanNode& required(const PlanNode& map, std::string_view key);
const PlanNode& required(const PlanNode& map, std::string_view key, PlanNode::Kind kind);

/// @throws InputError if the node is not a mapping, or if it has a key that is not among `keys`.
void allowOnly(const PlanNode& map, const std::vector<std::string>& keys);

/// A value of a plan that differs from run to run: taken from a grid, or drawn at random.
///
/// A draw depends only on the plan's seed, the variable's name and the number of the run. It does not depend on other
/// variables, the order of the runs or the number of threads. Philox4x32-10 gives the random words, and Boost.Random
/// the distribution.
class Variable
{
public:
  /// Whether a node is a variable: a mapping with the single key grid, uniform, log_uniform, normal, integer or choice.
  static bool stands(const PlanNode& node);

  /// @throws InputError if the variable's list of numbers is invalid.
  explicit Variable(const PlanNode& node);

  const PlanNode& node() const { return *node_; }
  std::size_t gridSize() const { return distribution_ == Distribution::GRID ? choices_.size() : 1; }

  /// Value in a run. `digit` is the index in a grid; draws do not depend on it.
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

/// All texts that the value of a key can have in the runs of the plan. @throws InputError.
std::vector<std::string> textsOf(const PlanNode& map, const std::string& key);

/// A random word that differs from run to run, as a seed for random quantities of the run.
std::uint32_t drawnWord(std::uint32_t seed, const std::string& name, std::uint64_t run);
}  // namespace hjt
