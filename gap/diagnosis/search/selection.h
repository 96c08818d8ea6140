#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/search/explanation_search.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {

// Which of the candidates, most probable first, the answer is: the most probable one with something unknown,
// of whatever form, where these have the majority; else the most probable one, or, where none is certain, one
// with fewer effects of the same that is not much less probable. What adds little is not worth a name; nor
// has an effect one where explanations without any effect of the library are more probable together than
// those with it: then the most probable of them is the answer.
std::size_t chosen_among(std::span<const Candidate> candidates, const SelectionOptions& options = {});

// Of explanations with a cause from outside and the same effects that have `alike_share` of the chosen one's
// probability at least, the one whose fit alone has the most evidence; the others lean on what any simulator
// may be off by. What has no known form is returned as it was chosen.
std::size_t best_form(const ExplanationSearch& search, std::size_t chosen, double alike_share);

// The evidence of a linearised explanation, made of its parts by groups of drives: whitened residuals and
// columns of prior deviation 1.
class GroupedEvidence {
 public:
  GroupedEvidence(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns,
                  std::span<const std::size_t> group_of_row, std::size_t group_count);
  // log_marginal of the drives with each group counted so many times.
  double counted(std::span<const int> times) const;

 private:
  std::vector<double> square_;
  std::vector<Eigen::VectorXd> gradient_;
  std::vector<Eigen::MatrixXd> hessian_;
};

// The candidate that is chosen of some whose evidence changed; their order need not be that of probability.
std::size_t chosen_of_resample(std::vector<Candidate> candidates, const EvidenceOptions& evidence,
                               const SelectionOptions& selection);

// Which candidate would have been chosen had other drives of the same kinds been made: drives, with their
// repeats, drawn with replacement. Fits are not repeated: a drive that counts twice does so in the linearised
// evidence of each explanation. Candidates below SelectionOptions::min_running have no part.
struct SelectionBootstrap {
  std::vector<std::size_t> chosen;  // of each resample
  std::vector<double> share;        // of each candidate: of the resamples that chose it
};
SelectionBootstrap resample_selection(const ExplanationSearch& search, const PreparedCampaign& prepared,
                                      const DriveCampaign& campaign, const DiagnosisOptions& options,
                                      const DriveResampling& drives);

}  // namespace slipway::gap
