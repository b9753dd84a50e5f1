// SPDX-License-Identifier: Apache-2.0
//
// [[room]]: the inside of a box, or of a floor polygon between a floor and a ceiling plane.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "config/value_text.hpp"
#include "replay/simulation/scene/shape_reader.hpp"

namespace convexcut::simulation {
namespace {

using config::concat;

constexpr double kToleranceM = 1e-6;

// z = at_origin + slope_x · x + slope_y · y
struct Height {
  double at_origin = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
  [[nodiscard]] Vec3 above(const Vec3& p) const {
    return {p.x(), p.y(), at_origin + slope_x * p.x() + slope_y * p.y()};
  }
};

struct Wall {
  std::string name;  // in the file: "north"
  Vec3 from;         // z = 0
  Vec3 to;
  [[nodiscard]] double length() const { return (to - from).norm(); }
  [[nodiscard]] Vec3 along() const { return (to - from).normalized(); }
};

struct Plan {
  std::vector<Wall> walls;
  Height floor;
  Height ceiling;
};

class RoomReader {
 public:
  RoomReader(Fields& fields, std::string_view default_name) : fields_(fields) {
    const SurfaceInfo otherwise{std::string(default_name), SurfaceLabel::structure, 0.6};
    look_ = read_surface(fields_, otherwise);
  }

  std::vector<Item> read() {
    const std::optional<Plan> plan = read_plan();
    without_ = fields_.texts_if_any("without");
    const double floor_reflectivity =
        fields_.number_or("floor_reflectivity", kPartRange, look_.reflectivity);
    const double ceiling_reflectivity =
        fields_.number_or("ceiling_reflectivity", kPartRange, look_.reflectivity);
    const std::string floor_name = fields_.text_or("floor_name", look_.name + ".floor");
    const std::string ceiling_name = fields_.text_or("ceiling_name", look_.name + ".ceiling");
    if (!plan) {
      (void)fields_.tables("openings");
      return {};
    }
    add_level(plan->floor, *plan, "floor", floor_name, floor_reflectivity);
    add_level(plan->ceiling, *plan, "ceiling", ceiling_name, ceiling_reflectivity);
    const std::vector<Opening> openings = read_openings(*plan);
    for (std::size_t i = 0; i < plan->walls.size(); ++i) add_wall(*plan, i, openings);
    for (const std::string& name : without_) {
      fields_.report("without", concat("expected floor, ceiling or a wall, found \"",
                                       config::printable(name), "\""));
    }
    return std::move(items_);
  }

 private:
  struct Opening {
    std::size_t wall = 0;
    double from_m = 0.0;  // along the wall
    double to_m = 0.0;
    double low_z = 0.0;
    double high_z = 0.0;
    double depth_m = 0.0;
    std::optional<SurfaceInfo> pane;
    std::size_t line = 0;
  };

  std::optional<Plan> read_plan() {
    Plan plan;
    std::vector<Vec3> corners;
    if (fields_.has("floor")) {
      for (const auto& row : fields_.rows("floor", 2, 3)) corners.emplace_back(row[0], row[1], 0.0);
      if (!fields_.has("floor_plane") || !fields_.has("ceiling_plane")) {
        if (!read_levels(plan)) return std::nullopt;
      }
    } else {
      const auto low = fields_.point("min");
      const auto high = fields_.point("max");
      if (!low || !high) return std::nullopt;
      corners = {{low->x(), low->y(), 0.0},
                 {high->x(), low->y(), 0.0},
                 {high->x(), high->y(), 0.0},
                 {low->x(), high->y(), 0.0}};
      plan.floor.at_origin = low->z();
      plan.ceiling.at_origin = high->z();
    }
    read_plane("floor_plane", plan.floor);
    read_plane("ceiling_plane", plan.ceiling);
    if (corners.empty() || !add_walls(corners, plan)) return std::nullopt;
    for (const Vec3& corner : corners) {
      if (plan.ceiling.above(corner).z() > plan.floor.above(corner).z() + kToleranceM) continue;
      fields_.report("", "expected the ceiling above the floor at every corner");
      return std::nullopt;
    }
    return plan;
  }

  bool read_levels(Plan& plan) {
    const auto levels = fields_.numbers_if_any("z", 2, kCoordinateRange);
    if (!levels) {
      if (!fields_.has("z")) fields_.report_missing("z", "the heights of floor and ceiling");
      return false;
    }
    plan.floor.at_origin = (*levels)[0];
    plan.ceiling.at_origin = (*levels)[1];
    return true;
  }

