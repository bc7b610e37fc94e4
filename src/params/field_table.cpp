// SPDX-License-Identifier: BSD-3-Clause
#include "params/field_table.hpp"

#include <array>
#include <type_traits>
#include <utility>

#include "base/hash.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/choices.hpp"

namespace hjt
{
namespace
{
/// Visitor of visitFields that makes a FieldRow of each field.
class RowMaker
{
public:
  void operator()(const std::string& key, const char* unit, double value, const Range& range, const Meaning& meaning)
  {
    rows.push_back({ key, "float", unit, range, {}, numberText(value), meaning });
  }
  void operator()(const std::string& key, const char* unit, int value, const Range& range, const Meaning& meaning)
  {
    rows.push_back({ key, "int", unit, range, {}, std::to_string(value), meaning });
  }
  template <std::size_t N>
  void operator()(const std::string& key, const char* unit, const std::array<double, N>& values, const Range& range,
                  const Meaning& meaning)
  {
    const std::string text = "[" + joined(values, ", ", numberText) + "]";
    rows.push_back({ key, std::to_string(N) + " floats", unit, range, {}, text, meaning });
  }
  void operator()(const std::string& key, bool value, const Meaning& meaning)
  {
    rows.push_back({ key, "bool", "-", {}, {}, value ? "true" : "false", meaning });
  }
  void operator()(const std::string& key, const std::string& value, const Meaning& meaning)
  {
    rows.push_back({ key, "text", "-", {}, {}, "\"" + value + "\"", meaning });
  }
  template <class Choice>
  std::enable_if_t<std::is_enum<Choice>::value> operator()(const std::string& key, Choice value, const Meaning& meaning)
  {
    FieldRow row{ key, "text", "-", {}, {}, "", meaning };
    for (const auto& [name, choice] : choiceNames(Choice{}))
    {
      row.choices.emplace_back(name);
      row.value = choice == value ? name : row.value;
    }
    rows.push_back(std::move(row));
  }

  std::vector<FieldRow> rows;
};

/// Line of the form `section.key: value  # [unit] meaning`.
std::string lineOf(const FieldRow& row)
{
  return row.key + ": " + row.value + "  # [" + row.unit + "] " + row.meaning.text + '\n';
}

std::string allowedText(const FieldRow& row)
{
  if (row.range)
  {
    return rangeText(*row.range);
  }
  return row.type == "bool" ? "true, false" : row.choices.empty() ? "not empty" : joined(row.choices);
}
}  // namespace

std::vector<FieldRow> fieldRows(const Parameters& parameters)
{
  RowMaker maker;
  visitFields(parameters, maker);
  return std::move(maker.rows);
}

std::string describeParameters(const Parameters& parameters)
{
  RowMaker maker;
  visitFields(parameters, maker);
  int number = 0;
  for (const Fault& fault : parameters.faults)
  {
    const std::string key = faultKey(number++) + '.';
    maker(key + "kind", std::string(describe(fault.kind).name), "kind of the fault");
    maker(key + "severity", "-", fault.severity, {}, "severity");
    maker(key + "place", placeName(describe(fault.kind).place), fault.place, {},
          "number of the tooth, segment, lobe or ball; -1: the whole part");
    maker(key + "onset", "s", fault.onset, {}, "delay of the fault after the start");
  }
  std::string text;
  for (const FieldRow& row : maker.rows)
  {
    text += lineOf(row);
  }
  return text;
}

std::string describeSurfaceParameters(const Parameters& parameters, bool faulty)
{
  std::string text;
  for (const FieldRow& row : fieldRows(parameters))
  {
    const Shapes shapes = row.meaning.shapes;
    text += shapes == Shapes::SURFACE || (faulty && shapes == Shapes::FAULTS) ? lineOf(row) : "";
  }
  return text;
}

std::string parameterTableMarkdown()
{
  std::string table = "| parameter | type | unit | range | meaning |\n|---|---|---|---|---|\n";
  for (const FieldRow& row : fieldRows(Parameters()))
  {
    table += "| `" + row.key + "` | " + row.type + " | " + row.unit + " | " + allowedText(row) + " | " +
             row.meaning.text + " |\n";
  }
  return table;
}

namespace
{
/// Visitor of visitFields that hashes the values of the visited fields, without their keys.
class FieldHasher
{
public:
  explicit FieldHasher(bool surface_only) : surface_only_(surface_only) {}

  template <class T>
  void operator()(const std::string&, const char*, const T& value, const Range&, const Meaning& meaning)
  {
    add(value, meaning);
  }

  template <class T>
  void operator()(const std::string&, const T& value, const Meaning& meaning)
  {
    add(value, meaning);
  }

  void add(const std::vector<Fault>& faults)
  {
    for (const Fault& fault : faults)
    {
      addBytes(fault.kind);
      addBytes(fault.severity);
      addBytes(fault.place);
      addBytes(fault.onset);
    }
  }

  std::uint64_t hash() const { return hash_; }

private:
  template <class T>
  void add(const T& value, const Meaning& meaning)
  {
    if (surface_only_ && meaning.shapes == Shapes::OTHERS)
    {
      return;
    }
    if constexpr (std::is_same_v<T, std::string>)
    {
      hash_ = textHash(value, hash_);
      addBytes(value.size());
    }
    else
    {
      addBytes(value);
    }
  }

  template <class T>
  void addBytes(const T& value)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    hash_ = textHash({ reinterpret_cast<const char*>(&value), sizeof(value) }, hash_);
  }

  bool surface_only_;
  std::uint64_t hash_{ textHash("") };
};
}  // namespace

std::uint64_t parametersHash(const Parameters& parameters)
{
  FieldHasher hasher(false);
  visitFields(parameters, hasher);
  hasher.add(parameters.faults);
  return hasher.hash();
}

std::uint64_t surfaceParametersHash(const Parameters& parameters)
{
  FieldHasher hasher(true);
  visitFields(parameters, hasher);
  hasher.add(parameters.faults);
  return hasher.hash();
}
}  // namespace hjt
