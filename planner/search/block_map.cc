#include "planner/search/block_map.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/parallel_for.h"
#include "planner/search/grid_search.h"

namespace slipway::planner {
namespace {

constexpr long long kStripeBlocks = 16;  // rows of blocks that are read at once
// Counter-clockwise, as four steps of GridSearch are: step 4 k leads across side k.
enum Side { kEast, kNorth, kWest, kSouth };
constexpr int kBetweenSamples = 4;
// A node that no cell of the sample is in, or of whose sample no cell can be driven in a direction, costs so
// many times what level ground does.
constexpr float kUnknownFactor = 3.0F, kClosedFactor = 30.0F;
// What a share of closed ground adds: ways around it.
constexpr float kDetour = 1.0F;

}  // namespace

BlockMap::BlockMap(const PlanProblem& problem, const KeepOut& keep_out, Progress& progress)
    : geometry_(finest_geometry(problem.terrain->geometry())),
      problem_(problem),
      keep_out_(keep_out),
      block_rows_(block_rows(geometry_)),
      block_columns_(block_columns(geometry_)),
      blocks_(static_cast<std::size_t>(block_rows_ * block_columns_)),
      sizes_(blocks_.size()) {
  const GroundJudge judge(problem, keep_out, geometry_);
  const long long stripes = (block_rows_ + kStripeBlocks - 1) / kStripeBlocks;
  std::atomic<long long> done{0};
  parallel_for(static_cast<std::size_t>(stripes), problem.threads, [&](std::size_t stripe) {
    if (progress.cancelled()) return;
    const long long first = static_cast<long long>(stripe) * kStripeBlocks;
    read_stripe(problem, judge, first, std::min(kStripeBlocks, block_rows_ - first));
    progress.report("", static_cast<double>(++done) / static_cast<double>(stripes));
  });
  if (progress.cancelled()) return;
  number_nodes();
  join(problem.threads, progress);
}

void BlockMap::read_stripe(const PlanProblem& problem, const GroundJudge& judge, long long first_block_row,
                           long long block_rows) {
  const dem::CellWindow read = judge.rows_of_terrain(first_block_row * kBlockCells, block_rows * kBlockCells);
  const auto part = problem.terrain->part(read);
  if (!part) {
    damaged_ = true;
    return;
  }
  std::array<GroundCell, kBlockCells * kBlockCells> cells;
  Parts parts{};
  for (long long b = first_block_row * block_columns_; b < (first_block_row + block_rows) * block_columns_;
       ++b) {
    Block& block = blocks_[static_cast<std::size_t>(b)];
    const dem::CellWindow window = block_window(geometry_, static_cast<std::uint32_t>(b));
    judge.cells(*part, {read.row, 0}, window, cells.data(), kBlockCells);
    block.parts =
        static_cast<std::uint8_t>(label(cells.data(), window, parts, sizes_[static_cast<std::size_t>(b)]));
    for (int k = 0; k < kBlockCells; ++k) {
      block.edges[kNorth][static_cast<std::size_t>(k)] = parts[k];
      block.edges[kSouth][static_cast<std::size_t>(k)] = parts[(kBlockCells - 1) * kBlockCells + k];
      block.edges[kWest][static_cast<std::size_t>(k)] = parts[k * kBlockCells];
      block.edges[kEast][static_cast<std::size_t>(k)] = parts[k * kBlockCells + kBlockCells - 1];
    }
    for (int k = 0; k < kSamples; ++k) {
      const int at = (k / kBetweenSamples * kBetweenSamples + kBetweenSamples / 2) * kBlockCells +
                     k % kBetweenSamples * kBetweenSamples + kBetweenSamples / 2;
      block.samples[static_cast<std::size_t>(k)] = {cells[at].gradient_x, cells[at].gradient_y,
                                                    cells[at].soil, parts[at]};
    }
  }
}

int BlockMap::label(const GroundCell* cells, const dem::CellWindow& window, Parts& parts,
                    std::vector<std::uint16_t>& sizes) {
  constexpr std::uint8_t kOpen = 255;
  int open = 0;
  parts.fill(0);
  for (int row = 0; row < window.rows; ++row) {
    for (int column = 0; column < window.columns; ++column) {
      const int at = row * kBlockCells + column;
      if (!is_open(cells[at].passage)) continue;
      parts[at] = kOpen;
      ++open;
    }
  }
  sizes.clear();
  if (open == kBlockCells * kBlockCells) {
    parts.fill(1);
    sizes.push_back(static_cast<std::uint16_t>(open));
    return 1;
  }
  std::array<std::uint8_t, kBlockCells * kBlockCells> waiting;
  for (int seed = 0; seed < kBlockCells * kBlockCells; ++seed) {
    if (parts[seed] != kOpen) continue;
    const auto part = static_cast<std::uint8_t>(sizes.size() + 1);
    int count = 0, size = 0;
    parts[seed] = part;
    waiting[count++] = static_cast<std::uint8_t>(seed);
    while (count > 0) {
      const int at = waiting[--count];
      ++size;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) {
          const int row = at / kBlockCells + dr, column = at % kBlockCells + dc;
          if ((dr != 0) == (dc != 0) || row < 0 || column < 0 || row >= kBlockCells || column >= kBlockCells)
            continue;
          const int next = row * kBlockCells + column;
          if (parts[next] != kOpen) continue;
          parts[next] = part;
          waiting[count++] = static_cast<std::uint8_t>(next);
        }
      }
    }
    sizes.push_back(static_cast<std::uint16_t>(size));
  }
  return static_cast<int>(sizes.size());
}

