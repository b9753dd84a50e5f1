// SPDX-License-Identifier: Apache-2.0
#include "replay/pcd_reader.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace convexcut::replay {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD data is in the host's byte order");

struct Field {
  std::string name;
  char type = 'F';
  std::size_t size = 4;    // bytes of one value
  std::size_t count = 1;   // values
  std::size_t offset = 0;  // in a point: bytes when binary, values when ascii
};

struct Header {
  std::vector<Field> fields;
  std::size_t points = 0;
  std::string data;            // binary or ascii
  std::size_t point_size = 0;  // bytes
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : name_(file.string()) {
    std::ifstream in(file, std::ios::binary);
    if (!in) fail("cannot open");
    content_.assign(std::istreambuf_iterator<char>(in), {});
    if (in.bad()) fail("cannot read");
  }

  PcdCloud read() {
    read_header();
    const Columns fields{&find("x"),           &find("y"),
                         &find("z"),           find_integer("label"),
                         find_integer("ring"), find_integer("time")};
    return header_.data == "binary" ? read_binary(fields) : read_ascii(fields);
  }

 private:
  struct Columns {
    const Field* x;
    const Field* y;
    const Field* z;
    const Field* label;  // these may be null
    const Field* ring;
    const Field* time;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name_ + ": " + what);
  }

  [[nodiscard]] std::string here() const { return "line " + std::to_string(line_number_) + ": "; }

  // Up to and without the next line feed; the rest stays.
  std::optional<std::string_view> next_line() {
    if (position_ >= content_.size()) return std::nullopt;
    const std::size_t end = std::min(content_.find('\n', position_), content_.size());
    std::string_view line = std::string_view(content_).substr(position_, end - position_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    position_ = end + 1;
    ++line_number_;
    return line;
  }

  void read_header() {
    while (header_.data.empty()) {
      const auto line = next_line();
      if (!line) fail("not a PCD file: expected a line DATA binary or DATA ascii");
      if (!line->empty() && !line->starts_with('#')) read_header_line(std::string(*line));
    }
    if (header_.fields.empty()) fail("expected a line FIELDS before DATA");
    if (header_.data != "binary" && header_.data != "ascii") {
      fail("expected DATA binary or DATA ascii, found DATA " + header_.data);
    }
    std::size_t offset = 0;
    for (Field& field : header_.fields) {
      field.offset = offset;
      offset += header_.data == "binary" ? field.size * field.count : field.count;
    }
    header_.point_size = offset;
  }

  void read_header_line(const std::string& line) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "FIELDS") {
      for (std::string name; words >> name;) header_.fields.push_back({.name = name});
    } else if (key == "SIZE") {
      each_field(words, key, [](Field& f, std::size_t value) { f.size = value; });
    } else if (key == "COUNT") {
      each_field(words, key, [](Field& f, std::size_t value) { f.count = value; });
    } else if (key == "TYPE") {
      for (Field& field : header_.fields) words >> field.type;
    } else if (key == "POINTS") {
      if (!(words >> header_.points)) fail(here() + "expected a number after POINTS");
    } else if (key == "DATA") {
      words >> header_.data;
      if (header_.data.empty()) header_.data = "(nothing)";
    } else if (key != "VERSION" && key != "WIDTH" && key != "HEIGHT" && key != "VIEWPOINT") {
      fail(here() + "expected a PCD header, found \"" + printable(key) + "\"");
    }
  }

  template <class Set>
  void each_field(std::istringstream& words, const std::string& key, Set&& set) {
    constexpr std::size_t kMost = 4096;  // beyond any real cloud; keeps sums from overflowing
    for (Field& field : header_.fields) {
      std::size_t value = 0;
      if (!(words >> value) || value == 0 || value > kMost) {
        fail(here() + "expected " + key + " with a number of 1 to " + std::to_string(kMost) +
             " for each field");
      }
      set(field, value);
    }
  }

  static std::string printable(std::string_view text) {
    std::string out(text.substr(0, 20));
    for (char& c : out) {
      if (c < ' ' || c > '~') c = '?';
    }
    return out;
  }

  const Field& find(std::string_view name) const {
    for (const Field& field : header_.fields) {
      if (field.name != name) continue;
      if (field.type != 'F' || (field.size != 4 && field.size != 8)) {
        fail("field " + field.name + ": expected TYPE F and SIZE 4 or 8");
      }
      return field;
    }
    fail("expected the fields x, y and z, found no " + std::string(name));
  }

  const Field* find_integer(std::string_view name) const {
    for (const Field& field : header_.fields) {
      if (field.name != name) continue;
      if (field.type != 'U' && field.type != 'I') {
        fail("field " + field.name + ": expected TYPE U or I");
      }
      if (field.size != 1 && field.size != 2 && field.size != 4) {
        fail("field " + field.name + ": expected SIZE 1, 2 or 4");
      }
      return &field;
    }
    return nullptr;
  }

  // `value_of` gives the value of an integer field of the point at hand.
  template <class ValueOf>
  static void add_integers(const Columns& fields, PcdCloud& cloud, ValueOf&& value_of) {
    if (fields.label != nullptr) {
      cloud.label.push_back(value_of(*fields.label) == 1 ? Label::structure : Label::other);
    }
    if (fields.ring != nullptr) {
      cloud.ring.push_back(static_cast<std::uint16_t>(value_of(*fields.ring)));
    }
    if (fields.time != nullptr) cloud.time_ns.push_back(value_of(*fields.time));
  }

  PcdCloud read_binary(const Columns& fields) {
    const std::size_t held = content_.size() - std::min(position_, content_.size());
    if (held / header_.point_size < header_.points) {
      fail("expected " + std::to_string(header_.points) + " points of " +
           std::to_string(header_.point_size) + " bytes after the header, found " +
           std::to_string(held) + " bytes");
    }
    PcdCloud cloud;
    for (std::size_t i = 0; i < header_.points; ++i) {
      const char* point = content_.data() + position_ + i * header_.point_size;
      cloud.x.push_back(real(point, *fields.x));
      cloud.y.push_back(real(point, *fields.y));
      cloud.z.push_back(real(point, *fields.z));
      add_integers(fields, cloud, [point](const Field& field) { return integer(point, field); });
    }
    return cloud;
  }

  static float real(const char* point, const Field& field) noexcept {
    if (field.size == sizeof(double)) {
      double value = 0;
      std::memcpy(&value, point + field.offset, sizeof(value));
      return static_cast<float>(value);
    }
    float value = 0;
    std::memcpy(&value, point + field.offset, sizeof(value));
    return value;
  }

  static std::uint32_t integer(const char* point, const Field& field) noexcept {
    std::uint32_t value = 0;  // the lower bytes come first
    std::memcpy(&value, point + field.offset, field.size);
    return value;
  }

  PcdCloud read_ascii(const Columns& fields) {
    PcdCloud cloud;
    std::vector<std::string_view> values;
    for (std::size_t i = 0; i < header_.points; ++i) {
      const auto line = next_line();
      if (!line) {
        fail("expected " + std::to_string(header_.points) + " points, found " + std::to_string(i));
      }
      split(*line, values);
      cloud.x.push_back(number<float>(values, *fields.x));
      cloud.y.push_back(number<float>(values, *fields.y));
      cloud.z.push_back(number<float>(values, *fields.z));
      add_integers(fields, cloud, [&](const Field& field) {
        return static_cast<std::uint32_t>(number<double>(values, field));
      });
    }
    return cloud;
  }

  static void split(std::string_view line, std::vector<std::string_view>& values) {
    values.clear();
    std::size_t begin = 0;
    while ((begin = line.find_first_not_of(" \t", begin)) != std::string_view::npos) {
      const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
      values.push_back(line.substr(begin, end - begin));
      begin = end;
    }
  }

  template <class Real>
  Real number(const std::vector<std::string_view>& values, const Field& field) const {
    if (field.offset < values.size()) {
      const std::string_view text = values[field.offset];
      Real value = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error == std::errc{} && end == text.data() + text.size()) return value;
    }
    fail(here() + "expected a number for " + field.name);
  }

  std::string name_;
  std::string content_;
  std::size_t position_ = 0;
  std::size_t line_number_ = 0;
  Header header_;
};

}  // namespace

PcdCloud read_pcd(const std::filesystem::path& file) { return Reader(file).read(); }

}  // namespace convexcut::replay
