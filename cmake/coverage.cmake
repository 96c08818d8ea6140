# With SLIPWAY_COVERAGE: the branches of what judges a drive and of the jobs' store are counted (tests/coverage.sh). Each of these
# sources is compiled alone and as it is written. All else is what preset check makes of it.
file(GLOB covered_store CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/api/jobs/*.cc)
list(FILTER covered_store EXCLUDE REGEX "/(job_runner|job_progress|job_batch|work_in_parts)\\.cc$")  # what works on jobs
function(slipway_cover target)
  foreach(source IN LISTS ARGN)
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES SLIPWAY_COVERED ON SKIP_PRECOMPILE_HEADERS ON
      COMPILE_OPTIONS "-O0;--coverage;-fprofile-update=atomic")
  endforeach()
endfunction()
slipway_cover(slipway_sim ${PROJECT_SOURCE_DIR}/sim/prediction/rule_catalogue.cc ${PROJECT_SOURCE_DIR}/sim/prediction/drive_outcome.cc)
slipway_cover(slipway_planner ${PROJECT_SOURCE_DIR}/planner/judge/drive_verdict.cc ${PROJECT_SOURCE_DIR}/planner/judge/verdict_words.cc)
slipway_cover(slipway_api ${covered_store})
target_link_options(slipway_options INTERFACE $<BUILD_INTERFACE:--coverage>)
