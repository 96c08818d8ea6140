#include "research/cli/gap_benchmark_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/catalogue.h"
#include "api/files/terrain_site.h"
#include "api/files/whole_file.h"
#include "api/json/faults.h"
#include "core/largest_exact_whole.h"
#include "gap/diagnosis/decide/decision.h"
#include "gap/diagnosis/decide/posterior.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/follow/since_reference.h"
#include "gap/diagnosis/held_out/effect_marginals.h"
#include "research/benchmark/baselines.h"
#include "research/benchmark/benchmark_score.h"
#include "research/benchmark/sealed_campaigns.h"
#include "research/cli/drives_needed_command.h"
#include "research/documents/benchmark_document.h"
#include "research/documents/benchmark_report.h"
#include "research/documents/drives_needed_document.h"
#include "research/documents/search_record_document.h"
#include "research/sealed_set/benchmark_answers.h"
#include "research/sealed_set/hidden_traces_csv.h"
#include "research/sealed_set/sealed_campaign_folder.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_option.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMadeRover = "mer-class";  // of campaigns that are made here

// A diagnosis with something taken out of it: what does it owe to which part?
struct Variant {
  std::string_view name;
  gap::Retuning retuning = gap::Retuning::kAll;
  bool something_else = true;
  bool single = false;          // the effect with the best trace alone, no second, no pair
  bool whole_evidence = false;  // not tempered
  bool outside = true;          // causes from outside compete
  Result<gap::Diagnosis> (*method)(const gap::DriveCampaign&, const gap::DiagnosisOptions&,
                                   Progress&) = &gap::diagnose;
};
constexpr std::array kVariants{
    Variant{.name = "as-is"},
    Variant{.name = "no-retuning", .retuning = gap::Retuning::kNone},
    Variant{.name = "no-closures", .retuning = gap::Retuning::kNoClosures},
    Variant{.name = "no-unknown", .something_else = false},
    Variant{.name = "nearest-signature",
            .retuning = gap::Retuning::kNone,
            .something_else = false,
            .single = true},
    Variant{.name = "evidence-without-retuning",
            .retuning = gap::Retuning::kNone,
            .something_else = false,
            .whole_evidence = true},
    Variant{.name = "no-wrench", .outside = false},
    Variant{.name = "sample-level-folds", .method = &gap::diagnose_sample_by_sample},
    Variant{.name = "sparse-regression", .method = &gap::diagnose_by_sparse_regression},
    Variant{.name = "gaussian-process", .method = &gap::diagnose_by_gaussian_process},
};

const Variant* variant_named(std::string_view name) {
  const auto row =
      std::find_if(kVariants.begin(), kVariants.end(), [&](const Variant& v) { return v.name == name; });
  return row == kVariants.end() ? nullptr : &*row;
}

struct Timed {
  gap::Diagnosis diagnosis;
  double seconds = 0.0;
};

// Makes the folder's campaigns, by dynamics.
Result<void> make_campaigns(const GapBenchmarkCommand& options, const api::Catalogue& catalogue) {
  const auto sets = slipway::campaign::sealed_sets();
  if (std::find(sets.begin(), sets.end(), options.make) == sets.end()) {
    const std::string message =
        fmt::format("unknown set \"{}\", known are: {}", options.make, fmt::join(sets, ", "));
    return fail(ErrorCode::kInvalidRequest, message, {{"/make", message}});
  }
  const auto rover = catalogue.rovers.find(kMadeRover);
  if (rover == catalogue.rovers.end())
    return fail(ErrorCode::kNotFound, fmt::format("the data folder has no rover {}", kMadeRover));
  const auto campaigns = slipway::campaign::sealed_campaigns(options.make, options.seed, rover->second);
  Interruptible patience;
  const auto tell = [&](const std::string& name, std::size_t drives, std::size_t made) {
    std::cerr << fmt::format("made [{}/{}] {}: {} drives\n", made, campaigns.size(), name, drives);
  };
  return api::make_sealed_folder({options.folder, options.make, options.seed}, campaigns,
                                 static_cast<std::size_t>(options.threads), tell, patience);
}

