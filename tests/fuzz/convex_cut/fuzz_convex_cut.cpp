// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a cloud: the engine gives the reference's labels with every instruction set.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/fuzz/convex_cut/fuzzed_cloud.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view differs =
      convexcut::test::differing_path(convexcut::test::fuzzed_cloud({data, size}));
  if (!differs.empty()) {
    std::fprintf(stderr, "labels differ: %s\n", std::string(differs).c_str());
    std::abort();
  }
  return 0;
}
