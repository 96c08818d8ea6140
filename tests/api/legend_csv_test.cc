#include "api/files/legend_csv.h"

#include <gtest/gtest.h>

#include <string>

#include "api/files/commands_csv.h"
#include "api/files/soil_tests_csv.h"

namespace slipway::api {
namespace {

TEST(LegendCsv, EveryWayToWriteItIsTheSameLegend) {
  for (const std::string& text : std::vector<std::string>{
           "value,label,soil,rock_share\n1,plain,sand,0.25\n2,dune,,\n",
           "value;label;soil;rock_share\r\n1;plain;sand;0,25\r\n2;dune;;\r\n",
           "\xEF\xBB\xBFsep=;\nvalue;label;soil;rock_share;\n1.0;\"plain\";sand;0.25;\n2.0;dune;N/"
           "A;-;\n;;;;\n",
           "label\tvalue\trock_share\tsoil\nplain\t1\t0.25\tsand\ndune\t2\tNULL\tNone\n"}) {
    const auto legend = read_legend_table(text, "legend.csv", false);
    ASSERT_TRUE(legend) << text << (legend ? "" : legend.error().detail);
    ASSERT_EQ(legend->classes.size(), 2U) << text;
    EXPECT_EQ(legend->classes[0].value, 1) << text;
    EXPECT_EQ(legend->classes[0].label, "plain") << text;
    EXPECT_EQ(legend->classes[0].soil, "sand") << text;
    EXPECT_EQ(legend->classes[0].rock_share, 0.25) << text;
    EXPECT_EQ(legend->classes[1].value, 2) << text;
    EXPECT_FALSE(legend->classes[1].soil) << text;
    EXPECT_FALSE(legend->classes[1].rock_share) << text;
  }
}

TEST(LegendCsv, FaultsNameLineAndColumn) {
  const auto legend =
      read_legend_table("value;label;soil\n1.5;plain;sand\nx;;sand\n3;rock\n", "l.csv", false);
  ASSERT_FALSE(legend);
  std::vector<std::string> places;
  for (const Fault& fault : legend.error().faults) places.push_back(fault.pointer);
  EXPECT_EQ(places,
            (std::vector<std::string>{"l.csv, line 2, column 1 (value)", "l.csv, line 3, column 1 (value)",
                                      "l.csv, line 3, column 2 (label)", "l.csv, line 4"}));
  EXPECT_FALSE(read_legend_table("", "l.csv", false));
  EXPECT_FALSE(read_legend_table("label,soil\nplain,sand\n", "l.csv", false));
  const auto units = read_legend_table("label,soil\n1.0,sand\n07,rock\n", "l.csv", true);
  ASSERT_TRUE(units);
  EXPECT_EQ(units->classes[0].label, "1");
  EXPECT_EQ(units->classes[1].label, "07");
}

TEST(TablesOfTests, AreTakenWithSemicolonsAndDecimalCommas) {
  const auto wheel = read_wheel_tests_csv(
      "a.csv", "load_n;slip_ratio;torque_nm;sinkage_m\n60,5;0,1;1,5;nan\n61;0,2;1,75;0,01\n");
  ASSERT_TRUE(wheel);
  EXPECT_EQ((*wheel)[0].test.load_n, 60.5);
  EXPECT_EQ((*wheel)[1].readings[0].value, 1.75);
  const auto plate =
      read_plate_tests_csv("p.csv", "plate_radius_m\tsinkage_m\tpressure_pa\n0.1\t0.01\t500\n");
  ASSERT_TRUE(plate);
  EXPECT_EQ((*plate)[0].pressure_pa.at(0), 500.0);
}

TEST(CommandsCsv, AreTakenWithSemicolonsAndDecimalCommas) {
  const auto table = read_commands_csv(
      "# start_x_m: 10\n# start_y_m: 20\n# start_yaw_deg: "
      "90\ncommand;value;radius_m\ndrive;10,25;\narc;3,5;-6,0\n",
      "c.csv");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->commands[0].drive_m, 10.25);
  EXPECT_EQ(table->commands[1].radius_m, -6.0);
  EXPECT_EQ(table->lines[1], 6U);
}

}  // namespace
}  // namespace slipway::api
