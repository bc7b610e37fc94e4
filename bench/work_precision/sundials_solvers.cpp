// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include "bench/work_precision/follow.hpp"
#include "bench/work_precision/linear_system.hpp"
#include "bench/work_precision/solvers.hpp"

namespace hjt
{
namespace
{
/// What the callbacks of SUNDIALS need of us.
struct Callbacks
{
  DynamicRing* ring;
  LinearSystem* linear;
  double gamma{};
  long evaluations{};
  long factorisations{};
  Eigen::VectorXd rates;  // of IDA's residual
};

Callbacks& callbacks(void* data)
{
  return *static_cast<Callbacks*>(data);
}

int rates(double time, N_Vector y, N_Vector derivative, void* data)
{
  Callbacks& own = callbacks(data);
  own.ring->rates(N_VGetArrayPointer(y), time, N_VGetArrayPointer(derivative));
  ++own.evaluations;
  return std::isfinite(N_VGetArrayPointer(derivative)[0]) ? 0 : 1;
}

int residual(double time, N_Vector y, N_Vector derivative, N_Vector result, void* data)
{
  Callbacks& own = callbacks(data);
  const Eigen::Index n = own.ring->states();
  own.ring->rates(N_VGetArrayPointer(y), time, own.rates.data());
  ++own.evaluations;
  Eigen::Map<Eigen::VectorXd>(N_VGetArrayPointer(result), n) =
      Eigen::Map<Eigen::VectorXd>(N_VGetArrayPointer(derivative), n) - own.rates;
  return own.rates.allFinite() ? 0 : 1;
}

void linearise(Callbacks& own, double time, N_Vector y, double gamma)
{
  own.linear->linearise(N_VGetArrayPointer(y), time);
  own.gamma = gamma;
  ++own.evaluations;
}

/// CVODE and ARKODE: the system is I - gamma J. It is made again each time, at no more than a factorisation costs.
int linearSystem(double time, N_Vector y, N_Vector /*rates*/, SUNMatrix /*matrix*/, int /*keep*/, int* fresh,
                 double gamma, void* data, N_Vector, N_Vector, N_Vector)
{
  linearise(callbacks(data), time, y, gamma);
  *fresh = 1;
  return 0;
}

int linearSystemWithMass(double time, N_Vector y, N_Vector rates, SUNMatrix matrix, SUNMatrix /*mass*/, int keep,
                         int* fresh, double gamma, void* data, N_Vector a, N_Vector b, N_Vector c)
{
  return linearSystem(time, y, rates, matrix, keep, fresh, gamma, data, a, b, c);
}

/// IDA: cj I - J, that is cj times the same.
int residualJacobian(double time, double cj, N_Vector y, N_Vector, N_Vector, SUNMatrix, void* data, N_Vector, N_Vector,
                     N_Vector)
{
  linearise(callbacks(data), time, y, 1.0 / cj);
  return 0;
}

int factor(SUNLinearSolver solver, SUNMatrix)
{
  Callbacks& own = callbacks(solver->content);
  ++own.factorisations;
  return own.linear->factor(own.gamma) ? 0 : 1;
}

int solve(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, double)
{
  N_VScale(1.0, b, x);
  callbacks(solver->content).linear->solve(N_VGetArrayPointer(x));
  return 0;
}

int solveTimesCj(SUNLinearSolver solver, SUNMatrix, N_Vector x, N_Vector b, double)
{
  Callbacks& own = callbacks(solver->content);
  N_VScale(own.gamma, b, x);
  own.linear->solve(N_VGetArrayPointer(x));
  return 0;
}

enum class Kind
{
  CVODE,
  IDA,
  ARKODE
};

/// One integrator of SUNDIALS.
class Sundials : public Integrator
{
public:
  Sundials(Kind kind, int order, double tolerance, const Problem& problem)
    : kind_(kind), ring_(problem.ring()), linear_(ring_)
  {
    SUNContext_Create(nullptr, &context_);
    const Eigen::Index n = ring_.states();
    y_ = N_VNew_Serial(n, context_);
    yp_ = N_VClone(y_);
    between_ = N_VClone(y_);
    map(y_) << problem.q, problem.v;
    own_ = { &ring_, &linear_, 0.0, 0, 0, Eigen::VectorXd(n) };
    ring_.rates(N_VGetArrayPointer(y_), 0.0, N_VGetArrayPointer(yp_));
    weights_ = N_VClone(y_);
    map(weights_) = tolerance * problem.scale();
    makeLinear();
    make(order);
  }

