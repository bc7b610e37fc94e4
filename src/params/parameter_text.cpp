// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <utility>

#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "base/text_stream.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/choices.hpp"
#include "params/field_table.hpp"

namespace hjt
{
namespace
{
using Fields = std::function<bool(Shapes)>;

/// Writes each requested field as `section.key: value  # [unit] meaning`.
class FieldWriter
{
public:
  explicit FieldWriter(Fields fields = [](Shapes) { return true; }) : fields_(std::move(fields)) {}

  void operator()(const std::string& key, const char* unit, double value, const Range&, const Meaning& meaning)
  {
    write(key, numberText(value), unit, meaning);
  }

  void operator()(const std::string& key, const char* unit, int value, const Range&, const Meaning& meaning)
  {
    write(key, std::to_string(value), unit, meaning);
  }

  template <std::size_t N>
  void operator()(const std::string& key, const char* unit, const std::array<double, N>& values, const Range&,
                  const Meaning& meaning)
  {
    write(key, "[" + joined(values, ", ", numberText) + "]", unit, meaning);
  }

  void operator()(const std::string& key, bool value, const Meaning& meaning)
  {
    write(key, value ? "true" : "false", "-", meaning);
  }

  void operator()(const std::string& key, const std::string& value, const Meaning& meaning)
  {
    write(key, "\"" + value + "\"", "-", meaning);
  }

  template <class Choice>
  std::enable_if_t<std::is_enum<Choice>::value> operator()(const std::string& key, Choice value, const Meaning& meaning)
  {
    for (const auto& [name, choice] : choiceNames(Choice{}))
    {
      if (choice == value)
      {
        write(key, name, "-", meaning);
      }
    }
  }

  std::string text() const { return text_.str(); }

private:
  void write(const std::string& key, const std::string& value, const char* unit, const Meaning& meaning)
  {
    if (fields_(meaning.shapes))
    {
      text_ << key << ": " << value << "  # [" << unit << "] " << meaning.text << '\n';
    }
  }

  Fields fields_;
  TextStream text_;
};

/// Writes each field as a row of a Markdown table.
class TableWriter
{
public:
  TableWriter() { table_ << "| parameter | type | unit | range | meaning |\n|---|---|---|---|---|\n"; }

  void operator()(const std::string& key, const char* unit, double, const Range& range, const Meaning& meaning)
  {
    row(key, "float", unit, rangeText(range), meaning);
  }

  void operator()(const std::string& key, const char* unit, int, const Range& range, const Meaning& meaning)
  {
    row(key, "int", unit, rangeText(range), meaning);
  }

  template <std::size_t N>
  void operator()(const std::string& key, const char* unit, const std::array<double, N>&, const Range& range,
                  const Meaning& meaning)
  {
    row(key, std::to_string(N) + " floats", unit, rangeText(range), meaning);
  }

  void operator()(const std::string& key, bool, const Meaning& meaning)
  {
    row(key, "bool", "-", "true, false", meaning);
  }

  void operator()(const std::string& key, const std::string&, const Meaning& meaning)
  {
    row(key, "text", "-", "not empty", meaning);
  }

  template <class Choice>
  std::enable_if_t<std::is_enum<Choice>::value> operator()(const std::string& key, Choice, const Meaning& meaning)
  {
    const auto name = [](const auto& choice) { return choice.first; };
    row(key, "text", "-", joined(choiceNames(Choice{}), ", ", name), meaning);
  }

  std::string text() const { return table_.str(); }

private:
  void row(const std::string& key, const std::string& type, const std::string& unit, const std::string& range,
           const Meaning& meaning)
  {
    table_ << "| `" << key << "` | " << type << " | " << unit << " | " << range << " | " << meaning.text << " |\n";
  }

  TextStream table_;
};
}  // namespace

std::string describeParameters(const Parameters& parameters)
{
  FieldWriter writer;
  visitFields(parameters, writer);
  int number = 0;
  for (const Fault& fault : parameters.faults)
  {
    const std::string key = faultKey(number++) + '.';
    writer(key + "kind", std::string(describe(fault.kind).name), "kind of the fault");
    writer(key + "severity", "-", fault.severity, {}, "severity");
    writer(key + "place", placeName(describe(fault.kind).place), fault.place, {}, "where; -1: the whole member");
    writer(key + "onset", "s", fault.onset, {}, "after the start");
  }
  return writer.text();
}

std::string describeSurfaceParameters(const Parameters& parameters, bool faulty)
{
  FieldWriter writer([faulty](Shapes shapes)
                     { return shapes == Shapes::SURFACE || (faulty && shapes == Shapes::FAULTS); });
  visitFields(parameters, writer);
  return writer.text();
}

std::string parameterTableMarkdown()
{
  TableWriter writer;
  const Parameters parameters;
  visitFields(parameters, writer);
  return writer.text();
}
}  // namespace hjt
