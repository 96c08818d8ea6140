#pragma once

#include <string>

namespace slipway::api {

// Styles for QGIS (QML) of the layers of an answer: routes by verdict, stations by slip, rules by how often
// they trip.
std::string route_style();
std::string station_style();
std::string rule_style();

}  // namespace slipway::api
