// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace hjt
{
/// Pseudo-random words as a function of counter and key: Philox 4x32 with 10 rounds.
/// Source: Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC 2011.
constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key)
{
  for (int round = 0; round < 10; ++round)
  {
    const std::uint64_t even = std::uint64_t{ 0xD2511F53 } * counter[0];
    const std::uint64_t odd = std::uint64_t{ 0xCD9E8D57 } * counter[2];
    counter = { static_cast<std::uint32_t>(odd >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(odd),
                static_cast<std::uint32_t>(even >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(even) };
    key = { key[0] + 0x9E3779B9, key[1] + 0xBB67AE85 };
  }
  return counter;
}

/// Sequence of random words for one counter and key, for distributions of the standard library and Boost. The sequence
/// ends after 2^34 words.
class PhiloxStream
{
public:
  using result_type = std::uint32_t;

  /// The last word of the counter, which is not an argument, counts the blocks of the sequence.
  PhiloxStream(const std::array<std::uint32_t, 3>& counter, const std::array<std::uint32_t, 2>& key)
    : counter_{ counter[0], counter[1], counter[2], 0 }, key_(key)
  {
  }

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()()
  {
    if (left_ == 0)
    {
      words_ = philox(counter_, key_);
      ++counter_[3];
      left_ = words_.size();
    }
    return words_[--left_];
  }

private:
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> words_{};
  std::size_t left_ = 0;
};
}  // namespace hjt
