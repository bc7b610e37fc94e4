// SPDX-License-Identifier: BSD-3-Clause
/// FMI 3.0's C functions for co-simulation; names, arguments and the order of calls are the standard's. Whatever a
/// drive throws becomes fmi3Error and a message; nothing is printed.

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "fmu/drive.hpp"
#include "fmu/fmi3.hpp"

namespace hjt::fmu
{
namespace
{
constexpr const char* ERROR_CATEGORY = "logStatusError";

/// What `call` does with the drive, as a status; false is a warning. A null instance is an error too.
template <class Call>
Status guarded(Drive* drive, const Call& call) noexcept
{
  if (drive == nullptr)
  {
    return Status::ERROR;
  }
  try
  {
    if constexpr (std::is_void_v<decltype(call(*drive))>)
    {
      call(*drive);
      return Status::OK;
    }
    else
    {
      return call(*drive) ? Status::OK : Status::WARNING;
    }
  }
  catch (const std::exception& error)
  {
    drive->log(Status::ERROR, ERROR_CATEGORY, error.what());
  }
  catch (...)
  {
    drive->log(Status::ERROR, ERROR_CATEGORY, "failed without a reason");
  }
  return Status::ERROR;
}

Status refuse(Drive* drive, const char* name) noexcept
{
  return guarded(drive, [&](Drive&) { throw CallError(std::string(name) + ": this unit has none of it"); });
}

template <class Pointer>
void require(Pointer pointer, const char* name)
{
  if (pointer == nullptr)
  {
    throw CallError(std::string(name) + " is a null pointer");
  }
}

/// The variables and values of a call.
template <class Element>
struct Values
{
  const ValueReference* references;
  std::size_t references_count;
  Element* values;
  std::size_t count;