  ~Sundials() override
  {
    switch (kind_)
    {
      case Kind::CVODE:
        CVodeFree(&memory_);
        break;
      case Kind::IDA:
        IDAFree(&memory_);
        break;
      case Kind::ARKODE:
        ARKStepFree(&memory_);
        break;
    }
    SUNLinSolFreeEmpty(solver_);
    SUNMatFreeEmpty(matrix_);
    for (N_Vector vector : { y_, yp_, between_, weights_ })
    {
      N_VDestroy(vector);
    }
    SUNContext_Free(&context_);
  }

  Sundials(const Sundials&) = delete;
  Sundials& operator=(const Sundials&) = delete;

  void enter(const Phase& phase, double time) override
  {
    countRejections();
    ring_.setWave(phase.wave);
    ring_.rates(N_VGetArrayPointer(y_), time, N_VGetArrayPointer(yp_));
    switch (kind_)
    {
      case Kind::CVODE:
        CVodeReInit(memory_, time, y_);
        CVodeSetStopTime(memory_, phase.end);
        break;
      case Kind::IDA:
        IDAReInit(memory_, time, y_, yp_);
        IDASetStopTime(memory_, phase.end);
        break;
      case Kind::ARKODE:
        ARKStepReset(memory_, time, y_);
        ARKStepSetStopTime(memory_, phase.end);
        break;
    }
  }

  bool advance(double /*due*/, double end, double& time) override
  {
    int result = 0;
    switch (kind_)
    {
      case Kind::CVODE:
        result = CVode(memory_, end, y_, &time, CV_ONE_STEP);
        break;
      case Kind::IDA:
        result = IDASolve(memory_, end, &time, y_, yp_, IDA_ONE_STEP);
        break;
      case Kind::ARKODE:
        result = ARKStepEvolve(memory_, end, y_, &time, ARK_ONE_STEP);
        break;
    }
    ring_.pairTeeth(map(y_).head(ring_.coordinates()), time);
    ++steps_;
    return result >= 0;
  }

  const double* at(double time) override
  {
    switch (kind_)
    {
      case Kind::CVODE:
        CVodeGetDky(memory_, time, 0, between_);
        break;
      case Kind::IDA:
        IDAGetDky(memory_, time, 0, between_);
        break;
      case Kind::ARKODE:
        ARKStepGetDky(memory_, time, 0, between_);
        break;
    }
    return N_VGetArrayPointer(between_);
  }

  void count(Run& run) override
  {
    countRejections();
    run.steps = steps_;
    run.force_evaluations = own_.evaluations;
    run.factorisations = own_.factorisations;
    run.rejections = rejections_;
  }

private:
  /// Of the phase that ends: a new one sets the counters of SUNDIALS back.
  void countRejections()
  {
    long by_error = 0;
    long by_newton = 0;
    switch (kind_)
    {
      case Kind::CVODE:
        CVodeGetNumErrTestFails(memory_, &by_error);
        CVodeGetNumNonlinSolvConvFails(memory_, &by_newton);
        break;
      case Kind::IDA:
        IDAGetNumErrTestFails(memory_, &by_error);
        IDAGetNumNonlinSolvConvFails(memory_, &by_newton);
        break;
      case Kind::ARKODE:
        rejections_ = 0;  // ARKStepReset keeps its counters
        ARKStepGetNumErrTestFails(memory_, &by_error);
        ARKStepGetNumNonlinSolvConvFails(memory_, &by_newton);
        break;
    }
    rejections_ += by_error + by_newton;
  }

