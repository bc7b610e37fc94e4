// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "python/configuration.hpp"
#include "python/in_use.hpp"
#include "python/run_inputs.hpp"
#include "python/step_row.hpp"
#include "python/surface_source.hpp"
#include "python/tooth_values.hpp"

namespace hjt
{
/// A twin, and the arrays of its teeth.
class TwinObject
{
public:
  TwinObject(const Configuration& parameters, const std::optional<std::string>& cache, const py::object& progress)
    : TwinObject(makeTwin(parameters.values(), cache, progress), parameters)
  {
  }

  TwinObject(Twin twin, const Configuration& parameters)
    : twin_(std::move(twin))
    , forces_(std::make_shared<ToothForces>(twin_.makeToothForces()))
    , stress_(std::make_shared<ToothStress>(parameters.values().gear.teeth_flexspline))
    , parameters_(parameters.frozen())
  {
  }

  /// @throws std::runtime_error while another thread runs it.
  Twin& twin()
  {
    in_use_.refuse();
    return twin_;
  }

  const Configuration& parameters() const { return parameters_; }

  InUse& inUse() { return in_use_; }

  StepRows run(const std::optional<py::ssize_t>& given_steps, const GivenInputs& given, py::ssize_t every = 1,
               const py::object& out = py::none(), const py::object& progress = py::none())
  {
    RunShape shape{ RunShape::Axes::STEPS, parameters_.values().output.load_torque_limit, 1, given_steps };
    const RunInputs inputs(given, shape);
    const py::ssize_t steps = requireSteps(shape.steps, every);
    StepRows rows = rowsFor({ steps / every }, out);
    march(inputs, steps, every, rows.mutable_data(), progress);
    return rows;
  }

  std::shared_ptr<ToothForces> toothForces()
  {
    if (!twin().toothForces(*forces_))
    {
      throw NotConverged("no equilibrium found for the teeth at this instant");
    }
    return forces_;
  }

  std::shared_ptr<ToothStress> toothStress()
  {
    if (!twin().toothStress(*stress_))
    {
      throw NotConverged("no equilibrium found for the teeth at this instant");
    }
    return stress_;
  }

private:
  static Twin makeTwin(Parameters parameters, const std::optional<std::string>& cache, const py::object& progress)
  {
    SurfaceSourceOf source(cache, progress);
    Twin twin = withoutLock([&] { return Twin(parameters, source.source()); });
    source.warn();
    return twin;
  }

  void march(const RunInputs& inputs, py::ssize_t steps, py::ssize_t every, StepRow* row, const py::object& progress)
  {
    const InUse::Hold hold = in_use_.hold();
    withoutLock(
        [&]
        {
          RunCheck check(progress);
          py::ssize_t until_row = every;
          for (py::ssize_t step = 0; step < steps; ++step)
          {
            inputs.step(twin_, step, 0);
            if (--until_row == 0)
            {
              *row++ = rowOf(twin_);
              until_row = every;
            }
            if (step % 64 == 63)
            {
              check(step + 1, steps);
            }
          }
          check.end();
        });
  }

  Twin twin_;
  std::shared_ptr<ToothForces> forces_;
  std::shared_ptr<ToothStress> stress_;
  Configuration parameters_;
  InUse in_use_{ "twin" };
};

/// By name: dict of str to int.
py::dict namedCounters(const TwinCounters& counters);
}  // namespace hjt
