#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/catalogue.h"
#include "core/result.h"
#include "sim/single_wheel/current_map.h"

namespace slipway::api {

// Options that all maps of the drive current have.
struct CurrentMapOptions {
  std::string rover = "zhurong-class";  // whose first wheel is used
  std::optional<double> load_n;         // an equal share of the rover's weight where it is empty
  double gravity_m_s2 = 9.81;           // the paper's soils were measured, and its rover driven, on Earth
  double slip = 0.1;                    // used where no axis is slip
  sim::CurrentModel model = sim::CurrentModel::kLiteral;
};

// The current over one or two parameters on one soil.
struct CurrentPanel {
  std::string name;   // "a1"
  std::string title;  // "JLU Mars 1 shear parameters, n"
  std::string soil;   // gives the parameters that are not varied
  std::vector<sim::SweepAxis> axes;
  std::vector<sim::CurrentPoint> points;
};

struct CurrentMaps {
  std::string title;
  int figure = 0;             // number of the Zhurong paper's figure, 0 for other maps
  CurrentMapOptions options;  // with the load filled in
  std::vector<CurrentPanel> panels;
};

// "literal", "balanced".
std::string_view describe(sim::CurrentModel model);

// One map. Errors: invalid_request with pointers "/rover", "/soil", "/sweep/0/parameter" (0 is x, 1 is y),
// ...
Result<CurrentMaps> current_map(const Catalogue& catalogue, const CurrentMapOptions& options,
                                const std::string& soil, const std::vector<sim::SweepAxis>& axes);

// All panels of the Zhurong paper's figure 9 (slip, nine simulant states), 10 (k_s, several n and slips) or
// 11 (cohesion, several friction angles and slips). The ranges are those of its Table 3; it does not print
// which values it draws lines for: here n 0.7, 0.9, 1.1, 1.4, friction 16 to 40 deg by 6, slip 0.1 to 0.9 by
// 0.2, and the panels over slip keep the simulant's own n or friction angle. Errors: invalid_request, also
// where the catalogue has not all nine soils.
Result<CurrentMaps> current_figure(const Catalogue& catalogue, const CurrentMapOptions& options, int figure);

}  // namespace slipway::api
