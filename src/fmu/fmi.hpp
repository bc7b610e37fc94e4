// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

/// Common part of the C interfaces of FMI 2.0 and 3.0 for co-simulation. fmi2.cpp and fmi3.cpp have the functions.
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

/// Categories of messages in the log: the first for information and warnings, the second for errors.
constexpr const char* LOG_CATEGORIES[]{ "logStatusWarning", "logStatusError" };

/// Index of a variable in the unit's list. FMI 2.0 has no arrays: its references also contain the element of an array.
using ValueReference = std::uint32_t;
constexpr unsigned ELEMENT_SHIFT = 16;  ///< reference = element << ELEMENT_SHIFT | variable

/// Function that writes to the log of an importer; empty if the importer has no log.
using Log = std::function<void(Status status, const char* category, const std::string& message)>;
}  // namespace hjt::fmu
