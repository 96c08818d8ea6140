// A drive and its mirror image are the same to a diagnosis: what it predicts of them is the mirror image too.
// Ground, rover, steering and soil are those of the practice campaigns, on hills and in turns in place.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/files/campaign/drive_campaign_source.h"
#include "gap/diagnosis/model/channel.h"
#include "gap/diagnosis/model/hypothesis.h"
#include "gap/diagnosis/model/window_model.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {
namespace {

// The ground as a mirror on the plane y = 0 shows it.
class MirroredGround final : public sim::Ground {
 public:
  explicit MirroredGround(std::shared_ptr<const sim::Ground> of) : of_(std::move(of)) {}
  std::optional<sim::GroundPoint> at(double x_m, double y_m) const override {
    auto point = of_->at(x_m, -y_m);
    if (point) point->normal.y() *= -1.0;
    return point;
  }
  std::optional<std::size_t> soil_at(double x_m, double y_m) const override {
    return of_->soil_at(x_m, -y_m);
  }

 private:
  std::shared_ptr<const sim::Ground> of_;
};

// The wheel that a mirror shows in each wheel's place.
std::vector<std::size_t> mirrored_wheels(const sim::RoverModel& rover) {
  std::vector<std::size_t> partner;
  for (const auto& wheel : rover.wheels)
    for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
      const Eigen::Vector3d there = wheel.position_m.cwiseProduct(Eigen::Vector3d(1.0, -1.0, 1.0));
      if ((rover.wheels[k].position_m - there).norm() < 1e-12) partner.push_back(k);
    }
  return partner;
}

DriveCampaign mirrored(DriveCampaign campaign) {
  for (CampaignTerrain& terrain : campaign.terrains)
    terrain.ground = std::make_shared<MirroredGround>(terrain.ground);
  const std::vector<std::size_t> partner = mirrored_wheels(*campaign.rover);
  for (MeasuredDriveSeries& drive : campaign.drives) {
    drive.command.curvature_1_m *= -1.0;
    drive.command.turn_rate_rad_s *= -1.0;
    for (DriveSample& sample : drive.samples) {
      sample.p_MB.y() *= -1.0;
      sample.attitude.roll_rad *= -1.0;
      sample.attitude.yaw_rad *= -1.0;
      const auto wheels = sample.wheels;
      for (std::size_t k = 0; k < partner.size(); ++k) {
        sample.wheels[k] = wheels[partner[k]];
        sample.wheels[k].steer_rad *= -1.0;
      }
    }
  }
  return campaign;
}

bool changes_sign(Channel channel) {
  return channel == Channel::kSideSlip || channel == Channel::kYawRate || channel == Channel::kRoll;
}

// Of each channel, the largest difference between what is predicted of a drive and, mirrored, of its image.
std::map<std::string, double> differences(const DriveCampaign& campaign) {
  const DriveCampaign image = mirrored(campaign);
  const std::vector<DriveWindow> windows = cut_windows(campaign), mirrors = cut_windows(image);
  const WindowModel model(campaign, windows), mirror(image, mirrors);
  const auto predict = [](const DriveCampaign& of, const WindowModel& by) {
    const Hypothesis nominal(of, {});
    return nominal.predict(by, nominal.neutral());
  };
  const std::vector<double> here = predict(campaign, model), there = predict(image, mirror);
  const std::vector<std::size_t> partner = mirrored_wheels(*campaign.rover);
  std::map<std::string, double> largest;
  for (std::size_t w = 0; w < windows.size(); ++w)
    for (std::size_t i = 0; i < windows[w].observations.size(); ++i) {
      const Observation& o = windows[w].observations[i];
      for (std::size_t j = 0; j < mirrors[w].observations.size(); ++j) {
        const Observation& m = mirrors[w].observations[j];
        if (m.channel != o.channel ||
            (o.wheel >= 0 && static_cast<std::size_t>(m.wheel) != partner[static_cast<std::size_t>(o.wheel)]))
          continue;
        const double a = here[model.offset(w) + i], b = there[mirror.offset(w) + j];
        const double sign = changes_sign(o.channel) ? -1.0 : 1.0;
        double& most = largest[std::string(name_of(o.channel))];
        most = std::max(most, std::abs(a - sign * b));
      }
    }
  return largest;
}

DriveCampaign practice(const std::string& name) {
  auto campaign = api::load_drive_campaign(std::filesystem::path(SLIPWAY_DATA_FOLDER) / "gap-practice" / name,
                                           api::Catalogue{});
  if (!campaign) throw std::runtime_error(campaign.error().detail);
  return std::move(*campaign);
}

TEST(MirroredDrive, IsPredictedAsTheMirrorImage) {
  for (const char* name : {"p04", "p06"})
    for (const auto& [channel, difference] : differences(practice(name)))
      EXPECT_LT(difference, 1e-6) << name << " " << channel;
}

// Wheels stand in another order in the image, and readings of a window scatter together: what each is
// believed to say once depended on which came first, so that the evidences of drives and of their image were
// apart.
TEST(MirroredDrive, HasTheEvidenceOfItsImage) {
  const DriveCampaign campaign = practice("p06");
  const DriveCampaign some = subset_of(campaign, std::vector<std::size_t>{0, 3, 6, 9, 12, 15, 18, 21});
  const auto evidence_of = [](const DriveCampaign& of) {
    NoProgress progress;
    const auto prepared = prepare(of, {}, progress);
    EXPECT_TRUE(prepared);
    return prepared ? prepared->null->log_evidence : 0.0;
  };
  // Rounding ends the two searches a little apart: by 0.011 of 5,904 on one machine.
  EXPECT_NEAR(evidence_of(some), evidence_of(mirrored(some)), 0.05);
}

}  // namespace
}  // namespace slipway::gap
