# cmake --install: the program, its data, and the libraries with their headers as the CMake package "slipway".
# Components: tools (the program and its data), research (slipway-study and the data that it compares with), development (the
# libraries), service (see packages.cmake).
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/slipway)
set(rooms core sky dem sim steps planner gap campaign api)

install(TARGETS slipway RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
# The practice campaigns but two, and the scores of sealed campaigns, are the study's.
set(data_of_study gap-practice/p0[234678] "validation/(sealed_.*|worlds_scores.csv)")
list(JOIN data_of_study "|" data_of_study)
install(DIRECTORY data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/slipway/data COMPONENT tools
  REGEX "/data/(${data_of_study})(/|$)" EXCLUDE)
if(SLIPWAY_BUILD_RESEARCH)
  install(TARGETS slipway-study RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT research)
  install(DIRECTORY data/gap-practice data/validation DESTINATION ${CMAKE_INSTALL_DATADIR}/slipway/data COMPONENT research)
endif()
install(FILES README.md CHANGELOG.md LICENSE SECURITY.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT tools)
install(FILES clients/python/slipway_client.py DESTINATION ${CMAKE_INSTALL_DATADIR}/slipway/clients/python COMPONENT tools)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT tools)

# slipway::sim and its neighbours. A header is included as here: #include "sim/soil/soil.h".
add_library(slipway::options ALIAS slipway_options)
set_target_properties(slipway_options PROPERTIES EXPORT_NAME options)
set(targets slipway_options)
foreach(room IN LISTS rooms)
  add_library(slipway::${room} ALIAS slipway_${room})
  set_target_properties(slipway_${room} PROPERTIES EXPORT_NAME ${room})
  list(APPEND targets slipway_${room})
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/slipway COMPONENT development FILES_MATCHING PATTERN "*.h")
endforeach()
install(TARGETS ${targets} EXPORT slipway-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(EXPORT slipway-targets NAMESPACE slipway:: DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(cmake/slipway-config.cmake.in ${PROJECT_BINARY_DIR}/slipway-config.cmake
  INSTALL_DESTINATION ${package_folder} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/slipway-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/slipway-config.cmake ${PROJECT_BINARY_DIR}/slipway-config-version.cmake
  cmake/slipway_ompl.cmake DESTINATION ${package_folder} COMPONENT development)
