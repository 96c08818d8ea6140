#include "research/validation/laboratory/sandbox_plates.h"

#include "research/validation/report/csv_table.h"

namespace slipway::validation {

Result<std::vector<SandboxTest>> load_sandbox_plates(const std::filesystem::path& csv) {
  const auto table = CsvTable::read(csv, {.numbers = {"plate_diameter_mm", "sinkage_m", "pressure_kPa"},
                                          .numbers_or_empty = {},
                                          .texts = {"test"}});
  if (!table) return fail(table.error());
  std::vector<SandboxTest> tests;
  for (std::size_t k = 0; k < table->rows(); ++k) {
    if (tests.empty() || tests.back().name != table->text(k, "test"))
      tests.push_back({table->text(k, "test"), {0.5e-3 * table->number(k, "plate_diameter_mm"), {}, {}}});
    tests.back().plate.sinkage_m.push_back(table->number(k, "sinkage_m"));
    tests.back().plate.pressure_pa.push_back(1e3 * table->number(k, "pressure_kPa"));
  }
  return tests;
}

}  // namespace slipway::validation
