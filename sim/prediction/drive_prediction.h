#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/pose.h"
#include "core/progress.h"
#include "core/result.h"
#include "sim/prediction/relief_spread.h"
#include "sim/prediction/rule_catalogue.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/ground.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"

namespace slipway::sim {

// One place of a path at which the rover is balanced. Stations are in driving order.
struct PathStation {
  Pose2 pose;
  double distance_m = 0.0;     // driven by B since the path's start
  double turned_rad = 0.0;     // signed angle turned in place between the previous station and this one
  double curvature_1_m = 0.0;  // of the arc through this station
  bool turning_in_place = false;
  bool backwards = false;
  double crab_rad = 0.0;  // direction of travel from the rover's x axis, positive to the left
};

// The soil distributions of the ground in the order of Ground::soil_at's index, and that of unknown ground.
struct SoilBeliefs {
  std::vector<SoilDistribution> known;
  SoilDistribution unknown;

  const SoilDistribution& of(std::optional<std::size_t> soil) const { return soil ? known[*soil] : unknown; }
};

struct StationPrediction {
  PathStation station;
  double height_m = 0.0;
  Attitude attitude;  // as in StationState
  double clearance_m = 0.0;
  std::optional<std::size_t> soil;  // under B's origin; empty on unknown ground
  bool on_unknown_ground = false;   // true where any wheel is on unknown ground
  StationState state;               // on the mean soils
  double elapsed_s = 0.0;           // since the start
  // Quantiles over the soil draws (see RiskOptions); equal to the state's values where there are no draws.
  double slip_ratio_p05 = 0.0, slip_ratio_p50 = 0.0, slip_ratio_p95 = 0.0;
  double current_a_p95 = 0.0;  // of the worst wheel
  double sinkage_m_p95 = 0.0;  // of the worst wheel
  double tilt_rad_p05 = 0.0, tilt_rad_p95 = 0.0;
  double clearance_m_p05 = 0.0, clearance_m_p95 = 0.0;
  // Way to the side since the last look at where the rover is, positive to the left: on the mean soils, and
  // over the draws.
  double aside_m = 0.0, aside_m_p05 = 0.0, aside_m_p95 = 0.0;
  double risk = 0.0;       // share of draws that break a limit or are immobilised here
  double stops = 0.0;      // share of draws that halt here first, on this segment
  double embedding = 0.0;  // share of draws that are then embedded here
};

struct Immobilisation {
  double distance_m = 0.0;
  Pose2 pose;
  std::string reason;  // "no traction: ..." with the numbers
};

// A share of the draws with its 90 % interval: Wilson's, at the effective number of draws.
struct DrawnShare {
  double share = 0.0, low = 0.0, high = 0.0;
};

// Percentiles over the draws.
struct DrawnSpread {
  double p05 = 0.0, p50 = 0.0, p95 = 0.0;
};

// What the draws say of one rule.
struct RuleRisk {
  Rule rule = Rule::kSlipCheck;
  double limit = 0.0;                        // in SI; kNoLimit where nobody set one
  DrawnSpread value;                         // of each draw's value that comes nearest to the limit
  std::optional<DrawnSpread> tripping = {};  // the same of the draws in which it trips
  DrawnShare trips;                          // share of the draws in which it trips
  double halts = 0.0;                        // share of the draws that it halts first
  double from_m = 0.0, to_m = 0.0;           // where it trips in any draw; both 0 where it does in none
  // Where the value comes nearest most often, of the draws in which it trips if there are any, and whose it
  // is there; -1 where it is the rover's.
  std::size_t station = 0;
  int wheel = -1;
};

// How drives end over the draws, on the whole way or on a part of it. A halt ends a drive, whichever rule
// asks for it; the upper ends count draws of which the solver found no end as bad.
struct OutcomeShares {
  DrawnShare stop;         // at least one halt, an embedding among them
  DrawnShare immobilised;  // the first halt is where the ground holds the rover
  DrawnShare embedding;    // the wheels dig in before the first halt
};

// The same of one kind of ground, and of one stretch of the way: the mean number of first halts there, one
// for each segment, and of embeddings.
struct GroundRisk {
  std::optional<std::size_t> soil;  // empty: unknown ground
  double length_m = 0.0;
  double expected_stops = 0.0;
  double embedding = 0.0;
};
struct StretchRisk {
  double from_m = 0.0, to_m = 0.0;
  double expected_stops = 0.0;
  double embedding = 0.0;
  DrawnSpread shortfall_m = {};  // behind to_m when the wheels have rolled that far, see ShortfallFollower
  // To the left of the path and of its heading, without a look at where it is, see DriftFollower.
  DrawnSpread drift_m = {}, turned_rad = {};
};

// A part of a long drive that is decided by itself: a sol's drive, of the draws in which the rover comes to
// it.
struct SegmentRisk : OutcomeShares {
  double from_m = 0.0, to_m = 0.0;
  double reached = 0.0;  // share of the draws that come to it
};

struct DriveOutcomes : OutcomeShares {
  DrawnShare completed;  // drives that come to their end without a halt
  // Halts until the drive is through, each followed by another sol: mean with 90 % interval.
  double expected_stops = 0.0, expected_stops_low = 0.0, expected_stops_high = 0.0;
  std::vector<RuleRisk> rules;  // in the order of Rule
  std::vector<GroundRisk>
      grounds;  // those that the path meets; with a wheel on unknown ground the rover is there
  std::vector<StretchRisk> stretches;  // of equal length, 10 m or more, at most 100
  std::vector<SegmentRisk> segments;   // of RiskOptions::segment_m; empty where that is 0
  OutcomeShares on_known;              // what is left where nothing ever halts a drive on unknown ground
  double unsolved = 0.0;               // share of the draws in which the solver gave up somewhere
  double effective_draws = 0.0;        // (sum of the weights)^2 / sum of their squares
};

// The drive on the mean soils at one end of what is believed of c1 and c2.
struct ClosureEnd {
  double max_slip_ratio = 0.0;
  std::optional<std::size_t> soil;  // the ground of that slip; empty: unknown ground
  double c1 = 0.0, c2 = 0.0;        // there
  bool breaks_a_limit = false;      // that depends on the soil
  std::optional<double> immobilised_at_m;

