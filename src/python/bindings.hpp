// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "harmonic_joint_twin/solver/solve_status.hpp"
#include "twin/step_counters.hpp"

// Bindings of the Python module. The names, units and shapes of its members are in python/harmonic_joint_twin/_hjt.pyi.
namespace hjt
{
namespace py = pybind11;

// Functions that add the parts of the module. A part may use types of parts that were added before.
void bindParameters(py::module& module);
void bindHealth(py::module& module);
void bindToothValues(py::module& module);
void bindTwin(py::module& module);
void bindTwinBatch(py::module& module);
void bindStatics(py::module& module);
void bindTracking(py::module& module);

/// Counters of steps by name: dict of str to int.
inline py::dict stepCounters(const TwinCounters& counters)
{
  py::dict named;
  for (const auto& [name, count] : STEP_COUNTERS)
  {
    named[name] = counters.*count;
  }
  return named;
}

/// Error that the solver found no equilibrium; a RuntimeError in Python.
class NotConverged : public std::runtime_error
{
public:
  NotConverged(const std::string& what, const SolveStatus& status)
    : std::runtime_error("no equilibrium found for " + what + ": " + explanationOf(status))
  {
  }
  explicit NotConverged(const std::string& text) : std::runtime_error(text) {}
};

/// Thrown if a signal handler of Python has raised an exception. This exception is already set as Python's error.
struct Interrupted
{
};

/// Throws `Interrupted` if a signal handler of Python has raised an exception, for example that of Ctrl-C. Checks at
/// most twenty times a second, because taking the interpreter's lock can take longer than many steps of a twin.
class InterruptCheck
{
public:
  InterruptCheck() : next_(now() + PERIOD) {}

  /// Checks for an exception if the last check is at least PERIOD ago. @returns whether it checked.
  bool operator()()
  {
    const double time = now();
    if (time < next_)
    {
      return false;
    }
    next_ = time + PERIOD;
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0)
    {
      throw Interrupted{};
    }
    return true;
  }

private:
  static constexpr double PERIOD = 0.05;  // least time between two checks [s]

  static double now()
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  double next_;  // time of the next check [s]
};

/// An InterruptCheck that also calls the progress function of a run.
class RunCheck
{
public:
  /// `progress`: Python function that is called with the finished share 0 ... 1, or None.
  explicit RunCheck(const py::object& progress) : progress_(progress) {}

  /// Reports that `done` of `all` steps are finished.
  void operator()(py::ssize_t done, py::ssize_t all)
  {
    if (check_() && !progress_.is_none())
    {
      tell(static_cast<double>(done) / static_cast<double>(all));
    }
  }

  void end()
  {
    if (!progress_.is_none())
    {
      tell(1.0);
    }
  }

private:
  void tell(double share)
  {
    const py::gil_scoped_acquire acquire;
    progress_(share);
  }

  const py::object& progress_;
  InterruptCheck check_;
};

/// Calls `work` without the interpreter's lock and returns its result. If `work` throws `Interrupted`, throws Python's
/// error.
template <class Work>
auto withoutLock(const Work& work)
{
  try
  {
    py::gil_scoped_release release;
    return work();
  }
  catch (const Interrupted&)
  {
    throw py::error_already_set();
  }
}

/// A read-only array that is a view of `values`, memory of `owner`. The array keeps `owner` alive.
py::array_t<double> viewOf(const std::vector<double>& values, const py::object& owner);

/// Text of the names and values of all properties of `object`.
std::string describeObject(const py::object& object);

/// Gives a Python class of plain values a __repr__ that shows its properties.
template <class Class>
void addText(Class& type)
{
  type.def("__repr__", [](const py::object& self) { return describeObject(self); });
}

/// Flag that a call without the interpreter's lock uses a Python object, so that no second call may use the object. The
/// interpreter's lock protects the flag.
class InUse
{
public:
  /// Marks the object as in use during its lifetime. Constructor and destructor need the interpreter's lock.
  class Hold
  {
  public:
    explicit Hold(bool& used) : used_(&used) { *used_ = true; }
    Hold(Hold&& other) noexcept : used_(std::exchange(other.used_, nullptr)) {}
    Hold& operator=(Hold&&) = delete;
    ~Hold()
    {
      if (used_ != nullptr)
      {
        *used_ = false;
      }
    }

  private:
    bool* used_;
  };

  /// `what`: name of the object in the error text.
  explicit InUse(const char* what) : what_(what) {}

  /// Checks that the object is not in use. @throws std::runtime_error if the object is in use.
  void refuse() const
  {
    if (used_)
    {
      throw std::runtime_error("this " + std::string(what_) + " is being run by another thread");
    }
  }

  /// Marks the object as in use. @throws std::runtime_error if the object is already in use.
  [[nodiscard]] Hold hold()
  {
    refuse();
    return Hold(used_);
  }

private:
  const char* what_;
  bool used_{};
};
}  // namespace hjt
