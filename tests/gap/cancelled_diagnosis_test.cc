// A diagnosis that nobody wants any more: measured in the process's processor time, which does not depend on
// what else the machine does.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "tests/full_size.h"
#include "tests/gap/practice_drives.h"

namespace slipway::gap {
namespace {

constexpr double kPromised_s = 0.1;  // as Progress says

double processor_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Is cancelled some processor time after a stage began; remembers the longest time in which nobody asked.
class Watch final : public Progress {
 public:
  Watch(std::string stage, double after_s) : stage_(std::move(stage)), after_s_(after_s) {}

  void report(std::string_view stage, double fraction) override {
    const std::scoped_lock lock(mutex_);
    now_ = stage;
    if (fraction < fraction_) back_in_ = stage;
    fraction_ = fraction;
    if (stage == stage_ && cancel_at_ == 0.0) cancel_at_ = processor_s() + after_s_;
  }
  bool cancelled() const override {
    const std::scoped_lock lock(mutex_);
    const double now = processor_s();
    if (asked_ > 0.0 && now - asked_ > longest_s_) {
      longest_s_ = now - asked_;
      in_ = now_;
    }
    asked_ = now;
    return cancel_at_ > 0.0 && now >= cancel_at_;
  }
  double cancel_at() const { return cancel_at_; }
  double longest_s() const { return longest_s_; }
  const std::string& where() const { return in_; }
  // The stage that began with a smaller fraction than the one before; empty: progress never fell.
  const std::string& back_in() const { return back_in_; }

 private:
  std::string stage_;
  double after_s_ = 0.0;
  mutable std::mutex mutex_;
  double cancel_at_ = 0.0;
  mutable double asked_ = 0.0, longest_s_ = 0.0;
  double fraction_ = 0.0;
  std::string now_, back_in_;
  mutable std::string in_;
};

TEST(ACancelledDiagnosis, StopsWithinATenthOfASecondInEveryStage) {
  const DriveCampaign campaign = some_drives(3);
  DiagnosisOptions options;
  options.search.threads = 1;
  options.search.max_refitted = 3;
  options.search.max_paired = 1;
  for (const char* stage :
       {"fitting soil and closures", "estimating the drives' own scatter", "looking for soft places",
        "screening effects", "fitting effects", "locating the gap", "predicting held-out drives"}) {
    for (const double after_s : full_size() ? std::vector{0.0, 0.12} : std::vector{0.12}) {
      Watch watch(stage, after_s);
      const auto diagnosis = diagnose(campaign, options, watch);
      const double stopped = processor_s();
      ASSERT_GT(watch.cancel_at(), 0.0) << stage << " is no stage of a diagnosis";
      EXPECT_TRUE(watch.back_in().empty()) << "progress went back in: " << watch.back_in();
      if (diagnosis) continue;  // it was done before
      EXPECT_EQ(diagnosis.error().code, ErrorCode::kCancelled);
      EXPECT_LT(stopped - watch.cancel_at(), kPromised_s) << stage << " + " << after_s << " s";
      EXPECT_LT(watch.longest_s(), kPromised_s) << "nobody asked for so long in: " << watch.where();
    }
  }
}

TEST(ADiagnosis, RefusesMoreThanItCanHoldAndSaysHowToThin) {
  DiagnosisOptions options;
  options.preparation.max_observations = 100;
  NoProgress progress;
  const auto refused = diagnose(some_drives(3), options, progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kPayloadTooLarge);
  EXPECT_EQ(refused.error().faults.at(0).pointer, "/drives");
  EXPECT_NE(refused.error().detail.find("leave out rows until they are"), std::string::npos);
}

}  // namespace
}  // namespace slipway::gap
