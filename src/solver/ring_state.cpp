// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gear/vector_loops.hpp"

namespace hjt
{
namespace ring_vectors
{
HJT_VECTOR_CLONES double largest(const Eigen::VectorXd& values, int teeth) noexcept
{
  const int n = 2 * teeth;
  const double* __restrict__ value = values.data();
  double most = 0.0;
  double sum = 0.0;  // shows a NaN, which a comparison does not detect
#pragma omp simd reduction(max : most) reduction(+ : sum)
  for (int i = 0; i < n; ++i)
  {
    const double size = std::abs(value[i]);
    most = size > most ? size : most;
    sum += size;
  }
  return std::isfinite(sum) ? most : std::numeric_limits<double>::quiet_NaN();
}

HJT_VECTOR_CLONES void addScaled(const Eigen::VectorXd& start, double length, const Eigen::VectorXd& step,
                                 Eigen::VectorXd& result, int teeth) noexcept
{
  const int n = 2 * teeth;
  const double* __restrict__ from = start.data();
  const double* __restrict__ along = step.data();
  double* __restrict__ to = result.data();
#pragma omp simd
  for (int i = 0; i < n; ++i)
  {
    to[i] = from[i] + length * along[i];
  }
}

HJT_VECTOR_CLONES double dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int teeth) noexcept
{
  const int n = 2 * teeth;
  const double* first = a.data();
  const double* second = b.data();
  return blockSum(0, n, [&](int i) { return first[i] * second[i]; });
}

HJT_VECTOR_CLONES int signsChanged(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int teeth) noexcept
{
  const int n = teeth;
  const double* __restrict__ first = a.data();
  const double* __restrict__ second = b.data();
  double changed = 0.0;  // number of changes, a double like the values so that the compiler vectorises the loop
#pragma omp simd reduction(+ : changed)
  for (int i = 0; i < n; ++i)
  {
    changed += std::abs((first[i] > 0.0 ? 1.0 : 0.0) - (second[i] > 0.0 ? 1.0 : 0.0));
  }
  return static_cast<int>(changed);
}

HJT_VECTOR_CLONES void turn(const Eigen::VectorXd& values, int places, double c, double s,
                            Eigen::VectorXd& turned) noexcept
{
  const Eigen::Index n = values.size() / 2;
  const auto part = [&](Eigen::Index begin, Eigen::Index end, Eigen::Index shift)
  {
    const double* __restrict__ from = values.data();
    double* __restrict__ to = turned.data() + 2 * shift;
#pragma omp simd
    for (Eigen::Index i = begin; i < end; ++i)
    {
      to[2 * i] = c * from[2 * i] - s * from[2 * i + 1];
      to[2 * i + 1] = s * from[2 * i] + c * from[2 * i + 1];
    }
  };
  part(0, n - places, places);
  part(n - places, n, places - n);
}

HJT_VECTOR_CLONES void turnHalf(const Combination& vectors, const Combination::Factors& factors, int places, double c,
                                double s, Eigen::VectorXd& result, int teeth) noexcept
{
  const auto part = [&](int begin, int end, int shift, double sign)
  {
    const double* __restrict__ va = vectors.a;
    const double* __restrict__ vb = vectors.b;
    const double* __restrict__ vc = vectors.c;
    double* __restrict__ to = result.data() + 2 * static_cast<Eigen::Index>(shift);
    const double fa = factors.a;
    const double fb = factors.b;
    const double fc = factors.c;
    const double cosine = sign * c;
    const double sine = sign * s;
#pragma omp simd
    for (int i = begin; i < end; ++i)
    {
      const double x = fa * va[2 * i] + fb * vb[2 * i] + fc * vc[2 * i];
      const double y = fa * va[2 * i + 1] + fb * vb[2 * i + 1] + fc * vc[2 * i + 1];
      to[2 * i] = cosine * x - sine * y;
      to[2 * i + 1] = sine * x + cosine * y;
    }
  };
  part(0, teeth - places, places, 1.0);
  part(teeth - places, teeth, places - teeth, -1.0);
}

HJT_VECTOR_CLONES void addTurned(const Combination& vectors, const Combination::Factors& here,
                                 const Combination::Factors& turned, int places, double c, double s,
                                 Eigen::VectorXd& result, int teeth) noexcept
{
  const Eigen::Index n = result.size() / 2;
  const auto part = [&](Eigen::Index begin, Eigen::Index end, Eigen::Index shift)
  {
    const double* __restrict__ va = vectors.a;
    const double* __restrict__ vb = vectors.b;
    const double* __restrict__ vc = vectors.c;
    double* __restrict__ to = result.data();
    const double ha = here.a;
    const double hb = here.b;
    const double hc = here.c;
    const double ta = turned.a;
    const double tb = turned.b;
    const double tc = turned.c;
#pragma omp simd
    for (Eigen::Index i = begin; i < end; ++i)
    {
      const Eigen::Index k = 2 * (i + shift);
      const double x = ta * va[2 * i] + tb * vb[2 * i] + tc * vc[2 * i];
      const double y = ta * va[2 * i + 1] + tb * vb[2 * i + 1] + tc * vc[2 * i + 1];
      to[k] = ha * va[k] + hb * vb[k] + hc * vc[k] + c * x - s * y;
      to[k + 1] = ha * va[k + 1] + hb * vb[k + 1] + hc * vc[k + 1] + s * x + c * y;
    }
  };
  part(0, std::max<Eigen::Index>(teeth - places, 0), places);
  part(n - places, n - places + std::min(places, teeth), places - n);
}
}  // namespace ring_vectors
}  // namespace hjt
