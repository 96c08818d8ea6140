// What a diagnosis' report says at its head, of effects, units, options and next drives.

#include "api/report/diagnosis_report.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/json/parse.h"
#include "made_diagnosis.h"

namespace slipway::api {
namespace {

using AReportedDiagnosis = testing::WithFullDiagnosis;

TEST_F(AReportedDiagnosis, IsReportedWithItsRoverGravityAndDates) {
  const std::string undated = diagnosis_report(campaign(), diagnosis(), {}).markdown();
  EXPECT_NE(undated.find("| mer-class (174 kg, 6 wheels) | 3.71 | nominal |"), std::string::npos) << undated;
  EXPECT_NE(undated.find("| 44, from D001 to D044 | not recorded"), std::string::npos) << undated;
  gap::DriveCampaign dated = campaign();
  constexpr double kLanding_s = 1'344'230'220.0;  // 2012-08-06 05:17 UTC
  for (gap::MeasuredDriveSeries& drive : dated.drives)
    for (gap::DriveSample& sample : drive.samples) sample.time_s += kLanding_s;
  EXPECT_NE(diagnosis_report(dated, diagnosis(), {}).markdown().find("| 2012-08-06 05:17 to 2012-08-06 05:"),
            std::string::npos);
}

TEST_F(AReportedDiagnosis, IsReportedWithTheSentenceOfEveryEffectAndUnits) {
  const std::string report = diagnosis_report(campaign(), diagnosis(), {}).markdown();
  for (const char* words : {"| motor_temperature | the motors' torque constant, resistance",
                            "| slip_sinkage | a slipping wheel digs itself in"})
    EXPECT_NE(report.find(words), std::string::npos) << words;
  EXPECT_NE(report.find("| grousers | height_m | 0.01 m |"), std::string::npos) << report;
  gap::Diagnosis pulled = diagnosis();
  std::swap(pulled.residual[0], pulled.residual[1]);  // a cause from outside comes first
  pulled.residual[0].parameters.push_back({"height_m", {0.4, 0.3, 0.5}});
  const std::string of_pull = diagnosis_report(campaign(), pulled, {}).markdown();
  EXPECT_NE(of_pull.find("force_n = -25 (-27 to -23) N, height_m = 0.4 (0.3 to 0.5) m"), std::string::npos)
      << of_pull;
  EXPECT_NE(of_pull.find("it takes away 40 % of the gap that re-tuning leaves"), std::string::npos);
  EXPECT_NE(report.find("centre of mass above where the rover's file has it, m |"), std::string::npos);
}

TEST_F(AReportedDiagnosis, ShowsTheOptionsThatAreNotTheDefaultAlone) {
  const std::string usual = diagnosis_report(campaign(), diagnosis(), {}).html();
  EXPECT_NE(usual.find("has its default"), std::string::npos);
  EXPECT_EQ(usual.find("huber"), std::string::npos);
  gap::DiagnosisOptions options;
  options.fit.huber = 3.0;
  gap::Diagnosis other = diagnosis();
  other.options = gap::listed_options(options);
  EXPECT_NE(diagnosis_report(campaign(), other, {}).markdown().find("| fit | huber | 3 | 4 |"),
            std::string::npos);
}

// A drive of which next to nothing is expected is offered to nobody.
TEST_F(AReportedDiagnosis, OffersNoDriveThatWouldTellNextToNothing) {
  gap::Diagnosis d = diagnosis();
  d.next_drives = {{15.0, 90.0, 0.04, 0.3, -20.0, 0.4}, {5.0, 0.0, 0.04, 0.0, 20.0, 0.01}};
  const auto offered = [&] {
    return json::parse(json::diagnosis_document(campaign(), d)).value().find("next_drives")->elements.size();
  };
  EXPECT_EQ(offered(), 1U);
  d.next_drives.erase(d.next_drives.begin());
  EXPECT_EQ(offered(), 0U);
  const std::string report = diagnosis_report(campaign(), d, {}).markdown();
  EXPECT_NE(report.find("none is expected to bring 0.05 bits"), std::string::npos) << report;
}

}  // namespace
}  // namespace slipway::api
