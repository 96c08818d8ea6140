#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"
#include "gap/diagnosis/model/window_model.h"
#include "gap/estimate/least_squares.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {

// One way in which an effect of the catalogue could be at work: which of its fields are estimated, with what
// is believed of them, and what the others are held at.
struct EffectVariant {
  struct Free {
    std::string field;
    double std = 1.0;  // around the neutral value
    double lowest = 0.0, highest = 0.0;
  };
  std::string effect;
  std::string label;  // tells variants of one effect apart: "wheel lf"; may be empty
  std::vector<Free> free;
  std::vector<std::pair<std::string, double>> fixed;
  // Of attitude_bias: how much of the bias the inclinometer shows, and how much of it weights act along.
  // Both: the map is off. The first alone: the inclinometer is. The second alone: both are off together.
  double shown = 0.0, acting = 1.0;
};

// Every way in which the catalogue's effects could be at work on this rover, but for places (soft_patch), for
// which the residuals have to be looked at first.
std::vector<EffectVariant> effect_variants(const sim::RoverModel& rover,
                                           std::span<const std::string> withheld);

// Whether its law is one of several in the literature: what it does may then differ in form from the
// library's.
bool has_many_forms(std::string_view effect);

struct Parameter {
  std::string name;    // "friction/nominal", "grousers.height_m"
  std::string effect;  // empty: a nuisance
  double neutral = 0.0;
  double std = 1.0;  // of the prior around neutral
  double lowest = 0.0, highest = 0.0;
  std::optional<SoilQuantity> quantity = {};  // of a soil's nuisance that is one of these
  int soil = -1;                              // of a soil's nuisance: index into DriveCampaign::soils
};

// Which nuisances are free. kClosures: soils and motors are held at their nominal values.
enum class FreeNuisances { kAll, kClosures };

// A set of effects with the nuisances: parameters, and the model at their values.
class Hypothesis {
 public:
  Hypothesis(const DriveCampaign& campaign, std::vector<EffectVariant> effects,
             FreeNuisances nuisances = FreeNuisances::kAll);

  std::span<const Parameter> parameters() const { return parameters_; }
  std::span<const EffectVariant> effects() const { return effects_; }
  std::size_t nuisance_count() const { return nuisances_; }
  std::vector<double> neutral() const;
  std::vector<sim::EffectSetting> settings(std::span<const double> x) const;
  ModelState state(std::span<const double> x) const;
  // What the model at x says of every observation.
  std::vector<double> predict(const WindowModel& model, std::span<const double> x,
                              std::size_t threads = 1) const;
  // What a parameter is changed by to see what it does: well above the solver's tolerance.
  double step(std::size_t parameter) const;
  // Columns of derivatives by central differences, one a parameter, times the parameter's std; one-sided
  // where a bound is near. Rows without an answer are 0. With what is `predicted` at x: one-sided all, at
  // half the cost.
  Eigen::MatrixXd scaled_jacobian(const WindowModel& model, std::span<const double> x, std::size_t threads,
                                  std::span<const double> predicted = {}) const;

 private:
  // What the sensors would show of it: late headings, biased attitudes.
  std::vector<double> as_shown(const WindowModel& model, std::span<const double> x,
                               std::vector<double> predicted) const;
  const DriveCampaign* campaign_;
  std::vector<EffectVariant> effects_;
  std::vector<Parameter> parameters_;
  struct NuisancePlace {
    const Nuisance* row;
    int soil;  // -1: all
  };
  std::vector<NuisancePlace> places_;
  std::size_t nuisances_ = 0;
};

}  // namespace slipway::gap
