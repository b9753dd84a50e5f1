// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "replay/simulation/scene/fields.hpp"
#include "replay/simulation/scene/shape_reader.hpp"

namespace convexcut::simulation {

// Rooms, shapes and placed templates: what the file as a whole and each template may hold.
class GroupReader {
 public:
  // Mesh files are looked for in `directory`.
  explicit GroupReader(std::filesystem::path directory) : directory_(std::move(directory)) {}

  // [template.NAME] tables, all of them. Before everything else.
  void read_templates(Fields tables);

  // The group's items, in the group's frame. Other keys of the table are left to be asked for.
  std::vector<Item> read(Fields& group);

  // The items of the template that the key `template` names; null when there is no such one, which
  // is reported.
  const std::vector<Item>* named_template(Fields& fields);

 private:
  struct Template {
    explicit Template(Fields table) : fields(std::move(table)) {}
    Fields fields;
    bool being_read = false;
    std::optional<std::vector<Item>> items;
  };

  const std::vector<Item>* items_of(Template& entry, Fields& asked_by);
  void read_place(Fields& place, std::vector<Item>& items);

  std::filesystem::path directory_;
  std::map<std::string, Template, std::less<>> templates_;
};

// The items moved by world_from_local. Their names go behind `prefix` and a dot, but for one that
// is alone, which gets the prefix as its name.
[[nodiscard]] std::vector<Item> placed(const std::vector<Item>& items,
                                       const RigidTransform& world_from_local,
                                       const std::string& prefix, std::size_t line);

}  // namespace convexcut::simulation
