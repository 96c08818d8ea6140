#include "gap/diagnosis/model/hypothesis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/angle.h"
#include "sim/effects/effect_catalogue.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

constexpr double kSlope = 0.1;  // the ground rises eastward, rad; a rover on loose sand still climbs it

// A plane that rises eastward, with the first soil in the west and the last in the east.
class Incline : public sim::Ground {
 public:
  explicit Incline(std::size_t soils) : soils_(soils) {}
  std::optional<sim::GroundPoint> at(double x_m, double /*y_m*/) const override {
    return sim::GroundPoint{std::tan(kSlope) * x_m, {-std::sin(kSlope), 0.0, std::cos(kSlope)}};
  }
  std::optional<std::size_t> soil_at(double x_m, double /*y_m*/) const override {
    return x_m < 2.0 ? 0 : soils_ - 1;
  }

 private:
  std::size_t soils_;
};

sim::Soil sinking_sand() {
  sim::Soil soil = sim::loose_sand();
  soil.n1 = 0.2;
  soil.n1_skid = 0.1;
  soil.n1_lateral = 0.05;
  return soil;
}

// A drive uphill and across whose windows have every channel; what was measured does not matter here.
DriveCampaign campaign_on(const std::vector<sim::Soil>& soils,
                          const sim::RoverModel& rover = sim::six_wheeler()) {
  DriveCampaign campaign;
  campaign.gravity_m_s2 = 3.71;
  campaign.rover = std::make_shared<sim::RoverModel>(rover);
  campaign.measurement_std = {0.003, 0.003, 0.02, 0.003, 0.001};
  for (const sim::Soil& soil : soils)
    campaign.soils.push_back({"soil" + std::to_string(campaign.soils.size()), soil});
  campaign.terrains.push_back({"incline", std::make_shared<Incline>(soils.size()), ""});
  MeasuredDriveSeries drive;
  drive.id = "up";
  drive.command.speed_m_s = 0.05;
  drive.command.curvature_1_m = 0.05;
  drive.duration_s = 60.0;
  for (int i = 0; i <= 60; ++i) {
    DriveSample sample;
    sample.time_s = i;
    const double x_m = 0.04 * i, yaw_rad = 0.3;
    sample.p_MB = {x_m, 0.3 * x_m, std::tan(kSlope) * x_m};
    sample.attitude = {0.05, -kSlope, yaw_rad};
    sample.wheels = sim::PerWheel<WheelReading>(rover.wheels.size());
    for (WheelReading& wheel : sample.wheels) {
      wheel.current_a = 0.2 + 0.01 * i;
      wheel.sinkage_m = 0.02;
      wheel.motor_temp_c = -30.0;
    }
    sample.wheels[1].current_a = 0.3;
    drive.samples.push_back(sample);
  }
  campaign.drives.push_back(drive);
  return campaign;
}

struct Predicted {
  explicit Predicted(DriveCampaign of)
      : campaign(std::move(of)), windows(cut_windows(campaign)), model(campaign, windows) {}
  std::vector<double> of(const std::vector<EffectVariant>& effects) const {
    const Hypothesis hypothesis(campaign, effects);
    return hypothesis.predict(model, hypothesis.neutral());
  }
  DriveCampaign campaign;
  std::vector<DriveWindow> windows;
  WindowModel model;
};

