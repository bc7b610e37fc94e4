// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace hjt
{
/// A JSON value for output. Objects keep the order of their members. A number that is not finite is written as null.
class Json
{
public:
  using Member = std::pair<std::string, Json>;

  Json() = default;  ///< null
  Json(std::initializer_list<Member> members) : value_(std::vector<Member>(members)) {}
  Json(const char* text) : value_(std::string(text)) {}
  Json(std::string text) : value_(std::move(text)) {}
  template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
  Json(Number number)
  {
    if constexpr (std::is_same_v<Number, bool> || std::is_floating_point_v<Number>)
    {
      value_ = number;
    }
    else
    {
      value_ = static_cast<std::int64_t>(number);
    }
  }
  template <class Value>
  Json(const std::optional<Value>& value) : Json(value ? Json(*value) : Json())
  {
  }
  template <class Value>
  Json(const std::vector<Value>& values) : value_(std::vector<Json>(values.begin(), values.end()))
  {
  }
  template <class Value, std::size_t SIZE>
  Json(const std::array<Value, SIZE>& values) : value_(std::vector<Json>(values.begin(), values.end()))
  {
  }

  /// The member at `path`, which is added if it is missing. A dot in `path` leads to a member of a member
  /// ("peak.torque").
  Json& operator[](const std::string& path);

  /// Calls `visitor` with the content: nullptr, bool, std::int64_t, double, text, std::vector<Json> or
  /// std::vector<Member>.
  template <class Visitor>
  decltype(auto) visit(const Visitor& visitor) const
  {
    return std::visit(visitor, value_);
  }

  std::string dump() const;       ///< indented document
  double number() const;          ///< value of a number, 0 or 1 for a truth value; NaN for any other content
  std::string shortText() const;  ///< text for people: numbers with seven digits, truth values as yes or no

private:
  friend struct JsonWriter;

  std::variant<std::nullptr_t, bool, std::int64_t, double, std::string, std::vector<Json>, std::vector<Member>> value_;
};
}  // namespace hjt
