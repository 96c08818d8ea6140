#include "api/files/campaign/import_mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "api/json/faults.h"
#include "api/json/strict_reader.h"
#include "api/json/toml_parse.h"

namespace slipway::api {
namespace {

using json::JsonValue;
using json::kOptional;
using json::kRequired;
using json::ObjectReader;

constexpr std::size_t kMaxMapped = 500, kMaxImported = 10'000;
constexpr double kDegInRad = 180.0 / std::numbers::pi;
constexpr json::NumberRule kFinite{.unit = "", .lowest = -1e12, .highest = 1e12};

// A unit of a quantity, over the campaign's own.
struct Unit {
  std::string_view own, name;  // the suffix of the campaign's column, and the unit as recorded
  double factor;
};
constexpr std::array kUnits{Unit{"_m", "m", 1.0},         Unit{"_m", "mm", 1e-3},
                            Unit{"_m", "cm", 1e-2},       Unit{"_m", "km", 1e3},
                            Unit{"_deg", "deg", 1.0},     Unit{"_deg", "rad", kDegInRad},
                            Unit{"_deg_s", "deg/s", 1.0}, Unit{"_deg_s", "rad/s", kDegInRad},
                            Unit{"_deg_s", "rpm", 6.0},   Unit{"_a", "A", 1.0},
                            Unit{"_a", "mA", 1e-3},       Unit{"_c", "C", 1.0},
                            Unit{"_c", "K", 1.0},  // with an offset of its own
                            Unit{"_v", "V", 1.0},         Unit{"_v", "mV", 1e-3}};
constexpr double kZeroCelsius_k = 273.15;

// The units of a campaign's column, by the longest suffix that it ends with.
std::vector<Unit> units_of(std::string_view column) {
  std::string_view longest;
  for (const Unit& unit : kUnits)
    if (column.ends_with(unit.own) && unit.own.size() > longest.size()) longest = unit.own;
  std::vector<Unit> units;
  for (const Unit& unit : kUnits)
    if (unit.own == longest) units.push_back(unit);
  return units;
}

struct WheelNames {
  std::string own, theirs;
};

std::string with_wheel(std::string name, const std::string& wheel) {
  constexpr std::string_view kMark = "{w}";
  for (std::size_t at = name.find(kMark); at != std::string::npos; at = name.find(kMark, at + wheel.size()))
    name.replace(at, kMark.size(), wheel);
  return name;
}

class MappingReader {
 public:
  MappingReader(const JsonValue& document, std::vector<Fault>& faults)
      : reader_(document, "", faults), faults_(faults) {}

  ImportMapping read() {
    if (!reader_.is_object()) return {};
    std::string format;
    if (reader_.text("format", kRequired, {}, format) && format != "drive-import/1")
      reader_.fault("format", fmt::format("format is {}, must be \"drive-import/1\"", in_quotes(format)));
    reader_.text("name", kRequired, {}, mapping_.name);
    reader_.text("known", kRequired, {.most = 300}, mapping_.known);
    std::string separator;
    if (reader_.text("separator", kOptional, {.most = 3}, separator)) read_separator(separator);
    read_frame();
    read_clock();
    read_wheels();
    read_columns();
    read_drives();
    reader_.refuse_unknown();
    mapping_.separator_at_fault = has_fault_under(faults_, "/separator");
    mapping_.clock_at_fault = has_fault_under(faults_, "/clock");
    return std::move(mapping_);
  }

 private:
  void read_separator(const std::string& separator) {
    if (separator == "tab" || separator == "\t")
      mapping_.separator = '\t';
    else if (separator == "," || separator == ";" || separator == " ")
      mapping_.separator = separator[0];
    else
      reader_.fault("separator", "must be \",\", \";\", \" \" or \"tab\"");
  }

  void read_frame() {
    auto frame = reader_.object("frame", kOptional);
    if (!frame) return;
    std::string axes;
    if (frame->text("axes", kOptional, {}, axes)) {
      if (axes != "enu" && axes != "ned")
        frame->fault("axes", "must be \"enu\" (x east, y north, z up) or \"ned\" (x north, y east, z down)");
      mapping_.axes = axes == "ned" ? ImportAxes::kNed : ImportAxes::kEnu;
    }
    std::vector<double> origin;
    if (frame->numbers("origin_m", kOptional, {3, 3}, {.unit = "m", .lowest = -1e9, .highest = 1e9}, origin))
      std::copy_n(origin.begin(), 3, mapping_.origin_m.begin());
    frame->refuse_unknown();
  }

  void read_clock() {
    auto clock = reader_.object("clock", kRequired);
    if (!clock) return;
    clock->text("from", kRequired, {}, mapping_.clock_column);
    std::string zero;
    if (clock->text("unit", kOptional, {}, mapping_.clock_unit) && mapping_.clock_unit != "s" &&
        mapping_.clock_unit != "ms" && mapping_.clock_unit != "us" && mapping_.clock_unit != "ns")
      clock->fault("unit", "must be \"s\", \"ms\", \"us\" or \"ns\"");
    if (clock->text("zero", kOptional, {}, zero)) {
      if (zero != "first_row" && zero != "recorded")
        clock->fault("zero", "must be \"first_row\" or \"recorded\"");
      mapping_.clock_from_first_row = zero != "recorded";
    }
    clock->refuse_unknown();
  }

