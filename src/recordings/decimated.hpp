// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hjt
{
/// Every nth of a stream of any length, at least MAX_ROWS / 2 of it once there are as many, never more than MAX_ROWS.
template <class Row>
class Decimated
{
public:
  static constexpr std::size_t MAX_ROWS = 16000;

  void add(const Row& row)
  {
    if (seen_++ % stride_ == 0)
    {
      rows_.push_back(row);
      if (rows_.size() == MAX_ROWS)
      {
        halve();
      }
    }
  }

  const std::vector<Row>& rows() const { return rows_; }

private:
  void halve()
  {
    for (std::size_t i = 0; i < MAX_ROWS / 2; ++i)
    {
      rows_[i] = rows_[2 * i];
    }
    rows_.resize(MAX_ROWS / 2);
    stride_ *= 2;
  }

  std::vector<Row> rows_;
  std::uint64_t seen_{};
  std::uint64_t stride_{ 1 };
};
}  // namespace hjt