EffectVariant variant_named(const sim::RoverModel& rover, const std::string& effect,
                            const std::string& label = "") {
  for (const EffectVariant& v : effect_variants(rover, {}))
    if (v.effect == effect && (label.empty() || v.label == label)) return v;
  ADD_FAILURE() << "no variant of " << effect << " " << label;
  return {};
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST(Hypothesis, AtItsNeutralValuesEveryEffectLeavesASinkingSoilAndARoverWithGrousersAsTheyAre) {
  sim::RoverModel rover = sim::six_wheeler();
  for (sim::WheelModel& wheel : rover.wheels)
    wheel.grousers = sim::Grousers{.height_m = 0.006,
                                   .count = 20.0,
                                   .mobilisation = 0.7,
                                   .by_slip = 0.4,
                                   .surcharge = 0.3,
                                   .thrust = 0.6,
                                   .braking = 0.5,
                                   .shear_share = 0.3,
                                   .shear_by_spacing = 0.2};
  const Predicted predicted(campaign_on({sinking_sand()}, rover));
  const std::vector<double> nominal = predicted.of({});
  ASSERT_FALSE(nominal.empty());
  std::vector<EffectVariant> variants = effect_variants(rover, {});
  variants.push_back(variant_at(*sim::find_effect("soft_patch"), {1.0, 0.3, 2.0}));
  for (const EffectVariant& variant : variants)
    EXPECT_LT(largest_difference(predicted.of({variant}), nominal), 1e-9)
        << variant.effect << " " << variant.label;
}

// A rover file may have effects of its own: a hypothesis starts from them.
TEST(Hypothesis, AtItsNeutralValuesEveryEffectLeavesTheRoversOwnEffectsAsTheyAre) {
  sim::RoverModel rover = sim::six_wheeler();
  rover.effects = {{"dragging_wheel", {{"wheel", 4.0}, {"rate_share", 0.9}, {"drag_nm", 1.0}}},
                   {"slip_sinkage", {{"n1", 0.15}, {"n1_lateral", 0.1}}},
                   {"grousers", {{"height_m", 0.008}}},
                   {"motor_temperature", {}}};
  const Predicted predicted(campaign_on({sim::loose_sand()}, rover));
  const std::vector<double> nominal = predicted.of({});
  std::map<std::string, int> variants_of;
  for (const EffectVariant& variant : effect_variants(rover, {})) {
    ++variants_of[variant.effect];
    EXPECT_EQ(predicted.of({variant}), nominal) << variant.effect << " " << variant.label;
  }
  for (const sim::EffectSetting& own : rover.effects) EXPECT_EQ(variants_of[own.name], 1) << own.name;
  const EffectVariant drag = variant_named(rover, "dragging_wheel");
  EXPECT_EQ(drag.fixed, (std::vector<std::pair<std::string, double>>{{"wheel", 4.0}}));
  const Hypothesis hypothesis(predicted.campaign, {drag});
  EXPECT_EQ(hypothesis.neutral().back(), 1.0) << "drag_nm as the rover has it";
}

// The derivative at neutral against soils whose own n1 is a little greater.
TEST(Hypothesis, TheDerivativeBySlipSinkageOnASinkingSoilIsThatOfTheSoilsOwnExponent) {
  const std::vector<sim::Soil> soils{sinking_sand(), sim::sandy_loam()};
  const Predicted predicted(campaign_on(soils));
  const Hypothesis hypothesis(predicted.campaign, {variant_named(*predicted.campaign.rover, "slip_sinkage")});
  const std::vector<double> x = hypothesis.neutral();
  const std::vector<double> nominal = predicted.of({});
  const Eigen::VectorXd column = hypothesis.scaled_jacobian(predicted.model, x, 1).rightCols(1);

  const double step = hypothesis.step(hypothesis.parameters().size() - 1);
  std::vector<sim::Soil> deeper = soils;
  for (sim::Soil& soil : deeper) soil.n1 += step;
  const std::vector<double> above = Predicted(campaign_on(deeper)).of({});
  const double std = hypothesis.parameters().back().std;
  double largest = 0.0;
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    const double expected = std * (above[i] - nominal[i]) / step;
    EXPECT_NEAR(column[static_cast<Eigen::Index>(i)], expected, 1e-4 * (1.0 + std::abs(expected))) << i;
    largest = std::max(largest, std::abs(expected));
  }
  EXPECT_GT(largest, 0.01) << "slip sinkage matters on this slope";
}

