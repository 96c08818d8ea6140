#include "research/validation/laboratory/fit_words.h"

#include <fmt/format.h>

namespace slipway::validation {

std::string words_of(std::span<const gap::Unknown> unknowns, const gap::LeastSquaresFit& fit) {
  std::string text;
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    const auto error = fit.standard_error(k);
    text += fmt::format("{}{} {:.3g}{}{}", k == 0 ? "" : ", ", unknowns[k].name, fit.estimate[k],
                        error ? fmt::format(" +- {:.2g}", *error) : " (undetermined)",
                        fit.on_bound[k] ? " (at its bound)" : "");
  }
  return text;
}

}  // namespace slipway::validation
