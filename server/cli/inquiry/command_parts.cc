#include "server/cli/inquiry/command_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

#include "api/files/whole_file.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {
namespace {

namespace fs = std::filesystem;
using api::json::Writer;

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream list(text);
  for (std::string part; std::getline(list, part, separator);) parts.push_back(part);
  return parts;
}

std::optional<double> number_of(const std::string& text) {
  std::istringstream stream(text);
  double number = 0.0;
  if (stream >> number && stream.eof()) return number;
  return std::nullopt;
}

void write_number_or_text(Writer& w, const std::string& value) {
  if (const auto number = number_of(value)) {
    w.exact(*number);
  } else {
    w.text(value);
  }
}

bool is_report_page(const fs::path& path) {
  std::error_code error;
  return path.extension() == ".html" && !fs::is_directory(path, error);
}

tl::unexpected<Error> bad(const std::string& flag, const std::string& message) {
  return fail(ErrorCode::kInvalidRequest, message, {{"/" + flag, message}});
}

}  // namespace

std::string in_one_line(const Error& error) {
  std::string line = error.detail;
  for (const Fault& fault : error.faults) line += fmt::format("; {} {}", fault.pointer, fault.message);
  return line;
}

int refuse(const Error& error) {
  std::cerr << error_text(error);
  // Ground that is not known is the question's fault where it has places.
  const bool of_the_question =
      error.code == ErrorCode::kInvalidRequest || error.code == ErrorCode::kMalformedJson ||
      error.code == ErrorCode::kPayloadTooLarge || error.code == ErrorCode::kOffMap ||
      (error.code == ErrorCode::kNoData && !error.faults.empty());
  return of_the_question ? 2 : 1;
}

int refuse_unreadable(const Error& error) {
  const int status = refuse(error);
  return error.code == ErrorCode::kUnreadableData || error.code == ErrorCode::kUnreadableRaster ? 2 : status;
}

Result<api::Catalogue> open_catalogue(const std::string& data_option) {
  const auto data = data_folder(data_option);
  if (!data) return fail(data.error());
  auto catalogue = api::load_catalogue(*data);
  if (catalogue) std::cerr << left_out_text(*catalogue);
  return catalogue;
}

Result<std::unique_ptr<Inquiry>> inquiry(const AskOptions& options) {
  if (!options.url.empty()) return remote_inquiry(options.url);
  auto data = data_folder(options.data);
  if (!data) return fail(data.error());
  return local_inquiry({.data = std::move(*data), .model = options.model, .ground = options.ground});
}

int save(const OutputFile& file) {
  const auto written = api::write_whole_file(file.path, file.bytes);
  return written ? 0 : refuse(written.error());
}

int deliver(const std::vector<OutputFile>& files, const std::string& text) {
  int status = 0;
  for (const OutputFile& file : files) status = std::max(status, save(file));
  std::cout << text << std::flush;
  return status;
}

Result<void> make_room_for_report(const std::string& path) {
  if (!is_report_page(path)) return api::make_folder(path);
  const fs::path beside = fs::path(path).parent_path();
  return beside.empty() ? Result<void>() : api::make_folder(beside);
}

std::vector<OutputFile> report_output(const std::string& path, const api::ReportPage& report,
                                      const std::vector<api::NamedChart>& charts,
                                      std::string_view document_name, const std::string& document) {
  if (is_report_page(path)) return {{path, report.html()}};
  const fs::path folder(path);
  std::vector<OutputFile> files{{(folder / document_name).string(), document},
                                {(folder / "report.md").string(), report.markdown()},
                                {(folder / "report.html").string(), report.html()}};
  for (const api::NamedChart& chart : charts)
    files.push_back({(folder / (chart.name + ".svg")).string(), chart.svg});
  return files;
}

bool output_has_gone_out() {
  if (std::cout << std::flush) return true;
  std::cerr << error_text({ErrorCode::kUnwritableFile, "standard output can't be written", {}});
  return false;
}

