// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/choices.hpp"
#include "params/field_table.hpp"

namespace hjt
{
/// Required form of each entry in the list of faults, for error messages.
constexpr const char* FAULT_FORM = "{kind: ..., severity: ..., place: ..., onset: ...}";

/// Visitor of visitFields that fills the fields from a map and collects all errors for one message.
class FieldReader
{
public:
  /// `file`: file of all values if one file has them all. Messages about missing keys name `file`.
  explicit FieldReader(const ParameterMap& map, std::string file = "") : map_(map), file_(std::move(file)) {}

  void operator()(const std::string& key, const char* unit, double& field, const Range& range, const Meaning& meaning)
  {
    const ParameterValue* configured = find(key, numberKind("a number", unit, range), meaning);
    if (configured != nullptr)
    {
      readNumber(key, unit, *configured, range, field);
    }
  }

  void operator()(const std::string& key, const char* unit, int& field, const Range& range, const Meaning& meaning)
  {
    const std::string kind = numberKind("a whole number", unit, range);
    const ParameterValue* configured = find(key, kind, meaning);
    if (configured == nullptr)
    {
      return;
    }
    const auto* whole = std::get_if<std::int64_t>(&configured->value);
    if (whole == nullptr)
    {
      mistyped(key, *configured, kind);
      return;
    }
    if (inRange(key, unit, *configured, static_cast<double>(*whole), range))
    {
      field = static_cast<int>(*whole);
    }
  }

  template <std::size_t N>
  void operator()(const std::string& key, const char* unit, std::array<double, N>& field, const Range& range,
                  const Meaning& meaning)
  {
    readList(key, unit, field.data(), N, range, meaning);
  }

  /// Reads a list, which must have as many numbers as `field`.
  void operator()(const std::string& key, const char* unit, std::vector<double>& field, const Range& range,
                  const Meaning& meaning)
  {
    readList(key, unit, field.data(), field.size(), range, meaning);
  }

  void operator()(const std::string& key, bool& field, const Meaning& meaning)
  {
    readAs<bool>(key, field, "true or false, without quotes", meaning);
  }

  void operator()(const std::string& key, std::string& field, const Meaning& meaning)
  {
    readAs<std::string>(key, field, "a text (in quotes if it looks like a number)", meaning);
    const auto found = map_.find(key);
    if (found != map_.end() && std::holds_alternative<std::string>(found->second.value) && field.empty())
    {
      errors_.push_back(found->second.origin + ": " + key + " must not be empty");
    }
  }

  template <class Choice>
  std::enable_if_t<std::is_enum<Choice>::value> operator()(const std::string& key, Choice& field,
                                                           const Meaning& meaning)
  {
    const std::string names = joined(choiceNames(Choice{}), " or ", [](const auto& choice) { return choice.first; });
    std::string chosen;
    if (!readAs<std::string>(key, chosen, names, meaning))
    {
      return;
    }
    for (const auto& [name, choice] : choiceNames(Choice{}))
    {
      if (chosen == name)
      {
        field = choice;
        return;
      }
    }
    mistyped(key, map_.at(key), names);
  }

  void readFaults(std::vector<Fault>& faults)
  {
    for (int number = 0;; ++number)
    {
      const std::string key = faultKey(number) + '.';
      const auto first = map_.lower_bound(key);
      if (first == map_.end() || first->first.rfind(key, 0) != 0)
      {
        return;
      }
      Fault fault;
      std::string kind;
      if (readAs<std::string>(key + "kind", kind, faultNames(), "kind of the fault"))
      {
        const std::optional<FaultKind> named = faultNamed(kind);
        fault.kind = named.value_or(FaultKind{});
        if (!named)
        {
          mistyped(key + "kind", map_.at(key + "kind"), faultNames());
        }
      }
      (*this)(key + "severity", "-", fault.severity, Range{ 0.0, 1.0 },
              "severity, 0 ... 1; section fault_scale says what 1 means");
      (*this)(key + "place", "-", fault.place, Range{ WHOLE_MEMBER, 4000 },
              "number of the tooth, segment, lobe or ball; -1: the whole part");
      (*this)(key + "onset", "s", fault.onset, Range{ 0.0, 1e9 }, "delay of the fault after the start");
      faults.push_back(fault);
    }
  }

  /// Adds the error that the value of `key` must be `what`.
  void refuse(const std::string& key, const std::string& what) { mustBe(key, map_.at(key), what); }

  void refuseUnknownKeys()
  {
    for (const auto& [key, configured] : map_)
    {
      if (known_.count(key) == 0)
      {
        const std::string kind = groupKind(key);
        if (!kind.empty())
        {
          mustBe(key, configured, kind);
          continue;
        }
        errors_.push_back(configured.origin + ": unknown parameter " + key + " = " + valueText(configured) +
                          suggestion(key, known_));
      }
    }
  }

