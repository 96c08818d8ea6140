#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

// What each fuzz target defines: libFuzzer calls it, and so does fuzz_driver.cc where g++ compiles.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace slipway::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// A promise of a reader. Where it is broken, the sentence is printed and the process aborts, which is a
// finding.
void require(bool holds, const char* promise, std::string_view what = {});

// An input for a reader that takes a file. One path serves the whole process and goes away with it.
std::filesystem::path as_file(std::string_view bytes, const char* name);

}  // namespace slipway::fuzz
