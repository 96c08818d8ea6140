#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace slipway::server {

// What the command line was asked, in plain structs: how it was parsed is cli_app's affair.
struct AskOptions {
  std::string data;                 // folder of --data; empty here and below: see data_folder.h
  std::string url;                  // empty: the service in this process
  bool json = false;                // the document instead of a table
  std::string model;                // folder of a corrected model, as diagnose writes it; empty: none
  std::vector<std::string> ground;  // soils of terrains that are that model's
};

struct ServeOptions {
  std::string data;
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string jobs = "var/jobs.sqlite";  // empty: in memory, lost with the process
};

// A point "x,y" or "x,y,yaw_deg".
struct PlaceOption {
  double x_m = 0.0, y_m = 0.0;
  std::optional<double> yaw_deg;
};

struct DriveOptions {
  std::string terrain = "gale";
  std::string rover = "msl-class";
  std::optional<double> max_slip, max_tilt_deg, speed_m_s;
  std::optional<int> draws;
  std::optional<long long> seed;
  std::optional<double> motor_temp_c;
  std::vector<std::string> failed;   // "rf=locked"
  std::vector<std::string> effects;  // "slip_sinkage", "slip_sinkage:n1=0.2" or "slip_sinkage:off"
  std::string map;                   // file for the picture; empty: none
};

struct PlanOptions {
  AskOptions ask;
  DriveOptions drive;
  std::string
      request;  // file with a whole request, "-" is standard input; the options below are then not used
  std::optional<PlaceOption> start, goal;
  std::vector<PlaceOption> via;
  std::optional<int> routes, verify;
  std::vector<std::string> planners;
  bool compare = false;  // with the plan of the model that was corrected
};

struct PredictOptions {
  AskOptions ask;
  DriveOptions drive;
  std::string request;
  std::vector<PlaceOption> path;
  bool backwards = false;
  std::optional<double> crab_deg;
  std::string level;  // empty: the request's default
  std::string plot;   // file for the dynamic drive's time history; empty: none
};

struct TerrainOptions {
  AskOptions ask;
  std::string name = "gale";
  std::optional<PlaceOption> at;
};

struct ValidateOptions {
  std::string data;
  std::vector<std::string> only;  // names of comparisons; empty: all
  std::string plots;              // folder for one SVG per comparison; empty: none
  std::string check;              // page whose printed part must be what comes out; empty: none
  std::string write;              // page whose printed part is replaced; empty: none
  bool json = false;
  bool list = false;
};

// A single wheel on a rig.
struct WheelOptions {
  AskOptions ask;
  std::string rover = "mer-class", wheel, soil = "unknown_ground";
  std::vector<std::string> sweeps;  // "slip=0:0.9:0.1", "load_n=20,50,80"
  std::vector<std::string> set;     // "soil.n=1.1"
  std::optional<double> load_n, sinkage_m, slip, slip_angle_deg, gravity_m_s2, radius_m, width_m, speed_m_s;
  std::string slip_definition, speed_of;  // empty: the request's default
  std::string grousers;                   // "height_m,count"
  std::optional<double> motor_temp_c;
  bool in_a_track = false;
  std::vector<std::string> effects;
  std::string csv, plot;  // files; empty: none
};

struct CurrentMapCommand {
  AskOptions ask;
  std::optional<int> figure;
  std::string rover = "zhurong-class", soil = "jlu_mars_2_dense";
  std::string x = "slip", y;  // "k_s" or "k_s=60e3:600e3:60e3"; y may be empty
  double slip = 0.1, gravity_m_s2 = 9.81;
  std::optional<double> load_n;
  std::string model = "literal";  // or "balanced"
  std::string csv, plot;          // files; empty: none
};

struct CurrentInvertCommand {
  AskOptions ask;
  std::string rover = "zhurong-class", wheel, soil = "jlu_mars_2_dense";
  double current_a = 0.0, gravity_m_s2 = 3.71, max_slip = 0.4;
  std::optional<double> load_n, speed_m_s, motor_temp_c;
  std::vector<std::string> effects;
  int draws = 200;
  std::uint64_t seed = 1;
};

struct CampaignCommand {
  std::string data;
  std::string table;              // a file, a shipped table's name, or "list"
  std::string out;                // folder
  int threads = 0;                // 0: as many as the machine has
  std::vector<std::string> only;  // ids of drives with * and ?; empty: all
  bool start_over = false, dry_run = false, json = false;
};

