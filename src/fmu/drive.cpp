// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/drive.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "surface/surface_pool.hpp"

#include "base/number_text.hpp"
#include "base/whole_file.hpp"

namespace hjt::fmu
{
namespace
{
constexpr double LARGEST_TIME = 1e9;                // [s]
constexpr Stamp EPOCH = 1'000'000'000'000'000'000;  // of time 0, as `joint_twin simulate` starts
constexpr std::size_t KEPT_SURFACES = 4;

Stamp stampAt(double time)
{
  return EPOCH + static_cast<Stamp>(std::llround(1e9 * time));
}

/// One for all instances of the process.
const std::shared_ptr<SurfacePool>& surfaces()
{
  static const auto POOL = std::make_shared<SurfacePool>(KEPT_SURFACES);
  return POOL;
}

Parameters readParameters(const std::string& text, const std::string& folder)
{
  ParameterMap map;
  readDescription(text, PARAMETER_FILE, map);
  for (const char* key : FILE_PARAMETERS)
  {
    auto& name = std::get<std::string>(map.at(key).value);
    name = name == NO_FILE ? name : folder + name;
  }
  return parseParameters(map);
}

std::string nameAndValue(const FmuVariable& variable, std::size_t element, double value)
{
  return variable.name + (variable.is_array ? '[' + std::to_string(element + 1) + ']' : "") + " = " +
         numberText(value) + " [" + variable.unit + "]";
}
}  // namespace

Drive::Drive(const std::string& resources, const std::string& token, void* environment, LogMessage log)
  : environment_(environment), log_(log)
{
  const std::string folder = resources.empty() || resources.back() == '/' ? resources : resources + '/';
  const std::string text = readFile(folder + PARAMETER_FILE);
  if (token != instantiationToken(text))
  {
    throw InputError("the instantiation token '" + token + "' is not that of this library and its resources, '" +
                     instantiationToken(text) + "'");
  }
  base_ = readParameters(text, folder);
  variables_ = variables(base_);
  reset();
}

void Drive::log(Status status, const char* category, const std::string& message) const noexcept
{
  if (log_ != nullptr)
  {
    log_(environment_, status, category, message.c_str());
  }
}

void Drive::requireMode(bool allowed, const char* call, const char* what) const
{
  constexpr const char* NAMES[]{ "Instantiated", "Initialization Mode", "Step Mode", "Terminated" };
  if (!allowed)
  {
    throw CallError(std::string(call) + what + " is not allowed in state " + NAMES[static_cast<int>(state_.mode)]);
  }
}

void Drive::enterInitialization(double start, std::optional<double> stop)
{
  requireMode(state_.mode == Mode::INSTANTIATED, "fmi3EnterInitializationMode");
  if (!(std::abs(start) <= LARGEST_TIME) || (stop && !(*stop >= start)))
  {
    throw CallError("startTime = " + numberText(start) + " [s]" +
                    (stop ? ", stopTime = " + numberText(*stop) + " [s]" : std::string()) +
                    " out of range, allowed: a start within +-1e9 and a stop not before it");
  }
  state_.mode = Mode::INITIALIZATION;
  state_.start = start;
  state_.time = start;
  state_.stop = stop;
}

void Drive::exitInitialization()
{
  requireMode(state_.mode == Mode::INITIALIZATION, "fmi3ExitInitializationMode");
  makeTwin();
  state_.mode = Mode::STEP;
}

void Drive::terminate()
{
  requireMode(state_.mode == Mode::STEP, "fmi3Terminate");
  state_.mode = Mode::TERMINATED;
}

void Drive::reset()
{
  state_ = {};
  for (const FmuVariable& variable : variables_)
  {
    state_.values.push_back(variable.start);
  }
  teeth_known_ = false;
}

void Drive::takeUp(const State& state)
{
  state_ = state;
  teeth_known_ = false;
}

const FmuVariable& Drive::variable(ValueReference reference, Type type) const
{
  if (reference >= variables_.size())
  {
    throw CallError("no variable has the value reference " + std::to_string(reference));
  }
  const FmuVariable& found = variables_[reference];
  if (found.type != type)
  {
    throw CallError(found.name + " is of another type than the function");
  }
  return found;
}

void Drive::requireCount(Type type, const ValueReference* references, std::size_t references_count,
                         std::size_t count) const
{
  std::size_t expected = 0;
  for (std::size_t i = 0; i < references_count; ++i)
  {
    variable(references[i], type);
    expected += type == Type::STRING ? 1 : state_.values[references[i]].numbers.size();
  }
  if (count != expected)
  {
    throw CallError(std::to_string(count) + " values for variables that have " + std::to_string(expected));
  }
}

void Drive::requireSettable(const FmuVariable& variable) const
{
  const bool before_start = state_.mode == Mode::INSTANTIATED || state_.mode == Mode::INITIALIZATION;
  const bool settable = variable.causality == Causality::PARAMETER ?
                            before_start :
                            variable.causality == Causality::INPUT && (before_start || state_.mode == Mode::STEP);
  requireMode(settable, "setting ", variable.name.c_str());
}

void Drive::check(const FmuVariable& variable, std::size_t element, double value) const
{
  const bool in_range = !variable.range || (value >= variable.range->min && value <= variable.range->max);
  // A command beyond the limits is clamped and counted; a number it must be.
  const bool is_torque = variable.causality == Causality::INPUT && variable.unit == "N.m";
  if (!std::isfinite(value) || !(in_range || is_torque))
  {
    throw CallError(nameAndValue(variable, element, value) + " out of range, allowed: " +
                    (variable.range && !is_torque ? rangeText(*variable.range) : "finite numbers"));
  }
}

const Value& Drive::value(ValueReference reference)
{
  const FmuVariable& asked = variables_[reference];
  if (asked.causality == Causality::INDEPENDENT)
  {
    state_.values[reference].numbers[0] = state_.time;
  }
  if (asked.causality == Causality::OUTPUT)
  {
    requireMode(state_.mode != Mode::INSTANTIATED, "getting ", asked.name.c_str());
    if (!state_.twin)
    {
      makeTwin();
    }
    asked.is_array ? readTeeth() : readOutput(reference);
  }
  return state_.values[reference];
}

/// Those of the export with the values that were set; faults that were set are there from the start.
Parameters Drive::parameters() const
{
  ParameterMap changes;
  const std::size_t first = placeReference(FAULT_KINDS);
  for (std::size_t i = first; i < variables_.size(); ++i)
  {
    const FmuVariable& variable = variables_[i];
    const Value& value = state_.values[i];
    if (value.text == variable.start.text && value.numbers == variable.start.numbers)
    {
      continue;
    }
    ParameterValue& change = changes[variable.name];
    change.origin = "parameters of the instance";
    switch (variable.type)
    {
      case Type::STRING:
        change.value = value.text;
        break;
      case Type::BOOLEAN:
        change.value = value.numbers[0] != 0.0;
        break;
      case Type::INT32:
        change.value = static_cast<std::int64_t>(value.numbers[0]);
        break;
      case Type::FLOAT64:
        variable.is_array ? change.value = value.numbers : change.value = value.numbers[0];
        break;
    }
  }
  Parameters parameters = base_;
  parameters.input.temperature = state_.values[TEMPERATURE].numbers[0];
  parameters.brake.engaged_at_start = state_.values[BRAKE].numbers[0] != 0.0;
  for (std::size_t kind = 0; kind < FAULT_KINDS; ++kind)
  {
    const auto was = [&](std::size_t reference) { return variables_[reference].start.numbers[0]; };
    const auto is = [&](std::size_t reference) { return state_.values[reference].numbers[0]; };
    const std::size_t place = placeReference(kind);
    const Fault before{ static_cast<FaultKind>(kind), was(FIRST_FAULT + kind), static_cast<int>(was(place)) };
    const Fault now{ before.kind, is(FIRST_FAULT + kind), static_cast<int>(is(place)) };
    if (now.severity == before.severity && now.place == before.place)
    {
      continue;
    }
    std::vector<Fault>& faults = parameters.faults;
    faults.erase(std::remove_if(faults.begin(), faults.end(),
                                [&](const Fault& fault)
                                {
                                  return fault.kind == now.kind && fault.isActiveAtStart() &&
                                         (fault.place == before.place || fault.place == now.place);
                                }),
                 faults.end());
    if (now.severity > 0.0)
    {
      faults.push_back(now);
    }
  }
  changeParameters(parameters, changes);
  return parameters;
}

void Drive::makeTwin()
{
  if (!state_.twin)
  {
    SurfaceSource source;
    source.cache_directory = surfaceCacheDirectory();
    source.notice = [this](const std::string& what) { log(Status::WARNING, "logStatusWarning", what); };
    source.pool = surfaces();
    state_.twin.emplace(parameters(), source);
  }
  state_.twin->reset(stampAt(state_.start));
  state_.given.clear();
}

/// What has changed of the inputs, but the motor's torque, from this instant on.
void Drive::giveInputs(Stamp instant)
{
  if (state_.given.empty())
  {
    // The twin starts with all of them but a load.
    for (unsigned i = TIME; i < FIRST_OUTPUT; ++i)
    {
      state_.given.push_back(i == LOAD_TORQUE ? 0.0 : state_.values[i].numbers[0]);
    }
  }
  for (unsigned i = LOAD_TORQUE; i < FIRST_OUTPUT; ++i)
  {
    const double value = state_.values[i].numbers[0];
    if (value == state_.given[i])
    {
      continue;
    }
    state_.given[i] = value;
    if (i >= FIRST_FAULT)
    {
      const std::size_t kind = i - FIRST_FAULT;
      const auto place = static_cast<int>(state_.values[placeReference(kind)].numbers[0]);
      state_.twin->injectFault(instant, { static_cast<FaultKind>(kind), value, place });
      continue;
    }
    constexpr InputKind KINDS[]{ InputKind::LOAD_TORQUE, InputKind::TEMPERATURE, InputKind::BRAKE };
    state_.twin->push({ instant, KINDS[i - LOAD_TORQUE], value });
  }
}

bool Drive::step(double at, double length)
{
  requireMode(state_.mode == Mode::STEP, "fmi3DoStep");
  const double tolerance = 1e-9 * std::max(1.0, std::abs(state_.time));
  const double end = at + length;
  const auto asked = [&]
  {
    return "currentCommunicationPoint = " + numberText(at) + " [s], communicationStepSize = " + numberText(length) +
           " [s]: ";
  };
  if (!(std::abs(at - state_.time) <= tolerance))
  {
    throw CallError(asked() + "the instance is at " + numberText(state_.time) + " [s]");
  }
  if (!(length > 0.0) || !(end <= LARGEST_TIME))
  {
    throw CallError(asked() + "a step must be longer than 0 and end before 1e9 [s]");
  }
  if (state_.stop && end > *state_.stop + tolerance)
  {
    throw CallError(asked() + "the stop time is " + numberText(*state_.stop) + " [s]");
  }
  Twin& twin = *state_.twin;
  const std::uint64_t failures = twin.counters().solver_failures;
  const Stamp until = stampAt(end) + twin.stepLength() / 1000;  // sums of steps are rounded
  Stamp instant = twin.stamp() + twin.stepLength();
  if (instant <= until)
  {
    giveInputs(instant);
  }
  const double torque = state_.values[MOTOR_TORQUE].numbers[0];
  for (; instant <= until; instant += twin.stepLength())
  {
    twin.commandMotorTorque(instant, torque);  // at every instant, so that it does not time out
    twin.step(until);
  }
  state_.time = end;
  teeth_known_ = false;
  return twin.counters().solver_failures == failures;
}

/// Indicators and assessment are made from the first time on that one of them is asked for.
void Drive::readOutput(ValueReference reference)
{
  const ScalarOutput& output = scalarOutputs()[reference - FIRST_OUTPUT];
  if (output.watches && !state_.twin->watchesSignals())
  {
    state_.twin->watchSignals(true);
  }
  state_.values[reference].numbers[0] = output.of(*state_.twin, state_.twin->outputs());
}

/// On the response surface this solves a ring of its own. Without an equilibrium the last forces stay.
void Drive::readTeeth()
{
  if (teeth_known_)
  {
    return;
  }
  if (!forces_)
  {
    forces_ = state_.twin->makeToothForces();
  }
  if (!state_.twin->toothForces(*forces_))
  {
    log(Status::WARNING, "logStatusWarning", "no equilibrium of all teeth at " + numberText(state_.time) + " [s]");
  }
  std::size_t reference = FIRST_OUTPUT + scalarOutputs().size();
  for (const ToothOutput& output : toothOutputs())
  {
    state_.values[reference++].numbers = (*forces_).*output.forces;
  }
  teeth_known_ = true;
}
}  // namespace hjt::fmu
