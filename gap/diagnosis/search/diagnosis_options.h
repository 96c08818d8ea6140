#pragma once

#include <cstdint>

#include "gap/diagnosis/model/drive_window.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

struct DiagnosisOptions {
  SearchOptions search;
  WindowOptions windows;
  std::uint64_t seed = 1;
  // An oracle's: what is not withheld is at work, all of it (see fit_given_explanation).
  bool given = false;
  int folds = 5;
  int resamples = 400;  // of bootstraps and permutations
};

}  // namespace slipway::gap
