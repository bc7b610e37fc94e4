// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include "base/number_text.hpp"

namespace hjt
{
/// A number of a YAML file; yaml-cpp's own as<double>() follows the program's locale. @throws YAML::Exception.
inline double yamlNumber(const YAML::Node& node)
{
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  const std::optional<double> decimal = decimalNumber(text);
  const std::optional<double> number = decimal ? decimal : nonFiniteNumber(text);
  if (!number)
  {
    throw YAML::TypedBadConversion<double>(node.Mark());
  }
  return *number;
}
}  // namespace hjt
