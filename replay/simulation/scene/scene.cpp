// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/scene.hpp"

#include <algorithm>
#include <utility>

#include "replay/simulation/scene/scene_data.hpp"
#include "replay/simulation/scene/scene_reader.hpp"
#include "replay/simulation/scene/shipped_scenes.hpp"

namespace convexcut::simulation {
namespace {

const ShippedScene* find_shipped(std::string_view name) noexcept {
  const auto scenes = shipped_scenes();
  const auto found = std::ranges::find(scenes, name, &ShippedScene::name);
  return found == scenes.end() ? nullptr : &*found;
}

const std::vector<std::string_view>& sorted_names() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const ShippedScene& scene : shipped_scenes()) all.push_back(scene.name);
    std::ranges::sort(all);
    return all;
  }();
  return names;
}

}  // namespace

Scene::Scene(std::shared_ptr<const detail::SceneData> data) noexcept : data_(std::move(data)) {}

Scene Scene::open(const std::string& name_or_file, const SceneOptions& options) {
  const bool is_file =
      name_or_file.find('/') != std::string::npos || name_or_file.ends_with(".toml");
  return is_file ? load(name_or_file, options) : named(name_or_file, options);
}

Scene Scene::named(std::string_view name, const SceneOptions& options) {
  const ShippedScene* shipped = find_shipped(name);
  if (shipped != nullptr) return Scene(read_scene(shipped->text, std::string(name), options));
  std::string message = "unknown scene \"" + std::string(name) + "\", expected a file or one of ";
  for (const std::string_view each : sorted_names()) {
    message.append(each == sorted_names().front() ? "" : ", ").append(each);
  }
  throw SceneError(message);
}

Scene Scene::load(const std::filesystem::path& file, const SceneOptions& options) {
  return Scene(read_scene_file(file, options));
}

Scene Scene::parse(std::string_view toml, const std::filesystem::path& file,
                   const SceneOptions& options) {
  return Scene(read_scene(toml, file, options));
}

std::span<const std::string_view> Scene::names() noexcept { return sorted_names(); }

std::string_view Scene::text_of(std::string_view name) noexcept {
  const ShippedScene* shipped = find_shipped(name);
  return shipped == nullptr ? std::string_view() : shipped->text;
}

const std::string& Scene::name() const noexcept { return data_->name; }
const std::string& Scene::description() const noexcept { return data_->description; }
std::span<const SurfaceInfo> Scene::surfaces() const noexcept { return data_->surfaces; }
const RigPlan& Scene::rig() const noexcept { return data_->rig; }
const Bounds& Scene::bounds() const noexcept { return data_->still.bounds(); }

SceneAt Scene::at(Duration since_start) const {
  SceneAt instant(data_);
  instant.move_to(since_start);
  return instant;
}

}  // namespace convexcut::simulation
