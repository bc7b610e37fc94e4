// SPDX-License-Identifier: BSD-3-Clause
#include "python/configuration.hpp"

#include "harmonic_joint_twin/base/errors.hpp"
#include "params/configuration_files.hpp"

namespace hjt
{
namespace
{
double numberFrom(const py::handle& value, const std::string& key)
{
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1.0 && PyErr_Occurred() != nullptr)
  {
    PyErr_Clear();
    throw ParameterError(std::string(ORIGIN) + ": " + key + " = " + py::cast<std::string>(py::repr(value)) +
                         " must be a number, a text, a truth value or a list of numbers");
  }
  return number;
}

/// Whether the value is a list. A zero-dimensional array is a number.
bool isList(const py::handle& value)
{
  const bool is_list = PySequence_Check(value.ptr()) != 0 && PySequence_Size(value.ptr()) >= 0;
  PyErr_Clear();
  return is_list;
}

ParameterValue parameterValue(const py::handle& value, const std::string& key)
{
  const auto is_named = [&](const char* name)
  { return py::cast<std::string>(value.attr("__class__").attr("__name__")) == name; };
  if (PyBool_Check(value.ptr()) || is_named("bool_") || is_named("bool"))
  {
    return { PyObject_IsTrue(value.ptr()) == 1, ORIGIN };
  }
  if (py::isinstance<py::str>(value))
  {
    return { py::cast<std::string>(value), ORIGIN };
  }
  if (isList(value))
  {
    std::vector<double> numbers;
    for (const auto& item : value)
    {
      numbers.push_back(numberFrom(item, key));
    }
    return { numbers, ORIGIN };
  }
  if (PyIndex_Check(value.ptr()))
  {
    // Converts numpy's integers too, which are not of Python's type int.
    const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    if (whole)
    {
      return { py::cast<std::int64_t>(whole), ORIGIN };
    }
    PyErr_Clear();  // the value is an array without dimensions that holds no whole number
  }
  return { numberFrom(value, key), ORIGIN };
}

}  // namespace

void put(const py::dict& values, ParameterMap& map)
{
  for (const auto& item : values)
  {
    if (!py::isinstance<py::str>(item.first))
    {
      throw ParameterError(std::string(ORIGIN) + ": key " + py::cast<std::string>(py::repr(item.first)) +
                           " must be a text 'section.name'");
    }
    const auto key = py::cast<std::string>(item.first);
    map[key] = parameterValue(item.second, key);
  }
}

void readOverlay(const py::handle& what, const std::string& directory, ParameterMap& map)
{
  if (py::isinstance<py::dict>(what))
  {
    put(py::reinterpret_borrow<py::dict>(what), map);
    return;
  }
  const auto path = py::reinterpret_steal<py::object>(PyOS_FSPath(what.ptr()));
  if (!path)
  {
    throw py::error_already_set();
  }
  readYamlFile(findConfiguration(py::cast<std::string>(path), directory), map);
}
}  // namespace hjt
