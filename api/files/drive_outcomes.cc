#include "api/files/drive_outcomes.h"

#include <algorithm>

#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"

namespace slipway::api {
namespace {

using json::Element;
using json::kOptional;
using json::kRequired;
using json::ObjectReader;

constexpr std::size_t kMaxDrives = 10'000;
constexpr std::size_t kMaxCorners = 2000;

void read_path(ObjectReader& row, PastDrive& drive) {
  for (const Element& element : row.list("path", kRequired, {2, kMaxCorners})) {
    const auto& corner = element.value->elements;
    if (element.value->is(json::JsonValue::Kind::kArray) && corner.size() == 2 &&
        corner[0].is(json::JsonValue::Kind::kNumber) && corner[1].is(json::JsonValue::Kind::kNumber)) {
      drive.path.push_back({corner[0].number, corner[1].number, {}});
    } else {
      row.faults().push_back({element.pointer, "a corner is a pair [x_m, y_m]"});
    }
  }
}

void read_drive(const Element& element, DriveOutcomeTable& table, std::vector<Fault>& faults) {
  ObjectReader row(*element.value, element.pointer, faults);
  PastDrive& drive = table.drives.emplace_back();
  row.whole("sol", kRequired, 0, 1'000'000, drive.sol);
  std::size_t outcome = 0;
  if (row.choice("outcome", kRequired, {"completed", "slip_stop", "stopped_other", "no_report"}, outcome))
    drive.outcome = static_cast<PastOutcome>(outcome);
  read_path(row, drive);
  std::string words;
  std::size_t confidence = 0;
  row.choice("confidence", kOptional, {"confirmed", "inferred", "none"}, confidence);
  for (const std::string_view key : {"note", "source", "fault"})
    row.text(key, kOptional, {.most = 1000, .may_be_empty = true}, words);
  row.number("planned_m", kOptional, {"m", 0.0, 1e5}, drive.planned_m);
  row.refuse_unknown();
}

}  // namespace

Result<DriveOutcomeTable> read_drive_outcomes(std::string_view bytes) {
  const auto document = json::parse(bytes);
  if (!document) return fail(document.error());
  DriveOutcomeTable table;
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"drive-outcomes/1"}, format);
  reader.text("rover", kRequired, {.most = 64, .is_name = true}, table.rover);
  for (const Element& element : reader.list("drives", kRequired, {0, kMaxDrives}))
    read_drive(element, table, faults);
  reader.refuse_unknown();
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  std::stable_sort(table.drives.begin(), table.drives.end(),
                   [](const PastDrive& a, const PastDrive& b) { return a.sol < b.sol; });
  return table;
}

}  // namespace slipway::api
