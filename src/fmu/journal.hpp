// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "fmu/unit.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt::fmu
{
/// Appends a number, no truth value, as this machine has it.
template <class Number>
void putNumber(std::string& bytes, Number number)
{
  static_assert(std::is_arithmetic_v<Number> && !std::is_same_v<Number, bool>);
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

inline void putText(std::string& bytes, std::string_view text)
{
  putNumber(bytes, static_cast<std::uint64_t>(text.size()));
  bytes.append(text);
}

/// Takes from the front what was put. @throws InputError where less is left.
class ByteReader
{
public:
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}

  template <class Number>
  Number number()
  {
    Number found;
    std::memcpy(&found, take(sizeof found).data(), sizeof found);
    return found;
  }
  std::string_view text() { return take(number<std::uint64_t>()); }
  std::string_view rest() const noexcept { return left_; }
  bool empty() const noexcept { return left_.empty(); }

private:
  std::string_view take(std::uint64_t size)
  {
    if (size > left_.size())
    {
      throw InputError("a serialised state ends too early");
    }
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }

  std::string_view left_;
};

/// All that a simulation was told since its start: inputs, steps, and reads that change what comes. Told again, another
/// one comes to the same bits. It takes the time that the simulation took.
class Journal
{
public:
  static constexpr std::size_t MOST = 64u << 20;  ///< [bytes]

  Journal() = default;
  explicit Journal(const std::vector<FmuVariable>& variables);

  void begin(const Values& values);
  void step(const Values& values, double end);  ///< end: [s]. Allocates once in CHUNK bytes.
  void read(std::size_t reference);

  /// @throws InputError if there was more than MOST.
  std::string bytes() const;

  /// Becomes the journal of these bytes and has a simulation of `unit` do what it says. `values`: parameters, and the
  /// inputs that are to be replaced. `end`: of the last step, or `start` [s]. @throws InputError if the bytes are no
  /// journal of this unit that ends there; ParameterError as Unit::start.
  std::unique_ptr<Simulation> replay(std::string_view bytes, const Unit& unit, Values values, double start, double end,
                                     const Notice& notice);

private:
  static constexpr std::size_t CHUNK = 64u << 10;  // [bytes]

  template <class Put>
  void forInputs(const Values& values, const Put& put);
  void make(std::size_t room);

  std::vector<std::size_t> inputs_;                       // their references
  std::vector<double> given_;                             // their numbers at the last step
  std::vector<std::shared_ptr<const std::string>> full_;  // shared by copies
  std::string last_;
  bool is_too_long_{};
};
}  // namespace hjt::fmu