// The campaigns to diagnose, by name. Errors: unreadable_data; invalid_request at /only with every name that
// is none.
Result<std::vector<std::string>> campaigns_in(const GapBenchmarkCommand& options) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(options.folder, error), end; !error && it != end; it.increment(error))
    if (std::error_code none; fs::is_regular_file(it->path() / "campaign.json", none))
      names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());
  if (names.empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} holds no drive campaign", options.folder));
  std::vector<Fault> faults;
  for (const std::string& name : options.only)
    if (!std::binary_search(names.begin(), names.end(), name))
      faults.push_back({"/only", unknown_name("campaign", name, names)});
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, api::summary_of(faults), faults);
  std::erase_if(names, [&](const std::string& name) {
    return !options.only.empty() &&
           std::find(options.only.begin(), options.only.end(), name) == options.only.end();
  });
  return names;
}

// What a diagnosis is given besides the campaign.
struct Given {
  std::vector<std::string> withheld;
  bool oracle = false;  // all that is not withheld is at work
};

// The campaign becomes one that asks what has changed since its reference, where it has one.
Result<void> told_by_reference(const GapBenchmarkCommand& options, const api::Catalogue& catalogue,
                               const std::string& name, const gap::DiagnosisOptions& how, Progress& progress,
                               gap::DriveCampaign& campaign) {
  const fs::path folder = fs::path(options.folder) / "references" / name;
  if (std::error_code error; !options.references || !fs::exists(folder, error)) return {};
  const auto reference = api::load_drive_campaign(folder, catalogue);
  if (!reference) return fail(reference.error());
  auto since = gap::since_reference(*reference, campaign, how, progress);
  if (!since) return fail(since.error());
  campaign = std::move(*since);
  return {};
}

std::string file_of(const std::string& campaign, const Given& given) {
  if (given.oracle) return campaign + "-oracle.json";
  std::string file = campaign;
  for (const std::string& effect : given.withheld) file += "-without-" + effect;
  return file + ".json";
}

// The decision alone, from what a search left with --keep-search.
Result<Timed> decided_again(const GapBenchmarkCommand& options, const std::string& name, const Given& given) {
  const fs::path file = fs::path(options.replay) / file_of(name, given);
  const auto bytes = api::read_data_file(file);
  if (!bytes) return fail(bytes.error());
  auto record = api::json::read_search_record(*bytes, file.string());
  if (!record) return fail(record.error());
  const gap::DiagnosisOptions how;
  gap::Diagnosis diagnosis;
  const double share = gap::evidence_share(how, record->with_reference);
  gap::weigh(*record, share);
  const gap::Decision decision = gap::decide(*record, share, how.decision);
  diagnosis.campaign = name;
  diagnosis.verdict = decision.verdict;
  diagnosis.partial = decision.partial;
  diagnosis.marginals = gap::effect_marginals(*record);
  for (const std::string& effect : decision.names) diagnosis.effects.emplace_back().name = effect;
  for (const gap::SearchRecord::Explanation& e : record->explanations) {
    gap::ComparedSet& set = diagnosis.candidates.emplace_back();
    set.effects = e.effects;
    set.with_unknown = e.unknown();
    set.probability = e.probability;
  }
  diagnosis.search = std::move(*record);
  return Timed{std::move(diagnosis), 0.0};
}

Result<Timed> diagnosed(const GapBenchmarkCommand& options, const api::Catalogue& catalogue,
                        const std::string& name, const Given& given) {
  if (!options.replay.empty()) return decided_again(options, name, given);
  const auto start = std::chrono::steady_clock::now();
  auto campaign = api::load_drive_campaign(fs::path(options.folder) / name, catalogue);
  if (!campaign) return fail(campaign.error());
  gap::DiagnosisOptions how;
  how.search.withheld = given.withheld;
  how.given = given.oracle;
  how.search.threads = static_cast<std::size_t>(options.threads);
  how.seed = options.seed;
  const Variant& variant = *variant_named(options.variant);
  campaign->retuning = variant.retuning;
  how.search.something_else = variant.something_else;
  if (variant.single) {
    how.search.max_refitted = 1;
    how.search.max_paired = 0;
  }
  if (variant.whole_evidence) how.evidence.share = 1.0;
  how.search.outside = variant.outside;
  Interruptible patience;
  auto diagnosis = told_by_reference(options, catalogue, name, how, patience, *campaign).and_then([&] {
    return variant.method(*campaign, how, patience);
  });
  if (!diagnosis) return fail(diagnosis.error());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const auto keep = [&](const std::string& folder, const auto& document) -> Result<void> {
    if (folder.empty()) return {};
    return api::write_whole_file(fs::path(folder) / file_of(name, given), document());
  };
  const auto kept =
      keep(options.keep, [&] { return api::json::diagnosis_document(*campaign, *diagnosis); }).and_then([&] {
        return keep(options.keep_search, [&] { return api::json::search_record_document(*diagnosis); });
      });
  if (!kept) return fail(kept.error());
  return Timed{std::move(*diagnosis), took.count()};
}

