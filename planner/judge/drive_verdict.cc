#include "planner/judge/drive_verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "planner/judge/verdict_words.h"
#include "planner/problem/keep_out.h"

namespace slipway::planner {
namespace {

// One of the probabilities that the bars judge.
struct JudgedShare {
  std::string_view name, what;
  sim::DrawnShare sim::OutcomeShares::*share;
  double sim::OutcomeBars::*go_below;
  double sim::OutcomeBars::*no_go_above;
};
constexpr std::array kShares{
    JudgedShare{"embedding", "embedded", &sim::OutcomeShares::embedding, &sim::OutcomeBars::max_embedding,
                &sim::OutcomeBars::max_embedding},
    JudgedShare{"immobilised", "immobilised", &sim::OutcomeShares::immobilised,
                &sim::OutcomeBars::max_immobilised, &sim::OutcomeBars::max_immobilised},
    JudgedShare{"stop", "a halt", &sim::OutcomeShares::stop, &sim::OutcomeBars::max_stop,
                &sim::OutcomeBars::no_go_stop}};

Verdict by_bars(const sim::DrawnShare& share, double go_below, double no_go_above) {
  if (share.low > no_go_above) return Verdict::kNoGo;
  return share.high < go_below ? Verdict::kGo : Verdict::kUnknown;
}

JudgedRule forbidden(std::string name, std::optional<double> at_m, std::string words) {
  JudgedRule rule{.name = std::move(name), .verdict = Verdict::kNoGo};
  rule.at_m = at_m;
  rule.words = std::move(words);
  return rule;
}

class Judging {
 public:
  Judging(const PlanProblem& problem, const sim::DrivePrediction& drive, const VerdictSetting& setting)
      : problem_(problem), drive_(drive), setting_(setting), bars_(problem.risk.bars) {}

  DriveVerdict run() {
    keep_areas();
    judge_on_means();
    if (setting_.dynamic) judge_in_motion(*setting_.dynamic);
    if (drive_.draws > 0) judge_draws();
    std::stable_sort(out_.rules.begin(), out_.rules.end(), decides_before);
    out_.verdict = out_.rules.empty() ? Verdict::kGo : out_.rules.front().verdict;
    say_why();
    return std::move(out_);
  }

 private:
  // The more severe; what is certain before what is likely; of probabilities the one furthest beyond its bar.
  static bool decides_before(const JudgedRule& a, const JudgedRule& b) {
    if (a.verdict != b.verdict) return severity(a.verdict) > severity(b.verdict);
    if (a.over_draws != b.over_draws) return b.over_draws;
    return a.over_draws && a.value / a.no_go_above > b.value / b.no_go_above;
  }

  void keep_areas() {
    if (problem_.keep_out.empty() && problem_.keep_in.empty()) return;
    const KeepOut zones(problem_.keep_out, *problem_.rover, problem_.keep_in);
    if (setting_.motions)
      if (const auto pose = first_hit(zones, *setting_.motions))
        out_.rules.push_back(forbidden("keep_out", {},
                                       fmt::format("the rover's body would {} at ({:.2f}, {:.2f})",
                                                   trespass_in_words(problem_), pose->x_m, pose->y_m)));
    if (out_.rules.empty()) keep_areas_sliding(zones);
  }

  // The body beside its path by the way that side slip takes it between two looks at where it is.
  void keep_areas_sliding(const KeepOut& zones) {
    for (const sim::StationPrediction& at : drive_.stations) {
      for (const double aside_m : {at.aside_m, at.aside_m_p05, at.aside_m_p95}) {
        if (!zones.hits(beside(at.station, aside_m))) continue;
        JudgedRule rule = forbidden(
            "keep_out", at.station.distance_m,
            fmt::format("side slip of {:.2f} m would take the rover's body to {} at ({:.2f}, {:.2f})",
                        std::abs(aside_m), trespass_in_words(problem_), at.station.pose.x_m,
                        at.station.pose.y_m));
        if (aside_m != at.aside_m) {
          rule.verdict = Verdict::kUnknown;
          rule.words += " in 5 % of the draws";
        }
        const bool open_already = !out_.rules.empty();
        if (open_already && rule.verdict == Verdict::kUnknown) continue;
        out_.rules.push_back(std::move(rule));
        if (out_.rules.back().verdict == Verdict::kNoGo) return;
      }
    }
  }

