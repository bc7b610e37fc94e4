// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace hjt
{
namespace
{
__extension__ using Wide = unsigned __int128;

constexpr int DIGITS = std::numeric_limits<double>::max_digits10;
constexpr std::uint64_t LEAST = 10'000'000'000'000'000;  // of that many digits
constexpr int MAX_POWER = 51;                            // 53 bits times 5^51 have less than 192

constexpr std::array<Wide, MAX_POWER + 1> powersOfFive()
{
  std::array<Wide, MAX_POWER + 1> powers{};
  powers[0] = 1;
  for (std::size_t i = 1; i < powers.size(); ++i)
  {
    powers[i] = 5 * powers[i - 1];
  }
  return powers;
}

/// mantissa 5^power 2^exponent, rounded to the nearest whole number, from halfway to the even one. Less than 2^63.
std::uint64_t scaled(std::uint64_t mantissa, int power, int exponent) noexcept
{
  static constexpr std::array<Wide, MAX_POWER + 1> FIVES = powersOfFive();
  const Wide five = FIVES[static_cast<std::size_t>(power)];
  const Wide low = static_cast<Wide>(mantissa) * static_cast<std::uint64_t>(five);
  const Wide high = static_cast<Wide>(mantissa) * static_cast<std::uint64_t>(five >> 64) + (low >> 64);
  const auto last = static_cast<std::uint64_t>(low);
  const int shift = -exponent;
  if (shift <= 0)
  {
    return last << exponent;
  }
  Wide whole{};
  bool half{};  // the first bit cut off
  bool rest{};  // any further one
  if (shift < 64)
  {
    whole = high << (64 - shift) | last >> shift;
    half = (last >> (shift - 1) & 1) != 0;
    rest = (last & ((std::uint64_t{ 1 } << (shift - 1)) - 1)) != 0;
  }
  else
  {
    whole = shift < 192 ? high >> (shift - 64) : 0;
    half = shift == 64 ? last >> 63 != 0 : (high >> (shift - 65) & 1) != 0;
    rest = shift == 64 ? last << 1 != 0 : last != 0 || (high & ((Wide{ 1 } << (shift - 65)) - 1)) != 0;
  }
  const auto number = static_cast<std::uint64_t>(whole);
  return number + (half && (rest || (number & 1) != 0) ? 1 : 0);
}
}  // namespace

char* writeExact(double value, char* text) noexcept
{
  constexpr double SMALLEST = 1e-34;
  constexpr double LARGEST = 1e16;
  constexpr int FIRST_FIXED = -4;  // exponent from which no power is written
  const double size = std::abs(value);
  if (!(size >= SMALLEST && size < LARGEST))
  {
    if (value == 0.0 && !std::signbit(value))
    {
      *text = '0';
      return text + 1;
    }
    return text + std::snprintf(text, EXACT_TEXT_SIZE, "%.*g", DIGITS, value);
  }
  std::uint64_t bits{};
  std::memcpy(&bits, &size, sizeof(bits));
  const std::uint64_t mantissa = (bits & ((std::uint64_t{ 1 } << 52) - 1)) | std::uint64_t{ 1 } << 52;
  const int exponent = static_cast<int>(bits >> 52) - 1075;
  // value = 0.d1 d2 ... 10^(decimal + 1): floor(log10(2) times its exponent), or one more.
  int decimal = ((exponent + 52) * 78913) >> 18;
  const auto digitsAt = [&](int at) { return scaled(mantissa, DIGITS - 1 - at, exponent + DIGITS - 1 - at); };
  std::uint64_t number = digitsAt(decimal);
  if (number >= 10 * LEAST)
  {
    number = digitsAt(++decimal);
  }
  if (number >= 10 * LEAST)  // rounded up to the next power of ten
  {
    number /= 10;
    ++decimal;
  }
  std::array<char, DIGITS> digits{};
  int count = DIGITS;
  for (int i = DIGITS; i-- > 0; number /= 10)
  {
    digits[static_cast<std::size_t>(i)] = static_cast<char>('0' + number % 10);
  }
  while (digits[static_cast<std::size_t>(count) - 1] == '0')
  {
    --count;
  }
  if (value < 0.0)
  {
    *text++ = '-';
  }
  const auto copy = [&](int from, int to)
  {
    std::memcpy(text, digits.data() + from, static_cast<std::size_t>(to - from));
    text += to - from;
  };
  const auto zeros = [&](int number_of)
  {
    std::memset(text, '0', static_cast<std::size_t>(number_of));
    text += number_of;
  };
  if (decimal < FIRST_FIXED)
  {
    copy(0, 1);
    if (count > 1)
    {
      *text++ = '.';
      copy(1, count);
    }
    const int power = -decimal;
    *text++ = 'e';
    *text++ = '-';
    *text++ = static_cast<char>('0' + power / 10);
    *text++ = static_cast<char>('0' + power % 10);
  }
  else if (decimal < 0)
  {
    *text++ = '0';
    *text++ = '.';
    zeros(-decimal - 1);
    copy(0, count);
  }
  else
  {
    const int whole = decimal + 1;
    copy(0, whole < count ? whole : count);
    if (count > whole)
    {
      *text++ = '.';
      copy(whole, count);
    }
    else
    {
      zeros(whole - count);
    }
  }
  return text;
}

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
  std::array<char, 40> buffer{};
  for (int digits = 1; digits <= std::numeric_limits<double>::max_digits10; ++digits)
  {
    std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
    if (std::strtod(buffer.data(), nullptr) == value)
    {
      break;
    }
  }
  // 2e+02 reads better as 200.
  if (value == std::floor(value) && std::abs(value) < 1e6)
  {
    std::snprintf(buffer.data(), buffer.size(), "%.0f", value);
  }
  // printf writes 31000 and 1e-07; rosparam wants 31000.0 and 1.0e-7.
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
  char text[40];
  std::snprintf(text, sizeof(text), "%.*g", digits, value);
  return text;
}

std::string rangeText(const Range& range)
{
  const auto bound = [](double value)
  {
    const bool whole = value == std::floor(value) && std::abs(value) < 1e6;
    return whole ? std::to_string(static_cast<long long>(value)) : numberText(value);
  };
  if (range.max == std::numeric_limits<double>::max())
  {
    return ">= " + bound(range.min);
  }
  return bound(range.min) + " ... " + bound(range.max);
}

std::optional<double> decimalNumber(const std::string& text)
{
  const char* next = text.c_str();
  const auto digits = [&next]
  {
    const char* first = next;
    while (*next >= '0' && *next <= '9')
    {
      ++next;
    }
    return next - first;
  };
  next += *next == '+' || *next == '-' ? 1 : 0;
  auto mantissa = digits();
  if (*next == '.')
  {
    ++next;
    mantissa += digits();
  }
  bool good = mantissa > 0;
  if (good && (*next == 'e' || *next == 'E'))
  {
    ++next;
    next += *next == '+' || *next == '-' ? 1 : 0;
    good = digits() > 0;
  }
  // Beyond the largest number it is infinite.
  return good && next == text.c_str() + text.size() ? std::optional<double>(std::strtod(text.c_str(), nullptr)) :
                                                      std::nullopt;
}
}  // namespace hjt
