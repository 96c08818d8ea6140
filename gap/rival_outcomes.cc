#include "gap/rival_outcomes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace slipway::gap {
namespace {

// I(family; outcomes) = H(outcomes) - H(outcomes | family), in bits, of Bhattacharyya distances between all
// pairs of rivals; weights add up to 1.
double information_bits(const RivalOutcomes& outcomes, const Eigen::MatrixXd& distances) {
  const auto count = outcomes.weights.size();
  double bits = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    double all = 0.0, own = 0.0, own_weight = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      const double overlap = outcomes.weights[j] *
                             std::exp(-distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      all += overlap;
      if (outcomes.family[j] != outcomes.family[i]) continue;
      own += overlap;
      own_weight += outcomes.weights[j];
    }
    if (outcomes.weights[i] > 0.0) bits -= outcomes.weights[i] * std::log2(all / (own / own_weight));
  }
  return bits;
}

// Of one drive, with what is left open of the parameters in the scatter.
Eigen::LLT<Eigen::MatrixXd> scatter_of(const RivalOutcomes& outcomes, std::size_t drive) {
  const Eigen::Index from = outcomes.first_row[drive], rows = outcomes.first_row[drive + 1] - from;
  const auto j = outcomes.responses.middleRows(from, rows);
  return Eigen::LLT<Eigen::MatrixXd>(Eigen::MatrixXd::Identity(rows, rows) +
                                     j * outcomes.covariance * j.transpose());
}

Eigen::MatrixXd distances_of(const RivalOutcomes& outcomes, std::size_t drive) {
  const Eigen::Index from = outcomes.first_row[drive], rows = outcomes.first_row[drive + 1] - from;
  const Eigen::MatrixXd white =
      scatter_of(outcomes, drive).matrixL().solve(outcomes.means.middleRows(from, rows));
  const Eigen::MatrixXd products = white.transpose() * white;
  const double share = outcomes.imprecision * outcomes.imprecision;
  Eigen::MatrixXd distances = Eigen::MatrixXd::Zero(white.cols(), white.cols());
  for (Eigen::Index a = 0; a < white.cols(); ++a)
    for (Eigen::Index b = 0; b < a; ++b) {
      const double square = products(a, a) - 2.0 * products(a, b) + products(b, b);
      // With the shares of both that may be off: (1 + f^2 (a a^T + b b^T))^-1, by Woodbury.
      Eigen::Matrix2d inner;
      inner << 1.0 + share * products(a, a), share * products(a, b), share * products(a, b),
          1.0 + share * products(b, b);
      const Eigen::Vector2d along(products(a, a) - products(a, b), products(a, b) - products(b, b));
      const double off = share * along.dot(inner.inverse() * along);
      distances(a, b) = distances(b, a) = outcomes.believed / 8.0 * std::max(0.0, square - off);
    }
  return distances;
}

// As if the drive had been made: under each rival the parameters would be re-tuned to what it shows.
void learn_from(RivalOutcomes& outcomes, std::size_t drive) {
  const Eigen::Index from = outcomes.first_row[drive], rows = outcomes.first_row[drive + 1] - from;
  const Eigen::MatrixXd j = outcomes.responses.middleRows(from, rows),
                        shown = outcomes.means.middleRows(from, rows);
  const Eigen::MatrixXd gain = scatter_of(outcomes, drive).solve(j * outcomes.covariance).transpose();
  outcomes.means -= outcomes.responses * (gain * shown);
  outcomes.covariance -= gain * j * outcomes.covariance;
}

}  // namespace

std::vector<ChosenDrive> most_telling_drives(RivalOutcomes outcomes, std::size_t most, double least_bits) {
  const double sum = std::accumulate(outcomes.weights.begin(), outcomes.weights.end(), 0.0);
  for (double& weight : outcomes.weights) weight /= sum;
  const auto rivals = static_cast<Eigen::Index>(outcomes.weights.size());
  Eigen::MatrixXd known = Eigen::MatrixXd::Zero(rivals, rivals);
  double known_bits = 0.0;
  std::vector<ChosenDrive> chosen;
  while (chosen.size() < most) {
    ChosenDrive best{.drive = 0, .bits = -1.0};
    for (std::size_t d = 0; d < outcomes.drives(); ++d) {
      if (std::any_of(chosen.begin(), chosen.end(), [&](const ChosenDrive& c) { return c.drive == d; }))
        continue;
      const double bits = information_bits(outcomes, known + distances_of(outcomes, d)) - known_bits;
      if (bits > best.bits) best = {d, bits};
    }
    if (best.bits < least_bits) break;
    known += distances_of(outcomes, best.drive);
    known_bits += best.bits;
    learn_from(outcomes, best.drive);
    chosen.push_back(best);
  }
  return chosen;
}

}  // namespace slipway::gap
