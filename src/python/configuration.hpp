// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "python/bindings.hpp"

namespace hjt
{
constexpr const char* ORIGIN = "Python";  ///< of values, for error texts

/// Puts keys and values into the map, unchecked. @throws ParameterError where one is no value.
void put(const py::dict& values, ParameterMap& map);

/// Reads one overlay, a file as given or beside `directory`, or a dict, over the map, unchecked.
/// @throws ParameterError, Python's TypeError.
void readOverlay(const py::handle& what, const std::string& directory, ParameterMap& map);

/// All parameters, and the map that they were read from: what is set is checked with all the others, and an error
/// leaves everything as it was.
class Configuration
{
public:
  /// The default configuration with the overlays over it, files or dicts, later wins.
  /// `directory`: of the default configuration; empty: found as the tool does. @throws ParameterError.
  Configuration(const py::args& overlays, const std::string& directory);

  const Parameters& values() const { return values_; }
  const ParameterMap& map() const { return map_; }
  /// The same with other values. @throws ParameterError.
  Configuration with(const ParameterMap& map) const;
  Configuration copy() const;                         ///< that may be changed
  Configuration frozen() const;                       ///< that refuses to be changed: of a twin that has been made
  bool operator==(const Configuration& other) const;  ///< the same values and faults

  py::object value(const std::string& key) const;  ///< @throws py::key_error
  bool contains(const std::string& key) const;
  std::vector<std::string> keys() const;
  void update(const py::dict& changes);

  py::list faults() const;
  void setFaults(const py::object& faults);  ///< one, or several

  /// Every key with its value, for another process.
  py::tuple state() const;
  static Configuration fromState(const py::tuple& state);

private:
  Configuration() = default;
  void take(const ParameterMap& map);

  void requireChangeable() const;

  bool is_frozen_{};
  bool has_own_directory_{};
  std::string directory_;
  ParameterMap map_;
  Parameters values_;
};

/// A fault as an object or as the tool's KIND:SEVERITY[:PLACE[:ONSET]], checked. @throws ParameterError.
Fault faultOf(const py::handle& fault, const Parameters& parameters);
}  // namespace hjt
