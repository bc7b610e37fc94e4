// SPDX-License-Identifier: BSD-3-Clause
/// C functions of FMI 3.0 for co-simulation. The standard gives names, arguments and order of calls.

#include <cstdint>
#include <optional>

#include "fmu/calls.hpp"

namespace hjt::fmu
{
namespace
{
using LogMessage = void (*)(void* environment, Status status, const char* category, const char* message);

/// Log for an instance. It doubles each `#` of a message, because `#` would begin a value reference.
Log logOf(LogMessage log, void* environment)
{
  if (log == nullptr)
  {
    return {};
  }
  return [=](Status status, const char* category, const std::string& message)
  { log(environment, status, category, doubled(message, "#").c_str()); };
}

References arrays(const ValueReference* references, std::size_t size, std::size_t values)
{
  return { references, size, values, Version::FMI_3 };
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
    return setLogging(instance, on, count, categories);
  }

  Instance* fmi3InstantiateCoSimulation(const char* name, const char* token, const char* resources, bool, bool logs,
                                        bool event_mode, bool, const ValueReference*, std::size_t intermediate,
                                        void* environment, LogMessage log, void*)
  {
    return instantiated(
        token, resources, logs, logOf(log, environment),
        [&]
        {
          require(name, "instanceName");
          if (event_mode || intermediate > 0)
          {
            throw CallError("this unit supports neither eventModeUsed nor requiredIntermediateVariables");
          }
        });
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
    return guarded(instance,
                   [&](Instance& self)
                   {
                     self.setUp(start, stop_defined ? std::optional(stop) : std::nullopt);
                     self.enterInitialization();
                   });
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
    return getNumbers(instance, Type::FLOAT64, arrays(references, references_count, count), values);
  }
  Status fmi3GetInt32(Instance* instance, const ValueReference* references, std::size_t references_count,
                      std::int32_t* values, std::size_t count)
  {
    return getNumbers(instance, Type::INT32, arrays(references, references_count, count), values);
  }
  Status fmi3GetBoolean(Instance* instance, const ValueReference* references, std::size_t references_count,
                        bool* values, std::size_t count)
  {
    return getNumbers(instance, Type::BOOLEAN, arrays(references, references_count, count), values);
  }
  Status fmi3GetString(Instance* instance, const ValueReference* references, std::size_t references_count,
                       const char** values, std::size_t count)
  {
    return getTexts(instance, arrays(references, references_count, count), values);
  }

  Status fmi3SetFloat64(Instance* instance, const ValueReference* references, std::size_t references_count,
                        const double* values, std::size_t count)
  {
    return setNumbers(instance, Type::FLOAT64, arrays(references, references_count, count), values);
  }
  Status fmi3SetInt32(Instance* instance, const ValueReference* references, std::size_t references_count,
                      const std::int32_t* values, std::size_t count)
  {
    return setNumbers(instance, Type::INT32, arrays(references, references_count, count), values);
  }
  Status fmi3SetBoolean(Instance* instance, const ValueReference* references, std::size_t references_count,
                        const bool* values, std::size_t count)
  {
    return setNumbers(instance, Type::BOOLEAN, arrays(references, references_count, count), values);
  }
  Status fmi3SetString(Instance* instance, const ValueReference* references, std::size_t references_count,
                       const char* const* values, std::size_t count)
  {
    return setTexts(instance, arrays(references, references_count, count), values);
  }

  Status fmi3GetFMUState(Instance* instance, Instance::State** state)
  {
    return getState(instance, state);
  }
  Status fmi3SetFMUState(Instance* instance, const Instance::State* state)
  {
    return setState(instance, state);
  }
  Status fmi3FreeFMUState(Instance* instance, Instance::State** state)
  {
    return freeState(instance, state);
  }

  Status fmi3SerializedFMUStateSize(Instance* instance, const Instance::State* state, std::size_t* size)
  {
    return serialisedSize(instance, state, size);
  }
  Status fmi3SerializeFMUState(Instance* instance, const Instance::State* state, unsigned char* bytes, std::size_t size)
  {
    return serialise(instance, state, bytes, size);
  }
  Status fmi3DeserializeFMUState(Instance* instance, const unsigned char* bytes, std::size_t size,
                                 Instance::State** state)
  {
    return deserialise(instance, bytes, size, state);
  }

  Status fmi3DoStep(Instance* instance, double at, double length, bool, bool* event_needed, bool* terminate,
                    bool* early_return, double* last_time)
  {
    return guarded(instance,
                   [&](Instance& self)
                   {
                     for (bool* flag : { event_needed, terminate, early_return })
                     {
                       require(flag, "a result argument of fmi3DoStep");
                       *flag = false;
                     }
                     require(last_time, "lastSuccessfulTime");
                     *last_time = self.time();
                     const bool converged = doStep(self, at, length);
                     *last_time = self.time();
                     return converged;
                   });
  }

  // Functions that this unit does not support. They ignore their arguments and return an error.
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
