#pragma once

#include <map>
#include <string>

namespace slipway::sim {

// An effect switched on or off, with the parameters that differ from its row's initial values.
struct EffectSetting {
  std::string name;
  std::map<std::string, double> parameters;
  bool on = true;

  bool operator==(const EffectSetting&) const = default;
};

}  // namespace slipway::sim
