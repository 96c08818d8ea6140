#include "api/report/check_advice.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/json/lookup.h"

namespace slipway::api {
namespace {

using json::at;
using json::JsonValue;
using json::number;
using json::text;

double wrong_on(const JsonValue& part) {
  return number(part, "expected_stops") + number(part, "embedding");
}

double wrong_on_all(const JsonValue& parts) {
  double all = 0.0;
  for (const JsonValue& part : parts.elements) all += wrong_on(part);
  return all;
}

const JsonValue* worst_of(const JsonValue& parts) {
  const auto worst =
      std::max_element(parts.elements.begin(), parts.elements.end(),
                       [](const JsonValue& a, const JsonValue& b) { return wrong_on(a) < wrong_on(b); });
  return worst == parts.elements.end() || wrong_on(*worst) <= 0.0 ? nullptr : &*worst;
}

void advise_on_stretch(const JsonValue& check, std::vector<std::string>& advice) {
  const JsonValue& stretches = at(at(check, "outcomes"), "stretches");
  const JsonValue* const worst = worst_of(stretches);
  if (worst == nullptr) return;
  const double share = wrong_on(*worst) / wrong_on_all(stretches);
  advice.push_back(
      fmt::format("Avoid the way from {:.1f} to {:.1f} m: {:.0f} % of what goes wrong happens there",
                  number(*worst, "from_m"), number(*worst, "to_m"), 100.0 * share));
  const double every_m = number(at(at(check, "request"), "checks"), "slip_check_every_m");
  if (number(*worst, "embedding") > 0.0)
    advice.push_back(
        fmt::format("Or check the slip more often than every {:g} m there: a rover that spins is embedded "
                    "where its wheels turn too long before a check",
                    every_m));
}

// The limit of the rule that trips most often.
void advise_on_rule(const JsonValue& outcomes, std::vector<std::string>& advice) {
  const JsonValue* most = nullptr;
  for (const JsonValue& rule : at(outcomes, "rules").elements) {
    if (text(rule, "rule") == "embedding") continue;
    if (most == nullptr || number(at(rule, "trips"), "value") > number(at(*most, "trips"), "value"))
      most = &rule;
  }
  if (most == nullptr || number(at(*most, "trips"), "value") <= 0.0) return;
  const std::string& name = text(*most, "rule");
  const std::string unit = text(*most, "unit") == "1" ? "" : " " + text(*most, "unit");
  const bool is_floor = name == "clearance";
  constexpr double kSpinning = 0.99;  // of slip: hardly any way comes of it
  if (name == "slip_check" && number(at(*most, "value"), "p95") > kSpinning) {
    advice.push_back(
        fmt::format("The rule that trips most is slip_check, in {:.1f} % of the draws, and no other limit "
                    "helps: in more than 5 % of the draws the wheels spin on the spot",
                    100.0 * number(at(*most, "trips"), "value")));
    return;
  }
  advice.push_back(
      fmt::format("The rule that trips most is {}: with {:.3g}{} for its limit of {:.3g}{} it would trip in "
                  "about 5 % of the draws, where "
                  "it trips in {:.1f} %; whether that is to be risked is not for this page to say",
                  name, number(at(*most, "value"), is_floor ? "p05" : "p95"), unit, number(*most, "limit"),
                  unit, 100.0 * number(at(*most, "trips"), "value")));
}

void advise_on_ground(const JsonValue& outcomes, std::vector<std::string>& advice) {
  const JsonValue* const worst = worst_of(at(outcomes, "grounds"));
  if (worst == nullptr) return;
  const double share = wrong_on(*worst) / wrong_on_all(at(outcomes, "grounds"));
  if (json::has(*worst, "soil"))
    advice.push_back(fmt::format("Measure soil {}: {:.0f} % of what goes wrong happens on its {:.0f} m",
                                 text(*worst, "soil"), 100.0 * share, number(*worst, "length_m")));
  else
    advice.push_back(
        fmt::format("Map the {:.0f} m of ground that no map names: {:.0f} % of what goes wrong happens there",
                    number(*worst, "length_m"), 100.0 * share));
}

// The interval of a share or a mean has the bar inside.
bool straddles(double low, double high, double bar) {
  return low <= bar && bar <= high;
}

void advise_on_draws(const JsonValue& check, std::vector<std::string>& advice) {
  const JsonValue& outcomes = at(check, "outcomes");
  const JsonValue& bars = at(at(check, "request"), "bars");
  const JsonValue &embedding = at(outcomes, "embedding"), &stops = at(outcomes, "expected_stops");
  if (straddles(number(embedding, "low"), number(embedding, "high"), number(bars, "max_embedding")) ||
      straddles(number(stops, "low"), number(stops, "high"), number(bars, "max_expected_stops")))
    advice.push_back(fmt::format("Take more draws of the ground than {:.0f}: a bar lies inside an interval",
                                 number(outcomes, "draws")));
}

// How near a GO came to its limits.
std::string nearest_limit(const JsonValue& outcomes) {
  const JsonValue* nearest = nullptr;
  double least = 1e300;
  for (const JsonValue& rule : at(outcomes, "rules").elements) {
    const double limit = number(rule, "limit");
    if (text(rule, "rule") == "embedding" || limit <= 0.0) continue;
    const double share = number(rule, "margin") / limit;
    if (share >= least) continue;
    least = share;
    nearest = &rule;
  }
  if (nearest == nullptr) return "Nothing comes near to a limit";
  const std::string unit = text(*nearest, "unit") == "1" ? "" : " " + text(*nearest, "unit");
  return fmt::format("Nearest to its limit is {}: 95 % of the draws keep {:.3g}{} or more away from {:.3g}{}",
                     text(*nearest, "rule"), number(*nearest, "margin"), unit, number(*nearest, "limit"),
                     unit);
}

}  // namespace

std::string scout_words(const JsonValue& outcomes) {
  if (!json::has(outcomes, "scout")) return {};
  const JsonValue& scout = at(outcomes, "scout");
  const JsonValue &then = at(scout, "verdict_afterwards"), &slip = at(scout, "slip");
  return fmt::format(
      "A scout drive from {:.1f} to {:.1f} m, at ({:.1f}, {:.1f}) onto {}, would measure a slip of {:.2f} "
      "({:.2f} "
      "to {:.2f}): then the draws say GO with {:.0f} %, NO-GO with {:.0f} %, and it is worth {:.2f} sols; it "
      "has {:.2f} expected stops itself and embeds the rover in {:.1f} % of the draws",
      number(scout, "from_m"), number(scout, "to_m"), number(scout, "x_m"), number(scout, "y_m"),
      json::has(scout, "soil") ? "soil " + text(scout, "soil") : std::string("ground that no map names"),
      number(slip, "p50"), number(slip, "p05"), number(slip, "p95"), 100.0 * number(then, "go"),
      100.0 * number(then, "no_go"), number(scout, "worth_sols"), number(scout, "expected_stops"),
      100.0 * number(scout, "embedding"));
}

std::vector<std::string> check_advice(const JsonValue& check) {
  const JsonValue& outcomes = at(check, "outcomes");
  const std::string& verdict = text(check, "verdict");
  std::vector<std::string> advice;
  if (verdict == "go") advice.push_back(nearest_limit(outcomes));
  advise_on_stretch(check, advice);
  if (verdict == "go") return advice;
  advise_on_rule(outcomes, advice);
  advise_on_ground(outcomes, advice);
  if (verdict == "unknown") advise_on_draws(check, advice);
  if (std::string scout = scout_words(outcomes); !scout.empty()) advice.push_back(std::move(scout));
  if (advice.empty()) advice.emplace_back("Nothing that the draws show; see the reasons");
  return advice;
}

}  // namespace slipway::api
