// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/scene/group_reader.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "config/suggestion.hpp"
#include "config/value_text.hpp"
#include "replay/simulation/scene/geometry.hpp"

namespace convexcut::simulation {
namespace {

// Placing templates in templates multiplies: no scene has more surfaces than labels can name.
constexpr std::size_t kMostItems = kNoSurface;

void move_into(std::vector<Item>& all, std::vector<Item> more) {
  std::ranges::move(more, std::back_inserter(all));
}

}  // namespace

std::vector<Item> placed(const std::vector<Item>& items, const RigidTransform& world_from_local,
                         const std::string& prefix, std::size_t line) {
  std::vector<Item> moved;
  for (const Item& item : items) {
    Item copy{item.info, {}, line};
    copy.info.name = items.size() == 1 ? prefix : prefix + '.' + item.info.name;
    for (const Shape& shape : item.shapes) copy.shapes.push_back(placed(shape, world_from_local));
    moved.push_back(std::move(copy));
  }
  return moved;
}

void GroupReader::read_templates(Fields tables) {
  for (auto& [name, fields] : tables.named_tables()) templates_.emplace(name, Template(fields));
  for (auto& [name, entry] : templates_) {
    (void)items_of(entry, entry.fields);
    entry.fields.finish();
  }
}

const std::vector<Item>* GroupReader::items_of(Template& entry, Fields& asked_by) {
  if (entry.being_read) {
    asked_by.report("template", "expected a template that is not made of this one");
    return nullptr;
  }
  if (!entry.items) {
    entry.being_read = true;
    entry.items = read(entry.fields);
    entry.being_read = false;
  }
  return &*entry.items;
}

const std::vector<Item>* GroupReader::named_template(Fields& fields) {
  const auto name = fields.text("template", "the name of a [template.…] table");
  if (!name) return nullptr;
  const auto found = templates_.find(*name);
  if (found != templates_.end()) return items_of(found->second, fields);
  std::vector<std::string_view> known;
  for (const auto& [each, entry] : templates_) known.push_back(each);
  fields.report("template", config::concat("no template \"", config::printable(*name), "\"",
                                           config::suggest(*name, known)));
  return nullptr;
}

std::vector<Item> GroupReader::read(Fields& group) {
  std::vector<Item> items;
  std::size_t index = 0;
  for (const Fields& room : group.tables("room")) {
    move_into(items, read_room(room, "room-" + std::to_string(index++)));
  }
  for (const std::string_view kind : kShapeKinds) {
    index = 0;
    for (const Fields& shape : group.tables(kind)) {
      const std::string name = config::concat(kind, "-", std::to_string(index++));
      move_into(items, read_shape(kind, shape, name, directory_));
    }
  }
  for (Fields& place : group.tables("place")) read_place(place, items);
  return items;
}

void GroupReader::read_place(Fields& place, std::vector<Item>& items) {
  const std::vector<Item>* source = named_template(place);
  const std::string name = place.text_or("name", place.text_or("template", "place"));
  const double z = place.number_or("z", kCoordinateRange, 0.0);
  std::size_t index = 0;
  for (const auto& row : place.rows("at", 3, 1)) {
    if (source == nullptr) break;
    if (items.size() + source->size() > kMostItems) {
      place.report("at", "too many: a scene has less than 65535 surfaces");
      break;
    }
    const RigidTransform where{to_quaternion({{0.0}, {0.0}, {row[2]}}), {row[0], row[1], z}};
    move_into(items, placed(*source, where, name + '-' + std::to_string(index++), place.line()));
  }
  place.finish();
}

}  // namespace convexcut::simulation
