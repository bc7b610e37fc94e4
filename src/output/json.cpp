// SPDX-License-Identifier: BSD-3-Clause
#include "output/json.hpp"

#include <algorithm>
#include <cmath>

#include "output/ordered_json.hpp"
#include "output/report.hpp"

namespace hjt
{
/// Converts a Json to a value of the JSON library.
struct JsonWriter
{
  using Library = OrderedJson;

  static Library convert(const Json& json)
  {
    return std::visit([](const auto& value) { return converted(value); }, json.value_);
  }

private:
  template <class Value>
  static Library converted(const Value& value)
  {
    return value;
  }
  static Library converted(const std::vector<Json>& values)
  {
    Library array = Library::array();
    for (const Json& value : values)
    {
      array.push_back(convert(value));
    }
    return array;
  }
  static Library converted(const std::vector<Json::Member>& members)
  {
    Library object = Library::object();
    for (const auto& [name, value] : members)
    {
      object[name] = convert(value);
    }
    return object;
  }
};

Json& Json::operator[](const std::string& path)
{
  const std::size_t dot = path.find('.');
  const std::string name = path.substr(0, dot);
  if (!std::holds_alternative<std::vector<Member>>(value_))
  {
    value_ = std::vector<Member>();
  }
  auto& members = std::get<std::vector<Member>>(value_);
  auto found =
      std::find_if(members.begin(), members.end(), [&name](const Member& member) { return member.first == name; });
  if (found == members.end())
  {
    found = members.insert(members.end(), { name, Json() });
  }
  return dot == std::string::npos ? found->second : found->second[path.substr(dot + 1)];
}

std::string Json::dump() const
{
  return JsonWriter::convert(*this).dump(2);
}

double Json::number() const
{
  return std::visit(
      [](const auto& value)
      {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_arithmetic_v<Value>)
        {
          return static_cast<double>(value);
        }
        return std::nan("");
      },
      value_);
}

std::string Json::shortText() const
{
  if (const auto* number = std::get_if<double>(&value_))
  {
    return shortNumber(*number);
  }
  if (const auto* text = std::get_if<std::string>(&value_))
  {
    return *text;
  }
  if (const auto* truth = std::get_if<bool>(&value_))
  {
    return *truth ? "yes" : "no";
  }
  if (std::holds_alternative<std::nullptr_t>(value_))
  {
    return "-";
  }
  return JsonWriter::convert(*this).dump();
}
}  // namespace hjt
