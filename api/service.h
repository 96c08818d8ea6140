#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/files/campaign/shipped_campaigns.h"
#include "api/files/catalogue.h"
#include "api/ground_evidence.h"
#include "api/uploads/upload_folder.h"
#include "core/result.h"
#include "planner/problem/cost_catalogue.h"
#include "planner/search/planner_catalogue.h"

namespace slipway::api {

struct ServiceOptions {
  std::filesystem::path data;            // the folder that holds rovers, soils and terrains
  std::size_t threads = 0;               // of one plan or prediction; 0: as many as the machine has
  std::filesystem::path model = {};      // folder of a corrected model to plan with; empty: none
  std::vector<std::string> ground = {};  // soils of terrains that are that model's, see with_model()
  // What routes cost and what searches for them. The rows must outlive the service.
  std::span<const planner::CostTerm> costs = planner::cost_catalogue();
  std::span<const planner::PlannerRow> planners = planner::planner_catalogue();
  const sim::SoilFormat* soil_format =
      &sim::soil_format();                          // what its soil files may hold; outlives the service
  std::shared_ptr<UploadFolder> uploads = nullptr;  // what clients send; empty: nothing
};

// What the answers to all requests are made from. The requests are in service_drives.h, service_map.h,
// service_diagnoses.h, service_uploads.h and batch.h. Immutable once opened but for what clients send;
// thread-safe.
class Service {
 public:
  // Errors: unreadable_data with the faults of all files.
  static Result<std::unique_ptr<Service>> open(ServiceOptions options);

  const ServiceOptions& options() const { return options_; }
  // With the terrains that clients have sent so far.
  std::shared_ptr<const Catalogue> catalogue() const;
  // Whether the terrain of this name is no client's.
  bool ships(const std::string& terrain) const { return catalogue_->terrains.contains(terrain); }
  // Where clients' files are; nullptr where none are taken.
  UploadFolder* uploads() const { return options_.uploads.get(); }
  // The drives that ship. A name among them, or of drives that were sent, is all that a request says of where
  // drives are: it opens no other.
  const std::vector<ShippedCampaign>& campaigns() const { return shipped_; }
  ConditionedGroundCache& conditioned_ground() const { return conditioned_ground_; }

 private:
  explicit Service(ServiceOptions options) : options_(std::move(options)) {}

  ServiceOptions options_;
  std::shared_ptr<const Catalogue> catalogue_;  // what ships
  // The same with what was sent, and which folders were there when it was read.
  mutable std::mutex sent_mutex_;
  mutable std::string sent_terrains_;
  mutable std::shared_ptr<const Catalogue> with_sent_;
  std::vector<ShippedCampaign> shipped_;
  mutable ConditionedGroundCache conditioned_ground_;
};

}  // namespace slipway::api
