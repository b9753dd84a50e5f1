// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/mover_reader.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "config/value_text.hpp"

namespace convexcut::simulation {
namespace {

using config::concat;

constexpr std::array<std::pair<std::string_view, PathEnd>, 3> kPathEndNames{{
    {"loop", PathEnd::loop},
    {"back", PathEnd::back},
    {"stop", PathEnd::stop},
}};
constexpr Range kHeightRange{0.5, 2.5};
constexpr double kWalkingSpeed = 1.2;  // m/s
constexpr int kMostPeople = 1000;

// The template's items as one rigid body; dynamic, whatever they are where they stand still.
void take_body(Fields& fields, GroupReader& groups, const std::string& name, MoverItem& item) {
  const SurfaceLabel label = fields.choice_or("label", kLabelNames, SurfaceLabel::dynamic);
  const std::vector<Item>* source = groups.named_template(fields);
  if (source == nullptr) return;
  for (Item& part : placed(*source, {}, name, fields.line())) {
    const auto surface = static_cast<std::uint32_t>(item.surfaces.size());
    part.info.label = label;
    item.surfaces.push_back(std::move(part.info));
    for (Shape& shape : part.shapes) item.primitives.push_back({std::move(shape), surface});
  }
}

void read_moving(Fields& root, GroupReader& groups, std::vector<MoverItem>& all) {
  std::size_t index = 0;
  for (Fields& fields : root.tables("mover")) {
    MoverItem item;
    item.line = fields.line();
    take_body(fields, groups, fields.text_or("name", "mover-" + std::to_string(index++)), item);
    Path path = read_path(fields, "path", 3, 0.0);
    item.mover.turns = fields.flag_or("turns", true);
    item.mover.yaw = fields.degrees_or("yaw_deg", 0.0).to_radians();
    fields.finish();
    if (path.empty() || item.primitives.empty()) continue;
    item.mover.way = std::move(path);
    all.push_back(std::move(item));
  }
}

void read_thrown(Fields& root, GroupReader& groups, std::vector<MoverItem>& all) {
  std::size_t index = 0;
  for (Fields& fields : root.tables("thrown")) {
    MoverItem item;
    item.line = fields.line();
    take_body(fields, groups, fields.text_or("name", "thrown-" + std::to_string(index++)), item);
    const auto from = fields.point("from");
    const auto to = fields.point("to");
    const auto flight_s = fields.number("flight_s", {0.0, 60.0, true});
    const Duration rest = fields.seconds_or("rest_s", 1.0);
    fields.finish();
    if (!from || !to || !flight_s || item.primitives.empty()) continue;
    const auto flight =
        std::chrono::duration_cast<Duration>(std::chrono::duration<double>(*flight_s));
    item.mover.way = Flight(*from, *to, flight, rest);
    all.push_back(std::move(item));
  }
}

void read_persons(Fields& root, std::vector<MoverItem>& all) {
  std::size_t index = 0;
  for (Fields& fields : root.tables("person")) {
    MoverItem item;
    item.line = fields.line();
    item.surfaces.push_back(
        read_surface(fields, {"person-" + std::to_string(index++), SurfaceLabel::dynamic, 0.4}));
    item.person_height_m = fields.number_or("height_m", kHeightRange, 1.75);
    Path path = read_path(fields, "path", 2, fields.number_or("z", kCoordinateRange, 0.0));
    item.mover.turns = path.way_points().size() > 1;
    item.mover.yaw = fields.degrees_or("yaw_deg", 0.0).to_radians();
    fields.finish();
    if (path.empty()) continue;
    item.mover.way = std::move(path);
    all.push_back(std::move(item));
  }
}

// The index-th of a sequence in 0 … 1 that fills it evenly, however many there are: multiples of
// an irrational number. Other numbers give sequences that have nothing to do with each other.
double spread(int index, double irrational) noexcept {
  const double multiple = (index + 1) * irrational;
  return multiple - std::floor(multiple);
}

// Everybody on a route: its way points moved a little, another speed, another place to begin at.
MoverItem person_of_crowd(int index, const Path& route, double aside_m) {
  const double angle = 2.0 * std::numbers::pi * spread(index, std::numbers::sqrt3);
  const double aside = aside_m * std::sqrt(spread(index, std::numbers::phi));
  std::vector<Vec3> way_points = route.way_points();
  double length = 0.0;
  for (std::size_t i = 0; i < way_points.size(); ++i) {
    way_points[i] += aside * Vec3(std::cos(angle), std::sin(angle), 0.0);
    if (i > 0) length += (way_points[i] - way_points[i - 1]).norm();
  }
  // Every third one stops at each way point for some seconds.
  const Duration pause = index % 3 == 2 ? std::chrono::milliseconds(3500) : Duration{};
  const double speed = route.speed_m_s() * (0.7 + 0.6 * spread(index, std::numbers::sqrt2));
  MoverItem item;
  item.surfaces.push_back({"people-" + std::to_string(index), SurfaceLabel::dynamic,
                           0.25 + 0.5 * spread(index, std::numbers::e)});
  item.person_height_m = 1.55 + 0.35 * spread(index, std::numbers::pi);
  item.mover.way = Path(std::move(way_points), speed, route.end(), pause,
                        2.0 * length * spread(index, std::numbers::phi));
  return item;
}

std::vector<Path> read_routes(Fields& people) {
  const double z = people.number_or("z", kCoordinateRange, 0.0);
  std::vector<Path> routes;
  for (Fields& fields : people.tables("route")) {
    Path route = read_path(fields, "path", 2, z);
    fields.finish();
    if (!route.empty()) routes.push_back(std::move(route));
  }
  return routes;
}

void read_people(Fields& root, const SceneOptions& options, std::vector<MoverItem>& all) {
  std::optional<Fields> people = root.table("people");
  if (!people) {
    if (options.people.value_or(0) != 0) {
      root.report("", "people were asked for, but the scene has no [people]");
    }
    return;
  }
  const int most = people->whole_number_or("max", 0, kMostPeople, 40);
  int count = people->whole_number_or("count", 0, most, 0);
  const double aside_m = people->number_or("aside_m", {0.0, 10.0}, 0.25);
  const std::vector<Path> routes = read_routes(*people);
  people->finish();
  if (options.people) {
    count = *options.people;
    if (count < 0 || count > most) {
      people->report("max", concat("the scene holds 0 … ", std::to_string(most),
                                   " people, asked for ", std::to_string(count)));
      return;
    }
  }
  if (routes.empty()) {
    people->report_missing("route", "at least one [[people.route]]");
    return;
  }
  for (int i = 0; i < count; ++i) {
    const Path& route = routes[static_cast<std::size_t>(i) % routes.size()];
    all.push_back(person_of_crowd(i, route, aside_m));
    all.back().line = people->line();
  }
}

}  // namespace

Path read_path(Fields& fields, std::string_view key, std::size_t columns, double z) {
  std::vector<Vec3> way_points;
  for (const auto& row : fields.rows(key, columns, 1)) {
    way_points.emplace_back(row[0], row[1], columns == 3 ? row[2] : z);
  }
  const double speed = fields.number_or("speed_m_s", kSpeedRange, kWalkingSpeed);
  const PathEnd end = fields.choice_or("path_end", kPathEndNames, PathEnd::back);
  const Duration pause = fields.seconds_or("pause_s", 0.0);
  const double start_m = fields.number_or("start_m", {0.0, 1e6}, 0.0);
  if (way_points.empty()) return {};
  return {std::move(way_points), speed, end, pause, start_m};
}

std::vector<MoverItem> read_movers(Fields& root, GroupReader& groups, const SceneOptions& options) {
  std::vector<MoverItem> movers;
  read_moving(root, groups, movers);
  read_thrown(root, groups, movers);
  read_persons(root, movers);
  read_people(root, options, movers);
  return movers;
}

}  // namespace convexcut::simulation
