// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace hjt
{
/// Whether a call without the interpreter's lock works on an object of Python, which no other call may touch then.
/// Itself guarded by the interpreter's lock.
class InUse
{
public:
  /// Marks the object as in use while it lives; constructed and destroyed with the interpreter's lock.
  class Hold
  {
  public:
    explicit Hold(bool& used) : used_(&used) { *used_ = true; }
    Hold(Hold&& other) noexcept : used_(std::exchange(other.used_, nullptr)) {}
    Hold& operator=(Hold&&) = delete;
    ~Hold()
    {
      if (used_ != nullptr)
      {
        *used_ = false;
      }
    }

  private:
    bool* used_;
  };

  /// `what`: name of the object in the error's text.
  explicit InUse(const char* what) : what_(what) {}

  /// @throws std::runtime_error while it is held.
  void refuse() const
  {
    if (used_)
    {
      throw std::runtime_error("this " + std::string(what_) + " is being run by another thread");
    }
  }

  /// @throws std::runtime_error while it is held already.
  [[nodiscard]] Hold hold()
  {
    refuse();
    return Hold(used_);
  }

private:
  const char* what_;
  bool used_{};
};
}  // namespace hjt
