// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/truth/truth_reader.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <toml++/toml.h>

#include "drivers/live/file_descriptor.hpp"
#include "drivers/recording/pose_file.hpp"
#include "replay/simulation/truth/label_name.hpp"
#include "replay/simulation/truth/truth_format.hpp"

namespace convexcut::simulation {

namespace format = truth_format;

// The whole file, in memory as far as it is looked at.
class TruthReader::Mapping {
 public:
  explicit Mapping(const std::filesystem::path& file) {
    const live::FileDescriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat status {};
    if (fd.get() < 0 || ::fstat(fd.get(), &status) != 0) {
      throw TruthError("cannot open " + file.string() + ": " + std::strerror(errno));
    }
    size_ = static_cast<std::size_t>(status.st_size);
    if (size_ == 0) throw TruthError(file.string() + ": is empty");
    address_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, fd.get(), 0);
    if (address_ == MAP_FAILED) {
      throw TruthError("cannot read " + file.string() + ": " + std::strerror(errno));
    }
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping() {
    if (address_ != MAP_FAILED) ::munmap(address_, size_);
  }

  [[nodiscard]] wire::Bytes bytes() const noexcept {
    return {static_cast<const std::byte*>(address_), size_};
  }

 private:
  void* address_ = MAP_FAILED;
  std::size_t size_ = 0;
};

namespace {

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw TruthError("cannot open " + file.string() + ": " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(in), {}};
}

// A value that has to be there.
template <class Value>
Value wanted(const toml::table& table, std::string_view path, const std::filesystem::path& file) {
  const auto value = table.at_path(path).value<Value>();
  if (!value) {
    throw TruthError(file.string() + ": " + std::string(path) +
                     ": missing or of another kind; expected the file that `convexcut simulate` "
                     "wrote");
  }
  return *value;
}

std::vector<SurfaceInfo> read_surfaces(const toml::table& table,
                                       const std::filesystem::path& file) {
  std::vector<SurfaceInfo> surfaces;
  const toml::array* array = table.at_path("scene.surface").as_array();
  if (array == nullptr) throw TruthError(file.string() + ": scene.surface: missing");
  for (const toml::node& node : *array) {
    const toml::table* row = node.as_table();
    if (row == nullptr) throw TruthError(file.string() + ": scene.surface: expected tables");
    const auto label = named_in(kLabelNames, wanted<std::string>(*row, "label", file));
    const auto material = named_in(kMaterialNames, wanted<std::string>(*row, "material", file));
    if (!label || !material) {
      throw TruthError(file.string() + ": scene.surface: an unknown label or material");
    }
    surfaces.push_back({wanted<std::string>(*row, "name", file), *label,
                        wanted<double>(*row, "reflectivity", file), *material});
  }
  return surfaces;
}

TruthSettings read_settings(const std::filesystem::path& file) {
  toml::table table;
  try {
    table = toml::parse(contents(file), file.string());
  } catch (const toml::parse_error& error) {
    throw TruthError(file.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                     std::string(error.description()));
  }
  const auto version = wanted<std::int64_t>(table, "format", file);
  if (version != format::kVersion) {
    throw TruthError(file.string() + ": format: expected " + std::to_string(format::kVersion) +
                     ", found " + std::to_string(version));
  }
  return {.scene = wanted<std::string>(table, "scene.name", file),
          .seed = static_cast<std::uint64_t>(wanted<std::int64_t>(table, "seed", file)),
          .start = from_ns<HostTime>(wanted<std::int64_t>(table, "start_ns", file)),
          .length = Duration{wanted<std::int64_t>(table, "length_ns", file)},
          .dual = wanted<bool>(table, "lidar.dual", file),
          .noise_m = wanted<double>(table, "lidar.noise_m", file),
          .min_range_m = wanted<double>(table, "lidar.min_range_m", file),
          .max_range_m = wanted<double>(table, "lidar.max_range_m", file),
          .gravity_error = {wanted<double>(table, "imu.gravity_error_deg", file)},
          .surfaces = read_surfaces(table, file)};
}

std::vector<PoseSample> read_truth_poses(const std::filesystem::path& file) {
  try {
    std::vector<PoseSample> poses = recording::read_poses(file);
    if (poses.size() >= 2) return poses;
  } catch (const std::runtime_error& error) {
    throw TruthError(error.what());
  }
  throw TruthError(file.string() + ": expected at least two poses");
}

}  // namespace

HostTime TrueFiring::time() const noexcept {
  return from_ns<HostTime>(wire::load_le<std::int64_t>(record_, format::kTimeOffset));
}

Azimuth TrueFiring::azimuth() const noexcept {
  return Azimuth::from_centidegrees(wire::load_le<std::uint16_t>(record_, format::kAzimuthOffset));
}

