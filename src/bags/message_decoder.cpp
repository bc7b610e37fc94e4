// SPDX-License-Identifier: BSD-3-Clause
#include "bags/message_decoder.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace hjt
{
namespace
{
/// Extracts values from a message one after the other. After a value with a wrong length, all further values are zero.
class Decoder
{
public:
  Decoder(const std::vector<std::uint8_t>& bytes, MessageEncoding encoding)
    : bytes_(bytes), is_cdr_(encoding == MessageEncoding::CDR)
  {
    if (is_cdr_)
    {
      // The first four bytes are two for the representation and two for options. Alignment is relative to their end.
      fits_ = bytes.size() >= ORIGIN && bytes[0] == 0 && bytes[1] <= 1;
      is_big_ = fits_ && bytes[1] == 0;
      at_ = ORIGIN;
    }
    else
    {
      fits_ = encoding == MessageEncoding::ROS1;
    }
  }

  template <class Number>
  Number number()
  {
    if (is_cdr_ && fits_)
    {
      at_ += (sizeof(Number) - (at_ - ORIGIN) % sizeof(Number)) % sizeof(Number);
    }
    std::array<std::uint8_t, sizeof(Number)> raw{};
    Number value{};
    if (!has(sizeof(Number)))
    {
      return value;
    }
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), sizeof(Number), raw.begin());
    at_ += sizeof(Number);
    if (is_big_)
    {
      std::reverse(raw.begin(), raw.end());
    }
    std::memcpy(&value, raw.data(), sizeof(value));
    return value;
  }

  std::string text()
  {
    const auto length = number<std::uint32_t>();
    if (!has(length))
    {
      return {};
    }
    std::string text(reinterpret_cast<const char*>(bytes_.data()) + at_, length);
    at_ += length;
    if (is_cdr_ && !text.empty() && text.back() == '\0')
    {
      text.pop_back();
    }
    return text;
  }

  template <class Value, class Take>
  void list(std::vector<Value>& values, std::size_t least_size, const Take& take)
  {
    const auto count = number<std::uint32_t>();
    values.clear();
    if (!has(least_size * count))
    {
      return;
    }
    for (std::uint32_t i = 0; i < count && fits_; ++i)
    {
      values.push_back(take());
    }
  }

  void numbers(std::vector<double>& values)
  {
    list(values, sizeof(double), [this] { return number<double>(); });
  }

  void header(std_msgs::Header& header)
  {
    header.seq = is_cdr_ ? 0 : number<std::uint32_t>();
    header.stamp.sec = number<std::uint32_t>();
    header.stamp.nsec = number<std::uint32_t>();
    header.frame_id = text();
  }

  /// Whether the message was read to its last byte. A CDR message may end with padding.
  bool done() const { return fits_ && bytes_.size() - at_ < (is_cdr_ ? sizeof(double) : 1); }

private:
  static constexpr std::size_t ORIGIN = 4;

  bool has(std::size_t count)
  {
    fits_ = fits_ && at_ <= bytes_.size() && count <= bytes_.size() - at_;
    return fits_;
  }

  const std::vector<std::uint8_t>& bytes_;
  const bool is_cdr_;
  bool is_big_{};
  std::size_t at_{};
  bool fits_{};
};
}  // namespace

MessageEncoding encodingOf(const std::string& name)
{
  return name == "cdr" ? MessageEncoding::CDR : name == "ros1" ? MessageEncoding::ROS1 : MessageEncoding::OTHER;
}

bool decode(const std::vector<std::uint8_t>& bytes, MessageEncoding encoding, sensor_msgs::JointState& message)
{
  Decoder decoder(bytes, encoding);
  decoder.header(message.header);
  decoder.list(message.name, sizeof(std::uint32_t), [&] { return decoder.text(); });
  decoder.numbers(message.position);
  decoder.numbers(message.velocity);
  decoder.numbers(message.effort);
  return decoder.done();
}

bool decode(const std::vector<std::uint8_t>& bytes, MessageEncoding encoding, sensor_msgs::Temperature& message)
{
  Decoder decoder(bytes, encoding);
  decoder.header(message.header);
  message.temperature = decoder.number<double>();
  message.variance = decoder.number<double>();
  return decoder.done();
}
}  // namespace hjt