// Three drives alike: the first on the soil as it is, the last on one of nine tenths of its strength.
TEST(Hypothesis, SoilThatDriftsIsWeakerUnderTheLastDriveAloneByAllOfIt) {
  DriveCampaign campaign = campaign_on({sim::loose_sand()});
  for (const char* id : {"b", "c"}) {
    campaign.drives.push_back(campaign.drives.front());
    campaign.drives.back().id = id;
  }
  sim::Soil weaker = sim::loose_sand();
  strengthen(weaker, 0.9);
  const std::vector<double> whole = Predicted(campaign).of({});
  const std::vector<double> weak = Predicted(campaign_on({weaker})).of({});
  ASSERT_EQ(whole.size(), 3 * weak.size());

  const Predicted predicted(campaign);
  EffectVariant drift = find_outside("soil_drift")->variants(campaign).front();
  drift.effect = "soil_drift";
  const Hypothesis hypothesis(campaign, {drift});
  std::vector<double> x = hypothesis.neutral();
  x[x.size() - 2] = -0.1;
  const std::vector<double> drifted = hypothesis.predict(predicted.model, x);
  double largest = 0.0;
  for (std::size_t i = 0; i < weak.size(); ++i) {
    EXPECT_NEAR(drifted[i], whole[i], 1e-9) << "the first drive";
    EXPECT_NEAR(drifted[2 * weak.size() + i], weak[i], 1e-6) << "the last drive";
    largest = std::max(largest, std::abs(weak[i] - whole[i]));
  }
  EXPECT_GT(largest, 0.01) << "strength matters on this slope";
}

Hypothesis with_outside(const DriveCampaign& campaign, std::string_view cause, std::string_view label) {
  for (EffectVariant variant : find_outside(cause)->variants(campaign))
    if (variant.label == label) {
      variant.effect = cause;
      return Hypothesis(campaign, {variant});
    }
  throw std::invalid_argument("no such variant");
}

// Every reading of a channel, as it is and as a sensor would show it that reads wrongly.
template <class Check>
void for_each_shown(const Predicted& predicted, const Hypothesis& hypothesis, double value,
                    const Check& check) {
  std::vector<double> x = hypothesis.neutral();
  const std::vector<double> right = hypothesis.predict(predicted.model, x);
  x.back() = value;
  const std::vector<double> shown = hypothesis.predict(predicted.model, x);
  std::size_t i = 0;
  for (std::size_t w = 0; w < predicted.model.windows().size(); ++w)
    for (const Observation& o : predicted.model.windows()[w].observations) {
      check(w, o, right[i], shown[i]);
      ++i;
    }
}

TEST(Hypothesis, AConstantMayBeOnTheCurrentsOfOneSideOrOnAYawRateAlone) {
  const Predicted predicted(campaign_on({sim::loose_sand()}));
  const sim::RoverModel& rover = *predicted.campaign.rover;
  for_each_shown(predicted, with_outside(predicted.campaign, "current_offset", "left side"), 0.03,
                 [&](std::size_t, const Observation& o, double right, double shown) {
                   const bool left = o.channel == Channel::kCurrent && o.wheel >= 0 &&
                                     rover.wheels[static_cast<std::size_t>(o.wheel)].position_m.y() > 0.0;
                   EXPECT_NEAR(shown - right, left ? 0.03 : 0.0, 1e-12) << name_of(o.channel);
                 });
  for_each_shown(predicted, with_outside(predicted.campaign, "motion_offset", "yaw_rate"), -0.001,
                 [&](std::size_t, const Observation& o, double right, double shown) {
                   EXPECT_NEAR(shown - right, o.channel == Channel::kYawRate ? -0.001 : 0.0, 1e-12);
                 });
}

