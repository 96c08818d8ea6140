#pragma once

#include <string>

#include "api/chart/report_page.h"
#include "gap/diagnosis/diagnosis.h"

namespace slipway::api {

// Sections of a diagnosis' report that tables of the program's catalogues go into.

// Which rover drove where and when: rover, gravity, soils, terrains, drives with their dates where the
// recorded times are seconds since 1970.
void write_what_was_driven(ReportPage& page, const gap::DriveCampaign& campaign);

// The effects found, each with its sentence from the catalogue and its parameters with their units.
void write_found_effects(ReportPage& page, const gap::Diagnosis& d);

// The parameters that were re-tuned, each with its meaning. Their picture is not in it.
void write_retuned(ReportPage& page, const gap::Diagnosis& d);

// What is left that nobody has named, and what of a small effect would have been seen.
void write_unknown(ReportPage& page, const gap::Diagnosis& d);

// Drives that would tell most, or that none would tell enough to be proposed.
void write_next_drives(ReportPage& page, const gap::Diagnosis& d);

// The options that are not at their defaults, and all of them folded.
void write_options(ReportPage& page, const gap::Diagnosis& d);

}  // namespace slipway::api