  void read_plane(std::string_view key, Height& height) {
    if (const auto plane = fields_.numbers_if_any(key, 3, kCoordinateRange)) {
      height = {(*plane)[0], (*plane)[1], (*plane)[2]};
    }
  }

  bool add_walls(std::vector<Vec3>& corners, Plan& plan) {
    const Vec3 normal = loop_normal(corners);
    if (std::abs(normal.z()) < kToleranceM) {
      fields_.report("", "expected a floor with an area");
      return false;
    }
    // Anticlockwise from above, as it is documented, whatever the file says.
    if (normal.z() < 0.0) std::ranges::reverse(corners);
    std::vector<std::string> names = fields_.texts_if_any("wall_names");
    if (names.empty()) {
      names = fields_.has("floor") ? std::vector<std::string>()
                                   : std::vector<std::string>{"south", "east", "north", "west"};
      for (std::size_t i = names.size(); i < corners.size(); ++i) {
        names.push_back("wall-" + std::to_string(i));
      }
    }
    if (names.size() != corners.size()) {
      fields_.report("wall_names", concat("expected ", std::to_string(corners.size()), " names"));
      return false;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      plan.walls.push_back({names[i], corners[i], corners[(i + 1) % corners.size()]});
      if (plan.walls.back().length() >= kToleranceM) continue;
      fields_.report("floor", "expected corners that differ");
      return false;
    }
    return true;
  }

  bool left_out(std::string_view name) {
    const auto found = std::ranges::find(without_, name);
    if (found == without_.end()) return false;
    without_.erase(found);
    return true;
  }

  Item& add_item(std::string name, double reflectivity) {
    SurfaceInfo info = look_;
    info.name = std::move(name);
    info.reflectivity = reflectivity;
    return items_.emplace_back(Item{std::move(info), {}, fields_.line()});
  }

  void add_level(const Height& height, const Plan& plan, std::string_view part,
                 const std::string& name, double reflectivity) {
    if (left_out(part)) return;
    std::vector<Vec3> loop;
    for (const Wall& wall : plan.walls) loop.push_back(height.above(wall.from));
    add_item(name, reflectivity).shapes.emplace_back(shape_of({std::move(loop)}));
  }

  // Parallelograms are met faster than polygons.
  static Shape shape_of(std::vector<std::vector<Vec3>> loops) {
    const std::vector<Vec3>& outer = loops.front();
    if (loops.size() == 1 && outer.size() == 4 &&
        (outer[0] + outer[2] - outer[1] - outer[3]).norm() < 1e-12) {
      return Flat(outer[0], outer[1] - outer[0], outer[3] - outer[0], Flat::Form::parallelogram);
    }
    return Polygon(std::move(loops));
  }

  void add_wall(const Plan& plan, std::size_t index, const std::vector<Opening>& openings) {
    const Wall& wall = plan.walls[index];
    if (left_out(wall.name)) return;
    std::vector<std::vector<Vec3>> loops{{plan.floor.above(wall.from), plan.floor.above(wall.to),
                                          plan.ceiling.above(wall.to),
                                          plan.ceiling.above(wall.from)}};
    Item item{look_, {}, fields_.line()};
    item.info.name = fields_.has("wall_names") ? wall.name : concat(look_.name, ".", wall.name);
    std::vector<Item> panes;
    for (const Opening& opening : openings) {
      if (opening.wall != index) continue;
      const std::vector<Vec3> hole = corners_of(wall, opening);
      loops.push_back(hole);
      const Vec3 outwards = opening.depth_m * wall.along().cross(Vec3::UnitZ());
      if (opening.depth_m > 0.0) add_reveal(hole, outwards, item.shapes);
      if (opening.pane) {
        Item pane{*opening.pane, {}, opening.line};
        if (pane.info.name.empty()) {
          pane.info.name = concat(item.info.name, ".pane-", std::to_string(panes.size()));
        }
        pane.shapes.emplace_back(Flat(hole[0] + outwards, hole[1] - hole[0], hole[3] - hole[0],
                                      Flat::Form::parallelogram));
        panes.push_back(std::move(pane));
      }
    }
    item.shapes.emplace_back(shape_of(std::move(loops)));
    items_.push_back(std::move(item));
    std::ranges::move(panes, std::back_inserter(items_));
  }

