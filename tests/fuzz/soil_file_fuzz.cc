// The reader of soil files.

#include <string>

#include "api/files/soil_file.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto soils = api::json::read_soil_file(fuzz::text_of(data, size));
  if (!soils) {
    fuzz::require(!soils.error().detail.empty(), "a refusal says why");
    return 0;
  }
  api::json::Writer writer;
  writer.begin_object().text("format", "soils/1").key("soils").begin_array();
  for (const sim::SoilDistribution& soil : *soils) api::json::write_soil(writer, soil);
  writer.end_array().end_object();
  const std::string written = writer.take();
  const auto again = api::json::read_soil_file(written);
  fuzz::require(again.has_value(), "soils that were read are written as a file that is read", written);
  return 0;
}
