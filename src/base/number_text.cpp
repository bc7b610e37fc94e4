// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <clocale>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include <yaml-cpp/yaml.h>

namespace hjt
{
namespace
{
/// While this object exists, the C library reads and writes numbers of this thread with a decimal point, whatever the
/// locale of the program is. The object does not allocate.
class DecimalPoint
{
public:
  DecimalPoint() noexcept : before_(uselocale(plain())) {}
  DecimalPoint(const DecimalPoint&) = delete;
  DecimalPoint& operator=(const DecimalPoint&) = delete;
  ~DecimalPoint() { uselocale(before_); }

private:
  static locale_t plain() noexcept
  {
    static const locale_t PLAIN = newlocale(LC_ALL_MASK, "C", nullptr);  // exists in every C library
    return PLAIN;
  }

  locale_t before_;
};

/// A decimal number: digits times 10^exponent. If it has at most 15 digits and a small exponent, both factors are exact
/// as a double. Then one rounding gives the nearest double (Clinger 1990), as in the C library.
struct Decimal
{
  static constexpr int FAR = 100000;  // exponent that stands for any larger exponent
  static constexpr std::array<double, 23> POWERS{ 1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22 };

  /// Appends the digits at the begin of the text to the number. @returns the position after the digits.
  const char* take(const char* text) noexcept
  {
    for (; *text >= '0' && *text <= '9'; ++text)
    {
      value = digits < DIGITS ? 10 * value + static_cast<std::uint64_t>(*text - '0') : value;
      digits += value > 0 ? 1 : 0;
    }
    return text;
  }

  bool isQuick() const noexcept
  {
    constexpr bool ROUNDS_ONCE = FLT_EVAL_METHOD == 0;
    return ROUNDS_ONCE && digits <= DIGITS && std::abs(exponent) < static_cast<int>(POWERS.size());
  }
  double quick() const noexcept
  {
    const double power = POWERS[static_cast<std::size_t>(std::abs(exponent))];
    const auto whole = static_cast<double>(value);
    const double size = exponent < 0 ? whole / power : whole * power;
    return is_negative ? -size : size;
  }

  bool is_negative{};
  std::uint64_t value{};
  int digits{};  // number of digits without leading zeros
  int exponent{};

private:
  static constexpr int DIGITS = 15;  // every number with this many digits is less than 2^53
};
}  // namespace

std::string numberText(double value)
{
  if (std::isnan(value))
  {
    return ".nan";
  }
  if (std::isinf(value))
  {
    return value > 0.0 ? ".inf" : "-.inf";
  }
  const DecimalPoint decimal_point;
  std::array<char, 40> buffer{};
  for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits)
  {
    std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
    if (std::strtod(buffer.data(), nullptr) == value)
    {
      break;
    }
  }
  // An integer gets all of its digits, because 200 is easier to read than 2e+02.
  if (value == std::floor(value) && std::abs(value) < 1e6)
  {
    std::snprintf(buffer.data(), buffer.size(), "%.0f", value);
  }
  // printf writes 31000 and 1e-07, but rosparam reads only 31000.0 and 1.0e-7 as numbers with a fraction.
  const std::string text(buffer.data());
  const std::size_t exponent = text.find('e');
  std::string mantissa = text.substr(0, exponent);
  mantissa += mantissa.find('.') == std::string::npos ? ".0" : "";
  if (exponent == std::string::npos)
  {
    return mantissa;
  }
  const std::size_t digits = text.find_first_not_of('0', exponent + 2);
  return mantissa + text.substr(exponent, 2) + text.substr(digits);
}

std::string roundedText(double value, int digits)
{
  const DecimalPoint decimal_point;
  char text[40];
  std::snprintf(text, sizeof(text), "%.*g", digits, value);
  return text;
}

std::string fixedText(double value, int digits)
{
  const DecimalPoint decimal_point;
  char text[400];  // because the largest double has 309 digits before the point
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

std::optional<double> decimalNumber(const std::string& text)
{
  return text.size() == std::strlen(text.c_str()) ? decimalNumber(text.c_str()) : std::nullopt;
}

std::optional<double> decimalNumber(const char* text)
{
  const char* next = text;
  Decimal number;
  number.is_negative = *next == '-';
  next += *next == '+' || *next == '-' ? 1 : 0;
  const char* const first = next;
  next = number.take(next);
  auto digits = next - first;
  if (*next == '.')
  {
    const char* const behind_point = ++next;
    next = number.take(next);
    digits += next - behind_point;
    number.exponent = static_cast<int>(std::max<std::ptrdiff_t>(behind_point - next, -Decimal::FAR));
  }
  bool good = digits > 0;
  if (good && (*next == 'e' || *next == 'E'))
  {
    ++next;
    Decimal power;
    power.is_negative = *next == '-';
    next += *next == '+' || *next == '-' ? 1 : 0;
    const char* const first_of_power = next;
    next = power.take(next);
    good = next != first_of_power;
    const int size = power.digits > 3 ? Decimal::FAR : static_cast<int>(power.value);
    number.exponent += power.is_negative ? -size : size;
  }
  if (!good || *next != '\0')
  {
    return std::nullopt;
  }
  if (number.isQuick())
  {
    return number.quick();
  }
  const DecimalPoint decimal_point;
  return std::strtod(text, nullptr);  // infinite if the number is larger than the largest double
}

std::optional<double> nonFiniteNumber(const std::string& text)
{
  const bool is_negative = text.rfind('-', 0) == 0;
  const std::string unsigned_text = text.substr(is_negative || text.rfind('+', 0) == 0 ? 1 : 0);
  if (unsigned_text == ".inf" || unsigned_text == ".Inf" || unsigned_text == ".INF")
  {
    return is_negative ? -HUGE_VAL : HUGE_VAL;
  }
  const bool is_nan = text == ".nan" || text == ".NaN" || text == ".NAN";
  return is_nan ? std::optional(std::nan("")) : std::nullopt;
}

double yamlNumber(const YAML::Node& node)
{
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  const std::optional<double> decimal = decimalNumber(text);
  const std::optional<double> number = decimal ? decimal : nonFiniteNumber(text);
  if (!number)
  {
    throw YAML::TypedBadConversion<double>(node.Mark());
  }
  return *number;
}
}  // namespace hjt
