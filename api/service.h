#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/campaign/shipped_campaigns.h"
#include "api/files/catalogue.h"
#include "api/ground_evidence.h"
#include "api/requests/answers.h"
#include "api/requests/soil_estimate.h"
#include "core/progress.h"
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
      &sim::soil_format();  // what its soil files may hold; outlives the service
};

// What the server and the command line both ask: immutable once opened, thread-safe.
class Service {
 public:
  // Errors: unreadable_data with the faults of all files.
  static Result<std::unique_ptr<Service>> open(ServiceOptions options);

  const Catalogue& catalogue() const { return *catalogue_; }
  std::span<const planner::CostTerm> costs() const { return options_.costs; }
  std::span<const planner::PlannerRow> planners() const { return options_.planners; }
  // The drives that ship. A name among them is all that a request says of where drives are: it opens no
  // other.
  const std::vector<ShippedCampaign>& campaigns() const { return shipped_; }

  // Reads a request and checks all that can be checked without planning: syntax, values, names, whether every
  // place lies on the terrain and has elevation. All faults together. off_map or no_data when all of them are
  // of that kind.
  Result<PlanRequest> read_plan(std::string_view json) const;
  Result<PredictionRequest> read_prediction(std::string_view json) const;
  Result<CheckRequest> read_check(std::string_view json) const;
  Result<DiagnosisRequest> read_diagnosis(std::string_view json) const;
  Result<WatchRequest> read_watch(std::string_view json) const;
  Result<SoilEstimateRequest> read_soil_estimate(std::string_view json) const;

  // The same request gives the same answer, on any number of threads.
  Result<PlanAnswer> plan(const PlanRequest& request, Progress& progress) const;
  Result<PredictionAnswer> predict(const PredictionRequest& request, Progress& progress) const;
  Result<CheckAnswer> check(const CheckRequest& request, Progress& progress) const;
  Result<DiagnosisAnswer> diagnose(const DiagnosisRequest& request, Progress& progress) const;
  Result<WatchAnswer> watch(const WatchRequest& request, Progress& progress) const;
  Result<SoilEstimateAnswer> estimate_soil(const SoilEstimateRequest& request, Progress& progress) const;

  // Errors: not_found (unknown terrain), off_map, no_data.
  Result<GroundAt> ground_at(std::string_view terrain, double x_m, double y_m) const;

 private:
  explicit Service(ServiceOptions options) : options_(std::move(options)) {}

  // How much of the map a problem's terrain is.
  enum class Window { kAroundPlaces, kWholeMap };
  // A problem without places, and the window's soils: what plan and prediction have in common.
  struct Setting {
    planner::PlanProblem problem;
    Provenance provenance;
  };
  Result<Setting> set_up(const std::string& terrain, const std::string& rover,
                         const std::vector<planner::Waypoint>& places, const DriveAssumptions& drive,
                         Progress& progress, Window window = Window::kAroundPlaces) const;
  Result<PlanAnswer> plan_within(Window window, const PlanRequest& request,
                                 const std::vector<planner::Waypoint>& places, Progress& progress) const;
  // The service's own, or a copy with the request's model and soils in it where it has some; the model's
  // rover takes the place of the one it was made of. What can't be taken is added to the faults.
  std::shared_ptr<const Catalogue> catalogue_for(const DriveAssumptions& drive, std::string& rover,
                                                 std::vector<Fault>& faults) const;
  // Conditions the setting's draws on the drive under way.
  static Result<void> learn(const DriveAssumptions& drive, Progress& progress, Setting& setting);
  // The same with the request's model alone.
  std::shared_ptr<const Catalogue> catalogue_of(const std::optional<RequestedModel>& model,
                                                std::string& rover, std::vector<Fault>& faults) const;

  // A request that was read, where neither its reader, nor `rest(request, check)`, nor what is checked of all
  // drives finds a fault.
  template <class Request, class Rest>
  Result<Request> checked(Result<Reading<Request>> reading, const Rest& rest) const;

  // Errors: invalid_request at /campaign, and those of load_drive_campaign.
  Result<gap::DriveCampaign> shipped_drives(const std::string& name) const;

  ServiceOptions options_;
  std::shared_ptr<const Catalogue> catalogue_;
  std::vector<ShippedCampaign> shipped_;
  std::vector<std::string> campaigns_;  // their names
  mutable ConditionedGroundCache conditioned_ground_;
};

}  // namespace slipway::api