  static Eigen::Map<Eigen::VectorXd> map(N_Vector vector)
  {
    return { N_VGetArrayPointer(vector), static_cast<Eigen::Index>(N_VGetLength(vector)) };
  }

  void makeLinear()
  {
    matrix_ = SUNMatNewEmpty(context_);
    matrix_->ops->getid = [](SUNMatrix) { return SUNMATRIX_CUSTOM; };
    matrix_->ops->zero = [](SUNMatrix) { return 0; };
    solver_ = SUNLinSolNewEmpty(context_);
    solver_->content = &own_;
    solver_->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
    solver_->ops->getid = [](SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; };
    solver_->ops->setup = factor;
    solver_->ops->solve = kind_ == Kind::IDA ? solveTimesCj : solve;
  }

  void make(int order)
  {
    constexpr long MAX_STEPS = 100000000;
    switch (kind_)
    {
      case Kind::CVODE:
        memory_ = CVodeCreate(CV_BDF, context_);
        CVodeInit(memory_, rates, 0.0, y_);
        CVodeSVtolerances(memory_, 0.0, weights_);
        CVodeSetUserData(memory_, &own_);
        CVodeSetMaxOrd(memory_, order);
        CVodeSetMaxNumSteps(memory_, MAX_STEPS);
        CVodeSetLinearSolver(memory_, solver_, matrix_);
        CVodeSetLinSysFn(memory_, linearSystem);
        CVodeSetErrFile(memory_, nullptr);
        break;
      case Kind::IDA:
        memory_ = IDACreate(context_);
        IDAInit(memory_, residual, 0.0, y_, yp_);
        IDASVtolerances(memory_, 0.0, weights_);
        IDASetUserData(memory_, &own_);
        IDASetMaxOrd(memory_, order);
        IDASetMaxNumSteps(memory_, MAX_STEPS);
        IDASetLinearSolver(memory_, solver_, matrix_);
        IDASetJacFn(memory_, residualJacobian);
        IDASetErrFile(memory_, nullptr);
        break;
      case Kind::ARKODE:
        memory_ = ARKStepCreate(nullptr, rates, 0.0, y_, context_);
        ARKStepSVtolerances(memory_, 0.0, weights_);
        ARKStepSetUserData(memory_, &own_);
        ARKStepSetOrder(memory_, order);
        ARKStepSetMaxNumSteps(memory_, MAX_STEPS);
        ARKStepSetLinearSolver(memory_, solver_, matrix_);
        ARKStepSetLinSysFn(memory_, linearSystemWithMass);
        ARKStepSetErrFile(memory_, nullptr);
        break;
    }
  }

  Kind kind_;
  DynamicRing ring_;
  LinearSystem linear_;
  Callbacks own_{};
  SUNContext context_{};
  N_Vector y_{};
  N_Vector yp_{};
  N_Vector between_{};
  N_Vector weights_{};
  SUNMatrix matrix_{};
  SUNLinearSolver solver_{};
  void* memory_{};
  long steps_{};
  long rejections_{};
};
}  // namespace

std::vector<Contender> sundialsContenders(const Problem& problem)
{
  struct Choice
  {
    const char* name;
    Kind kind;
    int order;
  };
  const Choice choices[] = { { "CVODE, order 5, KLU", Kind::CVODE, 5 },  { "CVODE, order 2, KLU", Kind::CVODE, 2 },
                             { "IDA, order 5, KLU", Kind::IDA, 5 },      { "IDA, order 2, KLU", Kind::IDA, 2 },
                             { "ARKODE, DIRK 3, KLU", Kind::ARKODE, 3 }, { "ARKODE, DIRK 5, KLU", Kind::ARKODE, 5 } };
  std::vector<Contender> contenders;
  for (const Choice& choice : choices)
  {
    for (const double tolerance : { 1e0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6 })
    {
      contenders.push_back({ choice.name, "tol = " + text("%.0e", tolerance),
                             [=, &problem](double limit)
                             {
                               Sundials integrator(choice.kind, choice.order, tolerance, problem);
                               return follow(problem, integrator, limit);
                             } });
    }
  }
  return contenders;
}
}  // namespace hjt
