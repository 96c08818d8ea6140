# OMPL's own package files name Boost and ODE parts that the library does not need and pull in another C++
# standard, so the library and its headers are found by hand. Its headers need Boost's.
find_path(OMPL_INCLUDE_DIR ompl/config.h PATH_SUFFIXES ompl-1.5 ompl-1.6 ompl REQUIRED)
find_library(OMPL_LIBRARY ompl REQUIRED)
find_package(Boost 1.74 REQUIRED)
add_library(slipway_ompl UNKNOWN IMPORTED)
set_target_properties(slipway_ompl PROPERTIES
  IMPORTED_LOCATION ${OMPL_LIBRARY}
  INTERFACE_INCLUDE_DIRECTORIES "${OMPL_INCLUDE_DIR}")
target_link_libraries(slipway_ompl INTERFACE Boost::headers Eigen3::Eigen)
