#include "postgres_schema.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "api/jobs/job.h"
#include "api/jobs/postgres_connection.h"

namespace slipway::api::testing {
namespace {

namespace fs = std::filesystem;

int script(const std::string& arguments) {
  return std::system((std::string(SLIPWAY_POSTGRES_SCRIPT) + " " + arguments + " >/dev/null").c_str());
}

// The folder of a server that ends with this process.
fs::path own_server() {
  if (script("available") != 0) return {};
  std::string folder = "/tmp/slipway-pg-XXXXXX";
  if (::mkdtemp(folder.data()) == nullptr || script("start " + folder) != 0)
    throw std::runtime_error("the PostgreSQL server of the tests does not start");
  script("guard " + folder + " " + std::to_string(::getpid()));
  return folder;
}

fs::path shared_server() {
  const char* const file = std::getenv("SLIPWAY_TEST_POSTGRES");
  std::string folder;
  if (file != nullptr) std::getline(std::ifstream(file) >> std::ws, folder);
  return folder;
}

// Empty where there is none.
const std::string& server_address() {
  static const std::string address = [] {
    fs::path folder = shared_server();
    if (folder.empty()) folder = own_server();
    if (folder.empty()) return std::string();
    std::string port;
    std::getline(std::ifstream(folder / "port"), port);
    return "postgresql://slipway@127.0.0.1:" + port + "/slipway";
  }();
  return address;
}

}  // namespace

std::unique_ptr<PostgresSchema> PostgresSchema::make() {
  if (server_address().empty()) return nullptr;
  auto schema = std::unique_ptr<PostgresSchema>(new PostgresSchema("test_" + new_job_id()));
  PostgresConnection(PostgresAddress(server_address()), CommitKind::kQuick)
      .run("CREATE SCHEMA " + schema->name_);
  return schema;
}

PostgresSchema::~PostgresSchema() {
  run("DROP SCHEMA " + name_ + " CASCADE");
}

std::string PostgresSchema::address() const {
  return server_address() + "?options=-csearch_path%3D" + name_ +
         "%20-cclient_min_messages%3Dwarning&application_name=" + name_;
}

void PostgresSchema::run(const std::string& sql) const {
  PostgresConnection(PostgresAddress(address()), CommitKind::kQuick).run(sql);
}

}  // namespace slipway::api::testing
