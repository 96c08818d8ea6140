#include "gap/diagnosis/describe/measurement_proposals.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>

#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

// A fit in which every re-tuned parameter has an observation of its own, one deviation a prior deviation;
// behind them one observation that no parameter touches.
ExplanationSearch search_of_unit_parameters(
    const std::map<std::string, double, std::less<>>& parameter_std = {}) {
  DriveCampaign campaign;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.soils.resize(1);
  campaign.parameter_std = parameter_std;
  ExplanationSearch search;
  search.fits.push_back({{}, Hypothesis(campaign, {})});
  const auto count = static_cast<Eigen::Index>(search.fits[0].hypothesis.nuisance_count());
  search.fits[0].white_jacobian = Eigen::MatrixXd::Identity(count + 1, count);
  return search;
}

Eigen::Index place_of_parameter(const ExplanationSearch& search, const std::string& name) {
  const auto parameters = search.fits[0].hypothesis.parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (parameters[p].name == name) return static_cast<Eigen::Index>(p);
  ADD_FAILURE() << name;
  return 0;
}

// Acts on the rows of these parameters alone, so that re-tuning hides it.
ScreenedVariant hidden_behind(const ExplanationSearch& search, const std::string& effect,
                              const std::vector<std::pair<std::string, double>>& rows) {
  ScreenedVariant s;
  s.variant.effect = effect;
  s.columns = Eigen::MatrixXd::Zero(search.fits[0].white_jacobian.rows(), 1);
  for (const auto& [name, deviations] : rows) s.columns(place_of_parameter(search, name), 0) = deviations;
  return s;
}

std::vector<MeasurementProposal> proposals_of(const ExplanationSearch& search) {
  return measurement_proposals(search, [](const Eigen::VectorXd& change) { return change; }, {});
}

TEST(MeasurementProposals, AskForTheFewestKindsThatUncoverAnEffect) {
  ExplanationSearch search = search_of_unit_parameters();
  search.screened = {hidden_behind(search, "hardpan", {{"n", 8.0}, {"c1", 4.0}}),
                     hidden_behind(search, "bulldozing", {{"n", 5.0}, {"c1", 5.0}}),
                     hidden_behind(search, "gearbox_friction", {{"torque_constant", 20.0}}),
                     hidden_behind(search, "duricrust", {{"n", 2.0}})};
  const std::vector<MeasurementProposal> proposals = proposals_of(search);
  ASSERT_EQ(proposals.size(), 3U) << "what is too small in all cannot be uncovered";
  EXPECT_EQ(proposals[0].effect, "bulldozing");
  EXPECT_EQ(proposals[0].kinds, (std::vector{NuisanceKind::kSoil, NuisanceKind::kClosure}));
  EXPECT_NEAR(proposals[0].deviations_then, std::hypot(5.0, 5.0), 1e-12);
  EXPECT_EQ(proposals[1].effect, "gearbox_friction");
  EXPECT_EQ(proposals[1].kinds, std::vector{NuisanceKind::kMotor});
  EXPECT_EQ(proposals[2].effect, "hardpan");
  EXPECT_EQ(proposals[2].kinds, std::vector{NuisanceKind::kSoil});
  EXPECT_NEAR(proposals[2].deviations_then, 8.0, 1e-12);
  EXPECT_NEAR(proposals[2].deviations_now, 0.0, 1e-12);
  EXPECT_EQ(proposals[2].parameters,
            (std::vector<std::string>{"stiffness", "n", "cohesion", "friction", "shear_modulus"}));
}

TEST(MeasurementProposals, AskForNothingWhereAllWasMeasured) {
  std::map<std::string, double, std::less<>> all;
  for (const Nuisance& row : nuisance_catalogue()) all.emplace(row.name, row.std);
  ExplanationSearch search = search_of_unit_parameters(all);
  search.screened = {hidden_behind(search, "hardpan", {{"n", 8.0}}),
                     hidden_behind(search, "duricrust", {{"n", 2.0}})};
  EXPECT_TRUE(proposals_of(search).empty());
}

TEST(MeasurementProposals, AskForNothingWhereOneWayWouldHaveShown) {
  ExplanationSearch search = search_of_unit_parameters();
  search.screened = {hidden_behind(search, "hardpan", {{"n", 8.0}}),
                     hidden_behind(search, "hardpan", {{"n", 8.0}})};
  search.screened[1].visibility = 6.5;
  EXPECT_TRUE(proposals_of(search).empty());
}

TEST(MeasurementProposals, DoNotAskForWhatWasMeasured) {
  ExplanationSearch search = search_of_unit_parameters({{"n", 0.01}});
  search.screened = {hidden_behind(search, "hardpan", {{"n", 8.0}}),
                     hidden_behind(search, "bulldozing", {{"stiffness", 8.0}})};
  const std::vector<MeasurementProposal> proposals = proposals_of(search);
  ASSERT_EQ(proposals.size(), 1U) << "the hard layer would have shown";
  EXPECT_EQ(proposals[0].effect, "bulldozing");
  EXPECT_EQ(proposals[0].parameters,
            (std::vector<std::string>{"stiffness", "cohesion", "friction", "shear_modulus"}));
}

}  // namespace
}  // namespace slipway::gap
