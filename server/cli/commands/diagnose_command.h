#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace CLI {
class App;
}

namespace slipway::server {

// What is asked of recorded drives, whether they are diagnosed or watched.
struct DriveQuestion {
  std::string data;
  std::string campaign;              // folder of a "drive-campaign/1", or the name of a shipped one
  std::string reference;             // another one, of the same rover, taken as healthy; empty: none
  std::vector<std::string> without;  // effects that are not looked for
  std::uint64_t seed = 1;
  int threads = 0;     // 0: as many as the machine has
  std::string report;  // folder, or an HTML file; empty: none
  bool json = false;

  gap::DiagnosisOptions search() const;
};

struct AskedDrives {
  gap::DriveCampaign campaign;
  std::optional<gap::DriveCampaign> reference;
};
// Errors: unreadable_data.
Result<AskedDrives> load_drives(const DriveQuestion& question);

struct DiagnoseCommand : DriveQuestion {
  std::string model;  // folder for the corrected one; empty: none
};

// The exit status: 0 a diagnosis, whatever its verdict, 1 none, 2 input that can't be read.
int diagnose(const DiagnoseCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_diagnose_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
