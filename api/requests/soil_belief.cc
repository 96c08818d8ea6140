#include "api/requests/soil_belief.h"

#include <fmt/format.h>

#include "api/json/faults.h"
#include "api/requests/soil_test_rigs.h"

namespace slipway::api {

Result<gap::SoilBelief> believe_soils(const Catalogue& catalogue, const SoilBeliefRequest& request,
                                      Progress& progress) {
  std::vector<Fault> faults;
  std::vector<gap::TestedSoilData> soils;
  for (std::size_t k = 0; k < request.soils.size(); ++k) {
    const BeliefSoil& soil = request.soils[k];
    const std::string place = fmt::format("/soils/{}", k);
    std::vector<Fault> of_soil = faults_of(catalogue, soil.estimate);
    const bool good = of_soil.empty();
    for (Fault& fault : of_soil) faults.push_back({place + fault.pointer, std::move(fault.message)});
    if (!good) continue;
    SoilTestRigs rigs = soil_test_rigs(catalogue, soil.estimate, of_soil);
    if (rigs.nominals.size() != 1) {
      faults.push_back({place, "the tests are of several soils: each stands on its own in a belief"});
      continue;
    }
    soils.push_back(
        {soil.name, std::move(rigs.nominals.front()), std::move(rigs.data), soil.estimate.options});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return gap::believe_soils(soils, request.options, progress);
}

}  // namespace slipway::api
