// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "python/bindings.hpp"

namespace hjt
{
constexpr const char* ORIGIN = "Python";  ///< origin of values from Python in error texts

/// Adds keys and values to the map without checks of range. @throws ParameterError if a value has no valid type.
void put(const py::dict& values, ParameterMap& map);

/// Reads an overlay into the map without checks of range. `what`: dict, or name of a file, also one in `directory`.
/// @throws ParameterError, Python's TypeError.
void readOverlay(const py::handle& what, const std::string& directory, ParameterMap& map);

/// All parameters and the map from which they were read. Setting a value checks all parameters. After an error no value
/// has changed.
class Configuration
{
public:
  /// The default configuration, changed by overlays (files or dicts). Later overlays replace values of earlier ones.
  /// `directory`: that of the default configuration; empty: that of the tool. @throws ParameterError.
  Configuration(const py::args& overlays, const std::string& directory);

  const Parameters& values() const { return values_; }
  const ParameterMap& map() const { return map_; }
  /// A copy with the values of `map`. @throws ParameterError.
  Configuration with(const ParameterMap& map) const;
  Configuration copy() const;                         ///< copy that can be changed
  Configuration frozen() const;                       ///< copy that cannot be changed, for a twin
  bool operator==(const Configuration& other) const;  ///< whether values and faults are equal

  py::object value(const std::string& key) const;  ///< value of a parameter @throws py::key_error
  bool contains(const std::string& key) const;
  std::vector<std::string> keys() const;
  void update(const py::dict& changes);

  py::list faults() const;
  void setFaults(const py::object& faults);  ///< sets one or several faults

  /// All keys and values, which `fromState` reads in another process.
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

/// A checked fault, from a Fault or from the text KIND:SEVERITY[:PLACE[:ONSET]]. @throws ParameterError.
Fault faultOf(const py::handle& fault, const Parameters& parameters);
}  // namespace hjt
