// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cfenv>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "fmu/fmi.hpp"
#include "fmu/instance.hpp"

/// Functions that FMI 2.0 and 3.0 have in common. An exception of an instance becomes an error status and a message in
/// the importer's log. Nothing is printed.
namespace hjt::fmu
{
/// Sets the default floating-point environment while it lives. That of the importer may trap or flush denormal numbers.
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

/// Calls `call` with the instance. @returns a status: a warning if `call` returns false, an error if the instance is
/// null or `call` throws.
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
    instance->log(Status::ERROR, "the call failed for an unknown reason");
  }
  return Status::ERROR;
}

inline Status refuse(Instance* instance, const char* name) noexcept
{
  return guarded(instance, [&](Instance&) { throw CallError(std::string(name) + " is not supported by this unit"); });
}

/// A new instance. After a failure: null, with a message even if logging is off. `check` throws for an invalid call.
template <class Check>
Instance* instantiated(const char* token, const char* resources, bool logs, const Log& log, const Check& check) noexcept
{
  try
  {
    const UsualArithmetic arithmetic;
    check();
    for (const char* text : { token, resources })
    {
      if (text == nullptr)
      {
        throw CallError("token or path of the resources is a null pointer");
      }
    }
    return std::make_unique<Instance>(resources, token, logs, log).release();
  }
  catch (const std::exception& error)
  {
    if (log)
    {
      log(Status::ERROR, LOG_CATEGORIES[1], error.what());
    }
  }
  catch (...)  // an exception must not leave the unit
  {
  }
  return nullptr;
}

/// Text with each of `letters` doubled, because these letters have a meaning in an importer's log.
inline std::string doubled(const std::string& text, const char* letters)
{
  std::string found;
  for (const char letter : text)
  {
    found.append(std::string(letters).find(letter) != std::string::npos ? 2 : 1, letter);
  }
  return found;
}

template <class Pointer>
void require(Pointer pointer, const char* name)
{
  if (pointer == nullptr)
  {
    throw CallError(std::string(name) + " is a null pointer");
  }
}

inline void requireArrays(const References& of, const void* values)
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

inline Status getTexts(Instance* instance, const References& of, const char** values) noexcept
{
  return guarded(instance,
                 [&](Instance& self)
                 {
                   requireArrays(of, values);
                   return self.get(Type::STRING, of,
                                   [&](std::size_t place, double, const std::string& text)
                                   { values[place] = text.c_str(); });
                 });
}

inline Status setTexts(Instance* instance, const References& of, const char* const* values) noexcept
{
  return guarded(instance,
                 [&](Instance& self)
                 {
                   requireArrays(of, values);
                   self.setTexts(of, values);
                 });
}

inline Status setLogging(Instance* instance, bool on, std::size_t count, const char* const* categories) noexcept
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

inline Status getState(Instance* instance, Instance::State** state) noexcept
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

inline Status setState(Instance* instance, const Instance::State* state) noexcept
{
  return guarded(instance,
                 [&](Instance& self)
                 {
                   require(state, "FMUState");
                   self.takeUp(*state);
                 });
}

inline Status freeState(Instance* instance, Instance::State** state) noexcept
{
  return guarded(instance,
                 [&](Instance&)
                 {
                   require(state, "FMUState");
                   const std::unique_ptr<Instance::State> freed(*state);
                   *state = nullptr;
                 });
}

inline Status serialisedSize(Instance* instance, const Instance::State* state, std::size_t* size) noexcept
{
  return guarded(instance,
                 [&](Instance& self)
                 {
                   require(state, "FMUState");
                   require(size, "size");
                   *size = self.serialised(*state).size();
                 });
}

inline Status serialise(Instance* instance, const Instance::State* state, unsigned char* bytes,
                        std::size_t size) noexcept
{
  return guarded(instance,
                 [&](Instance& self)
                 {
                   require(state, "FMUState");
                   require(bytes, "serializedState");
                   const std::string found = self.serialised(*state);
                   if (size != found.size())
                   {
                     throw CallError("size = " + std::to_string(size) + " [bytes], but the state has " +
                                     std::to_string(found.size()) + " bytes");
                   }
                   std::memcpy(bytes, found.data(), size);
                 });
}

inline Status deserialise(Instance* instance, const unsigned char* bytes, std::size_t size,
                          Instance::State** state) noexcept
{
  return guarded(instance,
                 [&](Instance& self)
                 {
                   require(bytes, "serializedState");
                   require(state, "FMUState");
                   *state = self.deserialised({ reinterpret_cast<const char*>(bytes), size }).release();
                 });
}

/// Does the importer's step from `at` over `length` [s]. @returns false if the twin kept its last converged state.
inline bool doStep(Instance& instance, double at, double length)
{
  const bool converged = instance.step(at, length);
  if (!converged)
  {
    instance.log(Status::WARNING, "a step had no equilibrium; the unit keeps its last converged state");
  }
  return converged;
}
}  // namespace hjt::fmu
