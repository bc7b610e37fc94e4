// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

/// Common part of FMI's C interfaces 2.0 and 3.0 for co-simulation; fmi2.cpp and fmi3.cpp have the functions.
namespace hjt::fmu
{
enum class Version
{
  FMI_2,
  FMI_3
};

enum class Status : int
{
  OK,
  WARNING,
  DISCARD,
  ERROR,
  FATAL
};

/// Categories of the log: information and warnings, errors.
constexpr const char* LOG_CATEGORIES[]{ "logStatusWarning", "logStatusError" };

/// Index of a variable in the unit's list. FMI 2.0 has no arrays, so its reference also contains the element.
using ValueReference = std::uint32_t;
constexpr unsigned ELEMENT_SHIFT = 16;  ///< reference = element << ELEMENT_SHIFT | variable

/// Log of an importer; empty without one.
using Log = std::function<void(Status status, const char* category, const std::string& message)>;
}  // namespace hjt::fmu
