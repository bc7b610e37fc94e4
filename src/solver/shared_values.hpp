// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace hjt
{
/// Values one after the other, which nobody changes any more: those of a vector, or what lies in a file in memory.
/// Copies share them.
template <class T>
class SharedValues
{
public:
  SharedValues() = default;
  explicit SharedValues(std::vector<T> values)
  {
    const auto own = std::make_shared<const std::vector<T>>(std::move(values));
    *this = SharedValues(own, own->data(), own->size());
  }
  SharedValues(std::shared_ptr<const void> owner, const T* first, std::size_t size) noexcept
    : owner_(std::move(owner)), first_(first), size_(size)
  {
  }

  const T& operator[](std::size_t i) const noexcept { return first_[i]; }
  const T* begin() const noexcept { return first_; }
  const T* end() const noexcept { return first_ + size_; }
  const T* data() const noexcept { return first_; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }

  friend bool operator==(const SharedValues& a, const SharedValues& b)
  {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

private:
  std::shared_ptr<const void> owner_;
  const T* first_{};
  std::size_t size_{};
};
}  // namespace hjt
