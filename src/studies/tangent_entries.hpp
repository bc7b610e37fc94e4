// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "elements/ring_tangent.hpp"

namespace hjt
{
/// Every entry of a tangent over all coordinates as (row, column, value); the order does not depend on the values.
/// Visits the entries without the cup's, whose matrix of rank one is dense.
template <class Visitor>
void visitEntries(const RingTangent& tangent, Visitor&& visit)
{
  const auto block = [&](int row_tooth, int column_tooth, const Block2& values)
  {
    for (int i = 0; i < 2; ++i)
    {
      for (int j = 0; j < 2; ++j)
      {
        visit(2 * row_tooth + i, 2 * column_tooth + j, values(i, j));
      }
    }
  };
  const auto couple = [&](int i, int j, const Block2& values)
  {
    block(i, j, values);
    block(j, i, values.transpose());
  };
  const int teeth = tangent.teeth();
  const int wave_generator = 2 * teeth;
  const int output = wave_generator + 1;
  for (int i = 0; i < teeth; ++i)
  {
    block(i, i, tangent.diagonal.at(i));
    couple(i, (i + 1) % teeth, tangent.next.at(i));
    couple(i, (i + 2) % teeth, tangent.second.at(i));
  }
  for (int k = 0; k < wave_generator; ++k)
  {
    visit(k, wave_generator, tangent.wave_generator[k]);
    visit(wave_generator, k, tangent.wave_generator[k]);
    visit(k, output, tangent.output[k]);
    visit(output, k, tangent.output[k]);
  }
  visit(wave_generator, wave_generator, tangent.wave_generator_stiffness);
  visit(output, output, tangent.output_stiffness);
}
}  // namespace hjt
