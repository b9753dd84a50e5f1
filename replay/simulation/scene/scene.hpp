// SPDX-License-Identifier: Apache-2.0
//
// A simulated room: surfaces with labels, what moves in it, and where a ray meets it. Frame world:
// z up, metres. docs/scenes.md describes the files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/angle.hpp"
#include "core/geometry.hpp"
#include "core/time.hpp"
#include "replay/simulation/scene/bounds.hpp"
#include "replay/simulation/scene/path.hpp"
#include "replay/simulation/scene/ray.hpp"
#include "replay/simulation/scene/surface_label.hpp"

namespace convexcut::simulation {

// A scene that cannot be used. what() is all there is wrong with it, one line each without a final
// newline: file and line, key, what was expected and found:
//   room.toml:12: box.max: expected three numbers, found "abc"
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What is chosen when a scene is opened, instead of in its file.
struct SceneOptions {
  std::optional<int> people;  // instead of [people] count; 0 … the file's maximum
};

struct SurfaceInfo {
  std::string name;  // unique in the scene
  SurfaceLabel label = SurfaceLabel::structure;
  double reflectivity = 0.5;  // 0 … 1, of a diffuse surface seen at a right angle
  Material material = Material::diffuse;
};

// Where the lidar starts, and the way it takes when the rig is to move.
struct RigPlan {
  Vec3 position = Vec3::Zero();
  Degrees yaw;  // of the lidar's x axis from the world's
  Path path;    // empty: the scene has none
};

class BoxRay;
class InShaft;
class Nearest;
struct EightBoxes;
struct MoverPart;
struct PartPose;
struct Shaft;

namespace detail {
struct SceneData;
}  // namespace detail

// A scene at an instant. Many may exist beside each other, one a thread.
class SceneAt {
 public:
  // Puts everything where it is then; any order of times. Without allocation.
  void move_to(Duration since_start) noexcept;

  // The first surface on the ray. False, and `hit` as it was made, when there is none. Without
  // allocation; the same bits for the same ray and instant.
  bool cast(const Ray& ray, Hit& hit) const noexcept;

  // What the rays of a shaft may meet, for cast() with one of them, which is then faster and gives
  // the same. Until the scene is moved; reuse `out`, it keeps its memory.
  void gather(const Shaft& shaft, InShaft& out) const;
  bool cast(const Ray& ray, const InShaft& in_shaft, Hit& hit) const noexcept;

  SceneAt(const SceneAt&);
  SceneAt(SceneAt&&) noexcept;
  SceneAt& operator=(const SceneAt&);
  SceneAt& operator=(SceneAt&&) noexcept;
  ~SceneAt();

 private:
  friend class Scene;
  explicit SceneAt(std::shared_ptr<const detail::SceneData> scene);
  void cast_on_mover(std::size_t index, const Ray& ray, const BoxRay& box_ray,
                     Nearest& nearest) const noexcept;
  void try_on(std::uint32_t thing, const Ray& ray, Nearest& nearest) const noexcept;
  bool settle(const Ray& ray, const Nearest& nearest, Hit& hit) const noexcept;

  std::shared_ptr<const detail::SceneData> scene_;
  // Where a mover's parts begin in the two lists that follow.
  struct Slot {
    std::size_t pose = 0;
    std::size_t boxes = 0;
  };
  std::vector<PartPose> poses_;
  std::vector<EightBoxes> part_boxes_;
  std::vector<Slot> slots_;              // by mover
  std::vector<const MoverPart*> parts_;  // by pose
  std::vector<EightBoxes> mover_boxes_;  // around all parts of each
};

// Immutable; copies share what they hold.
class Scene {
 public:
  // A shipped scene by its name, or a scene file: whatever has a '/' or ends in ".toml". These four
  // throw SceneError.
  [[nodiscard]] static Scene open(const std::string& name_or_file, const SceneOptions& = {});
  [[nodiscard]] static Scene named(std::string_view name, const SceneOptions& = {});
  [[nodiscard]] static Scene load(const std::filesystem::path& file, const SceneOptions& = {});
  // TOML in memory; `file` stands for it in messages, and mesh files are looked for beside it.
  [[nodiscard]] static Scene parse(std::string_view toml, const std::filesystem::path& file,
                                   const SceneOptions& = {});

  // The names of the shipped scenes, sorted, and the TOML text of one (empty when there is none).
  [[nodiscard]] static std::span<const std::string_view> names() noexcept;
  [[nodiscard]] static std::string_view text_of(std::string_view name) noexcept;

  [[nodiscard]] const std::string& name() const noexcept;
  [[nodiscard]] const std::string& description() const noexcept;
  [[nodiscard]] std::span<const SurfaceInfo> surfaces() const noexcept;  // < kNoSurface of them
  [[nodiscard]] const RigPlan& rig() const noexcept;
  [[nodiscard]] const Bounds& bounds() const noexcept;  // of all that stands still

  [[nodiscard]] SceneAt at(Duration since_start) const;

 private:
  explicit Scene(std::shared_ptr<const detail::SceneData> data) noexcept;
  std::shared_ptr<const detail::SceneData> data_;
};

}  // namespace convexcut::simulation