void tell(std::size_t number, std::size_t of, const std::string& name, const Timed& timed) {
  std::vector<std::string> effects;
  for (const gap::FoundEffect& effect : timed.diagnosis.effects) effects.push_back(effect.name);
  std::cerr << fmt::format("[{}/{}] {}: {} {} ({:.1f} s)\n", number, of, name,
                           gap::name_of(timed.diagnosis.verdict), fmt::join(effects, " + "), timed.seconds);
}

// answers.json, with traces.csv where there is one.
Result<std::map<std::string, gap::HiddenAnswer>> answers_of(const fs::path& folder) {
  const auto bytes = api::read_data_file(folder / "answers.json");
  if (!bytes) return fail(bytes.error());
  auto answers = api::json::read_benchmark_answers(*bytes);
  if (!answers) return fail(answers.error());
  std::map<std::string, gap::HiddenAnswer> by_name;
  for (gap::HiddenAnswer& answer : *answers) by_name.emplace(answer.campaign, std::move(answer));
  const fs::path traces_file = folder / "traces.csv";
  if (std::error_code error; !fs::exists(traces_file, error)) return by_name;
  const auto text = api::read_data_file(traces_file);
  if (!text) return fail(text.error());
  auto traces = api::read_hidden_traces_csv(traces_file.string(), *text);
  if (!traces) return fail(traces.error());
  for (auto& [campaign, of] : *traces)
    if (const auto answer = by_name.find(campaign); answer != by_name.end())
      answer->second.traces = std::move(of);
  return by_name;
}

std::set<std::string> library() {
  std::set<std::string> names;
  for (const sim::Effect& effect : sim::effect_catalogue()) names.emplace(effect.name);
  return names;
}

int tell_drives_needed(const GapBenchmarkCommand& options, const api::Catalogue& catalogue,
                       std::span<const std::string> names) {
  const auto answers = answers_of(options.folder);
  if (!answers) return refuse_unreadable(answers.error());
  const auto needed = drives_needed(options, catalogue, names, *answers, library());
  if (!needed) return refuse_unreadable(needed.error());
  const int status = deliver(
      {}, options.json ? api::json::drives_needed_document(*needed) : api::drives_needed_report(*needed));
  return given_up() ? refuse({ErrorCode::kCancelled, "interrupted: what was done is counted", {}}) : status;
}

// A diagnosis that was given up is none, and no error.
Result<std::optional<Timed>> diagnosed_or_given_up(const GapBenchmarkCommand& options,
                                                   const api::Catalogue& catalogue, const std::string& name,
                                                   const Given& given) {
  if (given_up()) return std::nullopt;
  auto timed = diagnosed(options, catalogue, name, given);
  if (timed) return std::optional<Timed>(*std::move(timed));
  if (timed.error().code == ErrorCode::kCancelled) return std::nullopt;
  return fail(std::move(timed.error()));
}

// The diagnoses of the first campaigns: of all, unless they are interrupted.
Result<std::vector<Timed>> diagnose_all(const GapBenchmarkCommand& options, const api::Catalogue& catalogue,
                                        const std::vector<std::string>& names) {
  std::vector<Timed> open;
  for (const std::string& name : names) {
    auto timed = diagnosed_or_given_up(options, catalogue, name, {});
    if (!timed) return fail(timed.error());
    if (!*timed) break;
    open.push_back(**std::move(timed));
    tell(open.size(), names.size(), name, open.back());
  }
  return open;
}

// What the scores of all campaigns are made with.
struct Scoring {
  const GapBenchmarkCommand& options;
  const api::Catalogue& catalogue;
  const std::vector<std::string>& names;
  const std::set<std::string> known = library();
};

// How much of the gap could have been closed: a diagnosis that is given the hidden effects.
Result<void> score_oracle(const Scoring& scoring, std::size_t i, const std::set<std::string>& hidden,
                          gap::Benchmark& benchmark) {
  const auto& known = scoring.known;
  if (!scoring.options.oracle || hidden.empty() ||
      !std::includes(known.begin(), known.end(), hidden.begin(), hidden.end()))
    return {};
  Given given{.withheld = {}, .oracle = true};
  std::set_difference(known.begin(), known.end(), hidden.begin(), hidden.end(),
                      std::back_inserter(given.withheld));
  auto timed = diagnosed_or_given_up(scoring.options, scoring.catalogue, scoring.names[i], given);
  if (!timed) return fail(timed.error());
  if (!*timed) return {};
  if ((*timed)->diagnosis.closed_fraction)
    benchmark.cases.back().oracle_closed_fraction = (*timed)->diagnosis.closed_fraction->value;
  tell(i + 1, scoring.names.size(), scoring.names[i] + " given the answer", **timed);
  return {};
}

