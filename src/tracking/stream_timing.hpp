// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hjt
{
/// How stamped rows arrive. Times in seconds from one zero.
struct StreamTimingReport
{
  std::uint64_t rows{};      ///< that brought something new
  std::uint64_t repeated{};  ///< with the stamp of the row before
  std::uint64_t backward{};  ///< with an earlier one
  std::uint64_t missing{};   ///< that the period would have had between two others
  double period{};           ///< between stamps, median of the last rows [s]
  double longest_gap{};      ///< between stamps [s]
  double offset{};  ///< reception less stamp, the smallest of the last rows: clocks' offset and shortest way [s]
  double jitter{};  ///< how far beyond it 95 of 100 rows stay [s]
};

/// Watches the stamps of a stream and when its rows arrive. Fixed memory; nothing allocates.
class StreamTiming
{
public:
  void reset() noexcept { *this = StreamTiming(); }

  void add(double time, double received) noexcept;

  StreamTimingReport report() const noexcept;

private:
  static constexpr std::size_t KEPT = 256;  // rows that medians are made of
  static constexpr std::size_t RENEW = 32;  // rows between two looks at the period

  std::size_t kept() const noexcept { return report_.rows < KEPT ? static_cast<std::size_t>(report_.rows) : KEPT; }

  StreamTimingReport report_;
  std::array<double, KEPT> intervals_{};
  std::array<double, KEPT> delays_{};
  double last_{};
};
}  // namespace hjt
