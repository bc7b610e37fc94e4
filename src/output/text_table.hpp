// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace hjt
{
/// A number for people: seven digits.
std::string shortNumber(double value);

/// Prints named values with units, one a line.
struct NamedValue
{
  std::string name;
  std::string value;
  std::string unit;
};
void printValues(const std::vector<NamedValue>& values);

/// Prints a text in lines of at most 100 columns, those after the first indented by `indent` more than it.
void printWrapped(const std::string& text, std::size_t indent);

/// Prints rows under headings ("torque [N.m]"), columns aligned.
void printTable(const std::vector<std::string>& headings, const std::vector<std::vector<std::string>>& rows);
}  // namespace hjt
