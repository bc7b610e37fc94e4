// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/json.hpp"
#include "output/progress.hpp"
#include "params/configuration_files.hpp"
#include "python/configuration.hpp"
#include "twin/options.hpp"

// Common part of the functions of the module _recordings. They take options by name, and return a document and notices.
namespace hjt
{
py::object toPython(const Json& json);

struct ToPython
{
  py::object operator()(std::nullptr_t) const { return py::none(); }
  py::object operator()(double value) const
  {
    return std::isfinite(value) ? py::float_(value) : py::object(py::none());
  }
  py::object operator()(const std::vector<Json>& values) const
  {
    py::list list;
    for (const Json& value : values)
    {
      list.append(toPython(value));
    }
    return std::move(list);
  }
  py::object operator()(const std::vector<Json::Member>& members) const
  {
    py::dict dict;
    for (const auto& [name, value] : members)
    {
      dict[py::str(name)] = toPython(value);
    }
    return std::move(dict);
  }
  template <class Value>
  py::object operator()(const Value& value) const
  {
    return py::cast(value);
  }
};

inline py::object toPython(const Json& json)
{
  return json.visit(ToPython());
}

/// Text of an object as Python writes it, with limited length.
inline std::string shortText(const py::handle& value)
{
  constexpr py::ssize_t LONGEST = 60;  // greatest number of characters, each of one or more bytes
  const py::object text = py::repr(value);
  const py::object begin = text[py::slice(0, LONGEST, 1)];
  return py::cast<std::string>(begin) + (begin.equal(text) ? "" : "...");
}

/// Text that names the required type of an option's value.
inline const char* kindText(const Option& option)
{
  const bool is_number = option.kind == Option::Kind::NUMBER;
  return option.kind == Option::Kind::FLAG  ? "True or False" :
         option.kind == Option::Kind::WHOLE ? "a whole number" :
         option.most == 1                   ? (is_number ? "a number" : "a text") :
         option.most == 2                   ? "a pair of numbers" :
                                              (is_number ? "a list of numbers" : "a list of texts");
}

/// Options that Python gives to a function, by their names.
class Given
{
public:
  explicit Given(const py::dict& values) : values_(values) {}

  /// Stores the given options in the fields of `table`. The options have the command line's names in Python's spelling.
  /// @throws InputError.
  void take(OptionTable table) const
  {
    for (Option& option : table.options)
    {
      option.name = nameOf(option.name);
      std::transform(option.needed.begin(), option.needed.end(), option.needed.begin(), nameOf);
      if (values_.contains(option.name))
      {
        give(option, py::object(values_[py::str(option.name)]));
      }
    }
    for (std::vector<std::string>& names : table.alternatives)
    {
      std::transform(names.begin(), names.end(), names.begin(), nameOf);
    }
    table.take();
  }

  /// Columns in the argument `name`; null if the argument names a file.
  py::object columns(const char* name) const
  {
    const py::object given = (*this)[name];
    if (py::isinstance<py::str>(given))
    {
      return {};
    }
    values_[name] = name;
    return given;
  }

  py::object operator[](const char* name) const
  {
    return values_.contains(name) ? py::object(values_[name]) : py::none();
  }

  /// Name of an option in Python: "--time-scale" is time_scale.
  static std::string nameOf(const std::string& option)
  {
    static const std::map<std::string, std::string> OTHERS{ { "--fault", "faults" },
                                                            { "--format", "file_format" },
                                                            { "--model", "models" } };
    const auto other = OTHERS.find(option);
    std::string name = other != OTHERS.end() ? other->second : option.substr(option.find_first_not_of('-'));
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
  }

private:
  static std::string textOf(const Option& option, const py::object& value)
  {
    return option.kind == Option::Kind::TEXT  ? py::cast<std::string>(value) :
           option.kind == Option::Kind::WHOLE ? std::to_string(py::cast<std::int64_t>(value)) :
                                                py::cast<std::string>(py::repr(py::float_(py::cast<double>(value))));
  }

  static void give(Option& option, const py::object& value)
  {
    option.shown = option.name + " = " + shortText(value);
    try
    {
      if (option.kind == Option::Kind::FLAG)
      {
        option.given = py::cast<bool>(value);
        return;
      }
      const bool is_one = option.most == 1;
      for (const py::object& each : is_one ? std::vector{ value } : py::cast<std::vector<py::object>>(value))
      {
        option.values.push_back(textOf(option, each));
      }
      option.given = !option.values.empty();
    }
    catch (const py::cast_error&)
    {
      throw InputError(option.shown + " must be " + kindText(option));
    }
    if (option.is_required && !option.given)
    {
      throw InputError(option.name + ": at least one is required");
    }
    if (option.most == 2 && option.values.size() != 2)
    {
      throw InputError(option.shown + " must be " + kindText(option));
    }
  }

  py::dict values_;
};

/// Connects a library function to Python. Ctrl-C and exceptions of `progress` end the call; notices become warnings.
class PythonWatch
{
public:
  explicit PythonWatch(py::object progress) : progress_(std::move(progress)) {}
  PythonWatch(const PythonWatch&) = delete;
  PythonWatch& operator=(const PythonWatch&) = delete;

  Watch watch()
  {
    return { [this](const std::string& what) { return [this, what](double done) { look(what, done); }; },
             [this]
             {
               look({}, 0.0);
               return ended_;
             },
             [this](const std::string& text) { notices_.push_back(text); } };
  }

