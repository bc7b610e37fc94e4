// SPDX-License-Identifier: BSD-3-Clause
/// FMI 3.0's C functions for co-simulation; names, arguments and the order of calls are the standard's. Whatever a
/// instance throws becomes fmi3Error and a message; nothing is printed.

#include <cfenv>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "fmu/fmi3.hpp"
#include "fmu/instance.hpp"

namespace hjt::fmu
{
namespace
{
/// The usual floating-point environment in place of the importer's, which may trap, or flush small numbers to zero.
class UsualArithmetic
{
public:
  UsualArithmetic() noexcept
  {
    std::fegetenv(&importers_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~UsualArithmetic() { std::fesetenv(&importers_); }
  UsualArithmetic(const UsualArithmetic&) = delete;
  UsualArithmetic& operator=(const UsualArithmetic&) = delete;

private:
  std::fenv_t importers_{};
};

/// What `call` does with the instance, as a status; false is a warning. A null instance is an error too.
template <class Call>
Status guarded(Instance* instance, const Call& call) noexcept
{
  if (instance == nullptr)
  {
    return Status::ERROR;
  }
  try
  {
    const UsualArithmetic arithmetic;
    if constexpr (std::is_void_v<decltype(call(*instance))>)
    {
      call(*instance);
      return Status::OK;
    }
    else
    {
      return call(*instance) ? Status::OK : Status::WARNING;
    }
  }
  catch (const std::exception& error)
  {
    instance->log(Status::ERROR, error.what());
  }
  catch (...)
  {
    instance->log(Status::ERROR, "failed without a reason");
  }
  return Status::ERROR;
}

Status refuse(Instance* instance, const char* name) noexcept
{
  return guarded(instance, [&](Instance&) { throw CallError(std::string(name) + ": this unit has none of it"); });
}

template <class Pointer>
void require(Pointer pointer, const char* name)
{
  if (pointer == nullptr)
  {
    throw CallError(std::string(name) + " is a null pointer");
  }
}

void requireArrays(const References& of, const void* values)
{
  if (of.size > 0)
  {
    require(of.references, "valueReferences");
    require(values, "values");
  }
}

template <class Number>
Status getNumbers(Instance* instance, Type type, const References& of, Number* values) noexcept
{
  return guarded(instance,
                 [&](Instance& self)
                 {
                   requireArrays(of, values);
                   return self.get(type, of,
                                   [&](std::size_t place, double number, const std::string&)
                                   { values[place] = static_cast<Number>(number); });
                 });
}

template <class Number>
Status setNumbers(Instance* instance, Type type, const References& of, const Number* values) noexcept
{
  return guarded(instance,
                 [&](Instance& self)
                 {
                   requireArrays(of, values);
                   self.setNumbers(type, of,
                                   [values](std::size_t place) { return static_cast<double>(values[place]); });
                 });
}
}  // namespace

extern "C"
{
  const char* fmi3GetVersion()
  {
    return "3.0";
  }

  Status fmi3SetDebugLogging(Instance* instance, bool on, std::size_t count, const char* const* categories)
  {
    return guarded(instance,
                   [&](Instance& self)
                   {
                     if (count > 0)
                     {
                       require(categories, "categories");
                     }
                     self.setLogging(on, count, categories);
                   });
  }

  Instance* fmi3InstantiateCoSimulation(const char* name, const char* token, const char* resources, bool, bool logs,
                                        bool event_mode, bool, const ValueReference*, std::size_t intermediate,
                                        void* environment, LogMessage log, void*)
  {
    try
    {
      const UsualArithmetic arithmetic;
      require(name, "instanceName");
      if (event_mode || intermediate > 0)
      {
        throw CallError("eventModeUsed and requiredIntermediateVariables: this unit has none of it");
      }
      require(token, "instantiationToken");
      require(resources, "resourcePath");
      return std::make_unique<Instance>(resources, token, logs, environment, log).release();
    }
    catch (const std::exception& error)
    {
      sendMessage(log, environment, Status::ERROR, error.what());  // whether logging is on or not
    }
    catch (...)  // nothing of C++ leaves the unit
    {
    }
    return nullptr;
  }
  Instance* fmi3InstantiateModelExchange()
  {
    return nullptr;
  }
  Instance* fmi3InstantiateScheduledExecution()
  {
    return nullptr;
  }

  void fmi3FreeInstance(Instance* instance)
  {
    const std::unique_ptr<Instance> freed(instance);
  }

  Status fmi3EnterInitializationMode(Instance* instance, bool, double, double start, bool stop_defined, double stop)
  {
    return guarded(instance, [&](Instance& self)
                   { self.enterInitialization(start, stop_defined ? std::optional(stop) : std::nullopt); });
  }
  Status fmi3ExitInitializationMode(Instance* instance)
  {
    return guarded(instance, [](Instance& self) { self.exitInitialization(); });
  }
  Status fmi3Terminate(Instance* instance)
  {
    return guarded(instance, [](Instance& self) { self.terminate(); });
  }
  Status fmi3Reset(Instance* instance)
  {
    return guarded(instance, [](Instance& self) { self.reset(); });
  }

  Status fmi3GetFloat64(Instance* instance, const ValueReference* references, std::size_t references_count,
                        double* values, std::size_t count)
  {
    return getNumbers(instance, Type::FLOAT64, { references, references_count, count }, values);
  }
  Status fmi3GetInt32(Instance* instance, const ValueReference* references, std::size_t references_count,
                      std::int32_t* values, std::size_t count)
  {
    return getNumbers(instance, Type::INT32, { references, references_count, count }, values);
  }
  Status fmi3GetBoolean(Instance* instance, const ValueReference* references, std::size_t references_count,
                        bool* values, std::size_t count)
  {
    return getNumbers(instance, Type::BOOLEAN, { references, references_count, count }, values);
  }
  Status fmi3GetString(Instance* instance, const ValueReference* references, std::size_t references_count,
                       const char** values, std::size_t count)
  {
    return guarded(instance,
                   [&](Instance& self)
                   {
                     const References of{ references, references_count, count };
                     requireArrays(of, values);
                     return self.get(Type::STRING, of,
                                     [&](std::size_t place, double, const std::string& text)
                                     { values[place] = text.c_str(); });
                   });
  }

  Status fmi3SetFloat64(Instance* instance, const ValueReference* references, std::size_t references_count,
                        const double* values, std::size_t count)
  {
    return setNumbers(instance, Type::FLOAT64, { references, references_count, count }, values);
  }
  Status fmi3SetInt32(Instance* instance, const ValueReference* references, std::size_t references_count,
                      const std::int32_t* values, std::size_t count)
  {
    return setNumbers(instance, Type::INT32, { references, references_count, count }, values);
  }
  Status fmi3SetBoolean(Instance* instance, const ValueReference* references, std::size_t references_count,
                        const bool* values, std::size_t count)
  {
    return setNumbers(instance, Type::BOOLEAN, { references, references_count, count }, values);
  }
  Status fmi3SetString(Instance* instance, const ValueReference* references, std::size_t references_count,
                       const char* const* values, std::size_t count)
  {
    return guarded(instance,
                   [&](Instance& self)
                   {
                     const References of{ references, references_count, count };
                     requireArrays(of, values);
                     self.setTexts(of, values);
                   });
  }

  Status fmi3GetFMUState(Instance* instance, Instance::State** state)
  {
    return guarded(instance,
                   [&](Instance& self)
                   {
                     require(state, "FMUState");
                     Instance::State copy = self.state();
                     if (*state == nullptr)
                     {
                       *state = std::make_unique<Instance::State>().release();
                     }
                     **state = std::move(copy);
                   });
  }
  Status fmi3SetFMUState(Instance* instance, const Instance::State* state)
  {
    return guarded(instance,
                   [&](Instance& self)
                   {
                     require(state, "FMUState");
                     self.takeUp(*state);
                   });
  }
  Status fmi3FreeFMUState(Instance* instance, Instance::State** state)
  {
    return guarded(instance,
                   [&](Instance&)
                   {
                     require(state, "FMUState");
                     const std::unique_ptr<Instance::State> freed(*state);
                     *state = nullptr;
                   });
  }

  Status fmi3DoStep(Instance* instance, double at, double length, bool, bool* event_needed, bool* terminate,
                    bool* early_return, double* last_time)
  {
    return guarded(instance,
                   [&](Instance& self)
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
                       self.log(Status::WARNING, "a step found no equilibrium: the last good state is held");
                     }
                     return converged;
                   });
  }

  // What this unit does not do; the arguments behind the instance are not looked at.
#define HJT_REFUSED(name)           \
  Status name(Instance* instance)   \
  {                                 \
    return refuse(instance, #name); \
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