  bool fails() const { return breaks_a_limit || immobilised_at_m.has_value(); }
};

// Both ends, see closure_reach().
struct ClosureReach {
  ClosureEnd least, greatest;

  // Whether the drive on the mean soils keeps its limits hangs on them.
  bool decides() const { return least.fails() != greatest.fails(); }
};

// A short drive onto the ground that decides, on the way itself, of which the slip would be measured; and
// what that would be worth (see scout_drive()).
struct ScoutDrive {
  std::optional<std::size_t> soil;  // the ground on which most goes wrong; empty: unknown ground
  double from_m = 0.0, to_m = 0.0;  // along the way
  Pose2 from;
  DrawnSpread slip_ratio;         // that it would measure
  double expected_stops = 0.0;    // on the scout drive itself
  double embedding = 0.0;         // the same, share of draws
  double go = 0.0, no_go = 0.0;   // probabilities that the bars are kept, or passed, once it is measured
  double worth_sols = 0.0;        // expected value of the measurement
  std::vector<float> drawn_slip;  // there, by the number of the draw; those beyond the last are not known
  double slip_error = 0.0;        // of the ground, see slip_deviation()
};

// What one draw of the ground makes of the whole drive.
struct DrawFigures {
  double weight = 1.0;  // that of its draw
  // Sums over the stations at which the rover moves. It does not come to the others: to what follows an
  // embedding that the rover cannot spin out of, and to places from which it is taken to go on after a stop.
  double driven_m = 0.0;
  double duration_s = 0.0;
  double energy_j = 0.0;       // of the drive motors
  double slip_length_m = 0.0;  // the slip ratio without sign, summed over the length
  int stops = 0;
  bool embedded = false;
  bool breaks_a_limit = false;  // or is immobilised

