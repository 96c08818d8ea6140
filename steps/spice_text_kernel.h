#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace slipway::steps {

// What is assigned to a name in a text kernel: words as they stand there, strings without their quotes.
struct KernelValues {
  std::vector<std::string_view> words;
  std::size_t line = 0;  // of the assignment, from 1
};

// The assignments between \begindata and \begintext, by NAIF's "Kernel Required Reading": NAME = value or
// NAME = ( values ), and += to append. The words point into the text. Errors: unreadable_data with the line.
Result<std::map<std::string, KernelValues>> read_text_kernel(std::string_view text, std::string_view file);

// A word as a number; SPICE writes exponents with E or D. Nothing where it is no finite number.
bool kernel_number(std::string_view word, double& value);

}  // namespace slipway::steps