  static Pose2 beside(const sim::PathStation& station, double aside_m) {
    const double travel =
        station.pose.yaw_rad + station.crab_rad + (station.backwards ? std::numbers::pi : 0.0);
    return {station.pose.x_m - aside_m * std::sin(travel), station.pose.y_m + aside_m * std::cos(travel),
            station.pose.yaw_rad};
  }

  void judge_on_means() {
    if (drive_.without_stance)
      out_.rules.push_back(
          forbidden("stance", drive_.without_stance->distance_m, drive_.without_stance->reason));
    else if (drive_.immobilised)
      out_.rules.push_back(forbidden("immobilised", drive_.immobilised->distance_m,
                                     "immobilised on the mean soils: " + drive_.immobilised->reason));
    for (const sim::BrokenLimit& broken : drive_.broken_limits) {
      const sim::RuleRow& row = sim::row_of(broken.rule);
      JudgedRule rule =
          forbidden(std::string(row.name), broken.distance_m, "on the mean soils " + sim::describe(broken));
      rule.value = rule.low = rule.high = broken.value * row.factor;
      rule.go_below = rule.no_go_above = broken.limit * row.factor;
      rule.unit = row.unit;
      out_.rules.push_back(std::move(rule));
    }
    if (!drive_.unsolved) return;
    JudgedRule rule = forbidden("solver", drive_.unsolved->distance_m, drive_.unsolved->reason);
    rule.verdict = Verdict::kUnknown;
    out_.rules.push_back(std::move(rule));
  }

  void judge_in_motion(const DynamicVerification& dynamic) {
    if (dynamic.refutes()) {
      const bool finished = !dynamic.end || dynamic.end == sim::DriveEnd::kFinished;
      std::string why =
          fmt::format("{} at {:.1f} m, {}", end_in_words(dynamic), dynamic.distance_m, dynamic.reason);
      if (finished) why = fmt::format("{}", sim::describe(dynamic.broken_limits.front()));
      out_.rules.push_back(forbidden("dynamics", dynamic.distance_m, "driven in motion: " + why));
    } else if (!dynamic.end) {
      JudgedRule rule = forbidden(
          "dynamics", dynamic.distance_m,
          fmt::format("{} the drive in motion: {}",
                      dynamic.left_the_route ? "neither confirmed nor refuted by" : "no answer from",
                      dynamic.reason));
      rule.verdict = Verdict::kUnknown;
      out_.rules.push_back(std::move(rule));
    }
  }

  // The shares of the whole drive, or of the segment that is judged worst by each.
  void judge_draws() {
    const bool hangs_on_unknown =
        bars_.are_passed(drive_.outcomes) && bars_.are_kept(drive_.outcomes.on_known);
    for (const JudgedShare& judged : kShares) {
      const double go_below = bars_.*judged.go_below, no_go_above = bars_.*judged.no_go_above;
      const sim::OutcomeShares* worst = &drive_.outcomes;
      for (const sim::SegmentRisk& segment : drive_.outcomes.segments) {
        const bool first = worst == &drive_.outcomes;
        const int here = severity(by_bars(segment.*judged.share, go_below, no_go_above));
        if (first || here > severity(by_bars(worst->*judged.share, go_below, no_go_above))) worst = &segment;
      }
      const sim::DrawnShare& share = worst->*judged.share;
      JudgedRule rule{.name = std::string(judged.name),
                      .verdict = by_bars(share, go_below, no_go_above),
                      .value = share.share,
                      .low = share.low,
                      .high = share.high,
                      .go_below = go_below,
                      .no_go_above = no_go_above};
      rule.over_draws = true;
      rule.words = share_words(judged.what, share, go_below, no_go_above, rule.verdict);
      if (worst != &drive_.outcomes) {
        const auto* segment = static_cast<const sim::SegmentRisk*>(worst);
        rule.at_m = segment->from_m;
        rule.words += fmt::format(" (segment from {:.0f} to {:.0f} m)", segment->from_m, segment->to_m);
      }
      if (rule.verdict == Verdict::kNoGo && hangs_on_unknown) {
        rule.verdict = Verdict::kUnknown;
        rule.words += ", all of it on ground that no map names";
      }
      out_.rules.push_back(std::move(rule));
    }
  }