  void check() const
  {
    if (references_count > 0)
    {
      require(references, "valueReferences");
      require(values, "values");
    }
  }
};

template <class Number>
Status getNumbers(Drive* drive, Type type, const Values<Number>& to) noexcept
{
  return guarded(drive,
                 [&](Drive& self)
                 {
                   to.check();
                   self.get(type, to.references, to.references_count, to.count,
                            [&](std::size_t place, double number, const std::string&)
                            { to.values[place] = static_cast<Number>(number); });
                 });
}

template <class Number>
Status setNumbers(Drive* drive, Type type, const Values<const Number>& from) noexcept
{
  return guarded(drive,
                 [&](Drive& self)
                 {
                   from.check();
                   self.set(type, from.references, from.references_count, from.count,
                            [&](std::size_t place, Value& value, std::size_t element)
                            { value.numbers[element] = static_cast<double>(from.values[place]); });
                 });
}
}  // namespace

extern "C"
{
  const char* fmi3GetVersion()
  {
    return "3.0";
  }

  Status fmi3SetDebugLogging(Drive* drive, bool, std::size_t, const char* const*)
  {
    return guarded(drive, [](Drive&) {});
  }

  Drive* fmi3InstantiateCoSimulation(const char*, const char* token, const char* resources, bool, bool, bool, bool,
                                     const ValueReference*, std::size_t, void* environment, LogMessage log, void*)
  {
    try
    {
      require(token, "instantiationToken");
      require(resources, "resourcePath");
      return std::make_unique<Drive>(resources, token, environment, log).release();
    }
    catch (const std::exception& error)
    {
      if (log != nullptr)
      {
        log(environment, Status::ERROR, ERROR_CATEGORY, error.what());
      }
    }
    return nullptr;
  }
  Drive* fmi3InstantiateModelExchange()
  {
    return nullptr;
  }
  Drive* fmi3InstantiateScheduledExecution()
  {
    return nullptr;
  }

  void fmi3FreeInstance(Drive* drive)
  {
    const std::unique_ptr<Drive> freed(drive);
  }

  Status fmi3EnterInitializationMode(Drive* drive, bool, double, double start, bool stop_defined, double stop)
  {
    return guarded(drive, [&](Drive& self)
                   { self.enterInitialization(start, stop_defined ? std::optional(stop) : std::nullopt); });
  }
  Status fmi3ExitInitializationMode(Drive* drive)
  {
    return guarded(drive, [](Drive& self) { self.exitInitialization(); });
  }
  Status fmi3Terminate(Drive* drive)
  {
    return guarded(drive, [](Drive& self) { self.terminate(); });
  }
  Status fmi3Reset(Drive* drive)
  {
    return guarded(drive, [](Drive& self) { self.reset(); });
  }

  Status fmi3GetFloat64(Drive* drive, const ValueReference* references, std::size_t references_count, double* values,
                        std::size_t count)
  {
    return getNumbers<double>(drive, Type::FLOAT64, { references, references_count, values, count });
  }
  Status fmi3GetInt32(Drive* drive, const ValueReference* references, std::size_t references_count,
                      std::int32_t* values, std::size_t count)
  {
    return getNumbers<std::int32_t>(drive, Type::INT32, { references, references_count, values, count });
  }
  Status fmi3GetBoolean(Drive* drive, const ValueReference* references, std::size_t references_count, bool* values,
                        std::size_t count)
  {
    return getNumbers<bool>(drive, Type::BOOLEAN, { references, references_count, values, count });
  }
  Status fmi3GetString(Drive* drive, const ValueReference* references, std::size_t references_count,
                       const char** values, std::size_t count)
  {
    return guarded(drive,
                   [&](Drive& self)
                   {
                     Values<const char*>{ references, references_count, values, count }.check();
                     self.get(Type::STRING, references, references_count, count,
                              [&](std::size_t place, double, const std::string& text)
                              { values[place] = text.c_str(); });
                   });
  }

  Status fmi3SetFloat64(Drive* drive, const ValueReference* references, std::size_t references_count,
                        const double* values, std::size_t count)
  {
    return setNumbers<double>(drive, Type::FLOAT64, { references, references_count, values, count });
  }
  Status fmi3SetInt32(Drive* drive, const ValueReference* references, std::size_t references_count,
                      const std::int32_t* values, std::size_t count)
  {
    return setNumbers<std::int32_t>(drive, Type::INT32, { references, references_count, values, count });
  }
  Status fmi3SetBoolean(Drive* drive, const ValueReference* references, std::size_t references_count,
                        const bool* values, std::size_t count)
  {
    return setNumbers<bool>(drive, Type::BOOLEAN, { references, references_count, values, count });
  }
  Status fmi3SetString(Drive* drive, const ValueReference* references, std::size_t references_count,
                       const char* const* values, std::size_t count)
  {
    return guarded(drive,
                   [&](Drive& self)
                   {
                     Values<const char* const>{ references, references_count, values, count }.check();
                     self.set(Type::STRING, references, references_count, count,
                              [&](std::size_t place, Value& value, std::size_t)
                              {
                                require(values[place], "a text");
                                value.text = values[place];
                              });
                   });
  }

  Status fmi3GetFMUState(Drive* drive, Drive::State** state)
  {
    return guarded(drive,
                   [&](Drive& self)
                   {
                     require(state, "FMUState");
                     Drive::State copy = self.state();
                     if (*state == nullptr)
                     {
                       *state = std::make_unique<Drive::State>().release();
                     }
                     **state = std::move(copy);
                   });
  }
  Status fmi3SetFMUState(Drive* drive, const Drive::State* state)
  {
    return guarded(drive,
                   [&](Drive& self)
                   {
                     require(state, "FMUState");
                     self.takeUp(*state);
                   });
  }
  Status fmi3FreeFMUState(Drive* drive, Drive::State** state)
  {
    return guarded(drive,
                   [&](Drive&)
                   {
                     require(state, "FMUState");
                     const std::unique_ptr<Drive::State> freed(*state);
                     *state = nullptr;
                   });
  }

  Status fmi3DoStep(Drive* drive, double at, double length, bool, bool* event_needed, bool* terminate,
                    bool* early_return, double* last_time)
  {
    return guarded(drive,
                   [&](Drive& self)
                   {
                     for (bool* flag : { event_needed, terminate, early_return })
                     {
                       require(flag, "a result of fmi3DoStep");
                       *flag = false;
                     }
                     require(last_time, "lastSuccessfulTime");
                     *last_time = self.time();
                     const bool converged = self.step(at, length);
                     *last_time = self.time();
                     if (!converged)
                     {
                       self.log(Status::WARNING, "logStatusWarning",
                                "a step found no equilibrium: the last good state is held");
                     }
                     return converged;
                   });
  }

  // What this unit does not do; the arguments behind the instance are not looked at.
#define HJT_REFUSED(name)        \
  Status name(Drive* drive)      \
  {                              \
    return refuse(drive, #name); \
  }
  HJT_REFUSED(fmi3EnterEventMode)
  HJT_REFUSED(fmi3EnterStepMode)
  HJT_REFUSED(fmi3EnterConfigurationMode)
  HJT_REFUSED(fmi3ExitConfigurationMode)
  HJT_REFUSED(fmi3EvaluateDiscreteStates)
  HJT_REFUSED(fmi3UpdateDiscreteStates)
  HJT_REFUSED(fmi3GetFloat32)
  HJT_REFUSED(fmi3GetInt8)
  HJT_REFUSED(fmi3GetUInt8)
  HJT_REFUSED(fmi3GetInt16)
  HJT_REFUSED(fmi3GetUInt16)
  HJT_REFUSED(fmi3GetUInt32)
  HJT_REFUSED(fmi3GetInt64)
  HJT_REFUSED(fmi3GetUInt64)
  HJT_REFUSED(fmi3GetBinary)
  HJT_REFUSED(fmi3GetClock)
  HJT_REFUSED(fmi3SetFloat32)
  HJT_REFUSED(fmi3SetInt8)
  HJT_REFUSED(fmi3SetUInt8)
  HJT_REFUSED(fmi3SetInt16)
  HJT_REFUSED(fmi3SetUInt16)
  HJT_REFUSED(fmi3SetUInt32)
  HJT_REFUSED(fmi3SetInt64)
  HJT_REFUSED(fmi3SetUInt64)
  HJT_REFUSED(fmi3SetBinary)
  HJT_REFUSED(fmi3SetClock)
  HJT_REFUSED(fmi3GetNumberOfVariableDependencies)
  HJT_REFUSED(fmi3GetVariableDependencies)
  HJT_REFUSED(fmi3SerializedFMUStateSize)
  HJT_REFUSED(fmi3SerializeFMUState)
  HJT_REFUSED(fmi3DeserializeFMUState)
  HJT_REFUSED(fmi3GetDirectionalDerivative)
  HJT_REFUSED(fmi3GetAdjointDerivative)
  HJT_REFUSED(fmi3GetOutputDerivatives)
  HJT_REFUSED(fmi3GetIntervalDecimal)
  HJT_REFUSED(fmi3GetIntervalFraction)
  HJT_REFUSED(fmi3GetShiftDecimal)
  HJT_REFUSED(fmi3GetShiftFraction)
  HJT_REFUSED(fmi3SetIntervalDecimal)
  HJT_REFUSED(fmi3SetIntervalFraction)
  HJT_REFUSED(fmi3SetShiftDecimal)
  HJT_REFUSED(fmi3SetShiftFraction)
  HJT_REFUSED(fmi3EnterContinuousTimeMode)
  HJT_REFUSED(fmi3CompletedIntegratorStep)
  HJT_REFUSED(fmi3SetTime)
  HJT_REFUSED(fmi3SetContinuousStates)
  HJT_REFUSED(fmi3GetContinuousStateDerivatives)
  HJT_REFUSED(fmi3GetEventIndicators)
  HJT_REFUSED(fmi3GetContinuousStates)
  HJT_REFUSED(fmi3GetNominalsOfContinuousStates)
  HJT_REFUSED(fmi3GetNumberOfEventIndicators)
  HJT_REFUSED(fmi3GetNumberOfContinuousStates)
  HJT_REFUSED(fmi3ActivateModelPartition)
#undef HJT_REFUSED
}
}  // namespace hjt::fmu
