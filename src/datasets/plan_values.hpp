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
/// One place of a plan's file. Read once, then used read-only from any thread.
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
  std::string path;            ///< keys from the top, joined by dots
  std::string origin;          ///< file:line
  ParameterValue scalar;       ///< of a SCALAR
  std::vector<Entry> entries;  ///< of a MAP; of a LIST under "0", "1", ...

  const PlanNode* find(std::string_view key) const;

  /// @throws InputError that names this place.
  [[noreturn]] void refuse(const std::string& what) const;
};

/// The value as a number, whole or not; nothing if it is no number.
std::optional<double> numberIn(const ParameterValue& value);

OrderedJson jsonOf(const ParameterValue& value);
OrderedJson jsonOf(const PlanNode& node);

/// @throws InputError naming file and line.
PlanNode readPlanFile(const std::string& path);

/// The plan in one run: each variable has its value. All members throw InputError that names file, line, key,
/// value, unit and range.
class PlanValues
{
public:
  /// A variable stands for this value.
  void set(const PlanNode& variable, ParameterValue value) { drawn_[&variable] = std::move(value); }

  // `otherwise`: where the key is left out; none: it must be there.
  double number(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                std::optional<double> otherwise = std::nullopt) const;
  std::int64_t whole(const PlanNode& map, const std::string& key, const char* unit, const Range& range,
                     std::optional<std::int64_t> otherwise = std::nullopt) const;
  std::string text(const PlanNode& map, const std::string& key,
                   const std::optional<std::string>& otherwise = std::nullopt) const;
  bool flag(const PlanNode& map, const std::string& key) const;  ///< false where the key is left out

  /// A plain value, a variable's or a list of numbers.
  ParameterValue value(const PlanNode& node) const;

private:
  std::map<const PlanNode*, ParameterValue> drawn_;
};

/// @throws InputError if the key is not there.
const PlanNode& required(const PlanNode& map, std::string_view key);
const PlanNode& required(const PlanNode& map, std::string_view key, PlanNode::Kind kind);

/// @throws InputError if the node is no mapping, or has a key that is not among these.
void allowOnly(const PlanNode& map, const std::vector<std::string>& keys);

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