  /// @returns the notices of the call. @throws what Python has raised during the call.
  std::vector<std::string> finish()
  {
    if (error_)
    {
      std::rethrow_exception(error_);
    }
    if (ended_)
    {
      throw py::error_already_set();
    }
    return std::move(notices_);
  }

private:
  /// Calls `progress` and Python's signal handlers. After an exception neither is called until files are closed.
  void look(const std::string& what, double done)
  {
    if (ended_)
    {
      return;
    }
    try
    {
      check_();
      if (!what.empty() && !progress_.is_none() && std::abs(done - shown_) >= STEP)
      {
        shown_ = done;
        const py::gil_scoped_acquire acquire;
        progress_(what, done);
      }
    }
    catch (const Interrupted&)
    {
      ended_ = true;
    }
    catch (const py::error_already_set&)
    {
      error_ = std::current_exception();
      ended_ = true;
    }
  }

  static constexpr double STEP = 0.01;

  py::object progress_;
  InterruptCheck check_;
  double shown_{ -1.0 };
  bool ended_{};
  std::exception_ptr error_;
  std::vector<std::string> notices_;
};

/// Reads the argument `overlays` of the call into `options`. @throws InputError, ParameterError.
inline void takeOverlays(const Given& given, ConfigurationOptions& options)
{
  const py::object overlays = given["overlays"];
  for (const auto& overlay : overlays.is_none() ? py::list() : py::list(overlays))
  {
    readOverlay(overlay, configurationDirectory("").string(), options.values);
  }
}

/// Reads options by the names that a library function declares, and `overlays` for the configuration.
/// @throws InputError, ParameterError.
template <class Options>
void takeOptions(const Given& given, Options& options)
{
  takeOverlays(given, options);
  OptionTable table;
  addOptions(table, options);
  given.take(table);
}

/// Adds to the module a list of the function's options, with which a test compares the function's signature.
template <class Options>
void listOptions(const py::module& module, const char* function)
{
  Options options;
  OptionTable table;
  addOptions(table, options);
  py::list names;
  for (const Option& option : table.options)
  {
    names.append(Given::nameOf(option.name));
  }
  module.attr("OPTIONS")[function] = names;
}

using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// @throws InputError if `columns` has no columns by name. `what`: name of the argument in the error text.
inline void requireColumns(const py::object& columns, const std::string& what)
{
  const bool is_structured = py::hasattr(columns, "dtype") && !columns.attr("dtype").attr("names").is_none();
  if (!is_structured && !py::hasattr(columns, "keys"))
  {
    throw InputError(what + " = " + shortText(columns) +
                     " must be the name of a file or have columns by name: a structured array, a frame or a mapping of "
                     "arrays");
  }
}

/// A column of a mapping of arrays or of a structured array; empty if the column is missing. The shape is (rows,) or,
/// for an arm, (rows, joints).
class MotionColumn
{
public:
  MotionColumn(const py::object& columns, const char* name)
  {
    const py::object names = py::hasattr(columns, "dtype") ? columns.attr("dtype").attr("names") : columns;
    if (names.contains(name))
    {
      read(columns[name], name);
    }
  }

  explicit operator bool() const { return data_ != nullptr; }
  py::ssize_t rows() const { return values_.shape(0); }
  py::ssize_t width() const { return values_.ndim() > 1 ? values_.shape(1) : 1; }
  double at(std::size_t row, std::size_t joint) const { return data_[row * static_cast<std::size_t>(width()) + joint]; }

private:
  /// Dates and times of numpy or pandas, converted to seconds [s].
  static py::object inSeconds(const py::object& column, const std::string& name)
  {
    const py::object kind = py::getattr(py::getattr(column, "dtype", py::none()), "kind", py::none());
    const bool is_date = kind.equal(py::str("M"));
    if (!is_date && !kind.equal(py::str("m")))
    {
      return column;
    }
    if (name != "time")
    {
      throw InputError("column '" + name + "' must contain numbers, but contains times");
    }
    const py::module numpy = py::module::import("numpy");
    const py::object times = numpy.attr("asarray")(column);
    const py::object since = is_date ? times - numpy.attr("datetime64")(0, "ns") : times;
    return since / numpy.attr("timedelta64")(1, "s");
  }

  void read(const py::object& column, const std::string& name)
  {
    try
    {
      values_ = inSeconds(column, name).cast<Values>();
    }
    catch (const py::error_already_set& error)
    {
      throw InputError("column '" + name + "' must contain numbers: " + error.what());
    }
    if (values_.ndim() != 1 && values_.ndim() != 2)
    {
      throw InputError("column '" + name + "' has " + std::to_string(values_.ndim()) +
                       " dimensions; its shape must be (rows,) or (rows, joints)");
    }
    data_ = values_.data();
  }

  Values values_;
  const double* data_{};
};

using Answer = std::pair<py::object, std::vector<std::string>>;

/// Calls `function` with the options, without the interpreter's lock. @returns the document that `document` makes of
/// the result, and the notices of the call.
template <class Options, class Function, class Document>
Answer call(const Given& given, Options& options, const Function& function, const Document& document)
{
  PythonWatch watch(given["progress"]);
  options.watch = watch.watch();
  try
  {
    const auto result = withoutLock([&] { return function(options); });
    const std::vector<std::string> notices = watch.finish();
    return { document(result), notices };
  }
  catch (const InputError& error)
  {
    const std::vector<std::string> notices = watch.finish();  // throws if Python has ended the call
    if (dynamic_cast<const ParameterError*>(&error) != nullptr || notices.empty())
    {
      throw;
    }
    // Notices from before the error may explain the error.
    throw InputError(error.what() + ("\n" + joined(notices, "\n")));
  }
}

Answer armIn(const py::dict& arguments);
void bindArm(py::module& module);
}  // namespace hjt
