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
/// Shortest text that reads back as the same number, in a form that rosparam reads as a number: 1.0e-5, 31000.0.
std::string numberText(double value);

/// The number with a number of significant digits.
std::string roundedText(double value, int digits);

/// The number with a number of digits after the decimal point.
std::string fixedText(double value, int digits);

/// The number in a text of decimal digits, as Python or C++ write it (5, -.5, 1e-06, 1.0E+3); nothing for another text.
std::optional<double> decimalNumber(const std::string& text);
std::optional<double> decimalNumber(const char* text);

/// Infinity or not-a-number in YAML's spelling (.inf, -.Inf, .NAN); nothing for another text.
std::optional<double> nonFiniteNumber(const std::string& text);

/// The number in a YAML node. as<double>() of yaml-cpp depends on the program's locale. @throws YAML::Exception.
double yamlNumber(const YAML::Node& node);

/// A string stream whose numbers have a decimal point and no separators in any locale of the program.
class TextStream : public std::ostringstream
{
public:
  TextStream() { imbue(std::locale::classic()); }
};
}  // namespace hjt
