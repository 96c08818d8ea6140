#include "research/validation/comparison_catalogue.h"

#include <array>

#include "research/validation/cuadriga/comparisons.h"
#include "research/validation/laboratory/comparisons.h"
#include "research/validation/mars/comparisons.h"
#include "research/validation/simulators/comparisons.h"
#include "research/validation/worlds/comparisons.h"

namespace slipway::validation {

std::span<const Comparison> comparison_catalogue() {
  static constexpr std::array kComparisons{
      Comparison{"kernel_cross_check", "the wheel against another implementation of the same equations",
                 "RoverDevKit", &kernel_cross_check},
      Comparison{"ding_2011", "the wheel against single-wheel tests, nothing fitted", "Ding et al. 2011",
                 &ding_2011},
      Comparison{"ding_2011_fitted",
                 "the same with slip sinkage, grousers, a smooth rim; one sand for both wheels",
                 "Ding et al. 2011", &ding_2011_fitted},
      Comparison{"ding_2011_closures",
                 "the same with a hyperbola of shear, digging and the cleats' shearing radius",
                 "Ding et al. 2011", &ding_2011_closures},
      Comparison{"zhurong_states", "Zhurong's current model at zero slip, literal and balanced",
                 "Shen et al. 2024", &zhurong_states},
      Comparison{"zhurong_wheels", "the currents of its six wheels, each by its own load", "Shen et al. 2024",
                 &zhurong_wheels},
      Comparison{"zhurong_pull", "its drawbar pull over slip", "Shen et al. 2024", &zhurong_pull},
      Comparison{"virtual_bevameter", "moduli and strength fitted to plate and annulus tests",
                 "Chrono CRM to SCM calibration study 2022", &virtual_bevameter},
      Comparison{"plate_tests", "how well a power law holds for nine real plate tests",
                 "Pavlov and Johnson 2022", &plate_tests},
      Comparison{"pavlov_tests", "189 real single-wheel tests over slip and slip angle, and their scatter",
                 "Pavlov and Johnson 2022", &pavlov_tests},
      Comparison{"pavlov_wheel",
                 "the same tests predicted, side force and skid included; fitted on half of them",
                 "Pavlov and Johnson 2022", &pavlov_wheel},
      Comparison{"grousered_wheel",
                 "a smooth and a grousered wheel on one sand, skid, slip and sideways; cross-validated",
                 "Pavlov and Johnson 2022", &grousered_wheel},
      Comparison{"cuadriga_data", "a real rover's slip and charge per metre by slope, and their scatter",
                 "University of Malaga", &cuadriga_data},
      Comparison{"cuadriga_drives", "that rover's slip and charge per metre predicted on logs not fitted",
                 "University of Malaga", &cuadriga_drives},
      Comparison{"cuadriga_campaign", "that rover's logs predicted by a model re-tuned on the others",
                 "University of Malaga", &cuadriga_campaign},
      Comparison{"cuadriga_days",
                 "that rover's days in their order, each told by the days before, and watched",
                 "University of Malaga", &cuadriga_days},
      Comparison{"cuadriga_intervals",
                 "whether 90 % intervals of its slip and charge hold on days not fitted, and when corrected",
                 "University of Malaga", &cuadriga_intervals},
      Comparison{"independent_simulator", "the quasi-static rover against another rover simulator",
                 "practice campaign p01", &independent_simulator},
      Comparison{"curiosity_attitude", "a rover set down on the map against Curiosity's measured attitude",
                 "NASA/JPL", &curiosity_attitude},
      Comparison{"curiosity_steps", "slip of single metres of Curiosity and Perseverance, forecast",
                 "NASA/JPL, SPICE kernels and PLACES", &curiosity_steps},
      Comparison{"curiosity_outcomes",
                 "which of Curiosity's drives were stopped by slip, and how probable that was",
                 "published mission updates", &curiosity_outcomes},
      Comparison{"curiosity_hops", "whether Curiosity is embedded between its 32 stops, where it never was",
                 "NASA/JPL", &curiosity_hops},
      Comparison{"fido_table_1", "slip of FIDO's 2 m drives on four tilts; one soil calibrated on them",
                 "ROAMS paper", &fido_table_1},
      Comparison{"roams_table_1", "where ROAMS and FIDO part, and which effects have that signature",
                 "ROAMS paper", &roams_table_1},
      Comparison{"sealed_campaigns", "how often the diagnosis of the gap is right, by fidelity and method",
                 "two other simulators", &sealed_campaigns},
      Comparison{"sealed_levels", "partial answers, wrong names and causes from outside, by fidelity",
                 "two other simulators", &sealed_levels},
      Comparison{"sealed_marginals", "whether an effect of so much probability is hidden so often",
                 "two other simulators", &sealed_marginals},
      Comparison{"sealed_detectability", "how much the best diagnosis could see of a hidden cause",
                 "two other simulators", &sealed_detectability},
      Comparison{"worlds", "planners in worlds whose truth is known: embeddings, stops, length",
                 "this project's seeded worlds", &worlds},
      Comparison{"worlds_slip", "whether the 90 % interval of a route's mean slip holds it there",
                 "this project's seeded worlds", &worlds_slip},
      Comparison{"worlds_reliability", "predicted and executed shares of stops and embeddings there",
                 "this project's seeded worlds", &worlds_reliability},
      Comparison{"artemis_cases", "Opportunity across a ripple, Spirit with a dead wheel, in motion",
                 "ARTEMIS paper", &artemis_cases},
      Comparison{"rungs", "the table level against the quasi-static level", "this project", &table_level},
      Comparison{"dynamic_rung", "the dynamic level against the quasi-static one on ten drives",
                 "this project", &dynamic_level},
  };
  return kComparisons;
}

const Comparison* find_comparison(std::string_view name) {
  for (const Comparison& comparison : comparison_catalogue())
    if (comparison.name == name) return &comparison;
  return nullptr;
}

}  // namespace slipway::validation
