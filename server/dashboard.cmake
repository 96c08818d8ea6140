# The dashboard is part of the program: dashboard/dist, built by dashboard/build.sh, is taken in as it is. A new file there is seen
# by the next build.
set(dashboard_folder ${PROJECT_SOURCE_DIR}/dashboard/dist)
file(GLOB_RECURSE dashboard_names CONFIGURE_DEPENDS RELATIVE ${dashboard_folder} ${dashboard_folder}/*)
list(FILTER dashboard_names EXCLUDE REGEX "^sources\\.sha256$")
list(SORT dashboard_names)
set(SLIPWAY_DASHBOARD_ASSEMBLY "")
set(SLIPWAY_DASHBOARD_SYMBOLS "")
set(SLIPWAY_DASHBOARD_ROWS "")
set(dashboard_paths "")
set(SLIPWAY_DASHBOARD_COUNT 0)
foreach(name IN LISTS dashboard_names)
  set(k ${SLIPWAY_DASHBOARD_COUNT})
  string(APPEND SLIPWAY_DASHBOARD_ASSEMBLY
    "asm(\".section .rodata\\n.global slipway_dashboard_${k}\\nslipway_dashboard_${k}:\\n\"\n"
    "    \".incbin \\\"${dashboard_folder}/${name}\\\"\\n.global slipway_dashboard_${k}_end\\nslipway_dashboard_${k}_end:\\n.byte 0\\n.previous\\n\");\n")
  string(APPEND SLIPWAY_DASHBOARD_SYMBOLS
    "extern const char slipway_dashboard_${k}[];\nextern const char slipway_dashboard_${k}_end[];\n")
  string(APPEND SLIPWAY_DASHBOARD_ROWS
    "      {\"${name}\", {slipway_dashboard_${k}, static_cast<std::size_t>(slipway_dashboard_${k}_end - slipway_dashboard_${k})}},\n")
  list(APPEND dashboard_paths ${dashboard_folder}/${name})
  math(EXPR SLIPWAY_DASHBOARD_COUNT "${k} + 1")
endforeach()
set(SLIPWAY_DASHBOARD_SOURCE ${CMAKE_CURRENT_BINARY_DIR}/dashboard_files.cc)
configure_file(dashboard_files.cc.in ${SLIPWAY_DASHBOARD_SOURCE} @ONLY)
set_source_files_properties(${SLIPWAY_DASHBOARD_SOURCE} PROPERTIES OBJECT_DEPENDS "${dashboard_paths}" SKIP_UNITY_BUILD_INCLUSION ON)