  void read_wheels() {
    auto wheels = reader_.object("wheels", kOptional);
    if (!wheels) return;
    const JsonValue& names = *reader_.member("wheels", kOptional);
    for (const std::string& own : names.keys) {
      WheelNames wheel{own, ""};
      if (wheels->text(own, kRequired, {}, wheel.theirs)) wheels_.push_back(std::move(wheel));
    }
    wheels->refuse_unknown();
  }

  void read_columns() {
    auto columns = reader_.object("columns", kRequired);
    if (!columns) return;
    const JsonValue& members = *reader_.member("columns", kRequired);
    for (const std::string& to : members.keys) {
      auto column = columns->object(to, kRequired);
      if (!column) continue;
      const std::size_t before = faults_.size();
      ImportColumn read = read_column(to, *column);
      read.at_fault = faults_.size() > before;
      if (to.find("{w}") == std::string::npos) {
        add_column(std::move(read), *column);
        continue;
      }
      if (wheels_.empty()) column->fault("from", "{w} stands for the wheels, and [wheels] names none");
      for (const WheelNames& wheel : wheels_) {
        ImportColumn of_wheel = read;
        of_wheel.to = with_wheel(to, wheel.own);
        of_wheel.from = with_wheel(read.from, wheel.theirs);
        add_column(std::move(of_wheel), *column);
      }
    }
    columns->refuse_unknown();
    if (mapping_.columns.size() > kMaxMapped)
      reader_.fault("columns",
                    fmt::format("{} columns, must be {} at most", mapping_.columns.size(), kMaxMapped));
  }

  ImportColumn read_column(const std::string& to, ObjectReader& column) {
    ImportColumn read;
    read.key = read.to = to;
    column.text("from", kRequired, {}, read.from);
    column.number("offset", kOptional, kFinite, read.offset);
    column.number("sign", kOptional, kFinite, read.sign);
    if (read.sign != 1.0 && read.sign != -1.0) column.fault("sign", "must be 1 or -1");
    column.number("delay_s", kOptional, {.unit = "s", .lowest = -3600.0, .highest = 3600.0}, read.delay_s);
    const std::vector<Unit> units = units_of(to);
    if (units.empty()) {
      column.fault("from", in_quotes(to) + " is no column of a campaign: it ends with no unit that is known");
    } else {
      read.unit = units.front().name;
      if (column.text("unit", kOptional, {}, read.unit)) choose_unit(units, column, read);
    }
    column.refuse_unknown();
    return read;
  }

  static void choose_unit(const std::vector<Unit>& units, ObjectReader& column, ImportColumn& read) {
    std::vector<std::string> known;
    for (const Unit& unit : units) {
      known.emplace_back(unit.name);
      if (unit.name != read.unit) continue;
      read.factor = unit.factor;
      if (unit.name == "K") read.offset -= kZeroCelsius_k;
      return;
    }
    column.fault("unit", unknown_name("unit", read.unit, known));
  }

  void add_column(ImportColumn column, ObjectReader& reader) {
    if (column.to == "t_s") reader.fault("from", "the time is that of [clock]");
    for (const ImportColumn& other : mapping_.columns)
      if (other.to == column.to) {
        reader.fault("from", in_quotes(column.to) + " is mapped twice");
        column.at_fault = true;
      }
    mapping_.columns.push_back(std::move(column));
  }

  void read_drives() {
    std::set<std::string> ids;
    std::size_t index = 0;
    for (const json::Element& element : reader_.list("drives", kRequired, {1, kMaxImported})) {
      const std::size_t before = faults_.size(), place = index++;
      ObjectReader object(*element.value, element.pointer, faults_);
      if (!object.is_object()) continue;
      ImportDrive& drive = mapping_.drives.emplace_back();
      if (object.text("id", kRequired, {}, drive.id) && !ids.insert(drive.id).second)
        object.fault("id", in_quotes(drive.id) + " is the id of another drive too");
      object.text("file", kRequired, {.most = 300}, drive.file);
      object.text("terrain", kRequired, {}, drive.terrain);
      object.text("repeat_of", kOptional, {}, drive.repeat_of);
      object.boolean("turn_in_place", kOptional, drive.turn_in_place);
      object.number("speed_m_s", drive.turn_in_place ? kOptional : kRequired,
                    {.unit = "m/s", .lowest = -10.0, .highest = 10.0}, drive.speed_m_s);
      object.number("curvature_1_m", kOptional, {.unit = "1/m", .lowest = -10.0, .highest = 10.0},
                    drive.curvature_1_m);
      object.number("turn_rate_deg_s", drive.turn_in_place ? kRequired : kOptional,
                    {.unit = "deg/s", .lowest = -360.0, .highest = 360.0}, drive.turn_rate_deg_s);
      object.number("from_s", kOptional, kFinite, drive.from_s);
      object.number("to_s", kOptional, kFinite, drive.to_s);
      if (drive.from_s && drive.to_s && !(*drive.from_s < *drive.to_s))
        object.fault("to_s", "must be above from_s");
      object.refuse_unknown();
      drive.index = place;
      drive.at_fault = faults_.size() > before;
    }
  }

  ObjectReader reader_;
  std::vector<Fault>& faults_;
  ImportMapping mapping_;
  std::vector<WheelNames> wheels_;
};

}  // namespace

Result<ImportMapping> read_import_mapping(std::string_view bytes, const std::string& file) {
  const auto document = json::parse_toml(bytes, file);
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  ImportMapping mapping = MappingReader(*document, faults).read();
  mapping.file = file;
  mapping.faults = moved_under(file + "#", std::move(faults));
  return mapping;
}

}  // namespace slipway::api
