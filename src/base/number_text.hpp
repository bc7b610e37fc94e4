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
/// Shortest text from which the same number is read, in a form that rosparam reads as a number: 1.0e-5, 31000.0.
std::string numberText(double value);

/// Text of `value` with `digits` significant digits.
std::string roundedText(double value, int digits);

/// Text of `value` with `digits` digits after the decimal point.
std::string fixedText(double value, int digits);

/// Number in a text of decimal digits as in Python or C++ (5, -.5, 1e-06, 1.0E+3); none for another text.
std::optional<double> decimalNumber(const std::string& text);
std::optional<double> decimalNumber(const char* text);

/// Infinity or not-a-number in the spelling of YAML (.inf, -.Inf, .NAN); none for another text.
std::optional<double> nonFiniteNumber(const std::string& text);

/// Number in a YAML node, in any locale; as<double>() of yaml-cpp depends on the locale. @throws YAML::Exception.
double yamlNumber(const YAML::Node& node);

/// String stream that writes numbers with a decimal point and without separators, in any locale of the program.
class TextStream : public std::ostringstream
{
public:
  TextStream() { imbue(std::locale::classic()); }
};
}  // namespace hjt
