#include "api/uploads/uploaded_campaigns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/terrain_site.h"
#include "api/files/whole_file.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "api/uploads/unpack.h"
#include "core/confined_child.h"
#include "core/sha256.h"
#include "core/utc.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "dc-";
constexpr std::size_t kNameDigits = 32;
constexpr std::string_view kDocument = "campaign.json";
constexpr std::string_view kFiles = "campaign";  // the folder of the campaign's own files
constexpr std::size_t kMaxAppended = 2000;
constexpr std::size_t kMaxCsvBytes = std::size_t{4} << 20U;
constexpr std::size_t kMaxDocumentBytes = std::size_t{16} << 20U;
constexpr ChildLimits kLimits{.max_memory_bytes = 3LL << 30U, .max_time_s = 600.0};

bool is_campaign_name(std::string_view name) {
  return name.starts_with(kPrefix) && name.size() == kPrefix.size() + kNameDigits &&
         name.find_first_not_of("0123456789abcdef", kPrefix.size()) == std::string_view::npos;
}

// Of the files' paths and bytes. Errors: unreadable_data.
Result<std::string> name_of(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(fs::relative(entry.path(), folder).string());
  std::sort(files.begin(), files.end());
  Sha256 hash;
  for (const std::string& file : files) {
    const auto digest = sha256_of_file(folder / file);
    if (!digest) return fail(digest.error());
    hash.add(fmt::format("{} {}\n", *digest, file));
  }
  return std::string(kPrefix) + hash.digest().substr(0, kNameDigits);
}

// Where campaign.json is: at the top, or in the only folder that is there.
std::optional<fs::path> top_of(const fs::path& folder) {
  std::error_code error;
  if (fs::is_regular_file(folder / kDocument, error)) return folder;
  std::vector<fs::path> inside;
  for (const auto& entry : fs::directory_iterator(folder, error)) inside.push_back(entry.path());
  if (inside.size() == 1 && fs::is_regular_file(inside.front() / kDocument, error)) return inside.front();
  return std::nullopt;
}

// Unpacks into `working` so that the campaign's files lie in `working`/campaign.
Result<void> unpack_campaign(const fs::path& archive, const fs::path& working, std::int64_t room,
                             Progress& progress) {
  const fs::path unpacked = working / "unpacked";
  if (const auto made = make_folder(unpacked); !made) return made;
  UnpackLimits limits;
  limits.max_bytes = std::min(limits.max_bytes, room);
  if (const auto done = unpack(archive, unpacked, limits, progress); !done) return done;
  const auto top = top_of(unpacked);
  if (!top)
    return fail(ErrorCode::kInvalidRequest, "the archive holds no campaign",
                {{"/upload", fmt::format("has no {} at its top, or in the only folder there", kDocument)}});
  std::error_code error;
  fs::rename(*top, working / kFiles, error);
  if (error) return fail(ErrorCode::kStorage, error.message());
  fs::remove_all(unpacked, error);
  return {};
}

// The drives with their rows in files of their own, which are named in the place of "csv".
class AppendedFiles {
 public:
  explicit AppendedFiles(fs::path folder) : folder_(std::move(folder)) {}

  // Writes the entries into a list that is open, each file into the folder.
  Result<void> write(json::Writer& w, const json::JsonValue& drives) {
    if (!drives.is(json::JsonValue::Kind::kArray) || drives.elements.empty() ||
        drives.elements.size() > kMaxAppended)
      return refused({{"/drives", fmt::format("must be a list of 1 to {} drives", kMaxAppended)}});
    for (std::size_t d = 0; d < drives.elements.size(); ++d)
      if (const auto written = write_drive(w, drives.elements[d], fmt::format("/drives/{}", d)); !written)
        return written;
    return faults_.empty() ? Result<void>() : refused(std::move(faults_));
  }

 private:
  static Result<void> refused(std::vector<Fault> faults) {
    const std::string summary = summary_of(faults);
    return fail(ErrorCode::kInvalidRequest, summary, std::move(faults));
  }

  Result<void> write_drive(json::Writer& w, const json::JsonValue& drive, const std::string& pointer) {
    json::ObjectReader reader(drive, pointer, faults_);
    std::string csv;
    if (!reader.is_object() || !reader.text("csv", json::kRequired, {.most = kMaxCsvBytes}, csv)) return {};
    if (drive.find("file") != nullptr) reader.fault("file", "stands where \"csv\" does; give the rows alone");
    // A name that no file of the campaign has: of the rows' own bytes.
    Sha256 hash;
    hash.add(csv);
    const std::string file = fmt::format("appended_{}.csv", hash.digest().substr(0, 16));
    if (const auto written = write_whole_file(folder_ / file, csv); !written) return written;
    w.begin_object();
    for (std::size_t k = 0; k < drive.keys.size(); ++k) {
      if (drive.keys[k] == "csv") {
        w.text("file", file);
      } else {
        w.key(drive.keys[k]);
        json::write_value(w, drive.elements[k]);
      }
    }
    w.end_object();
    return {};
  }

  fs::path folder_;
  std::vector<Fault> faults_;
};

