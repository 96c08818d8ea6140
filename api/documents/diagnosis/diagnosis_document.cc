#include "api/documents/diagnosis/diagnosis_document.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <string_view>

#include "api/documents/diagnosis/diagnosis_where.h"
#include "api/documents/interval_keys.h"
#include "api/files/effect_settings.h"
#include "api/files/noise_scales.h"
#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/json/writer.h"
#include "core/version.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api::json {
namespace {

using gap::Diagnosis;

// The numbers that the answer depends on, by the step that uses them.
void write_options(Writer& w, std::span<const gap::ListedOption> options) {
  w.key("options").begin_object();
  for (std::size_t i = 0; i < options.size(); ++i) {
    const gap::ListedOption& option = options[i];
    if (i == 0 || options[i - 1].step != option.step) w.key(option.step).begin_object();
    if (option.list) {
      w.key(option.name).begin_array();
      for (const double value : option.values) w.exact(value);
      w.end_array();
    } else {
      w.exact(option.name, option.values.front());
    }
    if (i + 1 == options.size() || options[i + 1].step != option.step) w.end_object();
  }
  w.end_object();
}

void write_provenance(Writer& w, const gap::DriveCampaign& campaign, const Diagnosis& d) {
  w.key("provenance").begin_object();
  w.key("hashes").begin_object().text("campaign", d.campaign_fingerprint).key("terrains").begin_object();
  for (const gap::CampaignTerrain& terrain : campaign.terrains) w.text(terrain.name, terrain.fingerprint);
  w.end_object().end_object();
  w.text("version", version()).whole("seed", static_cast<std::int64_t>(d.seed));
  write_options(w, d.options);
  w.texts("effects", d.library);
  std::vector<std::string> withheld;
  for (const sim::Effect& effect : sim::effect_catalogue())
    if (std::find(d.library.begin(), d.library.end(), effect.name) == d.library.end())
      withheld.emplace_back(effect.name);
  w.texts("withheld", withheld);
  w.whole("drives", static_cast<std::int64_t>(d.drives))
      .whole("windows", static_cast<std::int64_t>(d.windows));
  w.whole("observations", static_cast<std::int64_t>(d.observations)).end_object();
}

void write_effects_found(Writer& w, const Diagnosis& d) {
  w.key("effects").begin_array();
  for (const gap::FoundEffect& found : d.effects) {
    w.begin_object().text("name", found.name);
    if (!found.variant.empty()) w.text("variant", found.variant);
    w.significant("probability", found.probability).key("parameters").begin_object();
    for (const gap::FoundParameter& parameter : found.parameters)
      write_interval(w, parameter.name, parameter.value);
    w.end_object().end_object();
  }
  w.end_array();
}

void write_marginals(Writer& w, const Diagnosis& d) {
  w.key("marginals").begin_array();
  for (const gap::EffectMarginal& m : d.marginals)
    w.begin_object()
        .text("name", m.name)
        .exact("probability", m.probability)
        .significant("closed_share", m.closed_share)
        .significant("calibrated", m.calibrated)
        .end_object();
  w.end_array();
}

void write_measurements(Writer& w, const Diagnosis& d) {
  w.key("measurements").begin_array();
  for (const gap::MeasurementProposal& proposal : d.measurements) {
    std::vector<std::string> kinds;
    for (const gap::NuisanceKind kind : proposal.kinds) kinds.emplace_back(gap::measurement_of(kind));
    w.begin_object().text("effect", proposal.effect).texts("measure", kinds);
    w.texts("parameters", proposal.parameters);
    w.significant("deviations_now", proposal.deviations_now)
        .significant("deviations_then", proposal.deviations_then)
        .end_object();
  }
  w.end_array();
}

void write_candidates(Writer& w, const Diagnosis& d) {
  w.key("candidates").begin_array();
  for (const gap::ComparedSet& set : compared_sets(d)) {
    w.begin_object().texts("effects", gap::names_of(set)).exact("probability", set.probability);
    if (set.held_out_score) write_finite(w, "held_out_score", *set.held_out_score);
    w.whole("complexity", set.complexity);
    if (set.log_evidence) w.significant("log_evidence", *set.log_evidence);
    if (set.log_prior) w.significant("log_prior", *set.log_prior);
    w.significant("chosen_share", set.chosen_share).end_object();
  }
  w.end_array().key("confusable").begin_array();
  for (const gap::ConfusablePair& pair : d.confusable)
    w.begin_object().texts("effects", {pair.a, pair.b}).significant("angle_deg", pair.angle_deg).end_object();
  w.end_array().key("look_alikes").begin_array();
  for (const gap::LookAlike& alike : d.look_alikes) {
    w.begin_object().text("effect", alike.effect).text("like", alike.like);
    if (!alike.which.empty()) w.texts("parameters", alike.which);
    w.significant("angle_deg", alike.angle_deg).end_object();
  }
  w.end_array();
  write_measurements(w, d);
}

void write_planners_view(Writer& w, const Diagnosis& d) {
  const gap::PlannersView& view = d.planners_view;
  const auto count = [&](std::string_view key, std::size_t n) { w.whole(key, static_cast<std::int64_t>(n)); };
  w.key("planning").begin_object();
  count("observations", view.observations);
  count("windows", view.windows);
  count("immobilised", view.immobilised);
  count("pairs", view.pairs);
  for (const auto& [name, figures] : {std::pair{"nominal", &view.nominal},
                                      {"retuned", &view.retuned},
                                      {"with_effects", &view.with_effects}}) {
    w.key(name).begin_object();
    if (view.observations > 0) w.significant("within_90", figures->within_90);
    count("immobilised_called", figures->called);
    count("false_calls", figures->false_calls);
    if (view.pairs > 0) w.significant("pairs_in_order", figures->in_order);
    w.end_object();
  }
  w.end_object();
}

void write_extrapolations(Writer& w, const Diagnosis& d) {
  w.key("extrapolation").begin_array();
  for (const gap::Extrapolation& e : d.extrapolations) {
    w.begin_object().text("variable", e.variable).significant(e.above ? "above" : "below", e.limit);
    w.whole("drives", static_cast<std::int64_t>(e.groups));
    w.significant("log_density_gain", e.log_density_gain).significant("standard_error", e.error).end_object();
  }
  w.end_array();
}

void write_gap(Writer& w, const Diagnosis& d) {
  w.key("gap").begin_object().key("channels").begin_array();
  for (const gap::ChannelClosure& channel : d.gap) {
    const double unit = gap::boundary_unit(channel.channel);
    w.begin_object().text("channel", gap::name_of(channel.channel));
    w.text("unit", gap::unit_of(channel.channel));
    write_interval(w, "nominal", channel.nominal, unit);
    write_interval(w, "retuned", channel.retuned, unit);
    write_interval(w, "with_effects", channel.with_effects, unit);
    if (channel.with_discrepancy) write_interval(w, "with_discrepancy", *channel.with_discrepancy, unit);
    write_interval(w, "noise_floor", channel.noise_floor, unit);
    if (channel.closed_fraction) write_interval(w, "closed_fraction", *channel.closed_fraction);
    w.end_object();
  }
  w.end_array();
  if (d.closed_fraction) write_interval(w, "closed_fraction", *d.closed_fraction);
  w.end_object();
}

void write_reference(Writer& w, const Diagnosis& d) {
  if (!d.reference) return;
  const gap::ReferenceSummary& reference = *d.reference;
  w.key("reference").begin_object().text("campaign", reference.campaign);
  w.text("hash", reference.fingerprint);
  w.whole("drives", static_cast<std::int64_t>(reference.drives));
  w.whole("windows", static_cast<std::int64_t>(reference.windows));
  w.key("discrepancy").begin_array();
  for (const gap::ReferenceSummary::LearntChannel& channel : reference.channels) {
    const double unit = gap::boundary_unit(channel.channel);
    w.begin_object().text("channel", gap::name_of(channel.channel));
    w.text("unit", gap::unit_of(channel.channel));
    write_finite(w, "learnt", unit * channel.learnt);
    write_finite(w, "open", unit * channel.open);
    w.end_object();
  }
  w.end_array().end_object();
}

void write_residual(Writer& w, const Diagnosis& d) {
  w.key("residual").begin_array();
  for (const gap::ResidualShape& shape : d.residual) {
    w.begin_object().text("form", shape.form);
    if (!shape.words.empty()) w.text("text", shape.words);
    w.text("entry", shape.entry).text("variable", shape.variable);
    write_finite(w, "share", shape.share);
    if (shape.probability) w.exact("probability", *shape.probability);
    if (shape.closed_share) w.significant("closed_share", *shape.closed_share);
    if (!shape.parameters.empty()) {
      w.key("parameters").begin_object();
      for (const gap::FoundParameter& parameter : shape.parameters)
        write_interval(w, parameter.name, parameter.value);
      w.end_object();
    }
    if (!shape.unit.empty()) w.text("unit", shape.unit);
    w.key("shape").begin_array();
    for (const auto& [at, value] : shape.shape) {
      if (!std::isfinite(at) || !std::isfinite(value.value)) continue;
      w.begin_object().significant("at", at);
      write_interval_keys(w, value);
      w.end_object();
    }
    w.end_array().end_object();
  }
  w.end_array();
}

void write_least_detectable(Writer& w, const Diagnosis& d) {
  w.key("least_detectable").begin_array();
  for (const gap::LeastDetectable& least : d.least_detectable) {
    if (!std::isfinite(least.value)) continue;
    w.begin_object().text("effect", least.effect).text("parameter", least.parameter);
    w.significant("value", least.value).end_object();
  }
  w.end_array();
}

void write_next_drives(Writer& w, const Diagnosis& d) {
  w.key("next_drives").begin_array();
  for (const gap::NextDrive& drive : offered_drives(d)) {
    w.begin_object().significant("tilt_deg", drive.tilt_deg).significant("heading_deg", drive.heading_deg);
    w.significant("speed_m_s", drive.speed_m_s).significant("curvature_1_m", drive.curvature_1_m);
    w.significant("motor_temp_c", drive.motor_temp_c);
    write_finite(w, "expected_information_bits", drive.information_bits);
    w.end_object();
  }
  w.end_array();
}

void write_model(Writer& w, const gap::DriveCampaign& campaign, const Diagnosis& d) {
  const auto model = corrected_model(campaign, d);
  if (!model) return;
  w.key("model").begin_object().text("campaign", campaign.name);
  w.key("nominal").begin_object().text("rover", d.nominal_rover->name).key("soils").begin_array();
  for (const gap::NominalSoil& soil : d.nominal_soils) w.text(soil.name);
  w.end_array().end_object().key("rover").raw(rover_document(*model));
  w.key("soils").raw(soils_document(*model));
  write_effects(w, model->effects);
  w.end_object();
}

void write_retuned(Writer& w, const Diagnosis& d) {
  w.key("retuned").begin_array();
  for (const gap::RetunedParameter& parameter : d.retuned) {
    w.begin_object().text("name", parameter.name);
    write_interval_keys(w, parameter.value);
    w.significant("prior_std", parameter.prior_std).boolean("determined", parameter.determined).end_object();
  }
  w.end_array();
}

}  // namespace

