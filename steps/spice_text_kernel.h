#pragma once

#include <cstddef>
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

using KernelAssignments = std::map<std::string, KernelValues>;

// The assignments between \begindata and \begintext, by NAIF's "Kernel Required Reading": NAME = value or
// NAME = ( values ), and += to append. The words point into the text. Errors: unreadable_data with the line.
Result<KernelAssignments> read_text_kernel(std::string_view text, std::string_view file);

// A word as a number; SPICE writes exponents with E or D. Nothing where it is no finite number.
bool kernel_number(std::string_view word, double& value);

// The numbers of a name, of which there must be `least` or more. Errors: unreadable_data with the line, or
// with the name where the kernel has none.
Result<std::vector<double>> kernel_numbers(const KernelAssignments& all, std::string_view file,
                                           const std::string& name, std::size_t least);

}  // namespace slipway::steps
