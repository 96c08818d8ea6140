#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace slipway::gap {

// What a search found, as far as a decision needs it: evidence, priors, what each cause closes of the gap,
// and how far what was believed had to bend. Nothing of it depends on what is then named, so that decisions
// can be judged again without a diagnosis.
struct SearchRecord {
  // A set of causes that was compared, the most probable first.
  struct Explanation {
    std::vector<std::string> effects;  // of the library
    std::vector<std::string> outside;  // causes from outside, of a known form
    bool with_unknown = false;         // something of no known form besides
    std::size_t fit = 0;               // of `fits`
    double log_evidence = 0.0;         // over that of nothing missing, whole
    double log_prior = 0.0;
    // Of each cause: logarithms of the evidence that its other variants have over the fitted one's.
    std::vector<std::vector<double>> other_variants;
    double probability = 0.0;  // see posterior.h

    bool unknown() const { return with_unknown || !outside.empty(); }
  };
  // How far a re-tuned parameter had to go from what was believed of it, in usual deviations.
  struct Shift {
    std::string parameter;
    double deviations = 0.0;
    bool has_far_ends = true;  // false: an end is so near that the parameter may lie there
  };
  struct Fit {
    double held_out_rms = 0.0;  // of drives held out of it, in deviations of the noise, by derivatives
    std::vector<Shift> shifts;
  };
  struct Cause {
    std::string name;
    double share = 0.0;  // of the held-out gap that it closes: ClosedShares::of
  };

  bool with_reference = false;
  std::size_t drives = 0, windows = 0;
  std::vector<Explanation> explanations;
  std::vector<Fit> fits;      // [0]: re-tuned parameters alone
  std::vector<Cause> causes;  // every effect of the library, then every cause from outside that was compared
  std::vector<double> scatter_deviations;  // of each scale's logarithm, above what was believed of it
  double parameters_gain = 0.0;            // log evidence of free soils and motors over nominal ones
  double hidden_share = 1.0;    // of the variants, those that these drives would not surely have shown
  bool drives_changed = false;  // that they, one after the other, say so: see followed_drives.h

  double share_of(const std::string& cause) const;  // 0 of one that is not among them
};

}  // namespace slipway::gap
