// The calibration of names is the most likely one on the kept answers that ship.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "gap/diagnosis/decide/calibration.h"
#include "research/validation/report/csv_table.h"

namespace slipway::validation {
namespace {

struct Answer {
  Eigen::Vector3d features;
  double hidden = 0.0;
};

std::vector<Answer> kept_answers(bool with_reference) {
  const auto table =
      CsvTable::read(std::filesystem::path(SLIPWAY_DATA_FOLDER) / "validation/sealed_levels_marginals.csv",
                     {.numbers = {"probability", "closed_share", "hidden"},
                      .numbers_or_empty = {},
                      .texts = {"variant", "fidelity"}});
  if (!table) throw std::runtime_error(table.error().detail);
  std::vector<Answer> answers;
  for (std::size_t r = 0; r < table->rows(); ++r) {
    const bool has_reference = table->text(r, "variant").find("reference") != std::string::npos;
    const bool other_physics = table->text(r, "fidelity") == "L3";
    const double share = table->number(r, "closed_share");
    if (has_reference != with_reference || (other_physics && !has_reference) || !(share > 0.0)) continue;
    const double p = std::clamp(table->number(r, "probability"), 0.01, 0.99);
    answers.push_back(
        {{1.0, std::log(p / (1.0 - p)), std::log(std::max(share, 0.01))}, table->number(r, "hidden")});
  }
  return answers;
}

Eigen::Vector3d most_likely(const std::vector<Answer>& answers) {
  Eigen::Vector3d w = Eigen::Vector3d::Zero();
  for (int i = 0; i < 30; ++i) {
    Eigen::Matrix3d curvature = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d slope = Eigen::Vector3d::Zero();
    for (const Answer& a : answers) {
      const double q = 1.0 / (1.0 + std::exp(-w.dot(a.features)));
      slope += (a.hidden - q) * a.features;
      curvature += q * (1.0 - q) * a.features * a.features.transpose();
    }
    w += curvature.ldlt().solve(slope);
  }
  return w;
}

TEST(NamesCalibration, IsTheMostLikelyOneOnTheKeptAnswers) {
  for (const bool with_reference : {false, true}) {
    const std::vector<Answer> answers = kept_answers(with_reference);
    ASSERT_GT(answers.size(), 1000U);
    const Eigen::Vector3d fitted = most_likely(answers);
    const gap::Calibration& shipped = gap::calibration(with_reference);
    const Eigen::Vector3d numbers(shipped.constant, shipped.by_log_odds, shipped.by_log_share);
    EXPECT_LT((numbers - fitted).cwiseAbs().maxCoeff(), 1e-3) << fitted.transpose();
  }
}

}  // namespace
}  // namespace slipway::validation
