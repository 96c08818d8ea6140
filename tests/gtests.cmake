# What ctest runs of a program of GoogleTest.
#
#   slipway_gtests(PROGRAM [LABEL unit] [TIMEOUT seconds] [COST n] [SHARDS n] [LEAVE_OUT pattern]
#                  [ONLY_FULL test...] [LARGER_IN_FULL test...])
#
# Each test is an entry of its own; with SHARDS the program runs that many times, each time with its share of the tests, which
# pays where it takes longer to start than most of its tests take. A shard is run alone by GTEST_TOTAL_SHARDS and
# GTEST_SHARD_INDEX, a test of it by the program's --gtest_filter.
# LEAVE_OUT: a pattern of tests that are registered elsewhere.
# ONLY_FULL: tests that run with `ctest -C full` alone.
# LARGER_IN_FULL: tests that ask full_size() of tests/full_size.h; every run has them small, -C full the whole of them too.
# CONTRIBUTING.md says what holds in every run what the larger ones hold. A name that is no test's fails there.
include(GoogleTest)

function(slipway_gtests program)
  cmake_parse_arguments(arg "" "LABEL;TIMEOUT;COST;SHARDS;LEAVE_OUT" "ONLY_FULL;LARGER_IN_FULL" ${ARGN})
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "slipway_gtests(${program}): ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT arg_LABEL)
    set(arg_LABEL unit)
  endif()
  set(properties LABELS ${arg_LABEL})
  foreach(property TIMEOUT COST)
    if(arg_${property})
      list(APPEND properties ${property} ${arg_${property}})
    endif()
  endforeach()

  list(JOIN arg_ONLY_FULL ":" left_out)
  if(arg_LEAVE_OUT)
    string(JOIN ":" left_out ${left_out} ${arg_LEAVE_OUT})
  endif()
  set(filter "*")
  if(left_out)
    set(filter "-${left_out}")
  endif()
  if(arg_SHARDS)
    math(EXPR last "${arg_SHARDS} - 1")
    foreach(shard RANGE ${last})
      set(name ${program}_${shard})
      add_test(NAME ${name} COMMAND ${program} --gtest_brief=1 "--gtest_filter=${filter}")
      set_tests_properties(${name} PROPERTIES ${properties}
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${arg_SHARDS};GTEST_SHARD_INDEX=${shard}")
    endforeach()
  else()
    gtest_discover_tests(${program} DISCOVERY_TIMEOUT 60 TEST_FILTER "${filter}" PROPERTIES ${properties})
  endif()

  foreach(test IN LISTS arg_ONLY_FULL arg_LARGER_IN_FULL)
    set(name ${program}_full:${test})
    add_test(NAME ${name} CONFIGURATIONS full COMMAND ${program} "--gtest_filter=${test}")
    set_tests_properties(${name} PROPERTIES LABELS full TIMEOUT 1800 ENVIRONMENT "SLIPWAY_FULL_SIZE=1"
      FAIL_REGULAR_EXPRESSION "Running 0 tests")
  endforeach()
endfunction()
