#pragma once

#include <boost/container/static_vector.hpp>

namespace slipway::sim {

// The most wheels a rover may have: what the solvers set room aside for.
constexpr int kMaxWheels = 12;

// One value for each wheel of a rover, in the order of its wheels: as many as the rover has, kept in place so
// that nothing is allocated in a solver's loop, nor set up for wheels that the rover hasn't.
template <class T>
using PerWheel = boost::container::static_vector<T, kMaxWheels>;

}  // namespace slipway::sim
