// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/base/errors.hpp"
#include "python/bindings.hpp"

namespace hjt
{
namespace
{
void bindErrors(py::module& module)
{
  // pybind11 tries the errors in reverse order of registration, so errors derived from InputError come after it.
  const auto input = py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<ParameterError>(module, "ParameterError", input.ptr());
  py::register_exception<NotConverged>(module, "NotConverged", PyExc_RuntimeError);
  module.attr("InputError").attr("__doc__") =
      "Invalid input; the text names key, value, unit and range, or file and line.";
  module.attr("ParameterError").attr("__doc__") =
      "A parameter that is missing, misspelt, mistyped or out of range, or that contradicts another parameter.";
  module.attr("NotConverged").attr("__doc__") = "The solver found no equilibrium of the ring; the text gives advice.";
}
}  // namespace

py::array_t<double> viewOf(const std::vector<double>& values, const py::object& owner)
{
  py::array_t<double> view(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

std::string describeObject(const py::object& object)
{
  const py::object type = object.attr("__class__");
  const py::object property = py::module::import("builtins").attr("property");
  std::string text;
  for (const auto& item : py::dict(type.attr("__dict__")))
  {
    if (!py::isinstance(item.second, property))
    {
      continue;
    }
    const py::object value = object.attr(item.first);
    text += (text.empty() ? "" : ", ") + py::cast<std::string>(item.first) + "=";
    text += py::isinstance<py::array>(value) ? "<" + py::cast<std::string>(py::str(value.attr("shape"))) + " array>" :
                                               py::cast<std::string>(py::repr(value));
  }
  return py::cast<std::string>(type.attr("__name__")) + "(" + text + ")";
}
}  // namespace hjt

PYBIND11_MODULE(_hjt, module)
{
  module.doc() = "Digital twin of a robot joint's harmonic drive, tooth by tooth (docs/python.md).";
  hjt::bindErrors(module);
  hjt::bindParameters(module);
  hjt::bindHealth(module);
  hjt::bindToothValues(module);
  hjt::bindTwin(module);
  hjt::bindTwinBatch(module);
  hjt::bindStatics(module);
  hjt::bindTracking(module);
}