// A gyroscope turned about shows minus what the rover turns, and the channel is minus what was commanded.
TEST(Hypothesis, AReadingOfTheWrongSignIsMinusWhatItShouldBe) {
  const Predicted predicted(campaign_on({sim::loose_sand()}));
  const sim::DriveCommand& command = predicted.campaign.drives.front().command;
  const double commanded = command.speed_m_s * command.curvature_1_m;
  for_each_shown(predicted, with_outside(predicted.campaign, "wrong_scale", "yaw_rate"), -2.0,
                 [&](std::size_t, const Observation& o, double right, double shown) {
                   const double expected = o.channel == Channel::kYawRate ? -right - 2.0 * commanded : right;
                   EXPECT_NEAR(shown, expected, 1e-12);
                 });
  for_each_shown(predicted, with_outside(predicted.campaign, "wrong_scale", "current"), -2.0,
                 [&](std::size_t, const Observation& o, double right, double shown) {
                   EXPECT_NEAR(shown, o.channel == Channel::kCurrent ? -right : right, 1e-12);
                 });
}

TEST(Hypothesis, ALateReadingIsTheOneOfAWindowBeforeByAsMuchAsItIsLate) {
  const Predicted predicted(campaign_on({sinking_sand()}));
  const auto windows = predicted.model.windows();
  ASSERT_GE(windows.size(), 2U);
  const double apart = windows[1].mid_s() - windows[0].mid_s();
  std::vector<double> before(6, kNotMeasured);
  for_each_shown(predicted, with_outside(predicted.campaign, "late_reading", "current"), 0.5 * apart,
                 [&](std::size_t w, const Observation& o, double right, double shown) {
                   if (o.channel != Channel::kCurrent) {
                     EXPECT_EQ(shown, right);
                     return;
                   }
                   double& last = before[static_cast<std::size_t>(o.wheel)];
                   if (w == 0) {
                     EXPECT_EQ(shown, right);
                   } else if (w == 1) {
                     EXPECT_NEAR(shown, 0.5 * (last + right), 1e-12);
                   }
                   last = right;
                 });
}

// Of a drive on ground that weakens along it the middle is as it was, and its windows differ by more towards
// the ends.
TEST(Hypothesis, GroundThatWeakensAlongADriveIsStrongerBeforeItsMiddleAndWeakerBehind) {
  const Predicted predicted(campaign_on({sim::loose_sand()}));
  for_each_shown(predicted, with_outside(predicted.campaign, "soil_along_drive", ""), -0.2,
                 [&](std::size_t w, const Observation& o, double right, double shown) {
                   if (o.channel != Channel::kSlip) return;
                   const double middle_s = 30.0;
                   const double sense = predicted.model.windows()[w].mid_s() < middle_s ? -1.0 : 1.0;
                   EXPECT_GE(sense * (shown - right), -1e-9);
                 });
}

TEST(Hypothesis, BelievesAParameterAsWellAsItWasMeasuredAndTheOthersAsUsual) {
  DriveCampaign campaign = campaign_on({sim::sandy_loam(), sim::loose_sand()});
  const Hypothesis usual(campaign, {});
  campaign.parameter_std = {{"n", 0.01}, {"torque_constant", 0.002}};
  const Hypothesis measured(campaign, {});
  ASSERT_EQ(usual.parameters().size(), measured.parameters().size());
  int changed = 0;
  for (std::size_t p = 0; p < usual.parameters().size(); ++p) {
    const Parameter &before = usual.parameters()[p], &after = measured.parameters()[p];
    if (after.name.starts_with("n/")) {
      EXPECT_EQ(after.std, 0.01) << "of every soil";
    } else if (after.name == "torque_constant") {
      EXPECT_EQ(after.std, 0.002);
    } else {
      EXPECT_EQ(after.std, before.std) << after.name;
    }
    changed += after.std != before.std ? 1 : 0;
  }
  EXPECT_EQ(changed, 3);
}

