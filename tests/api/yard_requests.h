#pragma once

#include <string>
#include <vector>

#include "api/json/json_value.h"
#include "core/result.h"

namespace slipway::api::testing {

// Requests about drives of a rover on the small world's yard. `members` are those of the request's object
// beside terrain and rover.
class YardRequests {
 public:
  explicit YardRequests(std::string rover) : rover_(std::move(rover)) {}

  std::string with(const std::string& members) const;
  // The answer to a check as its document.
  Result<json::JsonValue> checked(const std::string& members) const;
  // The pointers of the faults that reading a check finds.
  std::vector<std::string> faults_of(const std::string& members) const;

 private:
  std::string rover_;
};

}  // namespace slipway::api::testing