void write_setting(api::json::Writer& w, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::string value = equals == std::string::npos ? "" : setting.substr(equals + 1);
  write_number_or_text(w.key(setting.substr(0, equals)), value);
}

void write_effect(api::json::Writer& w, const std::string& setting) {
  const std::size_t colon = setting.find(':');
  w.begin_object().text("name", setting.substr(0, colon));
  if (colon != std::string::npos && setting.substr(colon + 1) == "off") {
    w.boolean("on", false);
  } else if (colon != std::string::npos) {
    w.key("parameters").begin_object();
    std::istringstream list(setting.substr(colon + 1));
    for (std::string entry; std::getline(list, entry, ',');) write_setting(w, entry);
    w.end_object();
  }
  w.end_object();
}

void write_sweep_axis(Writer& w, const std::string& sweep) {
  const std::size_t equals = sweep.find('=');
  w.begin_object().text("parameter", sweep.substr(0, equals));
  const std::string values = equals == std::string::npos ? "" : sweep.substr(equals + 1);
  const std::vector<std::string> range = parts_of(values, ':');
  if (range.size() == 3) {
    write_number_or_text(w.key("from"), range[0]);
    write_number_or_text(w.key("to"), range[1]);
    write_number_or_text(w.key("step"), range[2]);
  } else {
    w.key("values").begin_array();
    for (const std::string& value : parts_of(values, ',')) write_number_or_text(w, value);
    w.end_array();
  }
  w.end_object();
}

Result<sim::SweepAxis> sweep_axis_of(const std::string& sweep, std::size_t samples, const std::string& flag) {
  const std::size_t equals = sweep.find('=');
  std::string name = sweep.substr(0, equals);
  if (!sim::sweep_field(name) && sim::sweep_field("soil." + name)) name = "soil." + name;
  if (equals == std::string::npos) {
    if (const auto axis = sim::paper_axis(name, samples)) return *axis;
    return bad(flag, fmt::format("{} has no range of its own, must be {}=from:to:step or {}=a,b,c", name,
                                 name, name));
  }
  const std::string values = sweep.substr(equals + 1);
  const bool is_range = values.find(':') != std::string::npos;
  std::vector<double> numbers;
  for (const std::string& part : parts_of(values, is_range ? ':' : ',')) {
    const auto number = number_of(part);
    if (!number) return bad(flag, fmt::format("{} = {} is not a number", name, part));
    numbers.push_back(*number);
  }
  if (!is_range && !numbers.empty()) return sim::SweepAxis{name, numbers};
  if (numbers.size() != 3 || !(numbers[2] > 0.0) || numbers[1] < numbers[0])
    return bad(flag, fmt::format("{} must be from:to:step, rising, or values with commas", sweep));
  return sim::SweepAxis{name, sim::stepped(numbers[0], numbers[1], numbers[2])};
}

Result<sim::EffectSetting> effect_of(const std::string& setting) {
  const std::size_t colon = setting.find(':');
  sim::EffectSetting effect{.name = setting.substr(0, colon), .parameters = {}};
  if (colon == std::string::npos) return effect;
  for (const std::string& entry : parts_of(setting.substr(colon + 1), ',')) {
    const std::size_t equals = entry.find('=');
    const auto number = equals == std::string::npos ? std::nullopt : number_of(entry.substr(equals + 1));
    if (!number) return bad("effect", fmt::format("{} must be NAME:parameter=number,...", setting));
    effect.parameters[entry.substr(0, equals)] = *number;
  }
  return effect;
}

void write_grousers(Writer& w, const std::string& grousers) {
  const std::size_t comma = grousers.find(',');
  w.begin_object();
  write_number_or_text(w.key("height_m"), grousers.substr(0, comma));
  if (comma != std::string::npos) write_number_or_text(w.key("count"), grousers.substr(comma + 1));
  w.end_object();
}

}  // namespace slipway::server
