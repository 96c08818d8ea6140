// answers.json in, scores out.
#include <gtest/gtest.h>

#include "api/json/parse.h"
#include "research/documents/benchmark_document.h"
#include "research/documents/benchmark_report.h"
#include "research/documents/search_record_document.h"
#include "research/sealed_set/benchmark_answers.h"

namespace slipway::api {
namespace {

TEST(BenchmarkAnswers, HasTheEffectsAndWhatIsKnownOfThem) {
  const auto answers = json::read_benchmark_answers(
      R"({"s01": {"soil": "drift", "effects": {"soft_patch": {"x_m": 1}}, "fidelity": "L2", "size": 2,
                  "nominal": "far", "place": {"x_m": 1, "y_m": -2, "radius_m": 2.5}},
          "s02": {"effects": {}}})");
  ASSERT_TRUE(answers);
  ASSERT_EQ(answers->size(), 2u);
  EXPECT_EQ((*answers)[0].effects, std::set<std::string>{"soft_patch"});
  EXPECT_EQ((*answers)[0].nominal_off, true);
  ASSERT_TRUE((*answers)[0].place);
  EXPECT_EQ((*answers)[0].place->y_m, -2.0);
  EXPECT_TRUE((*answers)[1].effects.empty());
  EXPECT_FALSE((*answers)[1].nominal_off);
}

TEST(BenchmarkAnswers, NamesEveryFault) {
  const auto answers = json::read_benchmark_answers(R"({"s01": {"size": "big"}, "s02": {"effects": 3}})");
  ASSERT_FALSE(answers);
  EXPECT_EQ(answers.error().faults.size(), 3u);
  EXPECT_FALSE(json::read_benchmark_answers("[]"));
}

// A decision that is made again from what was written is the one that was made.
TEST(SearchRecordDocument, IsReadAsItWasWritten) {
  gap::Diagnosis diagnosis;
  gap::SearchRecord& record = diagnosis.search;
  record.with_reference = record.drives_changed = true;
  record.drives = 5;
  record.windows = 40;
  record.explanations = {{.effects = {"hardpan"},
                          .outside = {"load"},
                          .with_unknown = true,
                          .fit = 1,
                          .log_evidence = 12.5,
                          .log_prior = -3.25,
                          .other_variants = {{-1.5, -4.0}, {}}},
                         {.effects = {}, .outside = {}, .log_prior = -1.0, .other_variants = {}}};
  record.fits = {{.held_out_rms = 2.5, .shifts = {{"c1", 1.5, true}, {"n", -0.5, false}}},
                 {.held_out_rms = 1.25, .shifts = {}}};
  record.causes = {{"hardpan", 0.75}, {"load", 0.125}};
  record.scatter_deviations = {0.5, -1.0};
  record.parameters_gain = 4.5;
  record.hidden_share = 0.25;
  const std::string written = json::search_record_document(diagnosis);
  const auto read = json::read_search_record(written, "s01.json");
  ASSERT_TRUE(read) << read.error().detail;
  gap::Diagnosis again;
  again.search = *read;
  EXPECT_EQ(json::search_record_document(again), written);
  EXPECT_EQ(read->explanations[0].other_variants, record.explanations[0].other_variants);
  EXPECT_FALSE(json::read_search_record("{}", "s01.json"));
}

TEST(BenchmarkDocument, IsOneDocumentWithFiguresForEachFidelity) {
  gap::Benchmark benchmark{.variant = "as-is", .cases = {}, .withheld = {}};
  gap::CaseScore score;
  score.campaign = "s01";
  score.truth = score.found = "hardpan";
  score.truth_kind = gap::TruthKind::kEffects;
  score.fidelity = "L2";
  score.exact = score.alike = true;
  benchmark.cases.push_back(score);
  const auto document = json::parse(json::benchmark_document(benchmark));
  ASSERT_TRUE(document);
  const json::JsonValue* group = document->find("figures")->find("L2");
  ASSERT_NE(group, nullptr);
  EXPECT_EQ(group->find("exact")->find("hits")->number, 1.0);
  EXPECT_NE(benchmark_report(benchmark).find("| hardpan | hardpan |"), std::string::npos);
}

TEST(BenchmarkCsv, HasALineForEachMarginalAndForEachEffectWithheld) {
  gap::Benchmark benchmark{.variant = "as-is", .cases = {{}}, .withheld = {{}}};
  gap::CaseScore& score = benchmark.cases.front();
  score.campaign = "s01";
  score.fidelity = "L2";
  score.marginals = {{{0.97, true}, "hardpan", 0.8}, {{0.1, false}, "multipass", 0.0}};
  EXPECT_EQ(marginals_csv(benchmark, "blind-1"),
            "set,variant,campaign,fidelity,effect,probability,closed_share,hidden\n"
            "blind-1,as-is,s01,L2,hardpan,0.97,0.8,1\nblind-1,as-is,s01,L2,multipass,0.1,0,0\n");
  gap::WithheldScore& withheld = benchmark.withheld.front();
  withheld.campaign = "s01";
  withheld.withheld = "hardpan";
  withheld.absorbed = withheld.declared = true;
  EXPECT_TRUE(withheld_csv(benchmark, "blind-1").ends_with("blind-1,as-is,s01,hardpan,,,,0,0,1,1\n"));
}

}  // namespace
}  // namespace slipway::api
