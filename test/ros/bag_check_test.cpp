// SPDX-License-Identifier: BSD-3-Clause
// Damaged bags are refused or read; nothing ends the program.
#include "bags/bag_file.hpp"

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>

#include "bags/bag_inputs.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/recorded_motion.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
/// A file of this process alone, removed at the end.
class TemporaryFile
{
public:
  explicit TemporaryFile(const std::string& name)
    : path_(::testing::TempDir() + "/" + std::to_string(getpid()) + "_" + name)
  {
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }

  const std::string& path() const { return path_; }

  std::string read() const
  {
    std::ifstream file(path_, std::ios::binary);
    return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

private:
  std::string path_;
};

const Parameters& parameters()
{
  static const Parameters SHIPPED = shippedParameters();
  return SHIPPED;
}

sensor_msgs::JointState stateOf(const ros::Time& stamp, double position)
{
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = { parameters().joint.name };
  message.position = { position };
  message.velocity = { 0.1 };
  message.effort = { 0.5 };
  return message;
}

/// Bytes of a small bag with several chunks: commands, telemetry and unstamped torques.
std::string smallBag(rosbag::CompressionType compression)
{
  const TemporaryFile file("sound.bag");
  rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
  bag.setCompression(compression);
  bag.setChunkThreshold(1500);
  for (int i = 0; i < 30; ++i)
  {
    const ros::Time stamp(1000, 1000000 * i + 1);
    const sensor_msgs::JointState message = stateOf(stamp, 0.01 * i);
    bag.write("/joint_twin/command", stamp, message);
    bag.write("/joint_states", stamp, message);
    std_msgs::Float64 torque;
    torque.data = 0.3;
    bag.write("/joint_twin/load_torque", stamp, torque);
  }
  bag.close();
  return file.read();
}

/// Reads a bag in each way that the tool has. @returns whether nothing was refused.
bool readInEveryWay(const std::string& path)
{
  bool whole = true;
  const auto attempt = [&whole](const auto& action)
  {
    try
    {
      action();
    }
    catch (const std::exception&)
    {
      whole = false;
    }
  };
  attempt(
      [&]
      {
        rosbag::Bag bag;
        openForReading(bag, path);
        readBagInputs(bag, "/joint_twin", parameters());
        rosbag::View view(bag);
        for (const rosbag::MessageInstance& message : view)
        {
          std::vector<std::uint8_t> bytes(message.size());
          ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
          message.write(stream);
        }
      });
  attempt(
      [&]
      {
        MotionSource source;
        source.path = path;
        source.joint = parameters().joint.name;
        source.load_topic = "/joint_twin/load_torque";
        readMotion(
            source, { source.joint }, [](const std::vector<MotionRow>&) { return true; }, [](double) {});
      });
  return whole;
}

/// One to three damages of the kinds that disks, transfers and crashes leave.
void damage(std::string& bytes, std::mt19937& random)
{
  const auto below = [&random](std::size_t limit)
  { return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random); };
  for (std::size_t count = 1 + below(3); count > 0 && bytes.size() > 100; --count)
  {
    const std::size_t at = below(bytes.size() - 60);
    switch (below(5))
    {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 2:  // a length, with luck
      {
        const std::uint32_t lengths[] = { 0, 1, 0x7fffffff, 0xffffffff, 0xfffffff0, 1u << 20, 1u << 31 };
        std::memcpy(&bytes[at], &lengths[below(7)], sizeof(std::uint32_t));
        break;
      }
      case 3:
        bytes.replace(at, 50, bytes.substr(below(bytes.size() - 60), 50));
        break;
      default:
        if (below(4) == 0)
        {
          bytes.resize(at + 50);
        }
        else
        {
          bytes.erase(at, 1 + below(8));
        }
    }
  }
}

class BagCheck : public ::testing::TestWithParam<rosbag::CompressionType>
{
};

TEST_P(BagCheck, LetsSoundBagsPass)
{
  const TemporaryFile file("sound.bag");
  file.write(smallBag(GetParam()));
  EXPECT_NO_THROW(checkBagFile(file.path()));
  readInEveryWay(file.path());
}

TEST_P(BagCheck, RefusesAnyLengthThatPointsBeyondTheEnd)
{
  const std::string sound = smallBag(GetParam());
  const TemporaryFile file("bad.bag");
  for (std::size_t at = sound.find("op="); at != std::string::npos; at = sound.find("op=", at + 1))
  {
    std::string bytes = sound;
    bytes[at - 1] = '\x7f';  // the highest byte of a field's length or of a header's
    file.write(bytes);
    EXPECT_THROW(checkBagFile(file.path()), InputError) << at;
  }
}

TEST_P(BagCheck, NoDamageEndsTheProgram)
{
  constexpr unsigned DAMAGED = 400;
  const std::string sound = smallBag(GetParam());
  const TemporaryFile file("bad.bag");
  int refused = 0;
  for (unsigned seed = 0; seed < DAMAGED; ++seed)
  {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string bytes = sound;
    damage(bytes, random);
    file.write(bytes);
    refused += readInEveryWay(file.path()) ? 0 : 1;
  }
  EXPECT_GT(refused, static_cast<int>(DAMAGED / 4));
}

INSTANTIATE_TEST_SUITE_P(Compressions, BagCheck,
                         ::testing::Values(rosbag::compression::Uncompressed, rosbag::compression::BZ2,
                                           rosbag::compression::LZ4));

TEST(BagMotion, SaysHowManyJumpsOfAFoldedAngleItTookOut)
{
  const TemporaryFile file("folded.bag");
  rosbag::Bag bag(file.path(), rosbag::bagmode::Write);
  for (int i = 0; i < 1000; ++i)
  {
    const ros::Time stamp(1000, 1000000 * i + 1);
    bag.write("/joint_states", stamp, stateOf(stamp, std::remainder(0.02 * i, 2.0 * M_PI)));
  }
  bag.close();
  MotionSource source;
  source.path = file.path();
  source.joint = parameters().joint.name;
  source.speeds = { 30.0 };
  const MotionCount count = readMotion(
      source, { source.joint }, [](const std::vector<MotionRow>&) { return true; }, [](double) {});
  EXPECT_THAT(count.remarks, ::testing::Contains("angles are folded into one turn: unwrapped, 3 jumps of 2 pi"));
}

TEST(BagDamage, IsNamedWithItsPlace)
{
  std::string bytes = smallBag(rosbag::compression::Uncompressed);
  const TemporaryFile file("bad.bag");
  bytes.resize(bytes.size() - 10);
  file.write(bytes);
  try
  {
    checkBagFile(file.path());
    ADD_FAILURE();
  }
  catch (const InputError& error)
  {
    EXPECT_NE(std::string(error.what()).find("longer than the remaining"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(" at byte "), std::string::npos) << error.what();
  }
}
}  // namespace
}  // namespace hjt
