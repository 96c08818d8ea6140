#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/campaign/shipped_campaigns.h"
#include "api/files/catalogue.h"
#include "api/ground_evidence.h"
#include "api/requests/answers.h"
#include "api/requests/map_request.h"
#include "api/requests/model_check.h"
#include "api/requests/soil_estimate.h"
#include "api/uploads/upload_folder.h"
#include "api/uploads/uploaded_campaigns.h"
#include "api/uploads/uploaded_terrains.h"
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
      &sim::soil_format();                          // what its soil files may hold; outlives the service
  std::shared_ptr<UploadFolder> uploads = nullptr;  // what clients send; empty: nothing
};

// What the server and the command line both ask. Immutable once opened but for what clients send;
// thread-safe.
class Service {
 public:
  // Errors: unreadable_data with the faults of all files.
  static Result<std::unique_ptr<Service>> open(ServiceOptions options);

  // With the terrains that clients have sent so far.
  std::shared_ptr<const Catalogue> catalogue() const;
  // Whether a terrain of this name is there that does not ship.
  bool was_sent(const std::string& terrain) const {
    return !catalogue_->terrains.contains(terrain) && catalogue()->terrains.contains(terrain);
  }
  // Where clients' files are; nullptr where none are taken.
  UploadFolder* uploads() const { return options_.uploads.get(); }
  std::span<const planner::CostTerm> costs() const { return options_.costs; }
  std::span<const planner::PlannerRow> planners() const { return options_.planners; }
  // The drives that ship. A name among them, or of drives that were sent, is all that a request says of where
  // drives are: it opens no other.
  const std::vector<ShippedCampaign>& campaigns() const { return shipped_; }

  // Reads a request and checks all that can be checked without planning: syntax, values, names, whether every
  // place lies on the terrain and has elevation. All faults together. off_map or no_data when all of them are
  // of that kind.
  Result<PlanRequest> read_plan(std::string_view json) const;
  Result<PredictionRequest> read_prediction(std::string_view json) const;
  Result<CheckRequest> read_check(std::string_view json) const;
  Result<DiagnosisRequest> read_diagnosis(std::string_view json) const;
  Result<ModelCheckRequest> read_model_check(std::string_view json) const;
  Result<WatchRequest> read_watch(std::string_view json) const;
  Result<SoilEstimateRequest> read_soil_estimate(std::string_view json) const;
  // These need uploads(). Errors also: invalid_request where there are none.
  Result<CampaignOrder> read_campaign(std::string_view json) const;
  Result<TerrainOrder> read_terrain(std::string_view json) const;
  Result<MapRequest> read_map(std::string_view json) const;

  // The same request gives the same answer, on any number of threads.
  Result<PlanAnswer> plan(const PlanRequest& request, Progress& progress) const;
  Result<PredictionAnswer> predict(const PredictionRequest& request, Progress& progress) const;
  Result<CheckAnswer> check(const CheckRequest& request, Progress& progress) const;
  Result<DiagnosisAnswer> diagnose(const DiagnosisRequest& request, Progress& progress) const;
  Result<ModelCheckAnswer> check_model(const ModelCheckRequest& request, Progress& progress) const;
  Result<WatchAnswer> watch(const WatchRequest& request, Progress& progress) const;
  Result<SoilEstimateAnswer> estimate_soil(const SoilEstimateRequest& request, Progress& progress) const;
  Result<CampaignTaken> take_campaign(const CampaignOrder& order, Progress& progress) const;
  Result<TerrainImportReport> take_terrain(const TerrainOrder& order, Progress& progress) const;

  // A map of the ground, written to the target. The same request gives the same bytes. Memory is bounded
  // whatever its size, but of maps of ways (see kMaxServedMapCells). Errors: those of reading the terrain;
  // payload_too_large above the target's limit; unwritable_file; cancelled.
  // Errors: off_map, payload_too_large at /extent (0 cells: no limit).
  Result<void> check_map_size(const MapRequest& request, long long max_cells) const;
  Result<MapAnswer> map(const MapRequest& request, const MapTarget& target, Progress& progress) const;
  // The same map from pieces that may be made anywhere: squares of its tiles, which are read as one piece of
  // ground in map() too, so that the bytes are the same. None of maps of ways, whose cells hang together.
  // Errors: off_map, not_found.
  Result<std::vector<MapPieceIndex>> map_pieces(const MapRequest& request) const;
  // The tiles of a piece, row by row, as they are kept.
  Result<std::vector<std::string>> map_piece(const MapRequest& request, const MapTarget& target,
                                             const MapPieceIndex& piece, Progress& progress) const;
  // `tiles_of` gives those of the piece of that number.
  Result<MapAnswer> map_of_pieces(const MapRequest& request, const MapTarget& target,
                                  const std::function<Result<std::vector<std::string>>(int)>& tiles_of,
                                  Progress& progress) const;

  // Errors: not_found (unknown terrain), off_map, no_data.
  Result<GroundAt> ground_at(std::string_view terrain, double x_m, double y_m) const;

 private:
  explicit Service(ServiceOptions options) : options_(std::move(options)) {}

  // A problem without places, and the window's soils: what plan and prediction have in common. The ground is
  // that of `window`, or lies around the places where that is not given.
  struct Setting {
    planner::PlanProblem problem;
    Provenance provenance;
    std::shared_ptr<const TerrainSite> site;
  };
  Result<Setting> set_up(const std::string& terrain, const std::string& rover,
                         const std::vector<planner::Waypoint>& places, const DriveAssumptions& drive,
                         Progress& progress, const std::optional<dem::Extent>& window = std::nullopt) const;
  Result<PlanAnswer> plan_within(const std::optional<dem::Extent>& window, const PlanRequest& request,
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

  // A map before its cells are made.
  struct MapWork;
  Result<MapWork> prepare_map(const MapRequest& request, const MapTarget& target, Progress& progress) const;
  Result<void> fill_map(const MapWork& work, dem::TileStore& store, Progress& progress) const;

  // A campaign of this name ships or was sent.
  bool has_campaign(const std::string& name) const;
  // Its drives. Errors: invalid_request at /campaign, and those of load_drive_campaign and of
  // load_uploaded_campaign.
  Result<gap::DriveCampaign> drives_of(const std::string& name) const;
  void check_campaign(const std::string& name, const std::string& pointer, std::vector<Fault>& faults) const;

  ServiceOptions options_;
  std::shared_ptr<const Catalogue> catalogue_;  // what ships
  // The same with what was sent, and which folders were there when it was read.
  mutable std::mutex sent_mutex_;
  mutable std::string sent_terrains_;
  mutable std::shared_ptr<const Catalogue> with_sent_;
  std::vector<ShippedCampaign> shipped_;
  std::vector<std::string> campaigns_;  // their names
  mutable ConditionedGroundCache conditioned_ground_;
};

}  // namespace slipway::api