  const std::vector<std::string>& errors() const { return errors_; }

private:
  static std::string withoutSection(const std::string& key) { return key.substr(key.find('.') + 1); }

  /// Suggestion " (did you mean gear.wave_amplitude?)"; empty if no key is similar.
  static std::string suggestion(const std::string& unknown, const std::set<std::string>& known)
  {
    std::string nearest;
    std::size_t distance = std::max<std::size_t>(2, withoutSection(unknown).size() / 3) + 1;
    for (const std::string& key : known)
    {
      // A key with a right name in a wrong section counts as one edit away from the right key.
      const bool other_section = withoutSection(key) == withoutSection(unknown);
      const std::size_t edits = other_section ? 1 : editDistance(unknown, key);
      if (edits < distance)
      {
        distance = edits;
        nearest = key;
      }
    }
    return nearest.empty() ? "" : " (did you mean " + nearest + "?)";
  }

  /// Required form of the value of `key`, for error messages; empty unless `key` is a section or the list of faults.
  std::string groupKind(const std::string& key) const
  {
    const auto below = known_.lower_bound(key + '.');
    if (below != known_.end() && below->rfind(key + '.', 0) == 0)
    {
      return "keys and values, for example " + *below;
    }
    return key == FAULTS ? std::string("a list of ") + FAULT_FORM : "";
  }

  static std::string numberKind(const std::string& what, const char* unit, const Range& range)
  {
    return what + " [" + unit + "], " + rangeText(range);
  }

  const ParameterValue* find(const std::string& key, const std::string& kind, const Meaning& meaning)
  {
    known_.insert(key);
    const auto found = map_.find(key);
    if (found == map_.end())
    {
      errors_.push_back((file_.empty() ? "" : file_ + ": ") + "parameter " + key + " is missing; expected " + kind +
                        " (" + meaning.text + ")");
      return nullptr;
    }
    return &found->second;
  }

  template <class T>
  bool readAs(const std::string& key, T& field, const std::string& kind, const Meaning& meaning)
  {
    const ParameterValue* configured = find(key, kind, meaning);
    if (configured == nullptr)
    {
      return false;
    }
    const T* value = std::get_if<T>(&configured->value);
    if (value == nullptr)
    {
      mistyped(key, *configured, kind);
      return false;
    }
    field = *value;
    return true;
  }

  void readList(const std::string& key, const char* unit, double* field, std::size_t count, const Range& range,
                const Meaning& meaning)
  {
    const std::string kind = numberKind("a list of " + std::to_string(count) + " numbers", unit, range);
    const ParameterValue* configured = find(key, kind, meaning);
    if (configured == nullptr)
    {
      return;
    }
    const auto* list = std::get_if<std::vector<double>>(&configured->value);
    if (list == nullptr || list->size() != count)
    {
      mistyped(key, *configured, kind);
      return;
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      if (inRange(key, unit, *configured, (*list)[i], range))
      {
        field[i] = (*list)[i];
      }
    }
  }

  void readNumber(const std::string& key, const char* unit, const ParameterValue& configured, const Range& range,
                  double& field)
  {
    const std::optional<double> value = numberOf(configured.value);
    if (!value)
    {
      mistyped(key, configured, numberKind("a number", unit, range));
    }
    else if (inRange(key, unit, configured, *value, range))
    {
      field = *value;
    }
  }

  bool inRange(const std::string& key, const char* unit, const ParameterValue& configured, double value,
               const Range& range)
  {
    // isfinite is false for NaN.
    if (std::isfinite(value) && value >= range.min && value <= range.max)
    {
      return true;
    }
    errors_.push_back(configured.origin + ": " + key + " = " + valueText(configured) + " [" + unit + "] is " +
                      (std::isfinite(value) ? "out of range" : "not a finite number") +
                      ", allowed: " + rangeText(range) + " [" + unit + "]");
    return false;
  }

  void mistyped(const std::string& key, const ParameterValue& configured, const std::string& kind)
  {
    const auto* text = std::get_if<std::string>(&configured.value);
    const bool quoted = text != nullptr && decimalNumber(*text);
    mustBe(key, configured, kind + (quoted ? ". Write the number without quotes, dot and exponent" : ""));
  }

  void mustBe(const std::string& key, const ParameterValue& configured, const std::string& what)
  {
    errors_.push_back(configured.origin + ": " + key + " = " + valueText(configured) + " must be " + what);
  }

  const ParameterMap& map_;
  const std::string file_;
  std::set<std::string> known_;
  std::vector<std::string> errors_;
};

/// @throws ParameterError with all `errors`, one per line, unless `errors` is empty.
inline void throwIfAny(const std::vector<std::string>& errors)
{
  if (!errors.empty())
  {
    throw ParameterError(joined(errors, "\n"));
  }
}
}  // namespace hjt