TEST(Hypothesis, PredictionsAreContinuousWhereAnEffectSetsIn) {
  const Predicted predicted(campaign_on({sinking_sand()}));
  const std::vector<double> nominal = predicted.of({});
  for (const EffectVariant& variant : effect_variants(*predicted.campaign.rover, {})) {
    const Hypothesis hypothesis(predicted.campaign, {variant});
    for (std::size_t p = hypothesis.nuisance_count(); p < hypothesis.parameters().size(); ++p) {
      const Parameter& parameter = hypothesis.parameters()[p];
      std::vector<double> x = hypothesis.neutral();
      x[p] += parameter.highest > x[p] ? 1e-4 * parameter.std : -1e-4 * parameter.std;
      EXPECT_LT(largest_difference(hypothesis.predict(predicted.model, x), nominal), 2e-3)
          << parameter.name << " " << variant.label;
    }
  }
}

TEST(Hypothesis, VariantsFreeFieldsOfTheirEffectWithinTheirRangesAndNoLabelTwice) {
  std::set<std::pair<std::string, std::string>> labels;
  const sim::RoverModel rover = sim::six_wheeler();
  for (const EffectVariant& variant : effect_variants(rover, {})) {
    EXPECT_TRUE(labels.insert({variant.effect, variant.label}).second) << variant.effect << variant.label;
    const sim::Effect* const effect = sim::find_effect(variant.effect);
    ASSERT_NE(effect, nullptr) << variant.effect;
    ASSERT_FALSE(variant.free.empty()) << variant.effect;
    sim::EffectSetting at_lowest{variant.effect, {}}, at_highest = at_lowest;
    for (const auto& [field, value] : variant.fixed)
      at_lowest.parameters[field] = at_highest.parameters[field] = value;
    for (const EffectVariant::Free& free : variant.free) {
      EXPECT_GT(free.std, 0.0);
      EXPECT_LT(free.lowest, free.highest);
      EXPECT_TRUE(at_lowest.parameters.emplace(free.field, free.lowest).second) << "free and fixed";
      at_highest.parameters.emplace(free.field, free.highest);
    }
    for (const std::string& field : variant.at_initial) EXPECT_FALSE(at_lowest.parameters.contains(field));
    EXPECT_TRUE(sim::faults_of(std::vector{at_lowest}).empty()) << variant.effect;
    EXPECT_TRUE(sim::faults_of(std::vector{at_highest}).empty()) << variant.effect;
    EXPECT_TRUE(sim::faults_of(std::vector{at_highest}, rover).empty()) << variant.effect;
  }
}

TEST(Hypothesis, EachWheelThatCouldDragOrStandAskewIsAVariant) {
  const sim::RoverModel rover = sim::six_wheeler();
  std::set<std::string> dragging, askew;
  for (const EffectVariant& v : effect_variants(rover, {})) {
    if (v.effect == "dragging_wheel") dragging.insert(v.label);
    if (v.effect == "steering_offset") askew.insert(v.label);
  }
  EXPECT_EQ(dragging, (std::set<std::string>{"lf", "lm", "lr", "rf", "rm", "rr"}));
  std::set<std::string> expected{"all that steer"};
  for (const sim::WheelModel& wheel : rover.wheels)
    if (wheel.steerable) expected.insert(wheel.name);
  EXPECT_EQ(askew, expected);
}

TEST(Hypothesis, WithheldEffectsAndThoseOfPlacesAreNotAmongTheVariants) {
  const std::vector<std::string> withheld{"hardpan"};
  const auto variants = effect_variants(sim::six_wheeler(), withheld);
  for (const EffectVariant& v : variants) {
    EXPECT_NE(v.effect, "hardpan");
    EXPECT_EQ(sim::find_effect(v.effect)->variant_at, nullptr);
    EXPECT_FALSE(place_of(v));
  }
}

TEST(Hypothesis, TheVariantOfAPlaceLiesThere) {
  const EffectVariant patch = variant_at(*sim::find_effect("soft_patch"), {3.0, -2.0, 1.5});
  EXPECT_EQ(patch.effect, "soft_patch");
  const std::optional<sim::Disc> place = place_of(patch);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->x_m, 3.0);
  EXPECT_EQ(place->y_m, -2.0);
  EXPECT_EQ(place->radius_m, 1.5);
}

