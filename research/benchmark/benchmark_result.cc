#include "research/benchmark/benchmark_result.h"

#include <set>

namespace slipway::gap {

std::vector<std::pair<std::string, std::vector<CaseScore>>> benchmark_groups(const Benchmark& benchmark) {
  std::vector<std::pair<std::string, std::vector<CaseScore>>> groups{{"all", benchmark.cases}};
  for (auto member : {&CaseScore::fidelity, &CaseScore::kind}) {
    std::set<std::string> names;
    for (const CaseScore& c : benchmark.cases)
      if (!(c.*member).empty()) names.insert(c.*member);
    for (const std::string& name : names) {
      groups.emplace_back(name, std::vector<CaseScore>{});
      for (const CaseScore& c : benchmark.cases)
        if (c.*member == name) groups.back().second.push_back(c);
    }
  }
  return groups;
}

}  // namespace slipway::gap
