#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/chart/chart.h"
#include "api/chart/report_page.h"
#include "api/files/catalogue.h"
#include "api/json/writer.h"
#include "core/progress.h"
#include "core/result.h"
#include "server/cli/inquiry/ask_options.h"
#include "server/cli/inquiry/inquiry.h"
#include "server/cli/terminal/interruption.h"
#include "sim/single_wheel/current_map.h"

// What several commands do alike.
namespace slipway::server {

// Says nothing, but hears an interruption.
class Interruptible final : public Progress {
 public:
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return given_up(); }
};

// The error with its faults, for a log.
std::string in_one_line(const Error& error);
// Prints the error with its faults; the exit status that goes with it.
int refuse(const Error& error);
// The same where drives are read: what can't be read is the question's fault, 2.
int refuse_unreadable(const Error& error);
// The rovers and soils of the data folder that --data names, or that is found where it is not given.
Result<api::Catalogue> open_catalogue(const std::string& data_option);
// The service in this process, or the one at the options' address.
Result<std::unique_ptr<Inquiry>> inquiry(const AskOptions& options);
// A file that a command was asked to write.
struct OutputFile {
  std::string path;
  std::string bytes;
};
// Writes the file, which has its old content until the new one is whole. The exit status: 0, or 1 with its
// reason on standard error.
int save(const OutputFile& file);
// Writes the files, then prints the text: who closes the pipe or fills the disk loses no file. The exit
// status.
int deliver(const std::vector<OutputFile>& files, const std::string& text);
// Makes the folder that --report names, or that in which its page is to lie: it names one HTML page where it
// ends in ".html" and is no folder. Errors: unwritable_file.
Result<void> make_room_for_report(const std::string& path);
// What --report asks for: the page alone, or report.html, report.md, every picture and the document under its
// name in the folder.
std::vector<OutputFile> report_output(const std::string& path, const api::ReportPage& report,
                                      const std::vector<api::NamedChart>& charts,
                                      std::string_view document_name, const std::string& document);
// Whether all that was printed has gone out. Otherwise says so on standard error.
bool output_has_gone_out();

// "name=number" as a member of the object that is being written; what is not a number is left to the reader.
void write_setting(api::json::Writer& w, const std::string& setting);

// "name" or "name:key=value,key=value"; what is not a number is left to the request's reader to refuse.
void write_effect(api::json::Writer& w, const std::string& setting);
// "slip=0:0.9:0.1" (from, to, step) or "load_n=20,50,80", for a wheel sweep's request; as above.
void write_sweep_axis(api::json::Writer& w, const std::string& sweep);
// The same sweep as an axis. A name without values takes the Zhurong paper's range with `samples` values, and
// "k_s" is "soil.k_s". Errors: invalid_request at /`flag`.
Result<sim::SweepAxis> sweep_axis_of(const std::string& sweep, std::size_t samples, const std::string& flag);
// The setting of write_effect as a value. Errors: invalid_request at /effect.
Result<sim::EffectSetting> effect_of(const std::string& setting);
// "0.01,24": height in metres and count; as above, and what stands behind the count is left to it too.
void write_grousers(api::json::Writer& w, const std::string& grousers);

}  // namespace slipway::server
