# Writes a C++ source (OUTPUT) with the texts of all scene files in DIRECTORY.
file(GLOB files ${DIRECTORY}/*.toml)
set(entries "")
set(count 0)
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  # Compilers take texts of 64 KiB at most.
  string(LENGTH "${text}" length)
  if(length GREATER 60000)
    message(FATAL_ERROR "${file} is too long to be a part of the program")
  endif()
  string(APPEND entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Made by embed_scenes.cmake.
#include <array>

#include \"replay/simulation/scene/shipped_scenes.hpp\"

namespace convexcut::simulation {

std::span<const ShippedScene> shipped_scenes() noexcept {
  static constexpr std::array<ShippedScene, ${count}> kScenes{{
${entries}  }};
  return kScenes;
}

}  // namespace convexcut::simulation
")
