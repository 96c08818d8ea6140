#include "server/cli/inquiry/data_option.h"

#include <CLI/CLI.hpp>

namespace slipway::server {

void add_data_option(CLI::App& command, std::string& data, const std::string& what) {
  command.add_option(
      "--data", data,
      "folder with " + what +
          "; else the folder of SLIPWAY_DATA, data beside the executable, or share/slipway/data of "
          "the install prefix");
}

}  // namespace slipway::server
