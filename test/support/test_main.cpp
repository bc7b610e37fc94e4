// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include <gmock/gmock.h>

namespace
{
/// Prints the reason of each skipped test; GoogleTest 1.10 does not.
class SkipReasons : public testing::EmptyTestEventListener
{
  void OnTestPartResult(const testing::TestPartResult& result) override
  {
    if (result.skipped())
    {
      std::cout << "skipped: " << result.message() << std::endl;
    }
  }
};
}  // namespace

// Catkin links GoogleTest without a main function, and its main libraries have other names on every distribution.
int main(int argc, char** argv)
{
  testing::InitGoogleMock(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new SkipReasons);
  return RUN_ALL_TESTS();
}