struct TuneCommand {
  std::string data;
  std::string table;                    // a file or a shipped table's name
  std::string measured;                 // a campaign's folder or a survey's CSV
  std::vector<std::string> parameters;  // "soil.n=0.8..1.2", "soil.k_phi=1e5..1e7:log"
  std::vector<std::string> priors;      // "soil.n=1,0.1"
  int coarse = 5, fine = 5;
  std::vector<std::string> drives;  // ids with * and ?; empty: all
  double position_scale_m = 0.1, heading_scale_deg = 5.0;
  bool scales_are_errors = false;
  std::string loss = "none";         // a name of gap::robust_loss_names()
  std::optional<double> loss_scale;  // nothing: the loss's usual one
  double within = 1.5, good_enough = 0.1;
  bool each_tilt = false, sweep_only = false;
  int threads = 0;  // 0: as many as the machine has
  std::string out;  // folder; empty: none
  bool json = false;
};

struct DiagnoseCommand {
  std::string data;
  std::string campaign;              // folder of a "drive-campaign/1"
  std::vector<std::string> without;  // effects that are not looked for
  std::uint64_t seed = 1;
  int threads = 0;            // 0: as many as the machine has
  std::string report, model;  // folders; empty: none
  bool json = false;
};

struct CheckCommand {
  std::string data;
  std::string campaign, model;      // folders
  std::vector<std::string> ground;  // the campaign's soils that are the model's
  std::uint64_t seed = 1;
  int threads = 0;  // 0: as many as the machine has
  bool json = false;
};

// A soil from tests or drives.
struct EstimateCommand {
  enum class From { kWheel, kPlates, kDrives };
  AskOptions ask;
  From from = From::kWheel;
  std::string file;  // a CSV, or the folder of a "drive-campaign/1"
  std::string soil = "unknown_ground", rover, wheel;
  std::optional<double> radius_m, width_m, motor_temp_c;
  std::string grousers;  // "height_m,count"
  double gravity_m_s2 = 3.71, speed_m_s = 0.04;
  std::string slip_definition = "forward";
  std::vector<std::string> free, channels, bounds;  // bounds: "n=0.5:1.5"
  bool merge_stiffness = false;
  std::string priors = "wide", loss = "none";
  std::optional<double> loss_scale;
  double noise = 0.02;  // share of a reading
  std::uint64_t seed = 1;
  int threads = 0;             // of drives
  std::string soil_out, plot;  // files; empty: none
};

struct GapBenchmarkCommand {
  std::string data;
  std::string folder;             // of campaigns, with answers.json
  std::string make;               // set of campaigns to make there first; empty: they are there
  std::vector<std::string> only;  // names of campaigns; empty: all
  std::uint64_t seed = 1;
  int threads = 0;                // 0: as many as the machine has
  std::string keep;               // folder for each diagnosis.json; empty: none
  std::string csv;                // file for one line a campaign; empty: none
  std::string withheld_csv;       // file for one line an effect withheld; empty: none
  std::string variant = "as-is";  // of the diagnosis: ablations and baselines
  bool without_each = false, oracle = false, json = false;
  bool drives_needed = false;  // instead: how many drives a right answer takes
  int random_repeats = 3;      // of that with random drives
};

// Each prints its answer on standard output and returns the process's exit status: 0 an answer (also "no safe
// route"), 1 no answer, 2 a question that can't be asked. Problems and progress go to standard error.
int serve(const ServeOptions& options);
int plan(const PlanOptions& options);
int predict(const PredictOptions& options);
int wheel(const WheelOptions& options);
int current_map(const CurrentMapCommand& options);
int current_invert(const CurrentInvertCommand& options);
int terrain(const TerrainOptions& options);
int rovers(const AskOptions& options);
int soils(const AskOptions& options);
int effects(const AskOptions& options);
int health(const AskOptions& options);
// 0: every stated band holds (and the page is as it should be); 1: one does not.
int validate(const ValidateOptions& options);
// 0: every drive has an answer; 1: one has none.
int campaign(const CampaignCommand& options);
int tune(const TuneCommand& options);
// 0: a diagnosis, whatever its verdict; 2: input that can't be read.
int diagnose(const DiagnoseCommand& options);
// 0: figures, whatever they are; 2: input that can't be read.
int check(const CheckCommand& options);
int estimate(const EstimateCommand& options);
// 0: every campaign has a diagnosis and a score; 2: one can't be read.
int gap_benchmark(const GapBenchmarkCommand& options);

// From a signal handler: the running question is given up, the server drains and ends.
void interrupt();
// Whether interrupt() was called.
bool given_up();

}  // namespace slipway::server
