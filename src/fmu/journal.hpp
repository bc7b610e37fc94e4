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
/// Appends the bytes of a number in the format of this machine. Truth values are excluded.
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

/// Reads numbers from the front of a text of bytes. Functions throw InputError if too few bytes are left.
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
      throw InputError("a serialised state is incomplete");
    }
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }

  std::string_view left_;
};

/// Record of everything that has determined a simulation since its start: inputs, steps, and readings that change later
/// results. A repetition gives bit-identical results and takes as long as the simulation did.
class Journal
{
public:
  static constexpr std::size_t MOST = 64u << 20;  ///< largest size of a serialised journal [bytes]

  Journal() = default;
  explicit Journal(const std::vector<FmuVariable>& variables);

  void begin(const Values& values);
  void step(const Values& values, double end);  ///< records a step to `end` [s]; allocates once in CHUNK bytes
  void read(std::size_t reference);

  /// The journal as bytes. @throws InputError if there are more than MOST bytes.
  std::string bytes() const;

  /// Replaces this journal by the journal in `bytes`, and repeats it with a new simulation of `unit`. `values`: the
  /// parameters; the journal replaces the inputs. `end`: end of the last step, or `start` without steps [s]. @throws
  /// InputError if the bytes are not a journal of this unit with this end, ParameterError as Unit::start does.
  std::unique_ptr<Simulation> replay(std::string_view bytes, const Unit& unit, Values values, double start, double end,
                                     const Notice& notice);

private:
  static constexpr std::size_t CHUNK = 64u << 10;  // size of a chunk [bytes]

  template <class Put>
  void forInputs(const Values& values, const Put& put);
  void make(std::size_t room);

  std::vector<std::size_t> inputs_;                       // value references of the inputs
  std::vector<double> given_;                             // values of the inputs at the last step
  std::vector<std::shared_ptr<const std::string>> full_;  // filled chunks, which copies share
  std::string last_;
  bool is_too_long_{};
};
}  // namespace hjt::fmu
