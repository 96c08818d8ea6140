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

constexpr double kZeroCelsius_k = 273.15, kZeroCelsius_f = 32.0;
constexpr std::array kUnits{RecordedUnit{"_m", "m", 1.0},
                            RecordedUnit{"_m", "mm", 1e-3},
                            RecordedUnit{"_m", "cm", 1e-2},
                            RecordedUnit{"_m", "km", 1e3},
                            RecordedUnit{"_deg", "deg", 1.0},
                            RecordedUnit{"_deg", "rad", kDegInRad},
                            RecordedUnit{"_deg_s", "deg/s", 1.0},
                            RecordedUnit{"_deg_s", "rad/s", kDegInRad},
                            RecordedUnit{"_deg_s", "rpm", 6.0},
                            RecordedUnit{"_a", "A", 1.0},
                            RecordedUnit{"_a", "mA", 1e-3},
                            RecordedUnit{"_c", "C", 1.0},
                            RecordedUnit{"_c", "K", 1.0, -kZeroCelsius_k},
                            RecordedUnit{"_c", "F", 5.0 / 9.0, -kZeroCelsius_f},
                            RecordedUnit{"_v", "V", 1.0},
                            RecordedUnit{"_v", "mV", 1e-3}};
struct ClockUnit {
  std::string_view name;
  double seconds;
};
constexpr std::array kClockUnits{ClockUnit{"s", 1.0},     ClockUnit{"ms", 1e-3},  ClockUnit{"us", 1e-6},
                                 ClockUnit{"ns", 1e-9},   ClockUnit{"min", 60.0}, ClockUnit{"h", 3600.0},
                                 ClockUnit{"d", 86'400.0}};
constexpr json::NumberRule kDelay{.unit = "s", .lowest = -3600.0, .highest = 3600.0};

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
    read_attitude();
    reader_.refuse_unknown();
    mapping_.separator_at_fault = has_fault_under(faults_, "/separator");
    mapping_.clock.at_fault = has_fault_under(faults_, "/clock");
    return std::move(mapping_);
  }

 private:
  void read_separator(const std::string& separator) {
    if (separator == "tab" || separator == "\t")
      mapping_.separator = '\t';
    else if (separator == "," || separator == ";" || separator == "|" || separator == " ")
      mapping_.separator = separator[0];
    else
      reader_.fault(
          "separator",
          "must be \",\", \";\", \"|\", \" \" or \"tab\"; without the key it is found in each file");
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
    clock->text("from", kRequired, {}, mapping_.clock.column);
    read_clock_unit(*clock, mapping_.clock.unit);
    std::string zero;
    if (clock->text("zero", kOptional, {}, zero)) {
      if (zero != "first_row" && zero != "recorded")
        clock->fault("zero", "must be \"first_row\" or \"recorded\"");
      mapping_.clock.from_first_row = zero != "recorded";
    }
    if (auto plus = clock->object("plus", kOptional)) {
      plus->text("from", kRequired, {}, mapping_.clock.plus_column);
      read_clock_unit(*plus, mapping_.clock.plus_unit);
      plus->refuse_unknown();
    }
    clock->number("ticks_per_s", kOptional, {.unit = "1/s", .lowest = 1.0, .highest = 1e12},
                  mapping_.clock.ticks_per_s);
    clock->number("day_s", kOptional, {.unit = "s", .lowest = 1.0, .highest = 1e8}, mapping_.clock.day_s);
    clock->refuse_unknown();
  }

  static void read_clock_unit(ObjectReader& clock, std::string& unit) {
    if (clock.text("unit", kOptional, {}, unit) && clock_unit_s(unit) == 0.0)
      clock.fault("unit",
                  "must be \"s\", \"ms\", \"us\", \"ns\", \"min\", \"h\" or \"d\"; dates and times as text "
                  "need no unit");
  }

  void read_wheels() {
    auto wheels = reader_.object("wheels", kOptional);
    if (!wheels) return;
    const JsonValue& names = *reader_.member("wheels", kOptional);
    for (const std::string& own : names.keys) {
      WheelNames wheel{own, ""};
      if (wheels->text(own, kRequired, {}, wheel.theirs)) mapping_.wheels.push_back(std::move(wheel));
    }
    wheels->refuse_unknown();
  }

  // Its columns become x, y, z, w, in whichever order the mapping has them.
  void read_attitude() {
    auto attitude = reader_.object("attitude", kOptional);
    if (!attitude) return;
    const std::size_t before = faults_.size();
    ImportAttitude& read = mapping_.attitude.emplace();
    std::vector<std::string> from;
    std::size_t order = 0;
    const bool named = attitude->texts("from", kRequired, {4, 4}, {}, from);
    const bool ordered = attitude->choice("order", kRequired, {"xyzw", "wxyz"}, order);
    if (named && ordered && order == 1) std::rotate(from.begin(), from.begin() + 1, from.end());
    if (named) std::move(from.begin(), from.end(), read.from.begin());
    attitude->number("delay_s", kOptional, kDelay, read.delay_s);
    attitude->boolean("inverse", kOptional, read.inverse);
    attitude->refuse_unknown();
    for (const ImportColumn& column : mapping_.columns)
      if (column.to == "roll_deg" || column.to == "pitch_deg" || column.to == "yaw_deg")
        attitude->fault("from", fmt::format("{} is mapped twice: the quaternion says it, so take it out of "
                                            "[columns]",
                                            column.to));
    read.at_fault = faults_.size() > before;
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
      if (mapping_.wheels.empty())
        column->fault("from", "{w} stands for the wheels, and [wheels] names none");
      for (const WheelNames& wheel : mapping_.wheels) {
        ImportColumn of_wheel = read;
        of_wheel.to = with_wheel(to, wheel.own);
        of_wheel.from = with_wheel(read.from, wheel.theirs);
        of_wheel.turned = std::find(turned_.begin(), turned_.end(), wheel.own) != turned_.end();
        if (of_wheel.turned) of_wheel.sign = -of_wheel.sign;
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
    column.number("delay_s", kOptional, kDelay, read.delay_s);
    read_turned(to, column);
    std::string signed_by;
    if (column.text("signed_by", kOptional, {}, signed_by)) {
      read.by_rate = signed_by == "rate";
      if (!read.by_rate || !to.ends_with("_current_a"))
        column.fault("signed_by", "must be \"rate\", and is of currents only");
    }
    const std::vector<RecordedUnit> units = units_of(to);
    if (units.empty()) {
      column.fault("from", in_quotes(to) + " is no column of a campaign: it ends with no unit that is known");
    } else {
      read.unit = units.front().name;
      if (column.text("unit", kOptional, {}, read.unit)) choose_unit(units, column, read);
    }
    column.refuse_unknown();
    return read;
  }

  // The wheels whose values were recorded in the other sense than those of the others.
  void read_turned(const std::string& to, ObjectReader& column) {
    turned_.clear();
    if (!column.texts("turned", kOptional, {0, kMaxMapped}, {}, turned_)) return;
    if (to.find("{w}") == std::string::npos)
      column.fault("turned", "names wheels of a column for every wheel ({w}); use sign = -1 for this one");
    std::vector<std::string> known;
    for (const WheelNames& wheel : mapping_.wheels) known.push_back(wheel.own);
    for (const std::string& wheel : turned_)
      if (std::find(known.begin(), known.end(), wheel) == known.end())
        column.fault("turned", unknown_name("wheel", wheel, known));
  }

  static void choose_unit(const std::vector<RecordedUnit>& units, ObjectReader& column, ImportColumn& read) {
    std::vector<std::string> known;
    for (const RecordedUnit& unit : units) {
      known.emplace_back(unit.name);
      if (unit.name != read.unit) continue;
      read.factor = unit.factor;
      read.offset += unit.factor * unit.zero;
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
  std::vector<std::string> turned_;  // of the column that is read
};

}  // namespace

std::vector<RecordedUnit> units_of(std::string_view column) {
  std::string_view longest;
  for (const RecordedUnit& unit : kUnits)
    if (column.ends_with(unit.own) && unit.own.size() > longest.size()) longest = unit.own;
  std::vector<RecordedUnit> units;
  for (const RecordedUnit& unit : kUnits)
    if (unit.own == longest) units.push_back(unit);
  return units;
}

double clock_unit_s(std::string_view unit) {
  for (const ClockUnit& known : kClockUnits)
    if (known.name == unit) return known.seconds;
  return 0.0;
}

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
