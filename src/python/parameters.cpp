// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/operators.h>
#include <pybind11/stl.h>

#include <optional>
#include <type_traits>

#include "harmonic_joint_twin/base/errors.hpp"
#include "params/choices.hpp"
#include "params/configuration_files.hpp"
#include "params/field_table.hpp"
#include "params/severity_errors.hpp"
#include "python/configuration.hpp"

namespace hjt
{
namespace
{
struct Field
{
  std::string key;
  std::string type;
  std::string unit;
  std::optional<double> minimum;
  std::optional<double> maximum;
  std::vector<std::string> choices;
  std::string meaning;
};

std::vector<Field> allFields()
{
  std::vector<Field> fields;
  for (FieldRow& row : fieldRows(Parameters()))
  {
    Field field{ row.key, row.type == "text" ? "str" : row.type, row.unit, {}, {}, row.choices, row.meaning.text };
    if (row.range)
    {
      field.minimum = row.range->min;
      field.maximum = row.range->max;
    }
    fields.push_back(std::move(field));
  }
  return fields;
}

Field fieldOf(const std::string& key)
{
  for (const Field& field : allFields())
  {
    if (field.key == key)
    {
      return field;
    }
  }
  throw py::key_error("unknown parameter " + key);
}

py::object toPython(bool value)
{
  return py::bool_(value);
}
py::object toPython(int value)
{
  return py::int_(value);
}
py::object toPython(double value)
{
  return py::float_(value);
}
py::object toPython(const std::string& value)
{
  return py::str(value);
}
template <std::size_t N>
py::object toPython(const std::array<double, N>& values)
{
  return py::tuple(py::cast(values));
}
template <class Choice>
std::enable_if_t<std::is_enum<Choice>::value, py::object> toPython(Choice value)
{
  for (const auto& [name, choice] : choiceNames(Choice{}))
  {
    if (choice == value)
    {
      return py::str(name);
    }
  }
  return py::none();
}

/// Calls `take(key, value)` for each field, whose value may have any type.
template <class Take>
void visitValues(const Parameters& parameters, const Take& take)
{
  visitFields(parameters,
              [&](const std::string& key, const auto& first, const auto& second, const auto&... rest)
              {
                // Arguments after the key: unit, value, range and meaning of a number; value and meaning of others.
                if constexpr (sizeof...(rest) == 0)
                {
                  take(key, first);
                }
                else
                {
                  take(key, second);
                }
              });
}

void putFaults(const std::vector<Fault>& faults, ParameterMap& map)
{
  eraseFaults(map);
  int number = 0;
  for (const Fault& fault : faults)
  {
    const std::string key = faultKey(number++) + '.';
    map[key + "kind"] = { std::string(describe(fault.kind).name), ORIGIN };
    map[key + "severity"] = { fault.severity, ORIGIN };
    map[key + "place"] = { std::int64_t{ fault.place }, ORIGIN };
    map[key + "onset"] = { fault.onset, ORIGIN };
  }
}

Fault makeFault(const std::string& kind, double severity, const std::optional<int>& place, double onset)
{
  const std::optional<FaultKind> named = faultNamed(kind);
  if (!named)
  {
    throw ParameterError("unknown kind of fault '" + kind + "', allowed: " + faultNames());
  }
  const Fault fault{ *named, severity, place.value_or(firstPlace(*named)), onset };
  if (const std::string errors = severityErrors(fault, ""); !errors.empty())
  {
    throw ParameterError(errors);
  }
  return fault;
}

py::tuple partsOf(const Fault& fault)
{
  return py::make_tuple(describe(fault.kind).name, fault.severity, fault.place, fault.onset);
}

Fault faultFrom(const py::tuple& parts)
{
  return makeFault(py::cast<std::string>(parts[0]), py::cast<double>(parts[1]), py::cast<int>(parts[2]),
                   py::cast<double>(parts[3]));
}

void bindFaults(py::module& module)
{
  auto fault = py::class_<Fault>(module, "Fault", "A fault of the gear. Its kind and place identify it.");
  fault
      .def(py::init(&makeFault), py::arg("kind"), py::arg("severity"), py::arg("place") = py::none(),
           py::arg("onset") = 0.0,
           "kind: see fault_kinds(); severity: 0 (none) ... 1 [-]; place: number of tooth, segment, lobe or ball from "
           "0 on, -1: the whole part, None: the first place that the kind allows; onset: delay after the start, or "
           "after the stamp of its injection [s].")
      .def_property_readonly(
          "kind", [](const Fault& self) { return describe(self.kind).name; }, "name of the kind")
      .def_readonly("severity", &Fault::severity, "size of the fault, 0 (none) ... 1 [-]")
      .def_readonly("place", &Fault::place,
                    "number of the tooth, segment, lobe or ball from 0 on; -1: the whole part [-]")
      .def_readonly("onset", &Fault::onset, "delay of the fault after the start, or after the stamp of injection [s]")
      .def(
          "__eq__", [](const Fault& self, const Fault& other) { return partsOf(self).equal(partsOf(other)); },
          py::is_operator(), py::arg("other"), "Whether kind, severity, place and onset are equal.")
      .def("__hash__", [](const Fault& self) { return py::hash(partsOf(self)); })
      .def(py::pickle(&partsOf, &faultFrom));
  addText(fault);

  auto kind = py::class_<FaultDescription>(module, "FaultKind", "Description of a kind of fault.");
  kind.def_property_readonly(
          "name", [](const FaultDescription& self) { return self.name; },
          "name of the kind, for Fault and for the option --fault")
      .def_property_readonly(
          "place", [](const FaultDescription& self) { return placeName(self.place); },
          "kind of the place: tooth, segment, lobe, ball, or - without places")
      .def_readonly("whole", &FaultDescription::whole, "whether place -1, the whole part, is allowed")
      .def_property_readonly(
          "severity", [](const FaultDescription& self) { return self.severity; }, "size of the fault at severity 1")
      .def(
          "shows",
          [](const FaultDescription& self, const Configuration& parameters)
          { return shownFirst(self.kind, parameters.values()); },
          py::arg("parameters"), "Returns the signal that shows the fault first in this drive.");
  addText(kind);
  module.def(
      "fault_kinds",
      []
      {
        py::dict kinds;
        for (const FaultDescription& description : FAULT_DESCRIPTIONS)
        {
          kinds[description.name] = description;
        }
        return kinds;
      },
      "Returns all kinds of faults by name (docs/faults.md): dict of str to FaultKind.");
}
}  // namespace

Configuration::Configuration(const py::args& overlays, const std::string& directory)
  : has_own_directory_(!directory.empty()), directory_(configurationDirectory(directory).string())
{
  readDefaultConfiguration(directory_, map_);
  for (const auto& what : overlays)
  {
    readOverlay(what, directory_, map_);
  }
  take(map_);
}

Configuration Configuration::with(const ParameterMap& map) const
{
  Configuration other = copy();
  other.take(map);
  return other;
}

Configuration Configuration::copy() const
{
  Configuration other(*this);
  other.is_frozen_ = false;
  return other;
}

Configuration Configuration::frozen() const
{
  Configuration other(*this);
  other.is_frozen_ = true;
  return other;
}

bool Configuration::operator==(const Configuration& other) const
{
  return state()[py::slice(1, 3, 1)].equal(other.state()[py::slice(1, 3, 1)]);
}

void Configuration::requireChangeable() const
{
  if (is_frozen_)
  {
    throw py::type_error(
        "the parameters of a twin cannot be changed; set values in parameters.copy() and make a new twin of the copy");
  }
}

void Configuration::take(const ParameterMap& map)
{
  ParameterMap found = map;
  if (has_own_directory_)
  {
    findNamedFiles(directory_, found);
  }
  values_ = parseParameters(found);
  map_ = map;
}

py::object Configuration::value(const std::string& key) const
{
  py::object found;
  visitValues(values_,
              [&](const std::string& other, const auto& value)
              {
                if (other == key)
                {
                  found = toPython(value);
                }
              });
  if (!found)
  {
    throw py::key_error("unknown parameter " + key);
  }
  return found;
}

bool Configuration::contains(const std::string& key) const
{
  bool found = false;
  visitValues(values_, [&](const std::string& other, const auto&) { found = found || other == key; });
  return found;
}

std::vector<std::string> Configuration::keys() const
{
  std::vector<std::string> keys;
  visitValues(values_, [&](const std::string& key, const auto&) { keys.push_back(key); });
  return keys;
}

void Configuration::update(const py::dict& changes)
{
  requireChangeable();
  ParameterMap map = map_;
  put(changes, map);
  take(map);
}

py::list Configuration::faults() const
{
  return py::cast(values_.faults);
}

void Configuration::setFaults(const py::object& faults)
{
  requireChangeable();
  const bool is_one = py::isinstance<py::str>(faults) || py::isinstance<Fault>(faults);
  std::vector<Fault> list;
  for (const auto& fault : is_one ? py::object(py::make_tuple(faults)) : faults)
  {
    list.push_back(faultOf(fault, values_));
  }
  if (list.size() > MAX_FAULTS)
  {
    throw ParameterError("faults: at most " + std::to_string(MAX_FAULTS) + " faults are allowed");
  }
  ParameterMap map = map_;
  putFaults(list, map);
  take(map);
}

py::tuple Configuration::state() const
{
  py::dict values;
  visitValues(values_, [&](const std::string& key, const auto& value) { values[py::str(key)] = toPython(value); });
  py::list faults;
  for (const Fault& fault : values_.faults)
  {
    faults.append(partsOf(fault));
  }
  return py::make_tuple(directory_, values, faults);
}

Configuration Configuration::fromState(const py::tuple& state)
{
  Configuration configuration;
  configuration.directory_ = py::cast<std::string>(state[0]);
  ParameterMap map;
  put(py::cast<py::dict>(state[1]), map);
  std::vector<Fault> faults;
  for (const auto& fault : py::cast<py::list>(state[2]))
  {
    faults.push_back(faultFrom(py::cast<py::tuple>(fault)));
  }
  putFaults(faults, map);
  configuration.take(map);
  return configuration;
}

Fault faultOf(const py::handle& fault, const Parameters& parameters)
{
  if (py::isinstance<py::str>(fault))
  {
    return parseFault(py::cast<std::string>(fault), parameters);
  }
  const auto given = py::cast<Fault>(fault);
  const std::string errors = faultErrors(given, parameters, "fault: ");
  if (!errors.empty())
  {
    throw ParameterError(errors);
  }
  return given;
}

namespace
{
Configuration configurationOf(const py::args& overlays, const py::kwargs& options)
{
  std::string directory;
  for (const auto& option : options)
  {
    if (py::cast<std::string>(option.first) != "config_dir")
    {
      throw py::type_error("Parameters() has no argument " + py::cast<std::string>(option.first));
    }
    directory = py::cast<std::string>(py::str(option.second));
  }
  return Configuration(overlays, directory);
}

void bindField(py::module& module)
{
  auto field = py::class_<Field>(module, "Field", "Description of a parameter, as in docs/parameters.md.");
  field.def_readonly("key", &Field::key, "section.name")
      .def_readonly("type", &Field::type, "type: float, int, bool, str, or for example '3 floats'")
      .def_readonly("unit", &Field::unit, "SI unit; '-': no unit")
      .def_readonly("minimum", &Field::minimum, "least allowed value; None if the parameter is not numeric")
      .def_readonly("maximum", &Field::maximum, "largest allowed value; None if the parameter is not numeric")
      .def_readonly("choices", &Field::choices, "allowed texts; empty: any")
      .def_readonly("meaning", &Field::meaning, "meaning of the parameter");
  addText(field);
  module.def("parameter_fields", &allFields,
             "Returns all parameters, in the order of docs/parameters.md: list of Field.");
}
}  // namespace

void bindParameters(py::module& module)
{
  bindField(module);
  py::class_<Configuration>(module, "Parameters",
                            "All parameters of a joint, by their keys 'section.name' (docs/parameters.md), in SI "
                            "units, temperatures in degC.\n\n"
                            "Parameters(*overlays, config_dir=''): the default configuration, changed by the overlays; "
                            "later overlays replace values of earlier ones. An overlay is a YAML file as for the "
                            "tool's --config, for example 'joints/elbow.yaml', or a dict of keys and values, as for "
                            "--set. config_dir: directory of another default configuration.\n\n"
                            "Setting a value checks all parameters at once. A ParameterError names key, value, unit "
                            "and range; no value has then changed.")
      .def(py::init(&configurationOf), "Parameters(*overlays, config_dir='')")
      .def("__getitem__", &Configuration::value, py::arg("key"),
           "Returns the value of a key; a list of numbers is a tuple.")
      .def(
          "__setitem__",
          [](Configuration& self, const py::str& key, const py::object& value)
          {
            py::dict changes;
            changes[key] = value;
            self.update(changes);
          },
          py::arg("key"), py::arg("value"), "Sets the value of one key. Raises ParameterError.")
      .def("__contains__", &Configuration::contains, py::arg("key"), "Whether a parameter has this key.")
      .def(
          "__len__", [](const Configuration& self) { return self.keys().size(); }, "Number of keys.")
      .def(
          "__iter__", [](const Configuration& self) { return py::iter(py::cast(self.keys())); },
          "Iterates over all keys.")
      .def("keys", &Configuration::keys, "Returns all keys: list of str; dict(parameters) also has their values.")
      .def(
          "items", [](const Configuration& self) { return self.state()[1].attr("items")(); },
          "Returns all keys with their values, as for a dict.")
      .def(py::self == py::self)
      .def("update", &Configuration::update, py::arg("changes"),
           "Sets the keys of a dict together, for values that would contradict each other if set alone. Raises "
           "ParameterError.")
      .def_static("field", &fieldOf, py::arg("key"),
                  "Returns type, unit, range and meaning of a key as a Field. Raises KeyError.")
      .def_property("faults", &Configuration::faults, &Configuration::setFaults,
                    "Faults that act from the start or begin later: list of Fault. Assign one fault or several; texts "
                    "'KIND:SEVERITY[:PLACE[:ONSET]]' are accepted too.")
      .def(
          "describe", [](const Configuration& self) { return describeParameters(self.values()); },
          "Returns a text with one line for each parameter: key, value, unit and meaning.")
      .def("copy", &Configuration::copy, "Returns another object with equal values.")
      .def("__copy__", &Configuration::copy)
      .def(
          "__deepcopy__", [](const Configuration& self, const py::dict&) { return self.copy(); }, py::arg("memo"))
      .def("__repr__",
           [](const Configuration& self) {
             return "<Parameters of joint '" + self.values().joint.name + "', " + std::to_string(self.keys().size()) +
                    " keys>";
           })
      .def(py::pickle([](const Configuration& self) { return self.state(); }, &Configuration::fromState))
      // Pickle's protocols 0 and 1 would make an instance of pybind11's base class. That would end the process.
      .def("__reduce_ex__", [](const py::object& self, int)
           { return py::module::import("builtins").attr("object").attr("__reduce_ex__")(self, 2); });
  bindFaults(module);
}
}  // namespace hjt