  double mean_slip_ratio() const { return driven_m > 0.0 ? slip_length_m / driven_m : 0.0; }
};

// A predicted drive. "Immobilised at 41 m" is an answer, not an error.
struct DrivePrediction {
  std::vector<std::string> wheel_names;  // in the order of every station's wheels
  std::vector<StationPrediction> stations;
  double length_m = 0.0;
  double turned_rad = 0.0;       // sum of the turns in place
  double duration_s = 0.0;       // on the mean soils
  double energy_j = 0.0;         // of the drive motors
  double mean_slip_ratio = 0.0;  // over the length
  Peak max_slip_ratio, max_tilt_rad, max_current_a, max_sinkage_m;
  double unknown_length_m = 0.0;  // length driven with any wheel on unknown ground
  // Length driven with any wheel on ground that is known by a slip curve: energy, current and sinkage, their
  // peaks and limits are of the rest of the way alone.
  double slip_curve_length_m = 0.0;
  bool by_slip_curve = false;                 // any station is on such ground
  std::optional<Immobilisation> immobilised;  // on the mean soils; the stations end there
  // Where the ground is too uneven for the suspension, on whatever soil; the path is driven no further.
  std::optional<Immobilisation> without_stance;
  // Where the solver gave up on the mean soils, which is no statement about the ground: the drive is taken to
  // go on as it came.
  std::optional<Immobilisation> unsolved;
  std::vector<BrokenLimit> broken_limits;  // on the mean soils, with the slip of each station by itself
  // The share of soil draws in which the drive breaks a limit or ends immobilised, with a 90 % Wilson
  // interval.
  int draws = 0;
  double risk = 0.0, risk_low = 0.0, risk_high = 0.0;
  double risk_immobilised = 0.0;
  Peak worst_place;  // the station with the largest risk
  double duration_s_p95 = 0.0, energy_j_p95 = 0.0;
  // Of each draw's slip over the way that it drives (see DrawFigures); of draws that come no way at all there
  // is none. Equal to mean_slip_ratio where no draw has one.
  double mean_slip_ratio_p05 = 0.0, mean_slip_ratio_p50 = 0.0, mean_slip_ratio_p95 = 0.0;
  DriveOutcomes outcomes;
  std::vector<DrawFigures> drawn;        // by the number of the draw: as many as `draws`
  std::optional<ClosureReach> closures;  // nothing without draws, or on slip curves alone
  std::optional<ScoutDrive> scout;       // nothing where nothing goes wrong in any draw, or no ground decides
};

// The bars that decide a drive. An interval below the lower bar keeps it, one above the upper passes it.
struct OutcomeBars {
  // A halt costs the rest of a sol: 116 of Curiosity's 738 drives had one, 16 %. Drives that are more likely
  // to end early than not are planned anew.
  double max_stop = 0.2, no_go_stop = 0.5;
  // The loss of the rover, or of a season: Spirit at Troy, Opportunity at Purgatory. Both bars are one.
  double max_immobilised = 0.01, max_embedding = 0.01;

  bool are_kept(const OutcomeShares& shares) const;
  bool are_passed(const OutcomeShares& shares) const;
  // Of a drive in segments: on each of them, or on any.
  bool are_kept(const DriveOutcomes& outcomes) const;
  bool are_passed(const DriveOutcomes& outcomes) const;
  bool decide(const DriveOutcomes& outcomes) const { return are_kept(outcomes) || are_passed(outcomes); }
};

// Units and patches of a draw of the ground that are another draw.
struct RedrawnCells {
  std::unordered_map<std::uint64_t, std::uint64_t> keys =
      {};  // of each cell's key the key that it has instead
  // Of a renewed draw: all cells without such a key are another draw too, one for each number; 0 of no other.
  std::uint64_t renewal = 0;

