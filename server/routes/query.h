#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "server/http/http_message.h"

namespace slipway::server {

// Reads the parameters of a query: each may be given once, and no others. The faults are gathered, so that a
// refusal names all of them. The request must outlive this.
class Query {
 public:
  Query(const HttpRequest& request, std::vector<std::string> known);

  // Empty with a fault where there is none.
  std::string required_text(const std::string& name);
  // A finite number; 0 with a fault where there is none.
  double required_number(const std::string& name);
  // Its text; empty where it is not given.
  std::string text(const std::string& name) const;
  // Numbers with commas between; empty with a fault where that is not what there is, or no number is finite.
  std::vector<double> required_numbers(const std::string& name);
  // The same in rows, with semicolons between them; a single row without `many`.
  std::vector<std::vector<double>> required_rows(const std::string& name, bool many = true);
  void fault(const std::string& name, std::string message);
  // A whole number in [1, most]; `initial` where the parameter is not given.
  std::size_t count(const std::string& name, std::size_t initial, std::size_t most);

  // invalid_request with every fault; nothing where there was none.
  std::optional<Error> error() const;

 private:
  const HttpRequest& request_;
  std::vector<Fault> faults_;
};

}  // namespace slipway::server
