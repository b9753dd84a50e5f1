// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/scene_reader.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include <system_error>

#include "config/value_text.hpp"
#include "replay/simulation/scene/eight_boxes.hpp"
#include "replay/simulation/scene/fields.hpp"
#include "replay/simulation/scene/group_reader.hpp"
#include "replay/simulation/scene/mover_reader.hpp"
#include "replay/simulation/scene/problems.hpp"
#include "replay/simulation/scene/shape_reader.hpp"

namespace convexcut::simulation {
namespace {

using config::concat;

constexpr std::size_t kMaxFileSize = std::size_t{16} << 20U;

// Gives the surfaces their numbers and puts the scene together.
class Assembly {
 public:
  Assembly(detail::SceneData& scene, Problems& problems) : scene_(scene), problems_(problems) {}

  void add(std::vector<Item> items) {
    for (Item& item : items) {
      const std::uint32_t surface = add_surface(std::move(item.info), item.line);
      for (Shape& shape : item.shapes) still_.push_back({std::move(shape), surface});
    }
  }

  void add(MoverItem item) {
    std::vector<std::uint32_t> numbers;
    for (SurfaceInfo& info : item.surfaces) {
      numbers.push_back(add_surface(std::move(info), item.line));
    }
    if (item.primitives.empty()) {
      item.mover.parts = person_parts(item.person_height_m, numbers.front());
    } else {
      for (Primitive& primitive : item.primitives) primitive.surface = numbers[primitive.surface];
      item.mover.parts.push_back({Geometry(std::move(item.primitives)), Vec3::Zero(), Radians{}});
    }
    scene_.movers.push_back(std::move(item.mover));
  }

  void finish() {
    scene_.still = Geometry(std::move(still_));
    if (scene_.surfaces.empty()) problems_.report(0, "", "no surfaces, expected at least one");
    const Bounds& bounds = scene_.still.bounds();
    const bool inside = bounds.empty() || ((bounds.low.array() >= -kLargestCoordinate).all() &&
                                           (bounds.high.array() <= kLargestCoordinate).all());
    if (!inside) problems_.report(0, "", "expected all surfaces within ±500 m");
  }

 private:
  std::uint32_t add_surface(SurfaceInfo info, std::size_t line) {
    const auto [first, is_new] = lines_.emplace(info.name, line);
    if (!is_new) {
      problems_.report(line, "name",
                       concat("\"", config::printable(info.name), "\" is the name of line ",
                              std::to_string(first->second), " too, expected another"));
    }
    if (scene_.surfaces.size() + 1 == kNoSurface) {
      problems_.report(line, "", "too many: a scene has less than 65535 surfaces");
    }
    scene_.surfaces.push_back(std::move(info));
    return static_cast<std::uint32_t>(scene_.surfaces.size() - 1);
  }

  detail::SceneData& scene_;
  Problems& problems_;
  std::vector<Primitive> still_;
  std::map<std::string, std::size_t> lines_;  // by the name of a surface
};

RigPlan read_rig(Fields& root) {
  std::optional<Fields> fields = root.table("rig");
  if (!fields) {
    root.report_missing("rig", "a table, [rig]");
    return {};
  }
  RigPlan rig;
  if (const auto position = fields->point("position")) rig.position = *position;
  rig.yaw = fields->degrees_or("yaw_deg", 0.0);
  if (fields->has("path")) rig.path = read_path(*fields, "path", 3, 0.0);
  fields->finish();
  return rig;
}

void read_root(Fields root, const std::filesystem::path& directory, const SceneOptions& options,
               detail::SceneData& scene, Problems& problems) {
  scene.description = root.text_or("description", "");
  scene.rig = read_rig(root);
  GroupReader groups(directory);
  if (auto templates = root.table("template")) groups.read_templates(*templates);
  Assembly assembly(scene, problems);
  assembly.add(groups.read(root));
  for (MoverItem& mover : read_movers(root, groups, options)) assembly.add(std::move(mover));
  root.finish();
  if (problems.empty()) assembly.finish();
}

}  // namespace

std::shared_ptr<const detail::SceneData> read_scene(std::string_view toml,
                                                    const std::filesystem::path& file,
                                                    const SceneOptions& options) {
  auto scene = std::make_shared<detail::SceneData>();
  scene->name = file.stem().string();
  Problems problems(file.string());
  try {
    const toml::table root = toml::parse(toml);
    read_root(Fields(root, "", problems), file.parent_path(), options, *scene, problems);
  } catch (const toml::parse_error& error) {
    problems.report(error.source().begin.line, "",
                    concat("not valid TOML: ", config::printable(error.description())));
  }
  problems.throw_if_any();
  return scene;
}

std::shared_ptr<const detail::SceneData> read_scene_file(const std::filesystem::path& file,
                                                         const SceneOptions& options) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw SceneError(file.string() + ": is a directory, expected a scene file");
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) throw SceneError(file.string() + ": cannot open: " + std::strerror(errno));
  std::string text(kMaxFileSize + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) throw SceneError(file.string() + ": cannot read: " + std::strerror(errno));
  if (text.size() > kMaxFileSize) {
    throw SceneError(file.string() + ": is larger than 16 MiB, expected a scene file");
  }
  return read_scene(text, file, options);
}

}  // namespace convexcut::simulation
