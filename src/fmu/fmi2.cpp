// SPDX-License-Identifier: BSD-3-Clause
/// C functions of FMI 2.0 for co-simulation. The standard gives names, arguments and order of calls. In FMI 2.0, truth
/// values are integers, and each element of an array is a variable.

#include <optional>

#include "fmu/calls.hpp"

namespace hjt::fmu
{
namespace
{
struct Callbacks
{
  void (*log)(void* environment, const char* instance, Status status, const char* category, const char* message, ...);
  void* (*allocate)(std::size_t count, std::size_t size);
  void (*free)(void* memory);
  void (*step_finished)(void* environment, Status status);
  void* environment;
};

/// Log for an instance. FMI 2.0 takes a message as a format string, in which `#` begins a value reference.
Log logOf(const Callbacks* callbacks, const char* name)
{
  if (callbacks == nullptr || callbacks->log == nullptr || name == nullptr)
  {
    return {};
  }
  return [log = callbacks->log, environment = callbacks->environment, instance = std::string(name)](
             Status status, const char* category, const std::string& message)
  { log(environment, instance.c_str(), status, category, doubled(message, "#%").c_str()); };
}

References scalars(const ValueReference* references, std::size_t size)
{
  return { references, size, size, Version::FMI_2 };
}
}  // namespace

extern "C"
{
  const char* fmi2GetTypesPlatform()
  {
    return "default";
  }
  const char* fmi2GetVersion()
  {
    return "2.0";
  }

  Status fmi2SetDebugLogging(Instance* instance, int on, std::size_t count, const char* const* categories)
  {
    return setLogging(instance, on != 0, count, categories);
  }

  Instance* fmi2Instantiate(const char* name, int type, const char* token, const char* resources,
                            const Callbacks* callbacks, int, int logs)
  {
    return instantiated(token, resources, logs != 0, logOf(callbacks, name),
                        [&]
                        {
                          constexpr int CO_SIMULATION = 1;
                          require(name, "instanceName");
                          if (type != CO_SIMULATION)
                          {
                            throw CallError("fmuType must be co-simulation, because this unit supports nothing else");
                          }
                        });
  }
  void fmi2FreeInstance(Instance* instance)
  {
    const std::unique_ptr<Instance> freed(instance);
  }

  Status fmi2SetupExperiment(Instance* instance, int, double, double start, int stop_defined, double stop)
  {
    return guarded(instance,
                   [&](Instance& self) { self.setUp(start, stop_defined != 0 ? std::optional(stop) : std::nullopt); });
  }
  Status fmi2EnterInitializationMode(Instance* instance)
  {
    return guarded(instance, [](Instance& self) { self.enterInitialization(); });
  }
  Status fmi2ExitInitializationMode(Instance* instance)
  {
    return guarded(instance, [](Instance& self) { self.exitInitialization(); });
  }
  Status fmi2Terminate(Instance* instance)
  {
    return guarded(instance, [](Instance& self) { self.terminate(); });
  }
  Status fmi2Reset(Instance* instance)
  {
    return guarded(instance, [](Instance& self) { self.reset(); });
  }

  Status fmi2GetReal(Instance* instance, const ValueReference* references, std::size_t count, double* values)
  {
    return getNumbers(instance, Type::FLOAT64, scalars(references, count), values);
  }
  Status fmi2GetInteger(Instance* instance, const ValueReference* references, std::size_t count, int* values)
  {
    return getNumbers(instance, Type::INT32, scalars(references, count), values);
  }
  Status fmi2GetBoolean(Instance* instance, const ValueReference* references, std::size_t count, int* values)
  {
    return getNumbers(instance, Type::BOOLEAN, scalars(references, count), values);
  }
  Status fmi2GetString(Instance* instance, const ValueReference* references, std::size_t count, const char** values)
  {
    return getTexts(instance, scalars(references, count), values);
  }
  Status fmi2SetReal(Instance* instance, const ValueReference* references, std::size_t count, const double* values)
  {
    return setNumbers(instance, Type::FLOAT64, scalars(references, count), values);
  }
  Status fmi2SetInteger(Instance* instance, const ValueReference* references, std::size_t count, const int* values)
  {
    return setNumbers(instance, Type::INT32, scalars(references, count), values);
  }
  Status fmi2SetBoolean(Instance* instance, const ValueReference* references, std::size_t count, const int* values)
  {
    return setNumbers(instance, Type::BOOLEAN, scalars(references, count), values);
  }
  Status fmi2SetString(Instance* instance, const ValueReference* references, std::size_t count,
                       const char* const* values)
  {
    return setTexts(instance, scalars(references, count), values);
  }

  Status fmi2GetFMUstate(Instance* instance, Instance::State** state)
  {
    return getState(instance, state);
  }
  Status fmi2SetFMUstate(Instance* instance, const Instance::State* state)
  {
    return setState(instance, state);
  }
  Status fmi2FreeFMUstate(Instance* instance, Instance::State** state)
  {
    return freeState(instance, state);
  }

  Status fmi2SerializedFMUstateSize(Instance* instance, const Instance::State* state, std::size_t* size)
  {
    return serialisedSize(instance, state, size);
  }
  Status fmi2SerializeFMUstate(Instance* instance, const Instance::State* state, unsigned char* bytes, std::size_t size)
  {
    return serialise(instance, state, bytes, size);
  }
  Status fmi2DeSerializeFMUstate(Instance* instance, const unsigned char* bytes, std::size_t size,
                                 Instance::State** state)
  {
    return deserialise(instance, bytes, size, state);
  }

  Status fmi2DoStep(Instance* instance, double at, double length, int)
  {
    return guarded(instance, [&](Instance& self) { return doStep(self, at, length); });
  }
  Status fmi2GetRealStatus(Instance* instance, int kind, double* value)
  {
    constexpr int LAST_SUCCESSFUL_TIME = 2;
    if (kind != LAST_SUCCESSFUL_TIME)
    {
      return Status::DISCARD;
    }
    return guarded(instance,
                   [&](Instance& self)
                   {
                     require(value, "value");
                     *value = self.time();
                   });
  }

  // Functions that this unit does not support. They ignore their arguments and return an error.
#define HJT_REFUSED(name)           \
  Status name(Instance* instance)   \
  {                                 \
    return refuse(instance, #name); \
  }
  HJT_REFUSED(fmi2GetDirectionalDerivative)
  HJT_REFUSED(fmi2SetRealInputDerivatives)
  HJT_REFUSED(fmi2GetRealOutputDerivatives)
  HJT_REFUSED(fmi2CancelStep)
  HJT_REFUSED(fmi2GetStatus)
  HJT_REFUSED(fmi2GetIntegerStatus)
  HJT_REFUSED(fmi2GetBooleanStatus)
  HJT_REFUSED(fmi2GetStringStatus)
#undef HJT_REFUSED
}
}  // namespace hjt::fmu