TEST(Hypothesis, WithoutARowsOwnVariantsFieldsAreAsUncertainAsTheirInitialValuesAreFarFromNeutral) {
  const Hypothesis hypothesis(campaign_on({sim::sandy_loam()}),
                              {variant_named(sim::six_wheeler(), "wheel_radius")});
  const Parameter& scale = hypothesis.parameters().back();
  EXPECT_EQ(scale.name, "wheel_radius.scale");
  EXPECT_EQ(scale.neutral, 0.0);
  EXPECT_EQ(scale.std, 0.03);
  EXPECT_EQ(scale.lowest, -0.2);
  EXPECT_EQ(scale.highest, 0.2);
}

TEST(Hypothesis, SettingsHaveTheEstimateTheFixedFieldsAndNeutralOnesBesides) {
  const DriveCampaign campaign = campaign_on({sim::sandy_loam()});
  const Hypothesis hypothesis(campaign, {variant_named(*campaign.rover, "grousers", "mobilised by slip"),
                                         variant_named(*campaign.rover, "slip_sinkage")});
  std::vector<double> x = hypothesis.neutral();
  x[x.size() - 5] = 0.012;
  x[x.size() - 3] = 0.1;
  x[x.size() - 2] = 0.2;
  x.back() = 0.4;
  const std::vector<sim::EffectSetting> settings = hypothesis.settings(x);
  ASSERT_EQ(settings.size(), 2U);
  EXPECT_EQ(settings[0].parameters, (std::map<std::string, double>{{"by_slip", 1.0},
                                                                   {"height_m", 0.012},
                                                                   {"mobilisation", 1.0},
                                                                   {"shear_share", 0.1},
                                                                   {"surcharge", 0.2}}))
      << "the count stays at its initial value: none would leave no grousers";
  EXPECT_EQ(settings[1].parameters,
            (std::map<std::string, double>{{"n1", 0.4}, {"n1_skid", 0.0}, {"n1_lateral", 0.0}}));
}

// The inclinometer shows a bias of its own alone; weights act along a bias of the map.
TEST(Hypothesis, AnAttitudeBiasIsShownOrActsByItsVariant) {
  const Predicted predicted(campaign_on({sim::sandy_loam()}));
  const std::vector<double> nominal = predicted.of({});
  struct Case {
    const char* label;
    bool shown, acts;
  };
  for (const Case& c : {Case{"the inclinometer alone", true, false}, Case{"the map alone", true, true},
                        Case{"map and inclinometer", false, true}}) {
    const Hypothesis hypothesis(predicted.campaign,
                                {variant_named(*predicted.campaign.rover, "attitude_bias", c.label)});
    std::vector<double> x = hypothesis.neutral();
    x.back() = -2.0;  // pitch_deg: nose up
    const std::vector<double> biased = hypothesis.predict(predicted.model, x);
    for (std::size_t i = 0; i < predicted.windows[0].observations.size(); ++i) {
      const double change = biased[i] - nominal[i];
      switch (predicted.windows[0].observations[i].channel) {
        case Channel::kPitch:
          // Where gravity acts otherwise the wheels sink otherwise, and the body leans a little.
          EXPECT_NEAR(change, c.shown ? rad_from_deg(-2.0) : 0.0, c.acts ? rad_from_deg(0.05) : 1e-12)
              << c.label;
          break;
        case Channel::kRoll:
          EXPECT_NEAR(change, 0.0, c.acts ? rad_from_deg(0.05) : 0.0) << c.label;
          break;
        case Channel::kSlip:
          EXPECT_EQ(change != 0.0, c.acts) << c.label;
          break;
        default:
          break;
      }
    }
  }
}

}  // namespace
}  // namespace slipway::gap
