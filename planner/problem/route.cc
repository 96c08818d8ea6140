#include "planner/problem/route.h"

namespace slipway::planner {

std::string_view describe(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGo:
      return "go";
    case Verdict::kCaution:
      return "caution";
    case Verdict::kNoGo:
      return "no_go";
  }
  return "no_go";
}

}  // namespace slipway::planner
