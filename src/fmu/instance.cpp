// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/instance.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/hash.hpp"
#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt::fmu
{
namespace
{
/// Path of the directory of the resources. FMI 3.0 prescribes a path and FMI 2.0 a URI, but importers give either.
std::string folderOf(std::string resources)
{
  if (resources.rfind("file:", 0) == 0)
  {
    const std::size_t path = resources.rfind("file://", 0) == 0 ? resources.find('/', 7) : 5;
    resources.erase(0, path);
    const auto is_digit = [](unsigned char c) { return std::isxdigit(c) != 0; };
    for (std::size_t i = 0; (i = resources.find('%', i)) != std::string::npos; ++i)
    {
      const std::string digits = resources.substr(i + 1, 2);
      if (digits.size() == 2 && std::all_of(digits.begin(), digits.end(), is_digit))
      {
        resources.replace(i, 3, 1, static_cast<char>(std::stoi(digits, nullptr, 16)));
      }
    }
  }
  return (std::filesystem::absolute(resources) / "").string();
}

std::size_t categoryOf(Status status) noexcept
{
  return status == Status::ERROR ? 1 : 0;
}

constexpr double NO_STOP = std::numeric_limits<double>::infinity();  // stop time of an instance without stop time [s]

std::string nameAndValue(const FmuVariable& variable, std::size_t element, double value)
{
  return variable.name + (variable.is_array ? '[' + std::to_string(element + 1) + ']' : "") + " = " +
         numberText(value) + " [" + variable.unit + "]";
}
}  // namespace

Instance::State::State(const State& other)
  : mode(other.mode)
  , start(other.start)
  , time(other.time)
  , stop(other.stop)
  , values(other.values)
  , journal(other.journal)
  , unit(other.unit)
  , simulation(other.simulation ? other.simulation->copy() : nullptr)
{
}

Instance::State& Instance::State::operator=(const State& other)
{
  return *this = State(other);
}

Instance::Instance(const std::string& resources, const std::string& token, bool logs, Log log)
  : log_(std::move(log)), token_(token), unit_(openUnit(folderOf(resources), token))
{
  logs_.fill(logs);
  reset();
}

void Instance::log(Status status, const std::string& message) const noexcept
{
  if (log_ && logs_[categoryOf(status)])
  {
    log_(status, LOG_CATEGORIES[categoryOf(status)], message);
  }
}

void Instance::setLogging(bool on, std::size_t count, const char* const* categories)
{
  for (std::size_t i = 0; i < logs_.size(); ++i)
  {
    const auto is_this = [i](const char* category)
    { return category != nullptr && std::string(category) == LOG_CATEGORIES[i]; };
    logs_[i] = on && (count == 0 || std::any_of(categories, categories + count, is_this));
  }
}

void Instance::requireMode(bool allowed, const char* call, const char* what) const
{
  constexpr const char* NAMES[]{ "Instantiated", "Initialization Mode", "Step Mode", "Terminated" };
  if (!allowed)
  {
    throw CallError(std::string(call) + what + " is not allowed in state " + NAMES[static_cast<int>(state_.mode)]);
  }
}

void Instance::setUp(double start, std::optional<double> stop)
{
  requireMode(state_.mode == Mode::INSTANTIATED, "setting startTime");
  if (!(std::abs(start) <= LARGEST_TIME) || (stop && !(*stop >= start)))
  {
    throw CallError("startTime = " + numberText(start) + " [s]" +
                    (stop ? ", stopTime = " + numberText(*stop) + " [s]" : std::string()) +
                    " out of range, allowed: a start from -1e9 to 1e9 and a stop that is not before the start");
  }
  state_.start = start;
  state_.time = start;
  state_.stop = stop;
}

void Instance::enterInitialization()
{
  requireMode(state_.mode == Mode::INSTANTIATED, "EnterInitializationMode");
  state_.mode = Mode::INITIALIZATION;
}

void Instance::exitInitialization()
{
  requireMode(state_.mode == Mode::INITIALIZATION, "ExitInitializationMode");
  start();
  state_.mode = Mode::STEP;
}

void Instance::terminate()
{
  requireMode(state_.mode == Mode::STEP, "Terminate");
  state_.mode = Mode::TERMINATED;
}

void Instance::reset()
{
  state_ = {};
  state_.journal = Journal(unit_->variables());
  for (const FmuVariable& variable : unit_->variables())
  {
    state_.values.push_back(variable.start);
  }
}

Instance::Elements Instance::elements(Type type, const References& of, std::size_t place) const
{
  const ValueReference reference = of.references[place];
  const bool is_element = of.version == Version::FMI_2;
  const std::size_t variable = is_element ? reference & ((1u << ELEMENT_SHIFT) - 1) : reference;
  const std::size_t first = is_element ? reference >> ELEMENT_SHIFT : 0;
  const auto& variables = unit_->variables();
  const std::size_t size = variable >= variables.size()             ? 0 :
                           variables[variable].type == Type::STRING ? 1 :
                                                                      state_.values[variable].numbers.size();
  if (first >= size)
  {
    throw CallError("no variable has the value reference " + std::to_string(reference));
  }
  if (variables[variable].type != type)
  {
    throw CallError(variables[variable].name + " does not have the type that the function reads or writes");
  }
  return { variable, first, is_element ? first + 1 : size };
}

void Instance::requireCount(Type type, const References& of) const
{
  std::size_t expected = 0;
  for (std::size_t i = 0; i < of.size; ++i)
  {
    const Elements asked = elements(type, of, i);
    expected += asked.end - asked.begin;
  }
  if (of.values != expected)
  {
    throw CallError(std::to_string(of.values) + " values for variables that have " + std::to_string(expected) +
                    " elements");
  }
}

void Instance::requireSettable(const FmuVariable& variable) const
{
  const bool before_start = state_.mode == Mode::INSTANTIATED || state_.mode == Mode::INITIALIZATION;
  const bool settable = variable.causality == Causality::PARAMETER ?
                            before_start :
                            variable.causality == Causality::INPUT && (before_start || state_.mode == Mode::STEP);
  requireMode(settable, "setting ", variable.name.c_str());
}

void Instance::check(const FmuVariable& variable, std::size_t element, double value)
{
  const bool in_range = !variable.range || (value >= variable.range->min && value <= variable.range->max);
  if (!std::isfinite(value) || !(in_range || variable.is_clamped))
  {
    throw CallError(nameAndValue(variable, element, value) + " out of range, allowed: " +
                    (variable.range && !variable.is_clamped ? rangeText(*variable.range) : "finite numbers"));
  }
}

/// Sets numbers. The function checks all numbers before it sets the first one.
void Instance::setNumbers(Type type, const References& of, const std::function<double(std::size_t)>& number)
{
  requireCount(type, of);
  std::size_t place = 0;
  for (std::size_t i = 0; i < of.size; ++i)
  {
    const Elements target = elements(type, of, i);
    const FmuVariable& variable = unit_->variables()[target.variable];
    requireSettable(variable);
    for (std::size_t k = target.begin; k < target.end; ++k)
    {
      check(variable, k, number(place++));
    }
  }
  place = 0;
  bool differs = false;
  for (std::size_t i = 0; i < of.size; ++i)
  {
    const Elements target = elements(type, of, i);
    for (std::size_t k = target.begin; k < target.end; ++k)
    {
      double& element = state_.values[target.variable].numbers[k];
      const double before = std::exchange(element, number(place++));
      differs = differs || element != before;
    }
  }
  changed(differs);
}

void Instance::setTexts(const References& of, const char* const* texts)
{
  requireCount(Type::STRING, of);
  for (std::size_t i = 0; i < of.size; ++i)
  {
    const FmuVariable& target = unit_->variables()[elements(Type::STRING, of, i).variable];
    requireSettable(target);
    if (texts[i] == nullptr)
    {
      throw CallError(target.name + " must be a null pointer");
    }
  }
  bool differs = false;
  for (std::size_t i = 0; i < of.size; ++i)
  {
    std::string& text = state_.values[elements(Type::STRING, of, i).variable].text;
    differs = text != texts[i] || differs;
    text = texts[i];
  }
  changed(differs);
}

/// Must be called after values were set. `differs`: whether a value changed. Before the start, a changed value needs a
/// new simulation. Inputs that are set later act with the next step.
void Instance::changed(bool differs)
{
  if (differs && state_.mode != Mode::STEP)
  {
    state_.simulation.reset();
  }
}

/// Updates the value of a variable. @returns false if the value stays that of an earlier instant.
bool Instance::update(std::size_t reference)
{
  const FmuVariable& asked = unit_->variables()[reference];
  if (asked.causality == Causality::INDEPENDENT)
  {
    state_.values[reference].numbers[0] = state_.time;
  }
  if (asked.causality == Causality::OUTPUT)
  {
    requireMode(state_.mode != Mode::INSTANTIATED, "getting ", asked.name.c_str());
    start();
    if (state_.simulation->marks(reference))
    {
      state_.journal.read(reference);
    }
    if (!state_.simulation->read(reference, state_.values))
    {
      log(Status::WARNING, asked.name + ": the solver found no equilibrium of all teeth at " + numberText(state_.time) +
                               " [s]; the value is that of an earlier instant");
      return false;
    }
  }
  return true;
}

Notice Instance::notice() const
{
  return [this](const std::string& what) { log(Status::OK, what); };
}

void Instance::start()
{
  if (!state_.simulation)
  {
    state_.unit = unit_;
    state_.simulation = unit_->start(state_.values, state_.start, notice());
    state_.journal.begin(state_.values);
  }
}

bool Instance::step(double at, double length)
{
  requireMode(state_.mode == Mode::STEP, "DoStep");
  const double tolerance = 1e-9 * std::max(1.0, std::abs(state_.time));
  const double end = at + length;
  const auto asked = [&]
  {
    return "currentCommunicationPoint = " + numberText(at) + " [s], communicationStepSize = " + numberText(length) +
           " [s]: ";
  };
  if (!(std::abs(at - state_.time) <= tolerance))
  {
    throw CallError(asked() + "a step must begin at the present time of the instance, " + numberText(state_.time) +
                    " [s]");
  }
  if (!(length > 0.0) || !(end <= LARGEST_TIME))
  {
    throw CallError(asked() + "a step must be longer than 0 and end before 1e9 [s]");
  }
  if (state_.stop && end > *state_.stop + tolerance)
  {
    throw CallError(asked() + "the step would end after the stop time; the stop time is " + numberText(*state_.stop) +
                    " [s]");
  }
  state_.journal.step(state_.values, end);
  const bool converged = state_.simulation->step(state_.values, end);
  state_.time = end;
  return converged;
}

/// The bytes contain the outputs too, because an output that cannot be computed has the value of an earlier instant.
std::string Instance::serialised(const State& state) const
{
  std::string body;
  putText(body, token_);
  putNumber(body, static_cast<int>(state.mode));
  putNumber(body, state.start);
  putNumber(body, state.time);
  putNumber(body, state.stop.value_or(NO_STOP));
  for (const Value& value : state.values)
  {
    for (const double number : value.numbers)
    {
      putNumber(body, number);
    }
    putText(body, value.text);
  }
  putNumber(body, state.simulation != nullptr ? 1 : 0);
  if (state.simulation)
  {
    body += state.journal.bytes();
  }
  std::string bytes;
  putNumber(bytes, textHash(body));
  return bytes + body;
}

std::unique_ptr<Instance::State> Instance::deserialised(std::string_view bytes) const
{
  ByteReader whole(bytes);
  const auto hash = whole.number<std::uint64_t>();
  const std::string_view body = whole.rest();
  if (hash != textHash(body))
  {
    throw InputError("a serialised state is incomplete or damaged");
  }
  ByteReader reader(body);
  if (const std::string_view token = reader.text(); token != token_)
  {
    throw InputError("a serialised state belongs to the unit '" + std::string(token) + "', but this unit is '" +
                     token_ + "'");
  }
  auto state = std::make_unique<State>();
  state->mode = static_cast<Mode>(std::clamp(reader.number<int>(), 0, static_cast<int>(Mode::TERMINATED)));
  state->start = reader.number<double>();
  state->time = reader.number<double>();
  const auto stop = reader.number<double>();
  state->stop = stop < NO_STOP ? std::optional(stop) : std::nullopt;
  for (const FmuVariable& variable : unit_->variables())
  {
    Value& value = state->values.emplace_back(variable.start);
    for (double& number : value.numbers)
    {
      number = reader.number<double>();
    }
    value.text = reader.text();
  }
  state->journal = Journal(unit_->variables());
  if (reader.number<int>() != 0)
  {
    state->unit = unit_;
    state->simulation =
        state->journal.replay(reader.rest(), *unit_, state->values, state->start, state->time, notice());
  }
  return state;
}
}  // namespace hjt::fmu