std::vector<gap::ComparedSet> compared_sets(const Diagnosis& diagnosis) {
  std::vector<gap::ComparedSet> sets;
  const auto same = [&](const gap::ComparedSet& as) {
    const std::set<std::string> effects(as.effects.begin(), as.effects.end());
    return std::find_if(sets.begin(), sets.end(), [&](const gap::ComparedSet& set) {
      return set.with_unknown == as.with_unknown &&
             std::set<std::string>(set.effects.begin(), set.effects.end()) == effects;
    });
  };
  double sum = 0.0;
  for (const gap::ComparedSet& candidate : diagnosis.candidates) {
    sum += candidate.probability;
    if (const auto known = same(candidate); known != sets.end()) {
      known->probability += candidate.probability;
      known->chosen_share += candidate.chosen_share;
    } else {
      sets.push_back(candidate);
    }
  }
  for (const bool unknown : {false, true}) {
    gap::ComparedSet always;
    always.with_unknown = unknown;
    if (same(always) == sets.end()) sets.push_back(always);
  }
  for (gap::ComparedSet& set : sets) {
    if (sum > 0.0)
      set.probability /= sum;
    else
      set.probability = 1.0 / static_cast<double>(sets.size());
  }
  std::stable_sort(sets.begin(), sets.end(), [](const gap::ComparedSet& a, const gap::ComparedSet& b) {
    return a.probability > b.probability;
  });
  return sets;
}

