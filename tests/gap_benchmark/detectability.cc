#include "detectability.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "random_stream.h"
#include "stretch_reading.h"

namespace slipway::gap_benchmark {
namespace {

// What a diagnosis may re-tune: its change in a world, and the deviations of two priors: by which the
// campaigns' usual nominal soils and the closures of L2c are off (`believed` and `closure_of` in
// sealed_campaign.cc), and of the diagnosis (docs/method/estimator.md), of the same quantity. 0 where one of
// them does not vary it.
struct Retuned {
  std::function<void(World&, double)> change;
  double drawn = 0.0, believed = 0.0;
  double step = 0.0;  // of the difference quotient
};

const std::vector<Retuned>& retuned_parameters() {
  static const std::vector<Retuned> parameters{
      {[](World& w, double d) { w.soil.k_c *= std::exp(d), w.soil.k_phi *= std::exp(d); }, 0.070, 0.15, 0.02},
      {[](World& w, double d) { w.soil.n *= std::exp(d); }, 0.022, 0.06, 0.01},
      {[](World& w, double d) { w.soil.cohesion_pa *= std::exp(d); }, 0.070, 0.15, 0.02},
      {[](World& w, double d) { w.soil.friction_rad *= std::exp(d); }, 0.019, 0.046, 0.005},
      {[](World& w, double d) { w.soil.shear_modulus_m *= std::exp(d); }, 0.079, 0.15, 0.02},
      {[](World& w, double d) { w.soil.c1 += d; }, 0.023, 0.05, 0.005},
      {[](World& w, double d) { w.soil.c2 += d; }, 0.042, 0.05, 0.01},
      {[](World& w, double d) { w.closure.exit_share += d; }, 0.058, 0.1, 0.02},
      {[](World& w, double d) { w.closure.rise_share += d; }, 0.023, 0.0, 0.01},
      {[](World& w, double d) { w.closure.pull_below_axle -= d; }, 0.144, 0.5, 0.05},
      {[](World& w, double d) { w.closure.lateral_modulus *= std::exp(d); }, 0.0, 0.15, 0.03},
      {[](World& w, double) { w.closure.coupled_shear = !w.closure.coupled_shear; }, 0.46, 0.5, 1.0},
      {[](World& w, double) { w.closure.parabolic_stress = !w.closure.parabolic_stress; }, 0.5, 0.0, 1.0},
      {[](World& w, double d) { w.rover.com_m.z() += d; }, 0.0, 0.05, 0.01},
      {[](World& w, double d) { w.rover.torque_constant_nm_a *= std::exp(d); }, 0.0, 0.01, 0.005}};
  return parameters;
}

// Stiffness, friction and shear modulus scatter, as the first, fourth and fifth parameter.
struct Scattered {
  std::size_t parameter = 0;
  double deviation = 0.0;
};
std::array<Scattered, 3> scattered_parameters(const SoilScatter& scatter) {
  return {Scattered{0, scatter.stiffness}, {3, scatter.friction}, {4, scatter.shear_modulus}};
}

// One reading of a stretch.
struct Observation {
  std::size_t stretch = 0;
  double variance = 0.0;  // of its sensor
  double change = 0.0;    // by the hidden causes
  Eigen::VectorXd slope;  // by the parameters, per unit
};

std::vector<Observation> observations_of(const SealedCampaign& campaign, const MadeDrive& drive) {
  const std::vector<Retuned>& parameters = retuned_parameters();
  const World bare = without_hidden_causes(campaign.world);
  const std::vector<Stretch> stretches = stretches_of(drive);
  const auto without = replayed(campaign, bare, drive, drive.rows);
  std::vector<DriveRow> middles;
  for (const Stretch& stretch : stretches) middles.push_back(drive.rows[stretch.middle()]);
  // Of the same rows as the changed worlds, so that wheels meet the same tracks.
  const auto nominal = replayed(campaign, bare, drive, middles);
  std::vector<std::vector<std::optional<DriveRow>>> changed;
  for (const Retuned& parameter : parameters) {
    World world = bare;
    parameter.change(world, parameter.step);
    changed.push_back(replayed(campaign, world, drive, middles));
  }
  std::vector<Observation> observations;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const Stretch& stretch = stretches[s];
    bool found = nominal[s].has_value();
    for (const auto& rows : changed) found = found && rows[s].has_value();
    if (!found) continue;
    const Reading here = reading_of(drive.order, *nominal[s]);
    std::vector<Reading> there;
    for (const auto& rows : changed) there.push_back(reading_of(drive.order, *rows[s]));
    const MeanReading means = mean_reading_of(drive, stretch, without);
    const std::span<const DriveRow> rows =
        std::span(drive.rows).subspan(stretch.from, stretch.to - stretch.from + 1);
    for (std::size_t c = 0; c < kTraceChannels.size(); ++c) {
      if (means.rows[c] == 0 || (c == kSinkage && !campaign.made_of.sinkage)) continue;
      for (std::size_t k = 0; k < here[c].size(); ++k) {
        const double mean = means.mean[c][k];
        if (c == kSlip && mean > kStuckSlip) continue;
        Observation observation{s, 0.0, means.change[c][k], Eigen::VectorXd(parameters.size())};
        observation.variance = std::pow(sensor_deviation(c, drive.order, rows, means.rows[c], mean), 2);
        for (std::size_t p = 0; p < parameters.size(); ++p)
          observation.slope[static_cast<Eigen::Index>(p)] =
              (there[p][c][k] - here[c][k]) / parameters[p].step;
        observations.push_back(std::move(observation));
      }
    }
  }
  return observations;
}

// The sums over drives of d' C^-1 d, J' C^-1 d and J' C^-1 J, with the change d, the parameters' slopes J and
// the covariance C of a drive.
struct Sums {
  double square = 0.0;
  Eigen::VectorXd product;
  Eigen::MatrixXd normal;
};

void add_drive(const std::vector<Observation>& observations, const SoilScatter& scatter, Sums& sums) {
  const auto n = static_cast<Eigen::Index>(observations.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd slopes(n, sums.product.size());
  Eigen::VectorXd change(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Observation& one = observations[static_cast<std::size_t>(i)];
    change[i] = one.change;
    slopes.row(i) = one.slope.transpose();
    covariance(i, i) += one.variance;
    for (Eigen::Index j = 0; j < n; ++j) {
      const Observation& other = observations[static_cast<std::size_t>(j)];
      const double along = one.stretch == other.stretch ? scatter.along * scatter.along : 0.0;
      for (const Scattered& scattered : scattered_parameters(scatter)) {
        const auto p = static_cast<Eigen::Index>(scattered.parameter);
        covariance(i, j) += (RandomStream::kBoundedVariance + along) * std::pow(scattered.deviation, 2) *
                            one.slope[p] * other.slope[p];
      }
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  const Eigen::VectorXd whitened = factor.matrixL().solve(change);
  const Eigen::MatrixXd white_slopes = factor.matrixL().solve(slopes);
  sums.square += whitened.squaredNorm();
  sums.product += white_slopes.transpose() * whitened;
  sums.normal += white_slopes.transpose() * white_slopes;
}

// The distance that is left where the parameters are fitted within a prior.
double left_over(const Sums& sums, double Retuned::*deviation) {
  const std::vector<Retuned>& parameters = retuned_parameters();
  Eigen::VectorXd width(sums.product.size());
  for (Eigen::Index p = 0; p < width.size(); ++p)
    width[p] = parameters[static_cast<std::size_t>(p)].*deviation;
  const Eigen::VectorXd product = width.cwiseProduct(sums.product);
  Eigen::MatrixXd normal = width.asDiagonal() * sums.normal * width.asDiagonal();
  normal.diagonal().array() += 1.0;
  return sums.square - product.dot(normal.ldlt().solve(product));
}

}  // namespace

Detectability detectability(const SealedCampaign& campaign) {
  if (campaign.effects.empty()) return {};
  const auto count = static_cast<Eigen::Index>(retuned_parameters().size());
  Sums sums{0.0, Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
  for (const MadeDrive& drive : campaign.drives)
    add_drive(observations_of(campaign, drive), campaign.world.scatter, sums);
  return {sums.square, left_over(sums, &Retuned::drawn), left_over(sums, &Retuned::believed)};
}

std::string detectability_header() {
  return "campaign,parameters_known,retuned_as_drawn,retuned_as_believed\n";
}

std::string detectability_row(const std::string& campaign, const Detectability& detectability) {
  std::array<char, 96> numbers;
  std::snprintf(numbers.data(), numbers.size(), ",%.4g,%.4g,%.4g\n", detectability.parameters_known,
                detectability.retuned_as_drawn, detectability.retuned_as_believed);
  return campaign + numbers.data();
}

}  // namespace slipway::gap_benchmark
