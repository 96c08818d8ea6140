#include "server/cli/wheel_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace slipway::server {
namespace {

// A number that is stated, and by which flag.
struct Stated {
  std::string parameter, flag;
};

std::string before_equals(const std::string& text) {
  return text.substr(0, text.find('='));
}

void add_conditions(const WheelOptions& options, std::vector<Stated>& stated) {
  const auto add = [&](bool given, const char* parameter, const char* flag) {
    if (given) stated.push_back({parameter, flag});
  };
  add(options.slip.has_value(), "slip", "/slip");
  add(options.slip_angle_deg.has_value(), "slip_angle_deg", "/slip-angle-deg");
  add(options.slope_deg.has_value(), "slope_deg", "/slope");
  add(options.load_n.has_value(), "load_n", "/load");
  add(options.sinkage_m.has_value(), "sinkage_m", "/sinkage-m");
  add(options.speed_m_s.has_value(), "speed_m_s", "/speed-m-s");
  add(options.gravity_m_s2.has_value(), "gravity_m_s2", "/gravity");
  add(options.motor_temp_c.has_value(), "motor_temp_c", "/motor-temp-c");
  add(options.radius_m.has_value(), "wheel.radius_m", "/radius");
  add(options.width_m.has_value(), "wheel.width_m", "/width");
}

// "grousers:height_m=0.01,count=24" states effects.grousers.height_m and effects.grousers.count.
void add_effect(const std::string& text, std::vector<Stated>& stated) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  stated.push_back({"effects." + name, "/effect"});
  if (colon == std::string::npos) return;
  std::string_view rest = std::string_view(text).substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view entry = rest.substr(0, comma);
    if (const std::size_t equals = entry.find('='); equals != std::string_view::npos)
      stated.push_back({fmt::format("effects.{}.{}", name, entry.substr(0, equals)), "/effect"});
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
}

}  // namespace

std::vector<Fault> dropped_flags(const WheelOptions& options, const std::vector<sim::SweepAxis>& rows) {
  std::vector<Stated> stated;
  add_conditions(options, stated);
  for (const std::string& effect : options.effects) add_effect(effect, stated);
  for (const std::string& setting : options.set) {
    const std::string name = before_equals(setting);
    stated.push_back({name, "/set/" + name});
  }
  for (const std::string& sweep : options.sweeps) stated.push_back({before_equals(sweep), "/sweep"});
  for (const sim::SweepAxis& axis : rows) stated.push_back({axis.parameter, "/rows"});
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < stated.size(); ++i)
    for (std::size_t k = i + 1; k < stated.size(); ++k)
      // Two axes of one name are the sweep's own fault.
      if (stated[i].parameter == stated[k].parameter && stated[i].flag != "/sweep" &&
          stated[i].flag != "/rows")
        faults.push_back({stated[i].flag, fmt::format("{} is given by {} too, which would take its place",
                                                      stated[i].parameter, stated[k].flag)});
  const auto find = [&](std::string_view parameter) {
    return std::find_if(stated.begin(), stated.end(),
                        [&](const Stated& s) { return s.parameter == parameter; });
  };
  const auto end = stated.end();
  if (const auto slip = find("slip"); slip != end && find("slope_deg") != end)
    faults.push_back({slip->flag, "slip and slope_deg: on a slope the slip follows from the pull"});
  if (const auto load = find("load_n"); load != end && find("sinkage_m") != end)
    faults.push_back(
        {load->flag, "load_n and sinkage_m: a wheel that is held at a depth carries no given load"});
  if (options.whole_rover && !options.rows.empty() && find("slope_deg") == end)
    faults.push_back({"/whole-rover", "the rows have no slope_deg"});
  return faults;
}

}  // namespace slipway::server