// The diagnoses again, with each hidden effect taken out of the library.
Result<void> score_withheld(const Scoring& scoring, std::size_t i, const gap::HiddenAnswer& answer,
                            const gap::Diagnosis& open, gap::Benchmark& benchmark) {
  for (const std::string& effect : answer.effects) {
    if (!scoring.options.without_each || !scoring.known.contains(effect)) continue;
    auto timed = diagnosed_or_given_up(scoring.options, scoring.catalogue, scoring.names[i],
                                       {.withheld = {effect}, .oracle = false});
    if (!timed) return fail(timed.error());
    if (!*timed) continue;
    tell(i + 1, scoring.names.size(), scoring.names[i] + " without " + effect, **timed);
    benchmark.withheld.push_back(gap::score_withheld(answer, effect, open, (*timed)->diagnosis));
  }
  return {};
}

// Scores what was diagnosed; `unscored` counts campaigns without an answer.
Result<gap::Benchmark> score(const Scoring& scoring, const std::vector<Timed>& open, std::size_t& unscored) {
  const auto answers = answers_of(scoring.options.folder);
  if (!answers) return fail(answers.error());
  const std::string variant = scoring.options.variant + (scoring.options.references ? "+reference" : "");
  gap::Benchmark benchmark{.variant = variant, .cases = {}, .withheld = {}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto answer = answers->find(scoring.names[i]);
    if (answer == answers->end()) {
      std::cerr << "answers.json says nothing of " << scoring.names[i] << ": it is not scored\n";
      ++unscored;
      continue;
    }
    benchmark.cases.push_back(
        gap::score_case(answer->second, open[i].diagnosis, scoring.known, open[i].seconds));
    if (auto scored = score_oracle(scoring, i, answer->second.effects, benchmark); !scored)
      return fail(scored.error());
    if (auto scored = score_withheld(scoring, i, answer->second, open[i].diagnosis, benchmark); !scored)
      return fail(scored.error());
  }
  return benchmark;
}

int score_and_print(const Scoring& scoring, const std::vector<Timed>& open) {
  const GapBenchmarkCommand& options = scoring.options;
  std::size_t unscored = 0;
  const auto benchmark = score(scoring, open, unscored);
  if (!benchmark) return refuse_unreadable(benchmark.error());
  const std::string set = fs::path(options.folder).lexically_normal().filename().string();
  std::vector<OutputFile> files;
  if (!options.csv.empty()) files.push_back({options.csv, api::benchmark_csv(*benchmark, set)});
  if (!options.marginals_csv.empty())
    files.push_back({options.marginals_csv, api::marginals_csv(*benchmark, set)});
  if (!options.withheld_csv.empty())
    files.push_back({options.withheld_csv, api::withheld_csv(*benchmark, set)});
  const int status = deliver(
      files, options.json ? api::json::benchmark_document(*benchmark) : api::benchmark_report(*benchmark));
  if (given_up())
    return refuse({ErrorCode::kCancelled,
                   fmt::format("interrupted: {} of {} campaigns were diagnosed, and what was done is scored",
                               open.size(), scoring.names.size()),
                   {}});
  return unscored > 0 ? std::max(status, 1) : status;
}

}  // namespace

