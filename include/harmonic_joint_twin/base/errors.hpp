// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace hjt
{
/// Exception for invalid input of the user. It is thrown at construction or while a file is read. The text names key,
/// value, unit and range, or file and line.
class InputError : public std::runtime_error
{
public:
  explicit InputError(const std::string& what) : std::runtime_error(what) {}
};

/// Exception for a parameter that is missing, misspelt, out of range or of a wrong type.
class ParameterError : public InputError
{
public:
  explicit ParameterError(const std::string& what) : InputError(what) {}
};
}  // namespace hjt
