// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

// Catkin links GoogleTest without a main function, and its main libraries have other names on every distribution.
int main(int argc, char** argv)
{
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
