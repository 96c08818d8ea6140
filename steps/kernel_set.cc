#include "steps/kernel_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace slipway::steps {
namespace {

tl::unexpected<Error> refuse(const std::string& file, std::string message) {
  return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be used", file),
              {{file, std::move(message)}});
}

}  // namespace

Result<KernelSet> KernelSet::read(std::span<const KernelBytes> files, const SpiceStepOptions& options,
                                  SpiceStepSummary& summary) {
  KernelSet set;
  set.options_ = options;
  // The faults of all files are told together.
  std::vector<Fault> faults;
  for (const KernelBytes& file : files) {
    const auto read = looks_like_daf(file.bytes) ? set.read_binary(file, summary) : set.read_text(file);
    if (!read) faults.insert(faults.end(), read.error().faults.begin(), read.error().faults.end());
  }
  if (faults.empty() && set.rover_.empty())
    faults.push_back(
        {"", fmt::format("no kernel has positions of body {} from one of its sites", options.rover)});
  if (faults.empty() && set.has_attitudes() && !set.clock_)
    faults.push_back(
        {"", fmt::format("there are attitudes but no clock kernel of spacecraft {}", options.clock)});
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, "the SPICE kernels can't be read", std::move(faults));
  set.put_in_order();
  summary.rover_segments = set.rover_.size();
  summary.attitude_segments = set.attitudes_.size();
  summary.sites = set.sites_.size();
  summary.has_landing_site = set.landing_m_.has_value();
  return set;
}

Result<void> KernelSet::read_binary(const KernelBytes& file, SpiceStepSummary& summary) {
  const auto daf = DafFile::read(file.bytes, file.name);
  if (!daf) return fail(daf.error());
  for (const DafArray& array : daf->arrays()) {
    const auto taken = daf->kind() == DafKind::kSpk ? take_positions(*daf, array, summary)
                                                    : take_attitudes(*daf, array, summary);
    if (!taken) return taken;
  }
  return {};
}

Result<void> KernelSet::read_text(const KernelBytes& file) {
  if (looks_like_clock(file.bytes)) {
    auto clock = read_spacecraft_clock(file.bytes, file.name, options_.clock);
    if (!clock) return fail(clock.error());
    if (clock_) return refuse(file.name, "there are two clock kernels: which one holds?");
    clock_ = std::move(*clock);
    return {};
  }
  if (!looks_like_leap_seconds(file.bytes))
    return refuse(file.name,
                  "neither positions (SPK) nor attitudes (CK), no clock (SCLK) and no leap seconds (LSK)");
  const auto time = read_leap_seconds(file.bytes, file.name);
  if (!time) return fail(time.error());
  ephemeris_ = *time;
  return {};
}

Result<void> KernelSet::take_positions(const DafFile& daf, const DafArray& array, SpiceStepSummary& summary) {
  const auto& [target, centre, frame, type] = array.whole;
  const auto is_site = [this](int body) {
    return body < options_.site_zero && body >= options_.site_zero - options_.most_sites;
  };
  const bool level = frame == options_.level_frame;
  const bool of_rover = target == options_.rover && is_site(centre) && level;
  const bool of_site = is_site(target) && centre == options_.landing_site && level;
  const bool of_landing =
      target == options_.landing_site && centre == options_.planet && frame == options_.planet_frame;
  if (!of_rover && !of_site && !of_landing) return ++summary.other_bodies, Result<void>();
  if (!is_readable_spk(array)) return ++summary.other_types, Result<void>();
  auto segment = read_spk_segment(daf, array);
  if (!segment) return fail(segment.error());
  const std::array<double, 3>& first_m = segment->states.front().position_m;
  if (of_rover)
    rover_.push_back(std::move(*segment));
  else if (of_site)
    sites_[options_.site_zero - target] = first_m;
  else
    landing_m_ = first_m;
  return {};
}

Result<void> KernelSet::take_attitudes(const DafFile& daf, const DafArray& array, SpiceStepSummary& summary) {
  if (array.whole[0] != options_.instrument || array.whole[1] != options_.level_frame)
    return ++summary.other_bodies, Result<void>();
  if (!is_readable_ck(array)) return ++summary.other_types, Result<void>();
  auto segment = read_ck_segment(daf, array);
  if (!segment) return fail(segment.error());
  attitudes_.push_back(std::move(*segment));
  return {};
}

void KernelSet::put_in_order() {
  if (clock_ && ephemeris_) clock_->ephemeris = *ephemeris_;
  std::stable_sort(rover_.begin(), rover_.end(),
                   [](const SpkSegment& a, const SpkSegment& b) { return a.start_et_s < b.start_et_s; });
  std::stable_sort(attitudes_.begin(), attitudes_.end(),
                   [](const CkSegment& a, const CkSegment& b) { return a.start_tick < b.start_tick; });
  for (const CkSegment& segment : attitudes_)
    latest_end_.push_back(latest_end_.empty() ? segment.end_tick
                                              : std::max(latest_end_.back(), segment.end_tick));
}

// Of several segments the one that starts last, or was read last, says.
std::optional<Eigen::Quaterniond> KernelSet::attitude(double et_s) const {
  if (!clock_) return std::nullopt;
  const double tick = clock_->tick_of(et_s);
  const double slack = options_.clock_slack_s * clock_->ticks_per_count;
  const auto after =
      std::upper_bound(attitudes_.begin(), attitudes_.end(), tick + slack,
                       [](double t, const CkSegment& segment) { return t < segment.start_tick; });
  for (auto k = static_cast<std::size_t>(after - attitudes_.begin()); k-- > 0;) {
    if (latest_end_[k] < tick - slack) break;
    if (auto q = attitude_at(attitudes_[k], tick, slack)) return q;
  }
  return std::nullopt;
}

std::optional<std::array<double, 3>> KernelSet::offset_of_site(int site) const {
  const auto found = sites_.find(site);
  return found == sites_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace slipway::steps
