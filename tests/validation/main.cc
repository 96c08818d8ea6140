// Runs every comparison with the world outside this project and prints it as docs/validation.md holds it.
//   validation SOURCE_DIR                 prints
//   validation SOURCE_DIR --check         also compares with the part of docs/validation.md between the
//   markers validation SOURCE_DIR --write         puts it there
#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "tests/validation/report.h"

namespace {

constexpr std::string_view kBegin = "<!-- begin: printed by tests/validation -->\n";
constexpr std::string_view kEnd = "<!-- end: printed by tests/validation -->\n";

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: validation SOURCE_DIR [--check | --write]\n";
    return 2;
  }
  using namespace slipway::validation;
  const std::string root = argv[1], mode = argc > 2 ? argv[2] : "";
  const std::vector<Report> reports{kernel_cross_check(),
                                    ding_2011(),
                                    zhurong_states(),
                                    independent_simulator(root + "/tests/validation/practice_p01_drives.csv"),
                                    curiosity_attitude(root + "/data"),
                                    rungs()};
  std::string printed;
  bool holds = true;
  for (const Report& report : reports) {
    printed += report.markdown();
    if (!report.holds) std::cerr << "a stated band does not hold: " << report.title << "\n";
    holds = holds && report.holds;
  }
  std::cout << printed;
  if (mode.empty()) return holds ? 0 : 1;

  const std::string path = root + "/docs/validation.md";
  std::stringstream document;
  document << std::ifstream(path).rdbuf();
  const std::string text = document.str();
  const auto begin = text.find(kBegin), end = text.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos) {
    std::cerr << path << " lacks its markers\n";
    return 1;
  }
  const std::string held = text.substr(begin + kBegin.size(), end - begin - kBegin.size());
  if (mode == "--write") {
    std::ofstream(path) << text.substr(0, begin + kBegin.size()) << printed << text.substr(end);
  } else if (held != printed) {
    std::cerr << path << " does not hold what was just measured; run: validation " << root << " --write\n";
    return 1;
  }
  return holds ? 0 : 1;
}