int gap_benchmark(const GapBenchmarkCommand& options) {
  if (variant_named(options.variant) == nullptr) {
    std::vector<std::string_view> known;
    for (const Variant& variant : kVariants) known.push_back(variant.name);
    std::cerr << fmt::format("unknown variant \"{}\", known are: {}\n", options.variant,
                             fmt::join(known, ", "));
    return 2;
  }
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  if (!options.make.empty())
    if (const auto made = make_campaigns(options, *catalogue); !made) return refuse_unreadable(made.error());
  const auto names = campaigns_in(options);
  if (!names) return refuse_unreadable(names.error());
  // What can't be read or written is said before the first diagnosis, not after an hour of them.
  for (const std::string& name : options.replay.empty() ? *names : std::vector<std::string>{})
    if (auto campaign = api::load_drive_campaign(fs::path(options.folder) / name, *catalogue); !campaign)
      return refuse_unreadable(campaign.error());
  for (const std::string& folder : {options.keep, options.keep_search})
    if (const auto made = folder.empty() ? Result<void>{} : api::make_folder(folder); !made)
      return refuse(made.error());
  if (options.drives_needed) return tell_drives_needed(options, *catalogue, *names);
  // All diagnoses before the key is opened.
  const auto open = diagnose_all(options, *catalogue, *names);
  if (!open) return refuse_unreadable(open.error());
  if (open->empty()) return refuse({ErrorCode::kCancelled, "interrupted before the first diagnosis", {}});
  return score_and_print({.options = options, .catalogue = *catalogue, .names = *names}, *open);
}

void add_gap_benchmark_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<GapBenchmarkCommand>();
  CLI::App* command = app.add_subcommand(
      "gap-benchmark",
      "diagnose a folder of campaigns (made first, if asked for), then score the diagnoses against its "
      "answers.json");
  command->add_option("folder", options->folder, "folder of drive campaigns, with answers.json")->required();
  command->add_option(
      "--make", options->make,
      "first make campaigns in that folder, by drives in motion: smoke (2), each, each_heavy_wheels (23)");
  add_data_option(*command, options->data, "rovers and soils");
  command->add_option("--only", options->only, "names of campaigns; all without it")->delimiter(',');
  command->add_option("--seed", options->seed, "the same seed gives the same campaigns and diagnoses")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_option("--keep", options->keep, "folder for each campaign's diagnosis, NAME.json");
  command->add_option(
      "--keep-search", options->keep_search,
      "folder for what each decision was made from, NAME.json: decisions are judged again from it "
      "without a diagnosis");
  command
      ->add_option("--replay", options->replay,
                   "folder of what --keep-search wrote: the decisions are made again from it and scored, "
                   "without a diagnosis")
      ->excludes("--keep-search");
  command->add_option("--csv", options->csv, "file for the scores, one line a campaign");
  command->add_option("--marginals-csv", options->marginals_csv,
                      "file for the marginal probabilities, one line a campaign and effect");
  CLI::Option* const variant =
      command
          ->add_option("--variant", options->variant,
                       "of the diagnosis, to compare with: as-is, no-retuning, no-closures, no-unknown, "
                       "no-wrench, "
                       "nearest-signature, evidence-without-retuning, sample-level-folds, sparse-regression, "
                       "gaussian-process")
          ->capture_default_str();
  CLI::Option* const without_each =
      command->add_flag("--without-each", options->without_each,
                        "diagnose again with each hidden effect taken out of the library");
  command->add_option("--withheld-csv", options->withheld_csv,
                      "file for the scores with effects taken out, one line an effect");
  CLI::Option* const oracle = command->add_flag(
      "--oracle", options->oracle,
      "diagnose again with the hidden effects given: how much of the gap could have been closed?");
  command->add_flag("--references", options->references,
                    "with the drives in the folder's references/NAME taken as healthy, where there are some: "
                    "what has changed since?");
  CLI::Option* const needed =
      command->add_flag("--drives-needed", options->drives_needed,
                        "instead: how many drives a right answer takes where next drives are those that "
                        "diagnoses propose, and where they are random");
  for (CLI::Option* const other : {variant, without_each, oracle}) needed->excludes(other);
  command
      ->add_option("--random-repeats", options->random_repeats,
                   "with --drives-needed: runs of each campaign with random drives")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  command->add_flag("--json", options->json, "print the document, for machines");
  command->footer(
      "Example: how often is the diagnosis right on campaigns that it has not seen?\n"
      "  sealed_campaigns blind-1 --seed 1 --set blind && slipway gap-benchmark blind-1 --keep "
      "blind-1-found\n"
      "Example: with campaigns of the program's own making?\n"
      "  slipway gap-benchmark made-1 --make each --seed 1\n"
      "Example: are the drives that it proposes worth following?\n"
      "  slipway gap-benchmark blind-1 --drives-needed\n"
      "Interrupted (Ctrl-C) while it makes, the same command goes on; later, it scores what is done. Exit "
      "status: 0 every campaign is scored, 1 interrupted, or a campaign or file is missing from the answer, "
      "2 "
      "something can't be read.");
  command->callback([options, &run] { run = [options] { return gap_benchmark(*options); }; });
}

}  // namespace slipway::server
