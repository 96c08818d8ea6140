#pragma once

#include <string>
#include <unordered_map>
#include <vector>

namespace slipway::dem {

// A stretch of one height that ground hardly has: a fill or a collar that the file does not declare.
struct ConstantHeight {
  float height_m = 0.0F;
  long long cells = 0;
  int row = 0, column = 0;  // of the cell beside its highest step, or of its first cell
  double step_m = 0.0;      // the highest at its edge
  bool is_cliff = false;    // most of its edge is one
};

// Looks at the rows of a map from north to south, and keeps a few of them.
class HeightCensus {
 public:
  // cell_m: the shorter side of a cell. quantum_m: what two heights differ by at least, 0 of floats: terraces
  // of rounded heights are no cliffs.
  HeightCensus(int columns, double cell_m, double quantum_m);

  // Cells that are `none` have no height.
  void add_row(const float* heights_m, float none);
  // After the last row: heights with a cliff along their edge, and heights that more than a fifth of the
  // cells have; not where the whole map is one height. The commonest first, at most four.
  std::vector<ConstantHeight> findings();

 private:
  struct Seen {
    ConstantHeight height;
    long long edges = 0, steep = 0;
  };
  struct Row {
    std::vector<float> heights_m;
    std::vector<char> is_constant;  // has a neighbour of the same height
  };

  void finish_middle_row();
  void look_at_edge(const Row& at, int column, float beside_m, int row);
  void look_at_step(const Row& one, int column, const Row& other, int other_column, int row, int other_row);
  bool is_cliff(const Seen& seen) const;

  int columns_;
  double cell_m_, quantum_m_;
  float none_ = 0.0F;
  int rows_ = 0;               // that were added
  Row above_, middle_, last_;  // the last row has no flags yet
  std::unordered_map<float, Seen> seen_;
  long long heights_ = 0, steps_ = 0;
  double sum_of_steps_m_ = 0.0;
  bool is_flat_ = true;
  float first_m_ = 0.0F;
};

}  // namespace slipway::dem
