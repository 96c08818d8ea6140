# Debian packages by CPack: slipway (the program and its data) and slipway-service (units of systemd, the user
# slipway, configuration). deploy/package.sh builds both.
set(SLIPWAY_PACKAGE_REVISION 1 CACHE STRING "What follows the version in the name of a Debian package")
set(units slipway.service slipway-worker@.service)
list(TRANSFORM units PREPEND deploy/systemd/)
# Absolute, and of the packages alone: cmake --install leaves them out.
install(FILES ${units} DESTINATION /usr/lib/systemd/system COMPONENT service EXCLUDE_FROM_ALL)
install(FILES deploy/debian/slipway.toml deploy/debian/worker.toml DESTINATION /etc/slipway
  COMPONENT service EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL tools service)
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# The list of parts is made while the package is.
set(CPACK_SLIPWAY_PARTS /usr/bin/python3 -B ${PROJECT_SOURCE_DIR}/deploy/parts.py ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR})
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_parts.cmake)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_RELEASE ${SLIPWAY_PACKAGE_REVISION})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The Slipway maintainers <maintainers@localhost>")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME slipway)
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "It plans routes over elevation and soil maps, predicts slip, sinkage, motor
current and risk along them, and diagnoses where predictions and drives part.")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
# proj.db has the systems that maps are in.
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS proj-data)
set(CPACK_DEBIAN_SERVICE_PACKAGE_NAME slipway-service)
set(CPACK_COMPONENT_SERVICE_DESCRIPTION "The HTTP service and its workers: slipway serve as the user slipway, under
systemd where there is one.")
set(CPACK_DEBIAN_SERVICE_PACKAGE_DEPENDS
  "slipway (= ${PROJECT_VERSION}-${SLIPWAY_PACKAGE_REVISION}), adduser")
set(CPACK_DEBIAN_SERVICE_PACKAGE_CONTROL_STRICT_PERMISSION ON)
foreach(script conffiles postinst prerm postrm)
  list(APPEND CPACK_DEBIAN_SERVICE_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/deploy/debian/${script})
endforeach()
include(CPack)
