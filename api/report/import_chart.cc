#include "api/report/import_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "api/chart/chart.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxDrawn = 12;  // drives, beyond which lines hide each other

struct ChannelGroup {
  std::string_view title, axis, ending;
};
constexpr std::array kChannelGroups{ChannelGroup{"Attitude", "roll, pitch, yaw, deg", ""},
                                    ChannelGroup{"Wheel rates", "deg/s", "_rate_deg_s"},
                                    ChannelGroup{"Motor currents", "A", "_current_a"},
                                    ChannelGroup{"Sinkages", "m", "_sinkage_m"}};

bool is_of(const ChannelGroup& group, std::string_view column) {
  if (!group.ending.empty()) return column.ends_with(group.ending);
  return column == "roll_deg" || column == "pitch_deg" || column == "yaw_deg";
}

std::optional<std::size_t> column_place(const ImportedCampaign& campaign, std::string_view column) {
  for (std::size_t c = 0; c < campaign.columns.size(); ++c)
    if (campaign.columns[c].to == column) return c;
  return std::nullopt;
}

Chart map_of(const ImportedCampaign& campaign, std::size_t drawn) {
  Chart chart;
  chart.title = "Drives on the map";
  chart.x.title = "x, m";
  chart.y.title = "y, m";
  const auto x = column_place(campaign, "x_m"), y = column_place(campaign, "y_m");
  for (std::size_t d = 0; x && y && d < drawn; ++d) {
    const ImportedDrive& drive = campaign.drives[d];
    chart.series.push_back({drive.id, ChartMark::kLine, drive.values[*x], drive.values[*y], d});
  }
  return chart;
}

// Of the first drive: one line a column.
Chart group_of(const ImportedCampaign& campaign, const ChannelGroup& group) {
  const ImportedDrive& drive = campaign.drives.front();
  Chart chart;
  chart.title = fmt::format("{}, drive {}", group.title, drive.id);
  chart.x.title = "time, s";
  chart.y.title = group.axis;
  std::size_t colour = 0;
  for (std::size_t c = 0; c < campaign.columns.size(); ++c)
    if (is_of(group, campaign.columns[c].to))
      chart.series.push_back({campaign.columns[c].to,
                              campaign.columns[c].missing > 0 ? ChartMark::kPoints : ChartMark::kLine,
                              drive.time_s, drive.values[c], colour++});
  return chart;
}

}  // namespace

std::string import_chart(const ImportedCampaign& campaign) {
  const std::size_t drawn = std::min(kMaxDrawn, campaign.drives.size());
  std::vector<Chart> charts{map_of(campaign, drawn)};
  for (const ChannelGroup& group : kChannelGroups) {
    Chart chart = group_of(campaign, group);
    if (!chart.series.empty()) charts.push_back(std::move(chart));
  }
  return draw_charts(
      fmt::format("{}: {} of {} drives as they were read", campaign.name, drawn, campaign.drives.size()),
      charts);
}

}  // namespace slipway::api
