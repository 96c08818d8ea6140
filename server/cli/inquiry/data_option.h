#pragma once

#include <string>

namespace CLI {
class App;
}

namespace slipway::server {

// --data of a command that reads `what` from the data folder; left empty where it is not given, see
// data_folder.h.
void add_data_option(CLI::App& command, std::string& data, const std::string& what);

}  // namespace slipway::server
