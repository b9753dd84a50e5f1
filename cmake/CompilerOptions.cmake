# Warnings are errors everywhere; floating point means the same in every build, because results are
# promised to be bit-identical.
function(convexcut_compiler_options target scope)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_compile_options(
    ${target}
    ${scope}
    $<$<COMPILE_LANGUAGE:CXX>:
    -Wall -Wextra -Wpedantic -Werror -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast
    -Wcast-align -Wcast-qual -Wnon-virtual-dtor -Woverloaded-virtual -Wdouble-promotion -Wformat=2
    -Wimplicit-fallthrough -Wextra-semi -Wundef
    # A fused multiply-add rounds once where the source rounds twice: labels would depend on the compiler.
    -ffp-contract=off
    >)
endfunction()

# Libraries are linked into programs only, so no function of theirs is ever replaced: the compiler may inline them.
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fno-semantic-interposition>)

# Everything is compiled alike: sanitizers and hardening are set for the whole tree.
set(CONVEXCUT_SANITIZE "" CACHE STRING "Sanitizers, as for -fsanitize= (empty: none)")
if(CONVEXCUT_SANITIZE)
  add_compile_options(-fsanitize=${CONVEXCUT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${CONVEXCUT_SANITIZE})
else()
  add_compile_options(-fstack-protector-strong)
  if(CMAKE_BUILD_TYPE STREQUAL "Release")
    add_compile_definitions(_FORTIFY_SOURCE=2)
  endif()
  add_link_options(-Wl,-z,relro,-z,now)
endif()

if(CONVEXCUT_FUZZ)
  # The fuzzer steers by the branches that are taken, so all code has to report them.
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
