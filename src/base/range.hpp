// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
/// Closed interval of the allowed values of a quantity.
struct Range
{
  double min;
  double max;
};

/// Text of a range, for example "8 ... 4000", or ">= 0.001" if the range has no upper limit.
inline std::string rangeText(const Range& range)
{
  const auto bound = [](double value)
  {
    const bool whole = value == std::floor(value) && std::abs(value) < 1e6;
    return whole ? std::to_string(static_cast<long long>(value)) : numberText(value);
  };
  if (range.max == std::numeric_limits<double>::max())
  {
    return ">= " + bound(range.min);
  }
  return bound(range.min) + " ... " + bound(range.max);
}

/// Whether the value is in the range. NaN is in no range.
inline bool isWithin(double value, const Range& range)
{
  return value >= range.min && value <= range.max;
}

/// Checks that an argument, which is a count, is at least `least`. @throws InputError.
inline void requireAtLeast(const char* name, std::int64_t value, std::int64_t least)
{
  if (value < least)
  {
    throw InputError(std::string(name) + " = " + std::to_string(value) +
                     " [-] is out of range, allowed: >= " + std::to_string(least));
  }
}

/// Error text "NAME = VALUE [UNIT] is out of range, allowed: RANGE [UNIT]".
inline std::string outOfRangeText(const std::string& name, double value, const std::string& unit, const Range& range)
{
  const std::string in_unit = " [" + unit + "]";
  return name + " = " + numberText(value) + in_unit + " is out of range, allowed: " + rangeText(range) + in_unit;
}

/// Error text for a value out of range; empty if the value is within the range.
inline std::string rangeErrors(const std::string& name, double value, const std::string& unit, const Range& range)
{
  return isWithin(value, range) ? std::string() : outOfRangeText(name, value, unit, range);
}

/// @throws InputError with the text of outOfRangeText if the value is out of range.
inline void requireWithin(const std::string& name, double value, const std::string& unit, const Range& range)
{
  if (!isWithin(value, range))
  {
    throw InputError(outOfRangeText(name, value, unit, range));
  }
}
}  // namespace hjt
