// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/joined.hpp"
#include "base/range_check.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "identification/cross_validation.hpp"
#include "output/json.hpp"
#include "output/watch.hpp"
#include "params/configuration_files.hpp"
#include "python/overlays.hpp"
#include "twin/configuration_options.hpp"

// What the functions of the module _recordings share: options by name in, a document and the notices out.
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

/// What an option of this type must be.
template <class Value>
constexpr const char* kindOf()
{
  return std::is_same_v<Value, bool>                               ? "True or False" :
         std::is_integral_v<Value>                                 ? "a whole number" :
         std::is_arithmetic_v<Value>                               ? "a number" :
         std::is_same_v<Value, std::string>                        ? "a text" :
         std::is_same_v<Value, std::vector<std::string>>           ? "a list of texts" :
         std::is_same_v<Value, std::map<std::string, std::string>> ? "a mapping of texts to texts" :
         std::is_same_v<Value, std::array<double, 2>>              ? "a pair of numbers" :
         std::is_same_v<Value, std::array<std::uint64_t, 2>>       ? "a pair of whole numbers" :
         std::is_same_v<Value, std::vector<double>>                ? "a list of numbers" :
                                                                     "of another type";
}

/// As Python writes it, not too long.
inline std::string shortText(const py::handle& value)
{
  constexpr py::ssize_t LONGEST = 60;  // characters, which may be of several bytes
  const py::object text = py::repr(value);
  const py::object begin = text[py::slice(0, LONGEST, 1)];
  return py::cast<std::string>(begin) + (begin.equal(text) ? "" : "...");
}

/// A function's options by their names.
class Given
{
public:
  explicit Given(const py::dict& values) : values_(values) {}

  template <class Value>
  void take(const char* name, Value& field) const
  {
    if (values_.contains(name))
    {
      take(name, py::object(values_[name]), field);
    }
  }

  void take(const char* name, std::optional<Span>& field) const
  {
    std::optional<std::array<double, 2>> pair;
    take<std::optional<std::array<double, 2>>>(name, pair);
    field = pair ? std::make_optional(Span{ (*pair)[0], (*pair)[1] }) : std::nullopt;
  }

  py::object operator[](const char* name) const
  {
    return values_.contains(name) ? py::object(values_[name]) : py::none();
  }

private:
  template <class Value>
  static void take(const char* name, const py::object& value, Value& field)
  {
    try
    {
      field = py::cast<Value>(value);
    }
    catch (const py::cast_error&)
    {
      throw InputError(std::string(name) + " = " + shortText(value) + " must be " + kindOf<Value>());
    }
  }

  template <class Value>
  static void take(const char* name, const py::object& value, std::optional<Value>& field)
  {
    take(name, value, field.emplace());
  }

  py::dict values_;
};

/// How Python follows a function: Ctrl-C, an error out of `progress`, and the notices that become warnings.
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

  /// @throws what Python raised meanwhile.
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
  /// Nothing of Python is called once it has raised: files are closed first.
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

inline void takeConfiguration(const Given& given, ConfigurationOptions& options)
{
  for (const auto& overlay : given["overlays"])
  {
    readOverlay(overlay, configurationDirectory("").string(), options.values);
  }
}

using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// @throws InputError unless `columns` has columns by name. `what`: its name in the error.
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

/// A column of a mapping of arrays or a structured array, of shape (rows,) or, of an arm, (rows, joints); none: it is
/// not there.
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
  /// Dates and times of numpy or pandas are seconds.
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
      throw InputError("column '" + name + "' must be numbers, it holds times");
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
      throw InputError("column '" + name + "' must be numbers: " + error.what());
    }
    if (values_.ndim() != 1 && values_.ndim() != 2)
    {
      throw InputError("column '" + name + "' has " + std::to_string(values_.ndim()) +
                       " dimensions, expected: the shape (rows,) or (rows, joints)");
    }
    data_ = values_.data();
  }

  Values values_;
  const double* data_{};
};

using Answer = std::pair<py::object, std::vector<std::string>>;

/// Calls `function` with the options, without the interpreter's lock; gives what `document` makes of its result, and
/// the notices.
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
    const std::vector<std::string> notices = watch.finish();  // half of the work is no error of the user's
    if (dynamic_cast<const ParameterError*>(&error) != nullptr || notices.empty())
    {
      throw;
    }
    // What was remarked before it may be its reason.
    throw InputError(error.what() + ("\n" + joined(notices, "\n")));
  }
}

Answer armIn(const py::dict& arguments);
void bindArm(py::module& module);
}  // namespace hjt
