// SPDX-License-Identifier: BSD-3-Clause
// Damaged bags are refused. What reads the others: test/tool/fuzz_test.py.
#include "bags/bag_file.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>

#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/recorded_motion.hpp"
#include "test/core/test_parameters.hpp"
#include "test/support/temporary_folder.hpp"

namespace hjt
{
namespace
{
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
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "sound.bag").string();
  rosbag::Bag bag(path, rosbag::bagmode::Write);
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
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
}

class BagCheck : public ::testing::TestWithParam<rosbag::CompressionType>
{
};

TEST_P(BagCheck, LetsSoundBagsPass)
{
  const TemporaryFolder folder;
  EXPECT_NO_THROW(checkBagFile(folder.write("sound.bag", smallBag(GetParam()))));
}

TEST_P(BagCheck, RefusesAnyLengthThatPointsBeyondTheEnd)
{
  const std::string sound = smallBag(GetParam());
  const TemporaryFolder folder;
  for (std::size_t at = sound.find("op="); at != std::string::npos; at = sound.find("op=", at + 1))
  {
    std::string bytes = sound;
    bytes[at - 1] = '\x7f';  // the highest byte of a field's length or of a header's
    EXPECT_THROW(checkBagFile(folder.write("bad.bag", bytes)), InputError) << at;
  }
}

INSTANTIATE_TEST_SUITE_P(Compressions, BagCheck,
                         ::testing::Values(rosbag::compression::Uncompressed, rosbag::compression::BZ2,
                                           rosbag::compression::LZ4));

TEST(BagMotion, SaysHowManyJumpsOfAFoldedAngleItTookOut)
{
  const TemporaryFolder folder;
  MotionSource source;
  source.path = (folder.path() / "folded.bag").string();
  rosbag::Bag bag(source.path, rosbag::bagmode::Write);
  for (int i = 0; i < 1000; ++i)
  {
    const ros::Time stamp(1000, 1000000 * i + 1);
    bag.write("/joint_states", stamp, stateOf(stamp, std::remainder(0.02 * i, 2.0 * M_PI)));
  }
  bag.close();
  source.joint = parameters().joint.name;
  source.speeds = { 30.0 };
  const MotionCount count = readMotion(
      source, { source.joint }, [](const std::vector<MotionRow>&) { return true; }, [](double) {});
  EXPECT_THAT(count.remarks, ::testing::Contains("angles are folded into one turn; 3 jumps of 2 pi were removed"));
}

TEST(BagDamage, IsNamedWithItsPlace)
{
  std::string bytes = smallBag(rosbag::compression::Uncompressed);
  bytes.resize(bytes.size() - 10);
  const TemporaryFolder folder;
  try
  {
    checkBagFile(folder.write("bad.bag", bytes));
    ADD_FAILURE();
  }
  catch (const InputError& error)
  {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("longer than the remaining"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr(" at byte "));
  }
}
}  // namespace
}  // namespace hjt
