#include "api/jobs/sqlite_job_schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>
#include <system_error>
#include <vector>

#include "api/files/whole_file.h"
#include "api/jobs/job.h"
#include "api/jobs/job_digest.h"
#include "core/boot_clock.h"
#include "core/utc.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSchemaVersion = 4;

// What is too long for an answer, in pages, and goes with its job.
constexpr const char* kSeries = R"(
CREATE TABLE series (
  job_id TEXT NOT NULL,
  page INTEGER NOT NULL,
  bytes BLOB NOT NULL,
  sha256 TEXT NOT NULL,
  PRIMARY KEY (job_id, page)
);
CREATE TRIGGER series_go AFTER DELETE ON jobs BEGIN DELETE FROM series WHERE job_id = OLD.id; END;
)";

constexpr const char* kSchema = R"(
CREATE TABLE jobs (
  sequence INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  kind TEXT NOT NULL,
  state TEXT NOT NULL,
  stage TEXT NOT NULL DEFAULT '',
  progress REAL NOT NULL DEFAULT 0,
  version INTEGER NOT NULL DEFAULT 1,
  attempt INTEGER NOT NULL DEFAULT 0,
  created_ms INTEGER NOT NULL,
  started_ms INTEGER,
  ended_ms INTEGER,
  worker TEXT,
  lease_until_ms INTEGER,
  request BLOB NOT NULL,
  outcome BLOB,
  deaths INTEGER NOT NULL DEFAULT 0,
  request_sha256 TEXT NOT NULL DEFAULT '',
  outcome_sha256 TEXT,
  last_death TEXT NOT NULL DEFAULT '',
  owner TEXT NOT NULL DEFAULT '',
  idempotency_key TEXT,
  urgency INTEGER NOT NULL DEFAULT 3,
  cpu_s REAL NOT NULL DEFAULT 0,
  whole TEXT,
  part INTEGER NOT NULL DEFAULT 0,
  parts INTEGER NOT NULL DEFAULT 0,
  parts_ended INTEGER NOT NULL DEFAULT 0,
  parts_failed INTEGER NOT NULL DEFAULT 0,
  parts_cpu_s REAL NOT NULL DEFAULT 0
);
CREATE UNIQUE INDEX jobs_keys ON jobs (owner, idempotency_key) WHERE idempotency_key IS NOT NULL;
CREATE INDEX jobs_unfinished ON jobs (sequence) WHERE state IN ('accepted', 'running');
CREATE INDEX jobs_ended ON jobs (sequence) WHERE state NOT IN ('accepted', 'running');
PRAGMA user_version = 4;
)";
// A job's parts, which go with it.
constexpr const char* kParts = R"(
CREATE INDEX jobs_parts ON jobs (whole, part) WHERE whole IS NOT NULL;
CREATE TRIGGER parts_go AFTER DELETE ON jobs WHEN OLD.parts > 0 BEGIN
  DELETE FROM jobs WHERE whole = OLD.id;
END;
)";
// What running jobs have found until now, beside the versions: a program that does not know it does without.
constexpr const char* kBestSoFar = R"(
CREATE TABLE IF NOT EXISTS best_so_far (
  job_id TEXT PRIMARY KEY,
  attempt INTEGER NOT NULL,
  document TEXT NOT NULL
);
CREATE TRIGGER IF NOT EXISTS best_so_far_goes AFTER DELETE ON jobs BEGIN
  DELETE FROM best_so_far WHERE job_id = OLD.id;
END;
)";

// How jobs ended, in digests; a program that does not know it does without.
constexpr const char* kEnds = R"(
CREATE TABLE IF NOT EXISTS ends (
  job_id TEXT PRIMARY KEY,
  sha256 TEXT NOT NULL
);
CREATE TRIGGER IF NOT EXISTS ends_go AFTER DELETE ON jobs BEGIN
  DELETE FROM ends WHERE job_id = OLD.id;
END;
)";

const std::vector<std::string> kTableColumns{"sequence",
                                             "id",
                                             "kind",
                                             "state",
                                             "stage",
                                             "progress",
                                             "version",
                                             "attempt",
                                             "created_ms",
                                             "started_ms",
                                             "ended_ms",
                                             "worker",
                                             "lease_until_ms",
                                             "request",
                                             "outcome",
                                             "deaths",
                                             "request_sha256",
                                             "outcome_sha256",
                                             "last_death",
                                             "owner",
                                             "idempotency_key",
                                             "urgency",
                                             "cpu_s",
                                             "whole",
                                             "part",
                                             "parts",
                                             "parts_ended",
                                             "parts_failed",
                                             "parts_cpu_s"};

