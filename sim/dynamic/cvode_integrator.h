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
  // The number of states at the front that are held to their absolute tolerance alone, because their values
  // have no scale, such as positions or attitudes.
  int absolute_only = 0;
  // Returns false where f is not defined at y; the step is then tried again with a shorter length.
  std::function<bool(double t, const double* y, double* rate)> derivative;
  int event_count = 0;
  // Event values should be of order one near 0. Returns false as above.
  std::function<bool(double t, const double* y, double* value)> events = nullptr;
};

// CVODE's backward differentiation formulas with a dense Jacobian by differences: variable step and order
// [Hindmarsh 2005]. Each integrator has a SUNDIALS context of its own, so that runs on several threads are
// independent; the same start gives the same bits.
class CvodeIntegrator {
 public:
  // absolute has one tolerance for each state; max_step_s is the longest step. Throws std::bad_alloc or
  // std::runtime_error where SUNDIALS cannot be set up, which a correct caller does not meet.
  CvodeIntegrator(StiffSystem system, double relative_tolerance, std::vector<double> absolute,
                  double max_step_s);
  ~CvodeIntegrator();
  CvodeIntegrator(const CvodeIntegrator&) = delete;
  CvodeIntegrator& operator=(const CvodeIntegrator&) = delete;

  void start(double t, std::span<const double> y);
  // Starts again from here at order one, as is needed after a jump in y or f.
  void restart(double t, std::span<const double> y);
  // From the next step on these are the absolute tolerances, one for each state.
  void set_tolerances(std::span<const double> absolute);

  // Takes back what the last step went beyond its end, where that was an event: for a caller that changes f
  // there.
  void end_at_event();

  struct Step {
    double t = 0.0;
    bool event = false;  // the step ended at an event, see event_directions()
  };
  // One internal step that does not go beyond t_stop. Errors: not_converged with CVODE's own reason as a
  // sentence.
  Result<Step> step(double t_stop);
  // The state at the end of the last step, and at any time within it.
  std::span<const double> state() const;
  void interpolate(double t, std::span<double> y) const;
  // For the last step that ended at an event: the direction in which each event's value goes through 0 (-1 or
  // 1), and 0 for events that did not happen.
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