std::vector<gap::NextDrive> offered_drives(const Diagnosis& diagnosis) {
  std::vector<gap::NextDrive> offered = diagnosis.next_drives;
  // Drives whose information is no number are not offered either.
  std::erase_if(offered,
                [](const gap::NextDrive& drive) { return !(drive.information_bits >= kLeastOfferedBits); });
  return offered;
}

std::string rover_document(const CorrectedModel& model) {
  Writer w;
  write_rover(w, model.rover);
  return w.take();
}

std::string soils_document(const CorrectedModel& model) {
  Writer w;
  w.begin_object().text("format", "soils/1").key("soils").begin_array();
  for (const sim::SoilDistribution& soil : model.soils) write_soil(w, soil);
  w.end_array().end_object();
  return w.take();
}

std::string diagnosis_document(const gap::DriveCampaign& campaign, const Diagnosis& d) {
  Writer w;
  w.begin_object().text("format", "diagnosis/1").text("campaign", d.campaign);
  write_provenance(w, campaign, d);
  w.text("verdict", gap::name_of(d.verdict)).text("reason", d.reason);
  w.text("overturned_by", d.overturned_by).boolean("model_adequate", d.model_adequate);
  w.significant("conflict_probability", d.conflict_probability);
  w.significant("held_out_probability", d.held_out_probability);
  write_effects_found(w, d);
  write_marginals(w, d);
  write_reference(w, d);
  write_candidates(w, d);
  write_where(w, campaign, d);
  write_gap(w, d);
  write_planners_view(w, d);
  write_extrapolations(w, d);
  write_residual(w, d);
  write_least_detectable(w, d);
  write_next_drives(w, d);
  write_retuned(w, d);
  write_noise_scales(w.key("noise"), d.noise);
  write_model(w, campaign, d);
  w.texts("notes", d.notes).end_object();
  return w.take();
}

}  // namespace slipway::api::json
