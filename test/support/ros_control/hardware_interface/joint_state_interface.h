// SPDX-License-Identifier: BSD-3-Clause
/// Stands in for github.com/ros-controls/ros_control (noetic-devel), hardware_interface, in tests: what a robot and a
/// controller call of it, by the same names.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <typeinfo>

namespace hardware_interface
{
class HardwareInterfaceException : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

class HardwareInterface
{
public:
  virtual ~HardwareInterface() = default;
};

template <class Handle>
class HardwareResourceManager : public HardwareInterface
{
public:
  void registerHandle(const Handle& handle) { handles_.insert({ handle.getName(), handle }); }

  Handle getHandle(const std::string& name)
  {
    const auto found = handles_.find(name);
    if (found == handles_.end())
    {
      throw HardwareInterfaceException("Could not find resource '" + name + "'");
    }
    return found->second;
  }

private:
  std::map<std::string, Handle> handles_;
};

class JointStateHandle
{
public:
  JointStateHandle(const std::string& name, const double* position, const double* velocity, const double* effort)
    : name_(name), position_(position), velocity_(velocity), effort_(effort)
  {
  }

  std::string getName() const { return name_; }
  double getPosition() const { return *position_; }
  double getVelocity() const { return *velocity_; }
  double getEffort() const { return *effort_; }

private:
  std::string name_;
  const double* position_;
  const double* velocity_;
  const double* effort_;
};

class JointStateInterface : public HardwareResourceManager<JointStateHandle>
{
};
}  // namespace hardware_interface
