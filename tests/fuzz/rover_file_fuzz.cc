// The reader of rover files.

#include "api/files/rover_file.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto rover = api::json::read_rover_file(fuzz::text_of(data, size));
  if (!rover) {
    fuzz::require(!rover.error().detail.empty(), "a refusal says why");
    return 0;
  }
  api::json::Writer writer;
  api::json::write_rover(writer, *rover);
  const std::string written = writer.take();
  const auto again = api::json::read_rover_file(written);
  fuzz::require(again.has_value(), "a rover that was read is written as a file that is read", written);
  return 0;
}
