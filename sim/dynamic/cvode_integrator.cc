#include "sim/dynamic/cvode_integrator.h"

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <sundials/sundials_context.hpp>

namespace slipway::sim {

struct CvodeIntegrator::Solver {
  StiffSystem system;
  sundials::Context context;
  Eigen::PartialPivLU<Eigen::MatrixXd> factors;
  Eigen::VectorXd solved;
  N_Vector y = nullptr, absolute = nullptr;
  double relative = 0.0;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  void* cvode = nullptr;
  std::vector<int> directions;
  std::string message;  // CVODE's last error message
  double t = 0.0;
  Work before;  // done before the last restart

  ~Solver() {
    CVodeFree(&cvode);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(absolute);
    N_VDestroy(y);
  }
};

namespace {

// The step's equations are solved by a Newton iteration with an old Jacobian. What it leaves over alternates
// from step to step and is raised 2^order - 1 times by the next step's prediction: at order 5, and at CVODE's
// own share of a tenth of the tolerance, it holds itself at the tolerance and the steps at a fiftieth of the
// length that the motion asks for.
constexpr int kMaxOrder = 3;
constexpr double kSolvedShare = 0.003;

// No exception may cross a callback of a C library.
template <class Call>
int guarded(Call call) noexcept {
  try {
    return call() ? 0 : 1;
  } catch (...) {
    return -1;
  }
}

int derivative(realtype t, N_Vector y, N_Vector rate, void* data) {
  auto& system = static_cast<CvodeIntegrator::Solver*>(data)->system;
  return guarded([&] { return system.derivative(t, NV_DATA_S(y), NV_DATA_S(rate)); });
}

int events(realtype t, N_Vector y, realtype* value, void* data) {
  auto& system = static_cast<CvodeIntegrator::Solver*>(data)->system;
  // CVODE gives up where an event's value is exactly 0 twice in a row, which happens with slow events.
  return guarded([&] {
    if (!system.events(t, NV_DATA_S(y), value)) return false;
    std::replace(value, value + system.event_count, 0.0, std::numeric_limits<double>::min());
    return true;
  });
}

int error_weights(N_Vector y, N_Vector weight, void* data) {
  const auto& solver = *static_cast<CvodeIntegrator::Solver*>(data);
  const double *at = NV_DATA_S(y), *absolute = NV_DATA_S(solver.absolute);
  for (int i = 0; i < solver.system.size; ++i) {
    const double relative = i < solver.system.absolute_only ? 0.0 : solver.relative * std::abs(at[i]);
    NV_DATA_S(weight)[i] = 1.0 / (relative + absolute[i]);
  }
  return 0;
}

void keep_message(int, const char*, const char*, char* message, void* data) {
  static_cast<std::string*>(data)->assign(message);
}

void require(int flag, const char* what) {
  if (flag != CV_SUCCESS) throw std::runtime_error(fmt::format("SUNDIALS: {} failed with {}", what, flag));
}

// Eigen's LU replaces SUNDIALS's own, which does not use the machine's vector units and costs twice as much.
Eigen::Map<Eigen::MatrixXd> dense(SUNMatrix matrix) {
  return {SM_DATA_D(matrix), SM_ROWS_D(matrix), SM_COLUMNS_D(matrix)};
}

SUNLinearSolver eigen_lu(CvodeIntegrator::Solver& solver) {
  SUNLinearSolver linear = SUNLinSolNewEmpty(solver.context);
  if (!linear) return nullptr;
  linear->content = &solver;
  linear->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
  linear->ops->initialize = [](SUNLinearSolver) { return 0; };
  linear->ops->setup = [](SUNLinearSolver self, SUNMatrix matrix) {
    auto& own = *static_cast<CvodeIntegrator::Solver*>(self->content);
    own.factors.compute(dense(matrix));
    return own.factors.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0 ? 0 : 1;
  };
  linear->ops->solve = [](SUNLinearSolver self, SUNMatrix, N_Vector x, N_Vector b, realtype) {
    auto& own = *static_cast<CvodeIntegrator::Solver*>(self->content);
    own.solved = own.factors.solve(Eigen::Map<Eigen::VectorXd>(NV_DATA_S(b), NV_LENGTH_S(b)));
    Eigen::Map<Eigen::VectorXd>(NV_DATA_S(x), NV_LENGTH_S(x)) = own.solved;
    return 0;
  };
  linear->ops->free = [](SUNLinearSolver self) {
    SUNLinSolFreeEmpty(self);
    return 0;
  };
  return linear;
}

std::string reason_of(int flag) {
  switch (flag) {
    case CV_TOO_MUCH_ACC:
      return "the asked accuracy is beyond the machine's";
    case CV_ERR_FAILURE:
      return "the step became too short for the asked accuracy";
    case CV_CONV_FAILURE:
      return "the step's equations could not be solved, however short the step";
    case CV_RHSFUNC_FAIL:
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
    case CV_RTFUNC_FAIL:
      return "the motion left what the model knows";
    default:
      return fmt::format("CVODE ended with {}", flag);
  }
}

}  // namespace

CvodeIntegrator::CvodeIntegrator(StiffSystem system, double relative_tolerance, std::vector<double> absolute,
                                 double max_step_s)
    : solver_(std::make_unique<Solver>()) {
  Solver& s = *solver_;
  s.system = std::move(system);
  s.relative = relative_tolerance;
  s.y = N_VNew_Serial(s.system.size, s.context);
  s.absolute = N_VNew_Serial(s.system.size, s.context);
  s.matrix = SUNDenseMatrix(s.system.size, s.system.size, s.context);
  if (!s.y || !s.absolute || !s.matrix) throw std::bad_alloc();
  s.linear = eigen_lu(s);
  s.cvode = CVodeCreate(CV_BDF, s.context);
  if (!s.linear || !s.cvode) throw std::bad_alloc();
  N_VConst(0.0, s.y);
  std::copy(absolute.begin(), absolute.end(), NV_DATA_S(s.absolute));
  s.directions.resize(s.system.event_count);
  require(CVodeSetErrHandlerFn(s.cvode, keep_message, &s.message), "error handler");
  require(CVodeInit(s.cvode, derivative, 0.0, s.y), "init");
  require(CVodeWFtolerances(s.cvode, error_weights), "tolerances");
  require(CVodeSetUserData(s.cvode, &s), "user data");
  require(CVodeSetLinearSolver(s.cvode, s.linear, s.matrix), "linear solver");
  require(CVodeSetMaxStep(s.cvode, max_step_s), "longest step");
  require(CVodeSetMaxOrd(s.cvode, kMaxOrder), "order");
  require(CVodeSetNonlinConvCoef(s.cvode, kSolvedShare), "solution of a step");
  require(CVodeSetMaxConvFails(s.cvode, 30), "convergence failures");
  require(CVodeSetMaxErrTestFails(s.cvode, 30), "error test failures");
  if (s.system.event_count > 0) {
    require(CVodeRootInit(s.cvode, s.system.event_count, events), "events");
    require(CVodeSetNoInactiveRootWarn(s.cvode), "events");
  }
}

CvodeIntegrator::~CvodeIntegrator() = default;

void CvodeIntegrator::start(double t, std::span<const double> y) {
  restart(t, y);
}

void CvodeIntegrator::restart(double t, std::span<const double> y) {
  Solver& s = *solver_;
  std::copy(y.begin(), y.end(), NV_DATA_S(s.y));
  s.t = t;
  begin_anew();
}

void CvodeIntegrator::set_tolerances(std::span<const double> absolute) {
  std::copy(absolute.begin(), absolute.end(), NV_DATA_S(solver_->absolute));
}

// Restarts CVODE at its present time and state.
void CvodeIntegrator::begin_anew() {
  Solver& s = *solver_;
  s.before = work();
  require(CVodeReInit(s.cvode, s.t, s.y), "restart");
}

void CvodeIntegrator::end_at_event() {
  double reached = solver_->t;
  require(CVodeGetCurrentTime(solver_->cvode, &reached), "current time");
  if (reached > solver_->t) begin_anew();
}

Result<CvodeIntegrator::Step> CvodeIntegrator::step(double t_stop) {
  Solver& s = *solver_;
  // The last step may have gone beyond t_stop, where an event within it made the caller set an earlier stop.
  double reached = s.t;
  require(CVodeGetCurrentTime(s.cvode, &reached), "current time");
  if (t_stop < reached) begin_anew();
  require(CVodeSetStopTime(s.cvode, t_stop), "stop time");
  int flag = CVode(s.cvode, t_stop, s.y, &s.t, CV_ONE_STEP);
  // The step may fail because of history from before a kink of the ground, so it is tried once more without.
  if (flag == CV_CONV_FAILURE || flag == CV_ERR_FAILURE) {
    begin_anew();
    require(CVodeSetStopTime(s.cvode, t_stop), "stop time");
    flag = CVode(s.cvode, t_stop, s.y, &s.t, CV_ONE_STEP);
  }
  if (flag < 0) return fail(ErrorCode::kNotConverged, fmt::format("{} at {:.3f} s", reason_of(flag), s.t));
  if (flag == CV_ROOT_RETURN) CVodeGetRootInfo(s.cvode, s.directions.data());
  return Step{.t = s.t, .event = flag == CV_ROOT_RETURN};
}

std::span<const double> CvodeIntegrator::state() const {
  return {NV_DATA_S(solver_->y), static_cast<std::size_t>(solver_->system.size)};
}

void CvodeIntegrator::interpolate(double t, std::span<double> y) const {
  N_Vector at = N_VMake_Serial(solver_->system.size, y.data(), solver_->context);
  const int flag = CVodeGetDky(solver_->cvode, t, 0, at);
  N_VDestroy(at);
  require(flag, "interpolation");
}

std::span<const int> CvodeIntegrator::event_directions() const {
  return solver_->directions;
}

CvodeIntegrator::Work CvodeIntegrator::work() const {
  Work now = solver_->before;
  long count = 0;
  const auto add = [&](int (*get)(void*, long*), long& to) {
    if (get(solver_->cvode, &count) == CV_SUCCESS) to += count;
  };
  add(CVodeGetNumSteps, now.steps);
  add(CVodeGetNumRhsEvals, now.evaluations);
  add(CVodeGetNumLinRhsEvals, now.evaluations);
  add(CVodeGetNumJacEvals, now.jacobians);
  add(CVodeGetNumErrTestFails, now.error_test_failures);
  add(CVodeGetNumNonlinSolvConvFails, now.solver_failures);
  return now;
}

}  // namespace slipway::sim