  void say_why() {
    std::vector<std::string>& reasons = out_.reasons;
    for (const JudgedRule& rule : out_.rules) {
      if (rule.verdict == Verdict::kGo && out_.verdict != Verdict::kGo) break;
      reasons.push_back(rule.words);
    }
    if (out_.verdict == Verdict::kGo) {
      std::string why = fmt::format("every limit holds on the mean soils");
      if (drive_.draws > 0)
        why += fmt::format("; {}", share_words("a halt", drive_.outcomes.stop, bars_.max_stop,
                                               bars_.no_go_stop, Verdict::kGo));
      if (const std::string nearest = nearest_limit_words(drive_); !nearest.empty()) why += "; " + nearest;
      std::erase_if(reasons, [](const std::string& words) { return words.starts_with("a halt in "); });
      reasons.insert(reasons.begin(), std::move(why));
    } else if (const sim::RuleRisk* const rule = behind(out_.rules.front())) {
      reasons.front() += fmt::format("; {}{}", rule == main_halt(drive_) ? "mostly " : "",
                                     halt_words(problem_, drive_, *rule));
    }
    if (drive_.draws == 0) return;
    if (!drive_.outcomes.segments.empty())
      for (std::string& words : segment_words(drive_.outcomes, bars_)) reasons.push_back(std::move(words));
    for (std::string& words : tripping_words(drive_)) reasons.push_back(std::move(words));
    for (std::string words : {ground_words(problem_, drive_), closure_words(problem_, drive_)})
      if (!words.empty()) reasons.push_back(std::move(words));
    if (drive_.outcomes.unsolved > 0.0)
      reasons.push_back(
          fmt::format("in {} of the draws the solver gave up somewhere; upper ends count these "
                      "as halted",
                      percent(drive_.outcomes.unsolved)));
  }

  // The rule that makes a probability what it is; null where no draw shows one.
  const sim::RuleRisk* behind(const JudgedRule& judged) const {
    if (!judged.over_draws) return nullptr;
    if (judged.name == "stop") return main_halt(drive_);
    const auto& rules = drive_.outcomes.rules;
    const auto rule = std::find_if(rules.begin(), rules.end(), [&](const sim::RuleRisk& each) {
      return sim::describe(each.rule) == judged.name;
    });
    return rule == rules.end() || rule->trips.share <= 0.0 ? nullptr : &*rule;
  }

  const PlanProblem& problem_;
  const sim::DrivePrediction& drive_;
  const VerdictSetting& setting_;
  const sim::OutcomeBars& bars_;
  DriveVerdict out_;
};

}  // namespace

Verdict judge_segment(const sim::OutcomeBars& bars, const sim::OutcomeShares& segment) {
  if (bars.are_passed(segment)) return Verdict::kNoGo;
  return bars.are_kept(segment) ? Verdict::kGo : Verdict::kUnknown;
}

DriveVerdict judge_drive(const PlanProblem& problem, const sim::DrivePrediction& drive,
                         const VerdictSetting& setting) {
  return Judging(problem, drive, setting).run();
}

}  // namespace slipway::planner
