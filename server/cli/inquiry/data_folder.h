#pragma once

#include <filesystem>
#include <string>

#include "api/files/catalogue.h"
#include "core/result.h"

// The folder of rovers, soils, terrains and campaigns that the command line works with.
namespace slipway::server {

// Where such a folder may be named or lie.
struct DataPlaces {
  std::string option;                // of --data; empty: not given
  std::string variable;              // of SLIPWAY_DATA; empty: not set
  std::filesystem::path executable;  // the running program's file; empty: not known
};

struct DataFolder {
  std::string path;
  std::string found_by;  // "--data", "SLIPWAY_DATA" or "looking beside the executable"
};

// The first that there is of: the option's folder, the variable's, `data` in the executable's folder, and
// share/slipway/data under the prefix whose bin holds the executable. A build folder has a link to the source
// tree's data beside its executable. What an option or a variable names is used or refused, never passed
// over. Errors: unreadable_data with every place that was looked at.
Result<DataFolder> find_data_folder(const DataPlaces& places);

// The places of this process.
DataPlaces data_places(const std::string& option);

// The folder to work with, `option` being what --data gave. Errors as above.
Result<std::string> data_folder(const std::string& option);

// The folder of a drive campaign that a command names: as it is typed or, where there is no such folder, the
// shipped campaign of this name (`p05`), as requests name it. What is neither stays as it was typed.
std::filesystem::path campaign_folder(const std::string& given, const std::string& data_option);

// In a line, for standard error: the one file of the folder that is left out with its first fault, or how
// many there are.
std::string left_out_text(const api::Catalogue& catalogue);

// What --version prints: the program's version, then the data folder and how it was found, or where it was
// looked for.
std::string version_text();

}  // namespace slipway::server
