#include "api/report/diagnosis_sections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/report/report_words.h"
#include "core/utc.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"

namespace slipway::api {
namespace {

using gap::Diagnosis;

// The time of the first and the last row of all drives, where all times are seconds since 1970: those of a
// clock that starts with the drive or the mission are far below.
std::optional<std::pair<double, double>> recorded_dates(const gap::DriveCampaign& campaign) {
  constexpr double kYear1990_s = 631'152'000.0, kYear2100_s = 4'102'444'800.0;
  double first = kYear2100_s, last = kYear1990_s;
  for (const gap::MeasuredDriveSeries& drive : campaign.drives) {
    if (drive.samples.empty()) continue;
    first = std::min(first, drive.samples.front().time_s);
    last = std::max(last, drive.samples.back().time_s);
  }
  if (first < kYear1990_s || last > kYear2100_s || first > last) return std::nullopt;
  return std::pair{first, last};
}

// "2012-08-06 05:17"
std::string minute_words(double seconds_since_1970) {
  std::string text = utc_text(static_cast<std::int64_t>(1000.0 * seconds_since_1970)).substr(0, 16);
  std::replace(text.begin(), text.end(), 'T', ' ');
  return text;
}

std::string dates_words(const gap::DriveCampaign& campaign) {
  const auto dates = recorded_dates(campaign);
  if (!dates) return "not recorded: the times in the drives' files are not seconds since 1970";
  return fmt::format("{} to {} UTC", minute_words(dates->first), minute_words(dates->second));
}

// The nuisance of a re-tuned parameter: "stiffness" of "stiffness/sand".
std::string_view meaning_of(std::string_view parameter) {
  const std::string_view name = parameter.substr(0, parameter.find('/'));
  for (const gap::Nuisance& row : gap::nuisance_catalogue())
    if (row.name == name) return row.summary;
  return "";
}

std::string values_words(const gap::ListedOption& option) {
  return fmt::format("{:.6g}", fmt::join(option.values, " / "));
}

const gap::ListedOption* same_option(const std::vector<gap::ListedOption>& options,
                                     const gap::ListedOption& as) {
  const auto at = std::find_if(options.begin(), options.end(), [&](const gap::ListedOption& option) {
    return option.step == as.step && option.name == as.name;
  });
  return at == options.end() ? nullptr : &*at;
}

void write_residual(ReportPage& page, const Diagnosis& d) {
  const gap::ResidualShape& first = d.residual.front();
  if (!first.words.empty())
    page.paragraph(fmt::format(
        "It looks most like {} ({}). The probability that this is at work is {}. On drives held out of the "
        "fit it takes away {:.0f} % of the gap that re-tuning leaves.",
        first.words, outside_parameters_words(first), probability_words(first.probability.value_or(0.0)),
        100.0 * first.closed_share.value_or(0.0)));
  page.paragraph(
      "Where what remains enters, on what it depends, and how it changes from the lowest (-1) to the "
      "highest (1) value of the variable that was driven. It is described, not to be extrapolated. The "
      "share says how much of this description, of all drives and in squared deviations of the noise, a row "
      "has; it is no share of the gap. Numbers without a unit are multiples of the size from which on such "
      "an error would matter.");
  page.table({"enters at", "depends on", "share of the description", "shape"});
  for (const gap::ResidualShape& shape : d.residual) {
    std::vector<std::string> points;
    for (const auto& [at, value] : shape.shape)
      points.push_back(
          fmt::format("{}{} at {:g}", number_words("{:.3g}", value.value), unit_words(shape.unit), at));
    page.row({shape.entry, shape.variable, fmt::format("{:.0f} %", 100.0 * shape.share),
              fmt::format("{}", fmt::join(points, ", "))});
  }
}

}  // namespace

void write_what_was_driven(ReportPage& page, const gap::DriveCampaign& campaign) {
  const sim::RoverModel& rover = *campaign.rover;
  std::vector<std::string> soils, terrains;
  for (const gap::NominalSoil& soil : campaign.soils) soils.push_back(soil.name);
  for (const gap::CampaignTerrain& terrain : campaign.terrains) terrains.push_back(terrain.name);
  page.table({"rover", "gravity, m/s2", "soils", "terrains", "drives", "dates"});
  page.row({fmt::format("{} ({:g} kg, {} wheels)", rover.name, rover.mass_kg, rover.wheels.size()),
            fmt::format("{:g}", campaign.gravity_m_s2), fmt::format("{}", fmt::join(soils, ", ")),
            fmt::format("{}", fmt::join(terrains, ", ")),
            campaign.drives.empty() ? "none"
                                    : fmt::format("{}, from {} to {}", campaign.drives.size(),
                                                  campaign.drives.front().id, campaign.drives.back().id),
            dates_words(campaign)});
}

void write_found_effects(ReportPage& page, const Diagnosis& d) {
  if (d.effects.empty()) return;
  page.table({"effect", "what it is", "how", "probability", "parameters, with 90 % intervals"});
  for (const gap::FoundEffect& found : d.effects) {
    std::vector<std::string> parameters;
    for (const gap::FoundParameter& p : found.parameters)
      parameters.push_back(fmt::format("{} = {}{}", p.name, interval_words(p.value),
                                       unit_words(effect_unit(found.name, p.name))));
    page.row({found.name, effect_summary(found.name), found.variant, probability_words(found.probability),
              fmt::format("{}", fmt::join(parameters, ", "))});
  }
}

void write_retuned(ReportPage& page, const Diagnosis& d) {
  if (d.retuned.empty()) return;
  page.section("Parameters re-tuned");
  page.paragraph(
      "Values are in what the last column says; a unit stands there where a value has one. A logarithm is of "
      "a factor on the nominal value: 0.1 is 10 % more, 1.5 is 4.5 times as much. One that is many "
      "deviations from what was believed of it is not to be trusted without another look at it.");
  page.table({"parameter", "value, 90 % interval", "believed before", "deviations off", "the drives tell",
              "what it is"});
  for (const gap::RetunedParameter& p : d.retuned)
    page.row({p.name, interval_words(p.value), fmt::format("{:.3g}, std {:.3g}", p.believed, p.prior_std),
              fmt::format("{:+.1f}", (p.value.value - p.believed) / p.prior_std), p.determined ? "yes" : "no",
              meaning_of(p.name)});
}

void write_unknown(ReportPage& page, const Diagnosis& d) {
  if (!d.residual.empty()) {
    page.section("What nobody has named");
    write_residual(page, d);
  }
  if (d.least_detectable.empty()) return;
  page.section("Smallest effects that would have been seen");
  page.table({"effect", "parameter", "at least", "what the effect is"});
  for (const gap::LeastDetectable& l : d.least_detectable)
    page.row({l.effect, l.parameter,
              number_words("{:.3g}", l.value) + unit_words(effect_unit(l.effect, l.parameter)),
              effect_summary(l.effect)});
}

void write_next_drives(ReportPage& page, const Diagnosis& d) {
  if (d.verdict == gap::Verdict::kInsufficient) return;
  page.section("Drives that would tell most");
  const std::vector<gap::NextDrive> offered = json::offered_drives(d);
  if (offered.empty()) return page.paragraph(no_drive_offered_words());
  page.table({"tilt, deg", "heading, deg", "speed, m/s", "curvature, 1/m", "motors, C",
              "expected information, bits"});
  for (const gap::NextDrive& n : offered)
    page.row({fmt::format("{:.0f}", n.tilt_deg), fmt::format("{:.0f}", n.heading_deg),
              fmt::format("{:.3g}", n.speed_m_s), fmt::format("{:.2g}", n.curvature_1_m),
              fmt::format("{:.0f}", n.motor_temp_c), number_words("{:.2f}", n.information_bits)});
}

void write_options(ReportPage& page, const Diagnosis& d) {
  if (d.options.empty()) return;
  page.section("Options");
  const std::vector<gap::ListedOption> defaults = gap::listed_options({});
  std::vector<std::vector<ReportText>> changed;
  for (const gap::ListedOption& option : d.options) {
    const gap::ListedOption* const usual = same_option(defaults, option);
    if (usual != nullptr && usual->values == option.values) continue;
    changed.push_back({option.step, option.name, values_words(option),
                       usual != nullptr ? values_words(*usual) : std::string()});
  }
  if (changed.empty())
    return page.paragraph("Every number that this answer depends on besides the drives has its default.");
  page.paragraph("Numbers that this answer depends on besides the drives and that are not the default:");
  page.table({"step", "option", "value", "default"});
  for (std::vector<ReportText>& row : changed) page.row(std::move(row));
}

}  // namespace slipway::api