// The earlier campaign's files by another name, and its document with the drives behind its own.
Result<void> append_drives(const fs::path& earlier, const json::JsonValue& drives, const fs::path& working) {
  std::error_code error;
  const fs::path folder = working / kFiles;
  fs::copy(earlier / kFiles, folder, fs::copy_options::recursive | fs::copy_options::create_hard_links,
           error);
  if (error) return fail(ErrorCode::kStorage, error.message());
  const auto bytes = read_data_file(folder / kDocument);
  if (!bytes) return fail(bytes.error());
  const auto document = json::parse(*bytes, {.bytes = kMaxDocumentBytes});
  if (!document) return fail(document.error());
  json::Writer w;
  w.begin_object();
  for (std::size_t k = 0; k < document->keys.size(); ++k) {
    w.key(document->keys[k]);
    if (document->keys[k] != "drives") {
      json::write_value(w, document->elements[k]);
      continue;
    }
    w.begin_array();
    for (const json::JsonValue& drive : document->elements[k].elements) json::write_value(w, drive);
    AppendedFiles files(folder);
    if (const auto written = files.write(w, drives); !written) return written;
    w.end_array();
  }
  w.end_object();
  // The old document's bytes are the earlier campaign's too: this makes a file of its own.
  return write_whole_file(folder / kDocument, w.take() + "\n");
}

}  // namespace

Result<CampaignTaken> take_campaign(UploadFolder& uploads, const CampaignOrder& order,
                                    const Catalogue& catalogue, Progress& progress) {
  const UploadOrigin origin{
      .owner = order.asker.name, .at_ms = now_ms(), .from = order.upload, .follows = order.follows};
  fs::path source;
  if (order.upload.empty()) {
    const auto earlier = uploaded_campaign(uploads, order.follows);
    if (!earlier)
      return fail(ErrorCode::kNotFound, fmt::format("there is no uploaded campaign {}", order.follows));
    source = earlier->parent_path();
  } else {
    const auto file = uploads.verified(order.upload, order.asker);
    if (!file) return fail(file.error());
    source = *file;
  }
  const std::string unnamed = "new";
  remove_abandoned(uploads.campaigns(), unnamed);
  const WorkingFolder folder(uploads.campaigns() / unnamed);
  const fs::path& working = folder.path();
  if (const auto made = make_folder(working); !made) return fail(made.error());
  progress.report("reading the drives", 0.1);
  const std::int64_t room = uploads.room();
  const auto notes = run_confined(
      kLimits,
      [&](Progress& inner) -> Result<std::string> {
        const auto there = order.upload.empty() ? append_drives(source, *order.drives, working)
                                                : unpack_campaign(source, working, room, inner);
        if (!there) return fail(there.error());
        const auto campaign = load_drive_campaign(working / kFiles, catalogue);
        if (!campaign) return fail(campaign.error());
        json::Writer w;
        w.begin_object().texts("notes", campaign->notes).end_object();
        return w.take();
      },
      progress);
  if (!notes) return fail(notes.error());
  const auto name = name_of(working / kFiles);
  if (!name) return fail(name.error());
  if (const auto fits = uploads.check_room(0); !fits) return fail(fits.error());
  if (const auto written = write_origin(working, origin, *name); !written) return fail(written.error());
  const auto placed = put_in_place(working, uploads.campaigns() / *name);
  if (!placed) return fail(placed.error());
  const fs::path place = uploads.campaigns() / *name;
  CampaignTaken taken{described_campaign(place / kFiles, *name, catalogue), origin, {}};
  if (auto known = read_origin(place)) taken.origin = *std::move(known);
  const auto told = json::parse(*notes);
  if (told)
    for (const json::JsonValue& note : told->find("notes")->elements) taken.notes.push_back(note.text);
  return taken;
}

std::optional<fs::path> uploaded_campaign(const UploadFolder& uploads, std::string_view name) {
  if (!is_campaign_name(name)) return std::nullopt;
  const fs::path folder = uploads.campaigns() / name / kFiles;
  std::error_code error;
  if (!fs::is_regular_file(folder / kDocument, error)) return std::nullopt;
  return folder;
}

Result<gap::DriveCampaign> load_uploaded_campaign(const UploadFolder& uploads, const std::string& name,
                                                  const Catalogue& catalogue) {
  const auto folder = uploaded_campaign(uploads, name);
  if (!folder) return fail(ErrorCode::kNotFound, fmt::format("there is no uploaded campaign {}", name));
  const auto now = name_of(*folder);
  if (!now || *now != name)
    return fail(ErrorCode::kDamagedStore,
                fmt::format("the files of the campaign {} are not what was sent any more", name));
  return load_drive_campaign(*folder, catalogue);
}

std::vector<UploadedCampaign> uploaded_campaigns(const UploadFolder& uploads, const Catalogue& catalogue) {
  std::vector<UploadedCampaign> campaigns;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(uploads.campaigns(), error)) {
    const std::string name = entry.path().filename().string();
    const auto folder = uploaded_campaign(uploads, name);
    if (!folder) continue;
    campaigns.push_back(
        {described_campaign(*folder, name, catalogue), read_origin(entry.path()).value_or(UploadOrigin{})});
  }
  std::sort(campaigns.begin(), campaigns.end(), [](const UploadedCampaign& a, const UploadedCampaign& b) {
    return a.campaign.name < b.campaign.name;
  });
  return campaigns;
}

}  // namespace slipway::api
