#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/result.h"

namespace slipway::sim {

// A stiff system y' = f(t, y) with events g(t, y) = 0.
struct StiffSystem {
  int size = 0;
  // So many at the front are held to their absolute tolerance alone: what has no size of its own, as a place
  // or an attitude.
  int absolute_only = 0;
  // False where y is outside what f knows: the step is tried again, shorter.
  std::function<bool(double t, const double* y, double* rate)> derivative;
  int event_count = 0;
  // Keep them of order one near 0. False as above.
  std::function<bool(double t, const double* y, double* value)> events = nullptr;
};

// CVODE's backward differentiation formulas with a dense Jacobian by differences: variable step and order
// [Hindmarsh 2005]. One context a run, so that runs on several threads don't meet; the same start gives the
// same bits.
class CvodeIntegrator {
 public:
  // absolute: one tolerance for each state. Throws std::bad_alloc or std::runtime_error where SUNDIALS can't
  // be set up: not an error a caller can meet.
  CvodeIntegrator(StiffSystem system, double relative_tolerance, std::vector<double> absolute,
                  double longest_step);
  ~CvodeIntegrator();
  CvodeIntegrator(const CvodeIntegrator&) = delete;
  CvodeIntegrator& operator=(const CvodeIntegrator&) = delete;

  void start(double t, std::span<const double> y);
  // From here at order one: after a jump in y or f.
  void restart(double t, std::span<const double> y);

  struct Step {
    double t = 0.0;
    bool event = false;  // ended at one: see event_directions()
  };
  // One internal step, not beyond t_stop. Errors: not_converged with CVODE's own reason as a sentence.
  Result<Step> step(double t_stop);
  // State at the end of the last step, and at any time within it.
  std::span<const double> state() const;
  void interpolate(double t, std::span<double> y) const;
  // Of the last step that ended at an event: -1, 0, 1 for each, the way its value goes through 0.
  std::span<const int> event_directions() const;

  struct Work {
    long steps = 0, evaluations = 0, jacobians = 0, error_test_failures = 0, solver_failures = 0;
  };
  Work work() const;  // since construction, restarts included

  struct Solver;

 private:
  void begin_anew();

  std::unique_ptr<Solver> solver_;
};

}  // namespace slipway::sim
