#pragma once

#include <memory>
#include <string>

namespace slipway::api::testing {

// An empty schema of a PostgreSQL server, gone at the end. The server is that of the run of ctest, or one
// that this process starts for all its tests.
class PostgresSchema {
 public:
  // Nothing where no server is installed: the test is to be skipped.
  static std::unique_ptr<PostgresSchema> make();
  ~PostgresSchema();
  PostgresSchema(const PostgresSchema&) = delete;
  PostgresSchema& operator=(const PostgresSchema&) = delete;

  // Of a store that makes its tables in it.
  std::string address() const;
  // Runs a statement in it.
  void run(const std::string& sql) const;

 private:
  explicit PostgresSchema(std::string name) : name_(std::move(name)) {}
  std::string name_;
};

inline constexpr const char* kNoPostgres =
    "no PostgreSQL server is installed (deploy/install.sh --test installs it)";

}  // namespace slipway::api::testing
