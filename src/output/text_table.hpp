// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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

/// Width of a column of numbers.
constexpr std::size_t NUMBER_WIDTH = 14;

/// Prints rows under headings ("torque [N.m]"), columns aligned, each at least so wide.
void printTable(const std::vector<std::string>& headings, const std::vector<std::vector<std::string>>& rows,
                std::size_t least_width = NUMBER_WIDTH);
}  // namespace hjt