constexpr std::string_view kMoveAway = "move it away to begin an empty store, or name another with --jobs";

[[noreturn]] void refuse(const fs::path& store, const std::string& why, std::string_view remedy) {
  throw SqliteDamage(fmt::format("the job store {} {}; {}", store.string(), why, remedy));
}

fs::path marker_of(const fs::path& store) {
  return store.string() + ".marker";
}

std::string first_text(SqliteConnection& connection, std::string_view sql) {
  auto row = connection.prepare(sql);
  return row.step() ? row.text(0) : std::string();
}

std::int64_t number_of(SqliteConnection& connection, std::string_view sql) {
  auto row = connection.prepare(sql);
  row.step();
  return row.number(0);
}

// Under one lock: another process may be at it too.
void make_tables_where_empty(SqliteConnection& connection) {
  SqliteTransaction transaction(connection);
  if (number_of(connection, "PRAGMA user_version") == 0 &&
      number_of(connection, "SELECT count(*) FROM sqlite_schema") == 0) {
    connection.execute(kSchema);
    connection.execute(kSeries);
    connection.execute(kParts);
  }
  transaction.commit();
}

void check_columns(SqliteConnection& connection, const fs::path& store) {
  std::vector<std::string> found;
  auto row = connection.prepare("SELECT name FROM pragma_table_info('jobs') ORDER BY cid");
  while (row.step()) found.push_back(row.text(0));
  if (found != kTableColumns)
    refuse(store, fmt::format("has a table of jobs with other columns ({})", fmt::join(found, ", ")),
           kMoveAway);
}

// A copy beside the store, "jobs.sqlite.version-1", before it is brought up.
void copy_of_version(SqliteConnection& connection, const fs::path& store, std::int64_t version) {
  fs::path copy = fmt::format("{}.version-{}", store.string(), version);
  std::error_code ignored;
  if (fs::exists(copy, ignored)) copy += fmt::format(".{}", now_ms());
  connection.prepare("VACUUM INTO ?").bind(copy.string()).step();
}

// Version 1 had no digests: those of what is there are taken as it is found.
void bring_up_from_1(SqliteConnection& connection) {
  connection.execute(
      "VACUUM");  // takes on the mode in which deleted pages can be given back, see SqliteConnection
  SqliteTransaction transaction(connection);
  connection.execute("ALTER TABLE jobs ADD COLUMN deaths INTEGER NOT NULL DEFAULT 0");
  connection.execute("ALTER TABLE jobs ADD COLUMN request_sha256 TEXT NOT NULL DEFAULT ''");
  connection.execute("ALTER TABLE jobs ADD COLUMN outcome_sha256 TEXT");
  auto row = connection.prepare("SELECT id, kind, state, request, outcome FROM jobs");
  std::vector<std::array<std::string, 3>> digests;
  while (row.step())
    digests.push_back({row.text(0), request_digest(row.text(0), row.text(1), row.text(3)),
                       outcome_digest(row.text(0), row.text(2), row.text(4))});
  for (const auto& [id, request, outcome] : digests)
    connection
        .prepare(
            "UPDATE jobs SET request_sha256 = ?, outcome_sha256 = CASE WHEN outcome IS NULL THEN NULL ELSE ? "
            "END "
            "WHERE id = ?")
        .bind(request)
        .bind(outcome)
        .bind(id)
        .step();
  connection.execute("PRAGMA user_version = 2");
  transaction.commit();
}

// Version 2 knew neither owners nor keys, urgencies, reasons of deaths and series.
void bring_up_from_2(SqliteConnection& connection) {
  SqliteTransaction transaction(connection);
  connection.execute("ALTER TABLE jobs ADD COLUMN last_death TEXT NOT NULL DEFAULT ''");
  connection.execute("ALTER TABLE jobs ADD COLUMN owner TEXT NOT NULL DEFAULT ''");
  connection.execute("ALTER TABLE jobs ADD COLUMN idempotency_key TEXT");
  connection.execute("ALTER TABLE jobs ADD COLUMN urgency INTEGER NOT NULL DEFAULT 3");
  connection.execute(
      "CREATE UNIQUE INDEX jobs_keys ON jobs (owner, idempotency_key) WHERE idempotency_key IS NOT NULL");
  connection.execute(kSeries);
  connection.execute("PRAGMA user_version = 3");
  transaction.commit();
}