  static std::vector<Vec3> corners_of(const Wall& wall, const Opening& opening) {
    const Vec3 from = wall.from + opening.from_m * wall.along();
    const Vec3 to = wall.from + opening.to_m * wall.along();
    const Vec3 low(0.0, 0.0, opening.low_z);
    const Vec3 high(0.0, 0.0, opening.high_z);
    return {from + low, to + low, to + high, from + high};
  }

  // The four sides of the hole through the wall.
  static void add_reveal(const std::vector<Vec3>& hole, const Vec3& outwards,
                         std::vector<Shape>& shapes) {
    for (std::size_t i = 0; i < 4; ++i) {
      shapes.emplace_back(
          Flat(hole[i], hole[(i + 1) % 4] - hole[i], outwards, Flat::Form::parallelogram));
    }
  }

  std::vector<Opening> read_openings(const Plan& plan) {
    std::vector<Opening> openings;
    for (Fields& fields : fields_.tables("openings")) {
      if (auto opening = read_opening(fields, plan)) openings.push_back(std::move(*opening));
      fields.finish();
    }
    for (std::size_t i = 0; i < openings.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Opening& a = openings[i];
        const Opening& b = openings[j];
        if (a.wall == b.wall && a.from_m < b.to_m && b.from_m < a.to_m && a.low_z < b.high_z &&
            b.low_z < a.high_z) {
          fields_.report("openings", concat("expected openings that do not overlap, in wall ",
                                            plan.walls[a.wall].name));
        }
      }
    }
    return openings;
  }

  std::optional<Opening> read_opening(Fields& fields, const Plan& plan) {
    Opening opening;
    opening.line = fields.line();
    const auto name = fields.text("wall", "the name of a wall");
    const auto along = fields.numbers_if_any("along", 2, kCoordinateRange);
    const auto height = fields.numbers_if_any("z", 2, kCoordinateRange);
    opening.depth_m = fields.number_or("depth", {0.0, 10.0}, 0.0);
    if (fields.flag_or("pane", false)) {
      opening.pane =
          read_surface(fields, {std::string(), SurfaceLabel::structure, 0.1, Material::glass});
    }
    if (!fields.has("along")) fields.report_missing("along", "where it begins and ends, metres");
    if (!fields.has("z")) fields.report_missing("z", "its lower and upper end, metres");
    if (!name || !along || !height) return std::nullopt;
    const auto wall = std::ranges::find(plan.walls, *name, &Wall::name);
    if (wall == plan.walls.end()) {
      std::string known;
      for (const Wall& each : plan.walls) known.append(known.empty() ? "" : ", ").append(each.name);
      fields.report(
          "wall", concat("expected one of ", known, ", found \"", config::printable(*name), "\""));
      return std::nullopt;
    }
    opening.wall = static_cast<std::size_t>(wall - plan.walls.begin());
    opening.from_m = (*along)[0];
    opening.to_m = (*along)[1];
    opening.low_z = (*height)[0];
    opening.high_z = (*height)[1];
    if (!is_within(opening, plan)) {
      fields.report("",
                    concat("expected an opening within wall ", wall->name, ", which is ",
                           config::number_text(std::round(wall->length() * 1e3) / 1e3), " m long"));
      return std::nullopt;
    }
    return opening;
  }

  static bool is_within(const Opening& opening, const Plan& plan) {
    const Wall& wall = plan.walls[opening.wall];
    if (opening.from_m >= opening.to_m || opening.low_z >= opening.high_z) return false;
    if (opening.from_m < -kToleranceM || opening.to_m > wall.length() + kToleranceM) return false;
    return std::ranges::all_of(corners_of(wall, opening), [&](const Vec3& corner) {
      return corner.z() > plan.floor.above(corner).z() - kToleranceM &&
             corner.z() < plan.ceiling.above(corner).z() + kToleranceM;
    });
  }

  Fields& fields_;
  SurfaceInfo look_;
  std::vector<std::string> without_;  // not yet found
  std::vector<Item> items_;
};

}  // namespace

std::vector<Item> read_room(Fields fields, std::string_view default_name) {
  std::vector<Item> items = RoomReader(fields, default_name).read();
  fields.finish();
  return items;
}

}  // namespace convexcut::simulation
