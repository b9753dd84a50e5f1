# Command lines are parsed once: sanitized builds need not spend a tenth of their time on optimising that.
function(convexcut_commands_options name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O0>)
endfunction()

# convexcut_library(NAME SOURCES a.cpp b.cpp LIBS x y): a static library of this project. Headers are
# included by their path from the root: #include "core/clock/hour_clock.hpp". Reading headers is most of what a file
# costs to compile, so with CONVEXCUT_UNITY it is done once for six files; APART: not here, as files share local names or
# are compiled once for each instruction set. COMMANDS: parses command lines.
function(convexcut_library name)
  cmake_parse_arguments(ARG "APART;COMMANDS" "" "SOURCES;LIBS;PRIVATE_LIBS" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    convexcut_compiler_options(${name} PRIVATE)
    target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} PUBLIC ${ARG_LIBS} PRIVATE ${ARG_PRIVATE_LIBS})
    if(ARG_COMMANDS)
      convexcut_commands_options(${name})
      convexcut_precompile(${name} commands)
    else()
      convexcut_precompile(${name} library)
    endif()
    if(CONVEXCUT_UNITY AND NOT ARG_APART)
      set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
      # The compiler takes a file that is included for a header, whose local types should not be members.
      target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    endif()
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} INTERFACE ${ARG_LIBS})
  endif()
endfunction()

function(convexcut_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  convexcut_compiler_options(${name} PRIVATE)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS})
endfunction()

# What is tested is optimised as ever; the tests themselves would spend half of a build on it.
function(convexcut_test_options name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CONFIG:RelWithDebInfo>:-O0>)
endfunction()

# convexcut_test(NAME SOURCES ... LIBS ... LABELS ...): one GoogleTest program. Each TEST is a ctest of its own, or
# without CONVEXCUT_CASES the program is one; labels: `threads`: worth running under ThreadSanitizer; `programs`: runs
# the programs in real time, always case by case so that they wait beside each other. OPTIMISED: in sanitized builds too.
function(convexcut_test name)
  cmake_parse_arguments(ARG "OPTIMISED" "" "SOURCES;LIBS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  convexcut_compiler_options(${name} PRIVATE)
  if(ARG_OPTIMISED)
    target_compile_options(${name} PRIVATE -O1)
  else()
    convexcut_test_options(${name})
    convexcut_precompile(${name} test)
  endif()
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  # SYSTEM silences nothing of ours: GoogleTest's own macros are what -Wconversion would flag.
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} convexcut_test_support GTest::gmock GTest::gtest_main)
  # Headers are most of what a test file costs to compile: read once for eight files. Names at
  # namespace scope have to differ within a test program therefore.
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests
                                           UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  if("threads" IN_LIST ARG_LABELS)
    add_dependencies(threads_tests ${name})
  endif()
  if(CONVEXCUT_CASES OR "programs" IN_LIST ARG_LABELS)
    gtest_discover_tests(${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
                         PROPERTIES TIMEOUT 300 LABELS "${ARG_LABELS}"
                         ENVIRONMENT CONVEXCUT_TEST_PERCENT=${CONVEXCUT_TEST_PERCENT})
  else()
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES TIMEOUT 600 LABELS "${ARG_LABELS}"
                         ENVIRONMENT CONVEXCUT_TEST_PERCENT=${CONVEXCUT_TEST_PERCENT})
  endif()
endfunction()

# convexcut_fuzz(NAME SOURCES ... LIBS ...): one libFuzzer target.
function(convexcut_fuzz name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  convexcut_compiler_options(${name} PRIVATE)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS})
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  add_dependencies(fuzz_targets ${name})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/fuzz)
endfunction()