// Version 3 knew no parts of jobs.
void bring_up_from_3(SqliteConnection& connection) {
  SqliteTransaction transaction(connection);
  for (const char* const column :
       {"cpu_s REAL NOT NULL DEFAULT 0", "whole TEXT", "part INTEGER NOT NULL DEFAULT 0",
        "parts INTEGER NOT NULL DEFAULT 0", "parts_ended INTEGER NOT NULL DEFAULT 0",
        "parts_failed INTEGER NOT NULL DEFAULT 0", "parts_cpu_s REAL NOT NULL DEFAULT 0"})
    connection.execute(fmt::format("ALTER TABLE jobs ADD COLUMN {}", column).c_str());
  connection.execute(kParts);
  connection.execute("PRAGMA user_version = 4");
  transaction.commit();
}

// Leases are counted by a clock that starts with the machine: whoever held one before that is gone, and so is
// the program of an older version that wrote them by the time of day.
void end_leases_of_other_boots(SqliteConnection& connection) {
  const std::string boot = boot_id();
  connection.execute("CREATE TABLE IF NOT EXISTS lease_clock (boot TEXT NOT NULL)");
  SqliteTransaction transaction(connection);
  const bool known = number_of(connection, "SELECT count(*) FROM lease_clock") == 1;
  if (!known || first_text(connection, "SELECT boot FROM lease_clock") != boot) {
    connection.execute("DELETE FROM lease_clock");
    connection.prepare("INSERT INTO lease_clock (boot) VALUES (?)").bind(boot).step();
    connection.execute(
        "UPDATE jobs SET lease_until_ms = 0 WHERE state = 'running' AND lease_until_ms IS NOT NULL");
  }
  transaction.commit();
}

}  // namespace

void check_marker(const fs::path& store) {
  std::error_code ignored;
  const fs::path marker = marker_of(store);
  if (store.empty() || !fs::exists(marker, ignored)) return;
  if (fs::exists(store, ignored) && fs::file_size(store, ignored) > 0) return;
  refuse(store, "is missing or empty, but its marker shows that there was one",
         fmt::format("put the store back, or remove {} to begin an empty one", marker.string()));
}

void settle_schema(SqliteConnection& connection, const fs::path& store, StoreCheck how_far) {
  try {
    if (how_far == StoreCheck::kWhole) {
      const std::string check = first_text(connection, "PRAGMA integrity_check(1)");
      if (check != "ok") refuse(store, fmt::format("is damaged ({})", check), kMoveAway);
    }
    make_tables_where_empty(connection);
    const std::int64_t version = number_of(connection, "PRAGMA user_version");
    if (version == 0) {
      refuse(store, "holds other tables than those of jobs", "name another with --jobs");
    } else if (version > kSchemaVersion) {
      refuse(store,
             fmt::format("was written by a newer program (version {}, this one reads {})", version,
                         kSchemaVersion),
             "use that program, or name another store with --jobs");
    } else if (version < kSchemaVersion) {
      copy_of_version(connection, store, version);
      if (version < 2) bring_up_from_1(connection);
      if (version < 3) bring_up_from_2(connection);
      bring_up_from_3(connection);
    }
    check_columns(connection, store);
    connection.execute(kBestSoFar);
    connection.execute(kEnds);
    end_leases_of_other_boots(connection);
  } catch (const SqliteDamage& damage) {
    const std::string words = damage.what();
    if (words.find(store.string()) != std::string::npos) throw;
    refuse(store, fmt::format("can't be read ({})", words), kMoveAway);
  }
  if (std::error_code ignored; store.empty() || fs::exists(marker_of(store), ignored)) return;
  const std::string words = fmt::format(
      "Beside this file stands a job store, {}. Without it the store would be taken for a new one.\n",
      store.filename().string());
  if (const auto written = write_whole_file(marker_of(store).string(), words); !written)
    throw SqliteFailure(written.error().detail);
}

}  // namespace slipway::api
