// SPDX-License-Identifier: BSD-3-Clause
#include <type_traits>

#include "base/text_hash.hpp"
#include "harmonic_joint_twin/params/parameter_map.hpp"
#include "params/field_table.hpp"

namespace hjt
{
namespace
{
/// Hashes the values of the requested fields; their order stands for their keys.
class FieldHasher
{
public:
  explicit FieldHasher(bool surface_only) : surface_only_(surface_only) {}

  template <class T>
  void operator()(const std::string&, const char*, const T& value, const Range&, const Meaning& meaning)
  {
    add(value, meaning);
  }

  template <class T>
  void operator()(const std::string&, const T& value, const Meaning& meaning)
  {
    add(value, meaning);
  }

  void add(const std::vector<Fault>& faults)
  {
    for (const Fault& fault : faults)
    {
      addBytes(fault.kind);
      addBytes(fault.severity);
      addBytes(fault.place);
      addBytes(fault.onset);
    }
  }

  std::uint64_t hash() const { return hash_; }

private:
  template <class T>
  void add(const T& value, const Meaning& meaning)
  {
    if (surface_only_ && meaning.shapes == Shapes::OTHERS)
    {
      return;
    }
    if constexpr (std::is_same_v<T, std::string>)
    {
      hash_ = textHash(value, hash_);
      addBytes(value.size());
    }
    else
    {
      addBytes(value);
    }
  }

  template <class T>
  void addBytes(const T& value)
  {
    static_assert(std::is_trivially_copyable_v<T>);
    hash_ = textHash({ reinterpret_cast<const char*>(&value), sizeof(value) }, hash_);
  }

  bool surface_only_;
  std::uint64_t hash_{ textHash("") };
};
}  // namespace

std::uint64_t parametersHash(const Parameters& parameters)
{
  FieldHasher hasher(false);
  visitFields(parameters, hasher);
  hasher.add(parameters.faults);
  return hasher.hash();
}

std::uint64_t surfaceParametersHash(const Parameters& parameters)
{
  FieldHasher hasher(true);
  visitFields(parameters, hasher);
  hasher.add(parameters.faults);
  return hasher.hash();
}
}  // namespace hjt
