#include "gap/diagnosis/search/effect_trace.h"

#include <cmath>

namespace slipway::gap {

Eigen::VectorXd effect_trace(const FittedExplanation& fit, const WindowModel& model, std::string_view effect,
                             std::size_t threads) {
  const auto parameters = fit.hypothesis.parameters();
  std::vector<double> x = fit.x;
  for (std::size_t p = fit.hypothesis.nuisance_count(); p < x.size(); ++p)
    if (effect.empty() || parameters[p].effect == effect) x[p] = parameters[p].neutral;
  const std::vector<double> with = fit.hypothesis.predict(model, fit.x, threads),
                            without = fit.hypothesis.predict(model, x, threads);
  Eigen::VectorXd trace(static_cast<Eigen::Index>(with.size()));
  for (std::size_t i = 0; i < with.size(); ++i) {
    const double change = with[i] - without[i];
    trace[static_cast<Eigen::Index>(i)] = std::isfinite(change) ? change : 0.0;
  }
  return trace;
}

}  // namespace slipway::gap
