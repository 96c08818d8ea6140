#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// Where a discrepancy that nobody has named could enter, and what it could depend on: the explanation called
// "something else", which competes with the effects on equal terms [Brynjarsdottir & O'Hagan 2014, Inverse
// Problems 30].
//
// A column is what an entry point does to every observation, at the fit, times a function of the window's
// circumstances: a constant pull, a pull that grows with the slope, a current that is wrong when cold. Each
// coefficient is believed to be 0 with one common deviation, the term's size.

// Entry points: of forces and loads (by what a lever of the model does), of the ground, and of readings.
enum class Entry {
  kTangentialForce,
  kLateralForce,
  kWheelLoadForeAft,
  kWheelLoadLeftRight,
  kKinematics,
  kPressureSinkage,
  kSlipSensor,
  kSideSlip,
  kYaw,
  kRollSensor,
  kPitchSensor,
  kTorqueToCurrent,
  kSinkage
};
std::string_view name_of(Entry entry);  // "tangential_force", ...

// What a window's drive met, each about 1 in size where it matters.
enum class Circumstance {
  kConstant,
  kPitch,
  kRoll,
  kSlip,       // predicted
  kDirection,  // 1 forwards, -1 backwards
  kSpeed,      // over the campaign's mean
  kCurvature,
  kTurning,  // in place
  kTemperature,
  kEast,   // of the heading
  kNorth,  // of the heading
  kOrder   // of the drives: -1 the first, 1 the last
};
constexpr std::size_t kCircumstances = 12;
std::string_view name_of(Circumstance circumstance);  // "constant", "pitch", ...
using Circumstances = std::array<double, kCircumstances>;

struct DiscrepancyTerm {
  struct Column {
    Entry entry = Entry::kTangentialForce;
    int wheel = -1;  // of a motor's own torque constant; -1: all
    Circumstance circumstance = Circumstance::kConstant;
  };
  std::vector<Column> columns;
  Eigen::MatrixXd values;  // observations x columns, for a coefficient of the size that would matter
};

// Of every window.
std::vector<Circumstances> circumstances(const WindowModel& model, std::span<const double> expected,
                                         const DiscrepancyOptions& options);

// What the levers do to every observation at a null fit's parameters: derivatives by the pitch and roll under
// which weights act (a force along, a force across; rad), by the centre of mass forward and to the left (m),
// and by the angle at which steered wheels stand (rad).
Eigen::MatrixXd lever_responses(const DriveCampaign& campaign, const WindowModel& model,
                                std::span<const double> null_x, const DiscrepancyOptions& options,
                                std::size_t threads);
constexpr int kLevers = 5;

DiscrepancyTerm make_discrepancy_term(const DriveCampaign& campaign, const WindowModel& model,
                                      const FittedExplanation& fit, const DiscrepancyOptions& options,
                                      std::size_t threads);

// Whether all drives meet a circumstance alike, or would but for those that go backwards, which are few.
bool acts_throughout(Circumstance circumstance);

// Its whitened columns, rows weighed as in the fit, and those of them by which something else may enter
// alone. What is off throughout may not: effects of the library, re-tuned parameters and causes from outside
// say that.
struct WhiteTerm {
  Eigen::MatrixXd columns;
  std::vector<Eigen::Index> single;
};
WhiteTerm whitened(const PosteriorMode& fit, const NoiseModel& noise, const DiscrepancyTerm& discrepancy);

// The columns, whitened, by which the effects of a fit may be off: what each of them does there, times
// functions of the circumstances. None where the fit has no effects. That an effect is at work does not say
// that its equation is the library's.
Eigen::MatrixXd form_columns(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                             const FittedExplanation& fit, const DiscrepancyOptions& options,
                             std::size_t threads);

// What follows works on whitened columns alone: `term` is of `whitened`, `form` of `form_columns`. Work that
// is `cancelled` ends early with numbers that nobody looks at.
using Cancelled = std::function<bool()>;

// By how much the logarithm of a fitted explanation's evidence rises with the term beside it, averaged over
// sizes from none to DiscrepancyOptions::imprecision, and over larger ones; the effects' forms are averaged
// over likewise.
struct DiscrepancyGain {
  double imprecision = 0.0, something_else = 0.0;
};
DiscrepancyGain discrepancy_gain(const PosteriorMode& fit, const WhiteTerm& term, const Eigen::MatrixXd& form,
                                 const DiscrepancyOptions& options, const Cancelled& cancelled);
// The same with the columns made of a fit and its noise.
DiscrepancyGain discrepancy_gain(const DriveCampaign& campaign, const WindowModel& model,
                                 const NoiseModel& noise, const FittedExplanation& fit,
                                 const DiscrepancyTerm& discrepancy, const DiagnosisOptions& options);

// The fit's whitened columns with the form's and the term's behind, these at their most probable sizes among
// those that discrepancy_gain averages over.
Eigen::MatrixXd columns_beside(const PosteriorMode& fit, const WhiteTerm& term, const Eigen::MatrixXd& form,
                               bool something_else, const DiscrepancyOptions& options,
                               const Cancelled& cancelled);

// The one of these sizes (at least one) of the term beside a fit that has the most evidence.
double most_probable_size(const PosteriorMode& fit, const WhiteTerm& term, std::span<const double> sizes,
                          const Cancelled& cancelled);

// The coefficients' means and standard errors, in units of the columns, at the most probable size.
struct DiscrepancyEstimate {
  Eigen::VectorXd mean, error;
};
DiscrepancyEstimate estimate_discrepancy(const PosteriorMode& fit, const WhiteTerm& term,
                                         const DiscrepancyOptions& options, const Cancelled& cancelled);

}  // namespace slipway::gap
