// SPDX-License-Identifier: BSD-3-Clause
#include "studies/dormand_prince_stepper.hpp"

#include <array>
#include <cmath>

#include "gear/vector_clones.hpp"

namespace hjt
{
namespace
{
// Coefficients of DOP853 (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.10).
using Row = std::array<double, 12>;
constexpr std::array<Row, 12> BEFORE{ {
    Row{},
    Row{ 0.05260015195876773 },
    Row{ 0.0197250569845379, 0.0591751709536137 },
    Row{ 0.02958758547680685, 0.0, 0.08876275643042054 },
    Row{ 0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792 },
    Row{ 0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242 },
    Row{ 0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125 },
    Row{ 0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
         0.008273789163814023 },
    Row{ 0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671, 20.154067550477894,
         -43.48988418106996 },
    Row{ 0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423,
         -33.28821096898486, -0.020331201708508627 },
    Row{ -0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927, -18.52006565999696,
         22.739487099350505, 2.4936055526796523, -3.0467644718982196 },
    Row{ 2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996,
         -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636 },
} };
constexpr Row TIMES{ 0.0,
                     0.05260015195876773,
                     0.0789002279381516,
                     0.1183503419072274,
                     0.2816496580927726,
                     0.3333333333333333,
                     0.25,
                     0.3076923076923077,
                     0.6512820512820513,
                     0.6,
                     0.8571428571428571,
                     1.0 };
constexpr Row WEIGHTS{ 0.054293734116568765,
                       0.0,
                       0.0,
                       0.0,
                       0.0,
                       4.450312892752409,
                       1.8915178993145003,
                       -5.801203960010585,
                       0.3111643669578199,
                       -0.1521609496625161,
                       0.20136540080403034,
                       0.04471061572777259 };
constexpr Row ERROR_OF_ORDER_5{ 0.01312004499419488,
                                0.0,
                                0.0,
                                0.0,
                                0.0,
                                -1.2251564463762044,
                                -0.4957589496572502,
                                1.6643771824549864,
                                -0.35032884874997366,
                                0.3341791187130175,
                                0.08192320648511571,
                                -0.022355307863886294 };
constexpr Row ERROR_OF_ORDER_3{ -0.18980075407240762,
                                0.0,
                                0.0,
                                0.0,
                                0.0,
                                4.450312892752409,
                                1.8915178993145003,
                                -5.801203960010585,
                                -0.4226823213237919,
                                -0.1521609496625161,
                                0.20136540080403034,
                                0.02265179219836082 };

/// out = start + sum of weights times columns. @param count a multiple of two
HJT_VECTOR_CLONES void combine(const double* __restrict__ start, const double* const* columns, const double* weights,
                               int count, int size, double* __restrict__ out) noexcept
{
  for (int k = 0; k < size; ++k)
  {
    out[k] = start[k];
  }
  for (int j = 0; j < count; j += 2)
  {
    const double* __restrict__ first = columns[j];
    const double* __restrict__ second = columns[j + 1];
    const double by_first = weights[j];
    const double by_second = weights[j + 1];
#pragma omp simd
    for (int k = 0; k < size; ++k)
    {
      out[k] += by_first * first[k] + by_second * second[k];
    }
  }
}
}  // namespace

DormandPrinceStepper::DormandPrinceStepper(DynamicRing& ring)
  : ring_(ring), zero_(Eigen::VectorXd::Zero(ring.states())), start_(ring.states()), state_(ring.states())
{
  rates_.fill(Eigen::VectorXd::Zero(ring.states()));
}

bool DormandPrinceStepper::step(RingMotion& motion, double length) noexcept
{
  restart();
  ring_.pairTeeth(motion.q, motion.time);
  if (!attempt(motion, length))
  {
    return false;
  }
  ++counts_.steps;
  return true;
}

/// out = start + length times the sum of weights times the rates of the first stages.
void DormandPrinceStepper::sum(const Eigen::VectorXd& start, const Weights& weights, double length, int stages,
                               Eigen::VectorXd& out) noexcept
{
  std::array<const double*, STAGES> columns{};
  Weights by{};
  int count = 0;
  for (int i = 0; i < stages; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    if (weights[k] != 0.0)
    {
      columns[static_cast<std::size_t>(count)] = rates_[k].data();
      by[static_cast<std::size_t>(count++)] = length * weights[k];
    }
  }
  if (count % 2 == 1)
  {
    columns[static_cast<std::size_t>(count++)] = rates_.front().data();  // times nothing
  }
  combine(start.data(), columns.data(), by.data(), count, static_cast<int>(start.size()), out.data());
}

bool DormandPrinceStepper::attempt(RingMotion& motion, double length) noexcept
{
  const int n = ring_.coordinates();
  start_.head(n) = motion.q;
  start_.tail(n) = motion.v;
  for (int i = 0; i < STAGES; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    if (i == 0 && begun_)
    {
      continue;
    }
    sum(start_, BEFORE[k], length, i, state_);
    ring_.rates(state_.data(), motion.time + TIMES[k] * length, rates_[k].data());
    powers_[k] = ring_.power();
    ++counts_.force_evaluations;
  }
  begun_ = true;
  const auto largest = [&](const Weights& weights)
  {
    sum(zero_, weights, length, STAGES, state_);
    return state_.head(n - 2).lpNorm<Eigen::Infinity>();
  };
  const double fifth = largest(ERROR_OF_ORDER_5);
  const double third = largest(ERROR_OF_ORDER_3);
  error_ = fifth == 0.0 ? 0.0 : fifth * fifth / std::hypot(fifth, 0.1 * third);
  sum(start_, WEIGHTS, length, STAGES, state_);
  if (!state_.allFinite())
  {
    return false;
  }
  motion.q = state_.head(n);
  motion.v = state_.tail(n);
  motion.time += length;
  for (std::size_t k = 0; k < STAGES; ++k)
  {
    motion.supplied += length * WEIGHTS[k] * powers_[k].supplied;
    motion.dissipated += length * WEIGHTS[k] * powers_[k].dissipated;
  }
  return true;
}
}  // namespace hjt
