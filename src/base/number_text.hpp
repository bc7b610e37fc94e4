// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <locale>
#include <optional>
#include <sstream>
#include <string>

namespace YAML  // NOLINT(readability-identifier-naming): of yaml-cpp
{
class Node;
}

namespace hjt
{
/// The shortest text that reads back as the same number, spelt so that rosparam takes it for one: 1.0e-5, 31000.0.
std::string numberText(double value);

/// The number with so many significant digits.
std::string roundedText(double value, int digits);

/// The number with so many digits behind the decimal point.
std::string fixedText(double value, int digits);

/// The number of a text in decimal digits as Python or C++ write it (5, -.5, 1e-06, 1.0E+3); nothing if it is another
/// text.
std::optional<double> decimalNumber(const std::string& text);
std::optional<double> decimalNumber(const char* text);

/// Infinity or not a number as YAML spells them (.inf, -.Inf, .NAN); nothing if it is another text.
std::optional<double> nonFiniteNumber(const std::string& text);

/// A number of a YAML file; yaml-cpp's own as<double>() follows the program's locale. @throws YAML::Exception.
double yamlNumber(const YAML::Node& node);

/// A text to write to. Its numbers have a decimal point and no separators, whatever locale the program has set.
class TextStream : public std::ostringstream
{
public:
  TextStream() { imbue(std::locale::classic()); }
};
}  // namespace hjt
