#include "steps/spice_orientation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "steps/spice_text_kernel.h"

namespace slipway::steps {
namespace {

constexpr double kJ2000Days = 2451545.0;
constexpr double kJ2000Frame = 1.0;
// No constant of a body comes near; beyond it an angle has no digits left.
constexpr double kMostDegrees = 1e9;

// The constants of one body.
class OrientationReader {
 public:
  OrientationReader(const KernelAssignments& all, std::string_view file, int id)
      : all_(all),
        file_(file),
        body_(fmt::format("BODY{}", id)),
        barycentre_(fmt::format("BODY{}", id / 100)) {}

  Result<std::optional<sky::Orientation>> read() const {
    sky::Orientation found;
    if (!all_.contains(body_ + "_POLE_RA")) return std::nullopt;
    for (const std::string& of : {body_, barycentre_})
      if (auto same = check_epoch(of); !same) return fail(same.error());
    for (const auto& [name, into] : {std::pair{"_POLE_RA", &found.right_ascension_deg},
                                     {"_POLE_DEC", &found.declination_deg},
                                     {"_PM", &found.prime_deg}}) {
      const auto powers = numbers(body_ + name, 1, into->size());
      if (!powers) return fail(powers.error());
      std::copy(powers->begin(), powers->end(), into->begin());
    }
    if (auto terms = read_terms(found); !terms) return fail(terms.error());
    return found;
  }

 private:
  tl::unexpected<Error> refuse(const std::string& name, std::string message) const {
    const auto found = all_.find(name);
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read as constants of bodies", file_),
                {{found == all_.end() ? file_ : fmt::format("{}, line {}", file_, found->second.line),
                  std::move(message)}});
  }

  Result<std::vector<double>> numbers(const std::string& name, std::size_t least, std::size_t most) const {
    auto read = kernel_numbers(all_, file_, name, least);
    if (!read) return read;
    if (read->size() > most)
      return refuse(name, fmt::format("{} has {} numbers, must have {} at most", name, read->size(), most));
    if (std::any_of(read->begin(), read->end(), [](double value) { return std::abs(value) > kMostDegrees; }))
      return refuse(name, fmt::format("{}: a number is beyond 1e9", name));
    return read;
  }

  // The constants are of the equator and the time of J2000, unless a kernel says otherwise.
  Result<void> check_epoch(const std::string& of) const {
    for (const auto& [suffix, usual, words] :
         {std::tuple{"_CONSTANTS_REF_FRAME", kJ2000Frame, "the frame of J2000 (1)"},
          {"_CONSTANTS_JED_EPOCH", kJ2000Days, "the epoch J2000 (2451545.0)"}}) {
      const std::string name = of + suffix;
      if (!all_.contains(name)) continue;
      const auto said = numbers(name, 1, 1);
      if (!said) return fail(said.error());
      if (said->front() != usual) return refuse(name, fmt::format("{}: only {} is read", name, words));
    }
    return {};
  }

  Result<void> read_terms(sky::Orientation& found) const {
    const std::string angles = barycentre_ + "_NUT_PREC_ANGLES", degree = barycentre_ + "_MAX_PHASE_DEGREE";
    std::size_t powers = 2;
    if (all_.contains(degree)) {
      const auto said = numbers(degree, 1, 1);
      if (!said) return fail(said.error());
      if (said->front() != 1.0 && said->front() != 2.0 && said->front() != 3.0)
        return refuse(degree, fmt::format("{} must be 1, 2 or 3", degree));
      powers = static_cast<std::size_t>(said->front()) + 1;
    }
    const auto name_of = [this](const char* suffix) { return fmt::format("{}_NUT_PREC_{}", body_, suffix); };
    for (const auto& [name, of] : {std::pair{name_of("RA"), &sky::Orientation::Term::right_ascension_deg},
                                   {name_of("DEC"), &sky::Orientation::Term::declination_deg},
                                   {name_of("PM"), &sky::Orientation::Term::prime_deg}}) {
      if (!all_.contains(name)) continue;
      const auto amplitudes = numbers(name, 0, kMostTerms);
      if (!amplitudes) return fail(amplitudes.error());
      if (found.terms.empty()) {
        const auto words = numbers(angles, powers, kMostTerms * powers);
        if (!words) return fail(words.error());
        if (words->size() % powers != 0)
          return refuse(angles, fmt::format("{} has {} numbers, must have {} for each angle", angles,
                                            words->size(), powers));
        found.terms.resize(words->size() / powers);
        for (std::size_t k = 0; k < words->size(); ++k)
          found.terms[k / powers].angle_deg[k % powers] = (*words)[k];
      }
      if (amplitudes->size() > found.terms.size())
        return refuse(name, fmt::format("{} has {} numbers, but there are {} angles in {}", name,
                                        amplitudes->size(), found.terms.size(), angles));
      for (std::size_t k = 0; k < amplitudes->size(); ++k) found.terms[k].*of = (*amplitudes)[k];
    }
    return {};
  }

  static constexpr std::size_t kMostTerms = 1000;
  const KernelAssignments& all_;
  std::string file_, body_, barycentre_;
};

}  // namespace

bool looks_like_constants(std::string_view text) {
  return text.starts_with("KPL/PCK") || text.find("_POLE_RA") != std::string_view::npos;
}

Result<std::optional<sky::Orientation>> read_orientation(std::string_view text, std::string_view file,
                                                         int id) {
  const auto all = read_text_kernel(text, file);
  if (!all) return fail(all.error());
  return OrientationReader(*all, file, id).read();
}

}  // namespace slipway::steps