void BlockMap::number_nodes() {
  first_node_.reserve(blocks_.size() + 1);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    first_node_.push_back(static_cast<std::uint32_t>(block_of_.size()));
    block_of_.insert(block_of_.end(), blocks_[b].parts, static_cast<std::uint32_t>(b));
    cells_.insert(cells_.end(), sizes_[b].begin(), sizes_[b].end());
  }
  first_node_.push_back(static_cast<std::uint32_t>(block_of_.size()));
  sizes_ = {};
}

// The nodes across one side of the node's block that its cells touch.
void BlockMap::touching(std::size_t node, int side, std::vector<std::uint32_t>& to) const {
  to.clear();
  const std::uint32_t block = block_of_[node];
  const GridStep& across = kGridDirections[static_cast<std::size_t>(4 * side)];
  const long long row = block / block_columns_ - across.up;
  const long long column = block % block_columns_ + across.right;
  if (row < 0 || column < 0 || row >= block_rows_ || column >= block_columns_) return;
  const auto beside = static_cast<std::uint32_t>(row * block_columns_ + column);
  const auto& ours = blocks_[block].edges[static_cast<std::size_t>(side)];
  const auto& theirs = blocks_[beside].edges[static_cast<std::size_t>((side + 2) % 4)];
  const std::size_t part = node - first_node_[block] + 1;
  std::uint8_t last = 0;
  for (std::size_t k = 0; k < kBlockCells; ++k) {
    if (ours[k] != part || theirs[k] == 0 || theirs[k] == last) continue;
    last = theirs[k];
    const std::uint32_t found = node_of(beside, last);
    if (std::find(to.begin(), to.end(), found) == to.end()) to.push_back(found);
  }
}

void BlockMap::join(std::size_t threads, const Progress& progress) {
  // First over the sides, then what follows from two and from three of these: the steps of GridSearch.
  std::vector<std::vector<Edge>> found(static_cast<std::size_t>(block_rows_));
  std::vector<std::uint32_t> counts(nodes() + 1, 0);
  parallel_for(static_cast<std::size_t>(block_rows_), threads, [&](std::size_t row) {
    if (progress.cancelled()) return;
    const auto first_block = row * static_cast<std::size_t>(block_columns_);
    const std::uint32_t from = first_node_[first_block];
    const std::uint32_t to = first_node_[first_block + static_cast<std::size_t>(block_columns_)];
    std::vector<std::uint32_t> first, second, third;
    for (std::uint32_t node = from; node < to; ++node) {
      const std::size_t begun = found[row].size();
      const auto add = [&](std::uint32_t target, int step) {
        for (std::size_t k = begun; k < found[row].size(); ++k)
          if (found[row][k].to == target) return;
        found[row].push_back({target, static_cast<std::uint8_t>(step)});
      };
      for (int a = 0; a < 4; ++a) {
        touching(node, a, first);
        for (const std::uint32_t p : first) add(p, 4 * a);
        for (const std::uint32_t p : first) {
          for (int b = 0; b < 4; ++b) {
            // Turned by a right angle: the diagonal between both.
            const int turn = (b - a + 4) % 4, aside = turn == 1 ? 1 : kGridSteps - 1;
            if (turn % 2 == 0) continue;
            touching(p, b, second);
            for (const std::uint32_t q : second) {
              add(q, (4 * a + 2 * aside) % kGridSteps);
              touching(q, a, third);
              for (const std::uint32_t r : third) add(r, (4 * a + aside) % kGridSteps);
            }
          }
        }
      }
      counts[node + 1] = static_cast<std::uint32_t>(found[row].size() - begun);
    }
  });
  if (progress.cancelled()) return;
  first_edge_ = std::move(counts);
  for (std::size_t n = 1; n < first_edge_.size(); ++n) first_edge_[n] += first_edge_[n - 1];
  edges_.reserve(first_edge_.back());
  for (std::vector<Edge>& row : found) {
    edges_.insert(edges_.end(), row.begin(), row.end());
    row = {};
  }
}

