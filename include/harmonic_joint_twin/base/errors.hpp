// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace hjt
{
/// The package's only exception: invalid user input. It is thrown at construction or while a file is read.
/// The text names the key, the value, the unit and the range, or the file and the line.
class InputError : public std::runtime_error
{
public:
  explicit InputError(const std::string& what) : std::runtime_error(what) {}
};

/// A parameter that is missing, misspelt, mistyped or out of range.
class ParameterError : public InputError
{
public:
  explicit ParameterError(const std::string& what) : InputError(what) {}
};
}  // namespace hjt