SimulatedReturn TrueFiring::at(std::size_t echo, std::size_t laser) const noexcept {
  const wire::Bytes bytes = record_.subspan(
      format::kReturnsOffset + (echo * format::kLasers + laser) * format::kReturnSize,
      format::kReturnSize);
  SimulatedReturn truth;
  truth.range_2mm = wire::load_le<std::uint16_t>(bytes, format::kRangeOffset);
  truth.true_range_m =
      std::bit_cast<float>(wire::load_le<std::uint32_t>(bytes, format::kTrueRangeOffset));
  truth.label = static_cast<SurfaceLabel>(wire::load_u8(bytes, format::kLabelOffset));
  truth.flags = wire::load_u8(bytes, format::kFlagsOffset);
  truth.surface = wire::load_le<std::uint16_t>(bytes, format::kSurfaceOffset);
  return truth;
}

TruthReader::TruthReader(const std::filesystem::path& folder) {
  std::filesystem::path truth = folder;
  if (!std::filesystem::exists(truth / format::kSettingsFile) &&
      std::filesystem::exists(folder / "truth")) {
    truth /= "truth";
  }
  settings_ = read_settings(truth / format::kSettingsFile);
  poses_ = read_truth_poses(truth / format::kPosesFile);
  returns_ = std::make_unique<Mapping>(truth / format::kReturnsFile);
  check_header(truth / format::kReturnsFile);
}

TruthReader::~TruthReader() = default;
TruthReader::TruthReader(TruthReader&&) noexcept = default;
TruthReader& TruthReader::operator=(TruthReader&&) noexcept = default;

void TruthReader::check_header(const std::filesystem::path& file) {
  const wire::Bytes bytes = returns_->bytes();
  if (bytes.size() < format::kHeaderSize ||
      std::memcmp(bytes.data(), format::kMagic.data(), format::kMagic.size()) != 0) {
    throw TruthError(file.string() + ": expected the returns of a simulation (" +
                     std::string(format::kMagic) + "), found something else");
  }
  const auto version = wire::load_le<std::uint32_t>(bytes, format::kVersionOffset);
  if (version != format::kVersion) {
    throw TruthError(file.string() + ": expected version " + std::to_string(format::kVersion) +
                     ", found " + std::to_string(version));
  }
  echoes_ = settings_.dual ? 2 : 1;
  const std::size_t record = format::record_size(echoes_);
  const auto firings = wire::load_le<std::uint64_t>(bytes, format::kFiringsOffset);
  const bool fits = wire::load_le<std::uint16_t>(bytes, format::kEchoesOffset) == echoes_ &&
                    wire::load_le<std::uint16_t>(bytes, format::kLasersOffset) == format::kLasers &&
                    wire::load_le<std::uint32_t>(bytes, format::kRecordSizeOffset) == record;
  if (!fits) {
    throw TruthError(file.string() + ": does not belong to the " +
                     std::string(format::kSettingsFile) + " beside it");
  }
  if (firings == 0 || (bytes.size() - format::kHeaderSize) / record != firings ||
      (bytes.size() - format::kHeaderSize) % record != 0) {
    throw TruthError(file.string() + ": expected " + std::to_string(firings) +
                     " firings and at least one, found " +
                     std::to_string((bytes.size() - format::kHeaderSize) / record));
  }
  firings_ = firings;
}

TrueFiring TruthReader::firing(std::size_t i) const noexcept {
  const std::size_t record = format::record_size(echoes_);
  return {returns_->bytes().subspan(format::kHeaderSize + i * record, record), echoes_};
}

std::size_t TruthReader::firing_at(HostTime time) const noexcept {
  std::size_t low = 0;
  std::size_t high = firings_;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (firing(middle).time() <= time ? low : high) = middle;
  }
  return low;
}

Pose TruthReader::pose_at(HostTime time) const noexcept {
  const auto after =
      std::upper_bound(poses_.begin(), poses_.end(), time,
                       [](HostTime t, const PoseSample& pose) { return t < pose.stamp; });
  const auto pose_of = [](const PoseSample& sample) -> Pose {
    return {sample.position_world, sample.q_world_from_lidar};
  };
  if (after == poses_.begin()) return pose_of(poses_.front());
  if (after == poses_.end()) return pose_of(poses_.back());
  const PoseSample& from = *(after - 1);
  const double share = static_cast<double>((time - from.stamp).count()) /
                       static_cast<double>((after->stamp - from.stamp).count());
  return {from.position_world + share * (after->position_world - from.position_world),
          from.q_world_from_lidar.slerp(share, after->q_world_from_lidar)};
}

}  // namespace convexcut::simulation