Eigen::Vector2d BlockMap::centre_m(std::uint32_t block) const {
  const dem::CellWindow w = block_window(geometry_, block);
  return 0.5 * (geometry_.centre_m({w.row, w.column}) +
                geometry_.centre_m({w.row + w.rows - 1, w.column + w.columns - 1}));
}

std::optional<std::uint32_t> BlockMap::node_at(double x_m, double y_m) const {
  const long long cell = grid_index(geometry_, x_m, y_m);
  if (cell < 0) return std::nullopt;
  const long long row = cell / geometry_.columns, column = cell % geometry_.columns;
  const std::uint32_t block = block_at(geometry_, row, column);
  // The parts of a block are not kept: they are found anew, in the same order.
  const GroundJudge judge(problem_, keep_out_, geometry_);
  const dem::CellWindow window = block_window(geometry_, block);
  std::array<GroundCell, kBlockCells * kBlockCells> cells;
  judge.cells(*problem_.terrain, {0, 0}, window, cells.data(), kBlockCells);
  Parts parts{};
  std::vector<std::uint16_t> sizes;
  label(cells.data(), window, parts, sizes);
  const std::uint8_t part =
      parts[static_cast<std::size_t>(row % kBlockCells * kBlockCells + column % kBlockCells)];
  if (part == 0 || part > blocks_[block].parts) return std::nullopt;
  return node_of(block, part);
}

std::array<float, 8> BlockMap::costs(std::size_t node, const MotionCost& cost) const {
  const Block& block = blocks_[block_of_[node]];
  const std::size_t part = node - first_node_[block_of_[node]] + 1;
  const float closed = 1.0F - static_cast<float>(cells_[node]) / (kBlockCells * kBlockCells);
  std::array<float, 8> all{};
  for (std::size_t k = 0; k < 8; ++k) {
    const Eigen::Vector2d& driven_in = GridSearch::direction(static_cast<int>(2 * k));
    float sum = 0.0F;
    int driven = 0, sampled = 0;
    std::uint8_t soil = kUnknownSoil;
    for (const Sample& sample : block.samples) {
      if (sample.part != part) continue;
      ++sampled;
      soil = sample.soil;
      const auto metre = static_cast<float>(cost.per_metre_on(
          sample.soil, {sample.gradient_x, sample.gradient_y}, driven_in.x(), driven_in.y()));
      if (!std::isfinite(metre)) continue;
      sum += metre;
      ++driven;
    }
    const auto level = static_cast<float>(
        cost.per_metre_on(sampled > 0 ? soil : kUnknownSoil, {0.0, 0.0}, driven_in.x(), driven_in.y()));
    float metre = level * (sampled > 0 ? kClosedFactor : kUnknownFactor);
    if (driven > 0) {
      const float held = 1.0F - static_cast<float>(driven) / static_cast<float>(sampled);
      metre = sum / static_cast<float>(driven) * (1.0F + kDetour * (closed + 3.0F * held));
    }
    all[k] = std::isfinite(metre) ? metre : 1e6F;
  }
  return all;
}

}  // namespace slipway::planner
