#include "api/files/parameter_posterior.h"

#include <Eigen/Eigenvalues>

namespace slipway::api::json {
namespace {

constexpr std::string_view kKey = "left_open";
constexpr std::size_t kMaxParameters = 10000;

}  // namespace

void write_parameter_posterior(Writer& w, const gap::ParameterPosterior& posterior) {
  w.key(kKey).begin_array();
  for (std::size_t i = 0; i < posterior.names.size(); ++i) {
    const double deviation = posterior.deviation(i);
    w.begin_object().text("name", posterior.names[i]).significant("deviation", deviation);
    w.key("correlation").begin_array();
    for (std::size_t j = 0; j < i; ++j) {
      const double both = posterior.covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      const double scale = deviation * posterior.deviation(j);
      w.significant(scale > 0.0 ? both / scale : 0.0);
    }
    w.end_array().end_object();
  }
  w.end_array();
}

std::optional<gap::ParameterPosterior> read_parameter_posterior(ObjectReader& model) {
  const std::size_t before = model.faults().size();
  const std::vector<Element> elements = model.list(kKey, kOptional, {1, kMaxParameters});
  if (elements.empty()) return std::nullopt;
  gap::ParameterPosterior posterior;
  const auto count = static_cast<Eigen::Index>(elements.size());
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(count);
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    ObjectReader reader = model.object(elements[n]);
    std::vector<double> with;
    posterior.names.emplace_back();
    reader.text("name", kRequired, {.most = 100}, posterior.names.back());
    reader.number("deviation", kRequired, {"", 0.0, 1e6}, deviations[i]);
    reader.numbers("correlation", kRequired, {n, n}, {"", -1.0, 1.0}, with);
    reader.refuse_unknown();
    for (std::size_t j = 0; j < with.size(); ++j)
      correlation(i, static_cast<Eigen::Index>(j)) = correlation(static_cast<Eigen::Index>(j), i) = with[j];
  }
  if (model.faults().size() != before) return std::nullopt;
  // As rounded in writing.
  constexpr double kRounding = 1e-3;
  if (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .minCoeff() < -kRounding)
    model.fault(kKey, "the correlations contradict each other: their matrix is not positive definite");
  posterior.covariance = deviations.asDiagonal() * correlation * deviations.asDiagonal();
  return posterior;
}

}  // namespace slipway::api::json
