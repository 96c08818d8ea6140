#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/catalogue.h"
#include "core/angle.h"
#include "gap/diagnosis/drive_watch.h"
#include "gap/diagnosis/model_check.h"
#include "gap/diagnosis/search/prepared_campaign.h"
#include "research/validation/cuadriga/comparisons.h"

namespace slipway::validation {
namespace {

using gap::ChannelCheck;
using gap::DriveCampaign;

// "20190129" of "20190129__2019_01_29_10_53_36".
std::string day_of(const gap::MeasuredDriveSeries& drive) {
  return drive.id.substr(0, drive.id.find("__"));
}

std::vector<std::string> days_of(const DriveCampaign& campaign) {
  std::vector<std::string> days;
  for (const gap::MeasuredDriveSeries& drive : campaign.drives)
    if (days.empty() || days.back() != day_of(drive)) days.push_back(day_of(drive));
  return days;
}

DriveCampaign only_days(DriveCampaign campaign, std::span<const std::string> days) {
  std::erase_if(campaign.drives, [&](const gap::MeasuredDriveSeries& drive) {
    return std::find(days.begin(), days.end(), day_of(drive)) == days.end();
  });
  return campaign;
}

// What the drives of a campaign teach of rover and soils, with what they leave open.
Result<gap::CorrectedBelief> learnt_from(const DriveCampaign& campaign) {
  NoProgress progress;
  const auto prepared = gap::prepare(campaign, {}, progress);
  if (!prepared) return fail(prepared.error());
  const gap::FittedExplanation& fit = *prepared->null;
  const gap::ModelState state = fit.hypothesis.state(fit.x);
  gap::CorrectedBelief belief;
  belief.rover = std::make_shared<const sim::RoverModel>(state.rover);
  belief.scatter = prepared->noise->scales();
  belief.left_open = gap::posterior_of(fit);
  for (std::size_t s = 0; s < campaign.soils.size(); ++s) {
    belief.soils.emplace_back().mean = state.soils[s];
    belief.called.push_back(campaign.soils[s].name);
  }
  return belief;
}

std::vector<std::string> row_of(const std::string& day, std::size_t learnt, const ChannelCheck& c) {
  const bool current = c.channel == gap::Channel::kCurrent;
  const auto number = [&](double value) { return fmt::format("{:.{}f}", value, current ? 2 : 3); };
  return {day,
          fmt::format("{}", learnt),
          current ? "current, A" : "slip",
          fmt::format("{}", c.values),
          fmt::format("{}", c.drives),
          number(c.rms.nominal),
          number(c.rms.corrected),
          fmt::format("{:.0f} %", c.rms.down_percent),
          number(c.median.nominal),
          number(c.median.corrected),
          fmt::format("{:.0f} %", c.median.down_percent),
          fmt::format("{:.0f} %", 100.0 * c.within_90)};
}

// How much a function of the gradient alone could say of the slip of windows: its means by bins of 2 deg, of
// all windows (which no prediction made before the drives can have), and of the other logs' windows.
struct SlipBound {
  double nominal_rms = 0.0, by_own_means_rms = 0.0, by_other_logs_rms = 0.0;
};

struct SlipOfWindow {
  std::size_t log = 0;
  int bin = 0;
  double slip = 0.0;
};

// The mean slip of the windows in a bin, less those of a log; of no windows 0.
double mean_in(std::span<const SlipOfWindow> windows, int bin, std::optional<std::size_t> but_log) {
  double sum = 0.0, count = 0.0;
  for (const SlipOfWindow& w : windows)
    if (w.bin == bin && w.log != but_log) {
      sum += w.slip;
      count += 1.0;
    }
  return count > 0.0 ? sum / count : 0.0;
}

Result<SlipBound> slip_bound(const DriveCampaign& campaign) {
  constexpr double kBin_deg = 2.0;
  NoProgress progress;
  const auto believed = gap::prepare_as_believed(campaign, {}, progress);
  if (!believed) return fail(believed.error());
  std::vector<SlipOfWindow> windows;
  SlipBound bound;
  for (std::size_t w = 0; w < believed->windows.size(); ++w)
    for (std::size_t i = 0; i < believed->windows[w].observations.size(); ++i) {
      const gap::Observation& o = believed->windows[w].observations[i];
      const double residual =
          believed->nominal_residuals[static_cast<Eigen::Index>(believed->model->offset(w) + i)];
      if (o.channel != gap::Channel::kSlip || !std::isfinite(residual)) continue;
      const double gradient_deg = deg_from_rad(believed->model->conditions(w).pitch_rad);
      windows.push_back(
          {believed->windows[w].drive, static_cast<int>(std::floor(gradient_deg / kBin_deg)), o.value});
      bound.nominal_rms += residual * residual;
    }
  for (const SlipOfWindow& w : windows) {
    bound.by_own_means_rms += std::pow(w.slip - mean_in(windows, w.bin, {}), 2);
    bound.by_other_logs_rms += std::pow(w.slip - mean_in(windows, w.bin, w.log), 2);
  }
  for (double* const sum : {&bound.nominal_rms, &bound.by_own_means_rms, &bound.by_other_logs_rms})
    *sum = std::sqrt(*sum / static_cast<double>(windows.size()));
  return bound;
}

std::string watch_note(const gap::DriveWatch& watched) {
  double highest = 0.0;
  for (const gap::WatchedDrive& drive : watched.drives) highest = std::max(highest, drive.log10_evidence);
  return fmt::format(
      "{} watched after {} that were taken as healthy: {}, highest evidence of a change {:.1f} to 1",
      watched.drives.size(), watched.learnt_drives, watched.alarm ? "an alarm" : "no alarm",
      std::pow(10.0, highest));
}

}  // namespace

Result<Report> cuadriga_days(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const auto campaign = api::load_drive_campaign(data / "drive-campaigns" / "cuadriga_2018_2019", *catalogue);
  if (!campaign) return fail(campaign.error());
  const std::vector<std::string> days = days_of(*campaign);
  Report report;
  report.title = "A real rover's days in their order: each told by the days before it, and watched";
  report.source =
      "University of Malaga (spaceuma/CAMIS_python), Cuadriga in 2018 and 2019 as the campaign "
      "data/drive-campaigns/cuadriga_2018_2019. Blind but for the nominal model: no day has a part in what "
      "tells it";
  report.columns = {"day",  "learnt drives", "channel",         "windows", "drives", "rms, nominal",
                    "told", "down",          "median, nominal", "told",    "down",   "in the 90 % interval"};
  NoProgress progress;
  double least_down = 100.0, least_within = 100.0;
  for (std::size_t d = 1; d < days.size(); ++d) {
    const DriveCampaign before = only_days(*campaign, std::span(days).first(d));
    const auto belief = learnt_from(before);
    if (!belief) return fail(belief.error());
    const auto told =
        gap::check_model(only_days(*campaign, std::span(days).subspan(d, 1)), *belief, {}, progress);
    if (!told) return fail(told.error());
    for (const ChannelCheck& c : told->channels) {
      const bool current = c.channel == gap::Channel::kCurrent;
      if (c.slope != gap::SlopeClass::kAll || (c.channel != gap::Channel::kSlip && !current)) continue;
      report.rows.push_back(row_of(days[d], before.drives.size(), c));
      if (!current) continue;
      least_down = std::min(least_down, c.rms.down_percent);
      least_within = std::min(least_within, 100.0 * c.within_90);
    }
  }
  const auto bound = slip_bound(*campaign);
  if (!bound) return fail(bound.error());
  report.notes.push_back(fmt::format(
      "Slip does not gain, and hardly can: the slip of a window scatters by {:.3f} about the nominal model, "
      "by "
      "{:.3f} about its means by bins of 2 deg of gradient over the other logs, and even about those means "
      "over "
      "the very windows that are told, of which some bins hold few, by {:.3f}. A window is 4 s and 2 m long, "
      "and its ends are measured to 0.04 m.",
      bound->nominal_rms, bound->by_other_logs_rms, bound->by_own_means_rms));
  std::size_t alarms = 0;
  for (const std::size_t first : {std::size_t{1}, std::size_t{2}}) {
    gap::WatchOptions watch;
    watch.learn = static_cast<int>(only_days(*campaign, std::span(days).first(first)).drives.size());
    watch.diagnose = false;
    const auto watched = gap::watch_drives(*campaign, nullptr, watch, {}, progress);
    if (!watched) return fail(watched.error());
    alarms += watched->alarm ? 1 : 0;
    report.notes.push_back(fmt::format("The watch: {}.", watch_note(*watched)));
  }
  report.notes.emplace_back(
      "Told: soil, closures and motors are re-tuned on all days before (prior of the diagnosis, whose "
      "nominal "
      "model knows nothing of these drives), as slipway diagnose and slipway test-model do where no effect "
      "is "
      "named. Nothing is known to have changed on the rover, so that an alarm would be a false one.");
  report.bands = {
      {"rms of current down on the next day, least over days, %", least_down, 30.0, 100.0},
      {"current in the 90 % interval on the next day, least over days, %", least_within, 60.0, 100.0},
      {"rms of slip about means by gradient over other logs, over the nominal model's",
       bound->by_other_logs_rms / bound->nominal_rms, 0.9, 1.2},
      {"alarms of the watch", static_cast<double>(alarms), 0.0, 0.0}};
  return report;
}

}  // namespace slipway::validation
