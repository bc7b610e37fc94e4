// SPDX-License-Identifier: BSD-3-Clause
/// As joint_state_interface.h.
#pragma once

#include <map>
#include <string>
#include <typeinfo>

#include <ros/duration.h>
#include <ros/time.h>

namespace hardware_interface
{
class RobotHW
{
public:
  virtual ~RobotHW() = default;

  template <class Interface>
  void registerInterface(Interface* interface)
  {
    interfaces_[typeid(Interface).name()] = interface;
  }

  template <class Interface>
  Interface* get()
  {
    const auto found = interfaces_.find(typeid(Interface).name());
    return found == interfaces_.end() ? nullptr : static_cast<Interface*>(found->second);
  }

  virtual void read(const ros::Time& /*time*/, const ros::Duration& /*period*/) {}
  virtual void write(const ros::Time& /*time*/, const ros::Duration& /*period*/) {}

private:
  std::map<std::string, void*> interfaces_;
};
}  // namespace hardware_interface
