# Headers of other libraries, read once instead of in each file: with CONVEXCUT_UNITY only, so that a build without it
# finds what a file forgot to include. convexcut_precompile(TARGET KIND): KIND is library, commands or test.
set(CONVEXCUT_STANDARD_HEADERS
    <algorithm> <array> <atomic> <bit> <charconv> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional>
    <limits> <map> <memory> <numeric> <optional> <span> <sstream> <stdexcept> <string> <string_view> <system_error>
    <thread> <utility> <vector>)

# A target that is compiled like those that reuse its headers, or the compiler would refuse them.
function(convexcut_headers name)
  cmake_parse_arguments(ARG "TEST;COMMANDS" "" "HEADERS;LIBS" ${ARGN})
  set(source ${CMAKE_BINARY_DIR}/${name}.cpp)
  if(ARG_TEST)  # programs are compiled with -fPIE, libraries with -fPIC
    file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
    add_executable(${name} EXCLUDE_FROM_ALL ${source})
    convexcut_test_options(${name})
  else()
    file(CONFIGURE OUTPUT ${source} CONTENT "")
    add_library(${name} OBJECT EXCLUDE_FROM_ALL ${source})
  endif()
  if(ARG_COMMANDS)
    convexcut_commands_options(${name})
  endif()
  convexcut_compiler_options(${name} PRIVATE)
  target_link_libraries(${name} PRIVATE ${ARG_LIBS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS} ${CONVEXCUT_STANDARD_HEADERS})
endfunction()

function(convexcut_precompile target kind)
  if(NOT CONVEXCUT_UNITY)
    return()
  endif()
  set(headers convexcut_${kind}_headers)
  if(NOT TARGET ${headers})
    if(kind STREQUAL "library")
      convexcut_headers(${headers} HEADERS <Eigen/Core> <Eigen/Geometry> LIBS Eigen3::Eigen)
    elseif(kind STREQUAL "commands")
      convexcut_headers(${headers} COMMANDS HEADERS <CLI/CLI.hpp> <Eigen/Core> <Eigen/Geometry> LIBS Eigen3::Eigen CLI11::CLI11)
    else()
      convexcut_headers(${headers} TEST HEADERS <gmock/gmock.h> <gtest/gtest.h> <Eigen/Core> <Eigen/Geometry> <random>
                        LIBS Eigen3::Eigen GTest::gmock)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
  # GCC does not know its own library in them, and warns of what it inlines from there.
  target_compile_options(
    ${target}
    PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread>)
endfunction()
