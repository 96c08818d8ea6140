#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"
#include "gap/diagnosis/model/window_model.h"
#include "gap/estimate/least_squares.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {

using EffectVariant = sim::EffectVariant;

// Every way in which the effects of the catalogue could be at work on this rover, without those withheld and
// those that are looked for in places (sim::Effect::variant_at), for which residuals are needed. An effect
// that the rover's own file has on has one variant: that it is of another size.
std::vector<EffectVariant> effect_variants(const sim::RoverModel& rover,
                                           std::span<const std::string> withheld);

// The variant of such an effect at a place.
EffectVariant variant_at(const sim::Effect& effect, const sim::Disc& place);

// The place of a variant that is at work in one; nothing, where it is at work everywhere.
std::optional<sim::Disc> place_of(const EffectVariant& variant);

struct Parameter {
  std::string name;        // "friction/nominal", "grousers.height_m"
  std::string effect;      // empty: a nuisance
  double neutral = 0.0;    // where the model is the nominal one
  double std = 1.0;        // of the prior around neutral
  double usual_std = 1.0;  // the same where nothing was measured of it and nothing is held
  double lowest = 0.0, highest = 0.0;
  std::optional<SoilQuantity> quantity = {};  // of a soil's nuisance that is one of these
  int soil = -1;                              // of a soil's nuisance: index into DriveCampaign::soils
  std::optional<NuisanceKind> kind = {};      // of a nuisance
  bool shape = false;                         // of an effect: it says in which form, not how strongly
  bool measured = false;                      // its deviation is one of DriveCampaign::parameter_std
  bool held = false;                          // at its nominal value, by DriveCampaign::retuning
  // Nobody measured it otherwise, and it is free.
  bool is_told_by_drives() const { return !measured && !held; }
};

// Which nuisances are free. kClosures: soils and motors are held at their nominal values.
enum class FreeNuisances { kAll, kClosures };

// A set of effects (and causes from outside, see outside_cause.h, which have variants as effects do) with the
// nuisances: parameters, and the model at their values. At the neutral values the model is the nominal rover
// on the nominal soils with all that these have already: a soil's own slip sinkage, a rover's own grousers
// and effects. Predictions are continuous there, so that their derivatives are those by the effects.
class Hypothesis {
 public:
  Hypothesis(const DriveCampaign& campaign, std::vector<EffectVariant> effects,
             FreeNuisances nuisances = FreeNuisances::kAll);

  std::span<const Parameter> parameters() const { return parameters_; }
  std::span<const EffectVariant> effects() const { return effects_; }
  std::size_t nuisance_count() const { return nuisances_; }
  std::vector<double> neutral() const;
  // The prior's precision in deviations from the neutral values; empty: all parameters are independent, of
  // deviation 1. It is not where reference drives have told of the nuisances.
  const Eigen::MatrixXd& prior_precision() const { return prior_precision_; }
  // Of the library's effects; causes from outside have none.
  std::vector<sim::EffectSetting> settings(std::span<const double> x) const;
  // The values of all fields of a cause from outside that is among the effects.
  OutsideValues outside_values(std::string_view cause, std::span<const double> x) const;
  ModelState state(std::span<const double> x) const;
  // What the model at x predicts for every observation.
  std::vector<double> predict(const WindowModel& model, std::span<const double> x,
                              std::size_t threads = 1) const;
  // The change of a parameter that derivatives are taken by: well above the solver's tolerance.
  double step(std::size_t parameter) const;
  // Derivatives of every observation by each parameter, times the parameter's std: central differences,
  // one-sided where a bound is near. Rows without a prediction are 0. Where the predictions at x are given,
  // all differences are one-sided, at half the cost.
  Eigen::MatrixXd scaled_jacobian(const WindowModel& model, std::span<const double> x, std::size_t threads,
                                  std::span<const double> predicted = {}) const;

 private:
  // What the sensors would show of the predictions: late headings, biased attitudes.
  std::vector<double> as_shown(const WindowModel& model, std::span<const double> x,
                               std::vector<double> predicted) const;
  // One for each of effects(), in their order.
  std::vector<sim::EffectSetting> all_settings(std::span<const double> x) const;
  // Takes what reference drives told of the nuisances, which are all parameters by then.
  void believe_reference();
  void add_learnt(const LearntDifference& learnt, std::span<const double> x,
                  std::vector<double>& predicted) const;
  // Where an effect changes nothing: at the rover's own value, the variant's, or the field's.
  double neutral_of(const EffectVariant& variant, const Field& field) const;

  const DriveCampaign* campaign_;
  std::vector<EffectVariant> effects_;
  std::vector<Parameter> parameters_;
  struct NuisancePlace {
    const Nuisance* row;
    int soil;  // -1: all
  };
  std::vector<NuisancePlace> places_;
  std::size_t nuisances_ = 0;
  Eigen::MatrixXd prior_precision_;  // or none
};

}  // namespace slipway::gap
