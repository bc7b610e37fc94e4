// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace hjt
{
/// Cosine and sine of many multiples of one angle. A multiple that is the sum or the difference of two earlier ones, up
/// to rounding, takes the product of their rotations in place of a sine and a cosine.
template <std::size_t COUNT>
class AngleMultiples
{
public:
  explicit AngleMultiples(const std::array<double, COUNT>& multiples)
  {
    for (std::size_t k = 0; k < COUNT; ++k)
    {
      rules_[k] = rule(multiples, k);
    }
  }

  /// `rotations`: cosine and sine of each multiple, one after the other.
  void at(double angle, double* rotations) const noexcept
  {
    for (std::size_t k = 0; k < COUNT; ++k)
    {
      const Rule& rule = rules_[k];
      const double* a = rotations + 2 * rule.first;
      const double* b = rotations + 2 * rule.second;
      double* to = rotations + 2 * k;
      if (rule.sign == 0.0)
      {
        to[0] = std::cos(rule.multiple * angle);
        to[1] = std::sin(rule.multiple * angle);
        continue;
      }
      const double sine = rule.sign * b[1];
      to[0] = a[0] * b[0] - a[1] * sine;
      to[1] = a[1] * b[0] + a[0] * sine;
    }
  }

private:
  struct Rule
  {
    double multiple{};
    std::size_t first{};
    std::size_t second{};
    double sign{};  // of the second; 0: of no other two
  };

  static Rule rule(const std::array<double, COUNT>& multiples, std::size_t k)
  {
    constexpr double ROUNDING = 1e-14;
    const double multiple = multiples[k];
    for (std::size_t i = 0; i < k; ++i)
    {
      for (std::size_t j = 0; j < k; ++j)
      {
        for (const double sign : { 1.0, -1.0 })
        {
          if (std::abs(multiples[i] + sign * multiples[j] - multiple) <= ROUNDING * std::abs(multiple))
          {
            return { multiple, i, j, sign };
          }
        }
      }
    }
    return { multiple, 0, 0, 0.0 };
  }

  std::array<Rule, COUNT> rules_;
};
}  // namespace hjt