  std::uint64_t key_of(std::uint64_t cell) const;
};

// What drives of the past make of one draw of the ground (see condition_draws()).
struct ConditionedDraw {
  std::optional<std::size_t> number = {};  // of the draw; its place in the list where it is empty
  double weight = 1.0;
  RedrawnCells redrawn;
  std::unordered_set<std::uint64_t> met;  // cells on which a drive of the past was
};

// (sum of the weights)^2 / sum of their squares.
double effective_draws(const std::vector<ConditionedDraw>& draws);

// As many draws of equal weight, each copied as often as its weight has it (systematic resampling [Douc,
// Cappe & Moulines 2005]), in a random order. Copies share the ground that past drives were on, and have
// ground of their own everywhere else, so that what is rare there is counted by all of them.
std::vector<ConditionedDraw> renewed(const std::vector<ConditionedDraw>& draws, std::size_t count,
                                     std::uint64_t key);

// Draws of the ground along a drive (see DrawnGround). Draw d's ground depends on (seed, d) and the place
// only, so that routes compared under one seed meet the same ground.
struct RiskOptions {
  int draws = 24;
  // Where this is more than `draws`, these are only the first batch: more are taken until the bars decide, or
  // there are so many.
  int max_draws = 0;
  OutcomeBars bars = {};
  SlipChecks checks = {};
  // Where it is over 0 the drive is decided in segments of this length, of which the last may be half as long
  // again.
  double segment_m = 0.0;
  std::uint64_t seed = 1;
  // What earlier drives make of the draws; those beyond the last have no weight. Where it is empty all weigh
  // the same, as they were drawn.
  std::shared_ptr<const std::vector<ConditionedDraw>> conditioned = {};
  // The relief is drawn with the soil, and the rover set down on each draw of it; empty: the map is the
  // ground.
  std::shared_ptr<const ReliefSpread> relief = {};
};

// Balances the rover on the draws of the ground along the path, without a prediction on the mean soils: how
// each of risk.draws draws goes. Errors as predict_drive().
struct DrawnOutcome : DrawFigures {
  bool immobilised = false;  // somewhere
};
Result<std::vector<DrawnOutcome>> drawn_outcomes(const RoverModel& rover, double gravity_m_s2,
                                                 const Ground& ground, const SoilBeliefs& beliefs,
                                                 std::span<const PathStation> path, const DriveLimits& limits,
                                                 const RiskOptions& risk, std::size_t threads,
                                                 Progress& progress, const DriveConditions& conditions = {});

// How a drive of the past went, for the draws that are conditioned on it.
struct PastDriveReport {
  bool stopped = false;  // by its slip check, its tilt or its current, or it was embedded
  // The share of drives whose outcome the model calls wrongly though its ground is right.
  double model_error = 0.05;
  int tries = 1;  // how many draws of the ground under it are made for each draw
};

// Conditions draws of the ground on a drive along a path: each draw's ground where no earlier drive has been
// is drawn `tries` times, one of these is kept with a probability that goes with how likely it makes the
// report, and the draw's weight is multiplied by their mean likelihood [sequential importance resampling
// within each draw; Doucet & Johansen 2009]. Draws under risk.seed, on the map's relief; risk.conditioned
// and risk.relief are not used. Errors as
// predict_drive().
Result<void> condition_draws(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                             const SoilBeliefs& beliefs, std::span<const PathStation> path,
                             const DriveLimits& limits, const RiskOptions& risk,
                             const PastDriveReport& report, std::size_t threads, Progress& progress,
                             std::vector<ConditionedDraw>& draws, const DriveConditions& conditions = {});

// The maximum spacing of stations at which no obstacle that a wheel would meet is missed.
double max_station_spacing_m(const RoverModel& rover);

// The draws of one drive so far, which are not made again. Filled by predict_drive(); to be given to calls
// that differ in the number of draws and in nothing else. They change no answer: one that needs fewer of them
// is of the first.
struct DrawnDrives;
using DrawsSoFar = std::shared_ptr<DrawnDrives>;

// Balances the rover at every station on the mean soils, then on the draws, on `threads` threads (0 takes all
// that the machine has). Errors: off_map or no_data where a station has no ground under a wheel (the fault
// names the station, "/stations/12"), cancelled. The path must not be empty.
Result<DrivePrediction> predict_drive(const RoverModel& rover, double gravity_m_s2, const Ground& ground,
                                      const SoilBeliefs& beliefs, std::span<const PathStation> path,
                                      const DriveLimits& limits, const RiskOptions& risk, std::size_t threads,
                                      Progress& progress, const DriveConditions& conditions = {},
                                      DrawsSoFar* so_far = nullptr);

}  // namespace slipway::sim
