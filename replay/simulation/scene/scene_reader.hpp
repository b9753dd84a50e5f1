// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "replay/simulation/scene/scene_data.hpp"

namespace convexcut::simulation {

// A scene of TOML. Both throw SceneError with everything that is wrong.
[[nodiscard]] std::shared_ptr<const detail::SceneData> read_scene_file(
    const std::filesystem::path& file, const SceneOptions& options);
[[nodiscard]] std::shared_ptr<const detail::SceneData> read_scene(std::string_view toml,
                                                                  const std::filesystem::path& file,
                                                                  const SceneOptions& options);

}  // namespace convexcut::simulation
