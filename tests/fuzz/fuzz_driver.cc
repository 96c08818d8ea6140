// Runs one fuzz target where libFuzzer is not there: replays the files of its corpus, then makes new inputs
// of them for the seconds given, and keeps those that take a branch none took before. With the same seed it
// makes the same inputs as far as time allows.
//
//   NAME_fuzz [--seconds S] [--seed N] [--most-bytes N] [--most-seconds-each S] [--keep FOLDER]
//   FILE_OR_FOLDER...
//
// An input that ends the process is written to finding-NAME in the working folder first, whoever ends it: a
// sanitizer, a broken promise, an exception that nobody caught, or the clock.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "coverage.h"
#include "fuzz_target.h"
#include "mutation.h"

// The sanitizers' own function, there where they are.
// NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());

namespace slipway::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  double seconds = 0.0;
  std::uint64_t seed = 1;
  std::size_t most_bytes = 20'000;
  unsigned most_seconds_each = 20;
  std::filesystem::path keep;  // where inputs that took a new branch are written; empty: nowhere
  std::vector<std::filesystem::path> corpus;
};

std::string_view current_input;
std::string finding_path;

// Only what a signal handler may do: the input's bytes are written and nothing else.
void write_finding() {
  std::FILE* const file = std::fopen(finding_path.c_str(), "wb");
  if (file == nullptr) return;
  std::fwrite(current_input.data(), 1, current_input.size(), file);
  std::fclose(file);
  std::fprintf(stderr, "\nthe input of %zu bytes is in %s\n", current_input.size(), finding_path.c_str());
}

void on_signal(int signal) {
  std::fprintf(stderr, "\n%s\n", signal == SIGALRM ? "the input took too long" : "the process was aborted");
  write_finding();
  std::_Exit(77);
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Fuzzer {
 public:
  explicit Fuzzer(Options options) : options_(std::move(options)), mutator_(options_.seed) {}

  void replay(const std::filesystem::path& path) {
    std::string input = bytes_of(path);
    run(input);
    ++replayed_;
    mutator_.learn(input);
    corpus_.push_back(std::move(input));
  }

  void mutate_for_a_while() {
    const auto end = Clock::now() + std::chrono::duration<double>(options_.seconds);
    while (!corpus_.empty() && Clock::now() < end) {
      // Every second input starts from one that was found late: what is new there has been looked at least.
      const std::size_t n = corpus_.size(), late = std::min<std::size_t>(n, 20);
      const std::string& old =
          corpus_[mutator_.below(2) == 0 ? mutator_.below(n) : n - late + mutator_.below(late)];
      std::string input = mutator_.mutate(old, corpus_[mutator_.below(n)], options_.most_bytes);
      if (!run(input)) continue;
      if (!options_.keep.empty()) keep(input);
      corpus_.push_back(std::move(input));
    }
  }

  void report(const char* name) const {
    std::printf(
        "%s: %zu inputs replayed, %zu run, %zu kept for a new branch, %zu branch counts seen, slowest %.0f "
        "ms\n",
        name, replayed_, runs_, corpus_.size() - replayed_, branches_, slowest_s_ * 1e3);
  }

 private:
  // Whether the input took a branch, or took it by a power of two more often, as none did before.
  bool run(const std::string& input) {
    coverage.fill(0);
    current_input = input;
    ::alarm(options_.most_seconds_each);
    const auto begin = Clock::now();
    // A copy of its own, so that a read past its end is seen.
    const std::vector<std::uint8_t> bytes(input.begin(), input.end());
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    ::alarm(0);
    slowest_s_ = std::max(slowest_s_, std::chrono::duration<double>(Clock::now() - begin).count());
    ++runs_;
    return take_coverage();
  }

  bool take_coverage() {
    const std::size_t before = branches_;
    for (std::size_t i = 0; i < coverage.size(); i += 8) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, &coverage[i], 8);
      if (eight == 0) continue;
      for (std::size_t k = i; k < i + 8; ++k) {
        const std::uint8_t bit = std::bit_floor(coverage[k]);
        if (bit == 0 || (seen_[k] & bit) != 0) continue;
        seen_[k] |= bit;
        ++branches_;
      }
    }
    return branches_ > before;
  }

  void keep(const std::string& input) const {
    std::ofstream file(options_.keep / ("new-" + std::to_string(corpus_.size())), std::ios::binary);
    file.write(input.data(), static_cast<std::streamsize>(input.size()));
  }

  Options options_;
  Mutator mutator_;
  std::vector<std::string> corpus_;
  std::array<std::uint8_t, kCoveragePlaces> seen_{};
  std::size_t replayed_ = 0, runs_ = 0, branches_ = 0;
  double slowest_s_ = 0.0;
};

// A folder's files in the order of their names.
std::vector<std::filesystem::path> files_of(const std::vector<std::filesystem::path>& corpus) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : corpus) {
    if (!std::filesystem::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::filesystem::path> inside;
    for (const auto& entry : std::filesystem::directory_iterator(path)) inside.push_back(entry.path());
    std::sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}

Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view flag = argv[i];
    const bool has_value = flag.starts_with("--");
    if (has_value && i + 1 == argc) {
      std::fprintf(stderr, "%s needs a value\n", argv[i]);
      std::exit(2);
    }
    if (flag == "--seconds")
      options.seconds = std::atof(argv[++i]);
    else if (flag == "--seed")
      options.seed = std::strtoull(argv[++i], nullptr, 10);
    else if (flag == "--most-bytes")
      options.most_bytes = std::strtoull(argv[++i], nullptr, 10);
    else if (flag == "--most-seconds-each")
      options.most_seconds_each = static_cast<unsigned>(std::strtoul(argv[++i], nullptr, 10));
    else if (flag == "--keep")
      options.keep = argv[++i];
    else if (!has_value)
      options.corpus.emplace_back(flag);
    else {
      std::fprintf(stderr, "unknown option %s\n", argv[i]);
      std::exit(2);
    }
  }
  return options;
}

}  // namespace
}  // namespace slipway::fuzz

int main(int argc, char** argv) {
  using namespace slipway::fuzz;
  const Options options = read_options(argc, argv);
  const std::string name = std::filesystem::path(argv[0]).filename();
  finding_path = "finding-" + name;
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(write_finding);
  std::signal(SIGABRT, on_signal);
  std::signal(SIGALRM, on_signal);

  const std::vector<std::filesystem::path> files = files_of(options.corpus);
  if (files.empty()) {
    std::fprintf(stderr, "%s: there is no corpus\n", name.c_str());
    return 2;
  }
  Fuzzer fuzzer(options);
  for (const std::filesystem::path& file : files) fuzzer.replay(file);
  fuzzer.mutate_for_a_while();
  fuzzer.report(name.c_str());
  return 0;
}
