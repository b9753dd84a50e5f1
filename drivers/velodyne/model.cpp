// SPDX-License-Identifier: Apache-2.0
#include "drivers/velodyne/model.hpp"

#include <algorithm>

namespace convexcut::velodyne {
namespace {

// Rings count the beams from the lowest up.
constexpr Model with_rings(Model model) noexcept {
  for (std::size_t i = 0; i < model.lasers; ++i) {
    model.ring[i] = static_cast<std::uint8_t>(
        std::count_if(model.elevation_mdeg.begin(), model.elevation_mdeg.begin() + model.lasers,
                      [&](std::int32_t other) { return other < model.elevation_mdeg[i]; }));
  }
  return model;
}

constexpr Model kHdl32e = with_rings({
    .id = ModelId::hdl32e,
    .name = "HDL-32E",
    .product = 0x21,
    .lasers = 32,
    .firings_per_block = 1,
    .lasers_at_once = 1,
    .distance_unit_mm = 2,
    .laser_interval_ns = 1'152,
    .recharge_ns = 9'216,
    .firing_period_ns = 46'080,
    .elevation_mdeg = {-30'670, -9'330, -29'330, -8'000, -28'000, -6'670, -26'670, -5'330,
                       -25'330, -4'000, -24'000, -2'670, -22'670, -1'330, -21'330, 0,
                       -20'000, 1'330,  -18'670, 2'670,  -17'330, 4'000,  -16'000, 5'330,
                       -14'670, 6'670,  -13'330, 8'000,  -12'000, 9'330,  -10'670, 10'670},
    .vertical_offset_um = {17'170, 4'760,  16'270, 4'070,  15'400, 3'380,  14'540, 2'700,
                           13'710, 2'020,  12'890, 1'350,  12'090, 670,    11'310, 0,
                           10'540, -670,   9'780,  -1'350, 9'040,  -2'020, 8'300,  -2'700,
                           7'580,  -3'380, 6'860,  -4'070, 6'150,  -4'760, 5'450,  -5'450},
});

// The Puck LITE is the same sensor to a decoder.
constexpr Model kVlp16 = with_rings({
    .id = ModelId::vlp16,
    .name = "VLP-16",
    .product = 0x22,
    .lasers = 16,
    .firings_per_block = 2,
    .lasers_at_once = 1,
    .distance_unit_mm = 2,
    .laser_interval_ns = 2'304,
    .recharge_ns = 18'432,
    .firing_period_ns = 55'296,
    .elevation_mdeg = {-15'000, 1'000, -13'000, 3'000, -11'000, 5'000, -9'000, 7'000, -7'000, 9'000,
                       -5'000, 11'000, -3'000, 13'000, -1'000, 15'000},
    .vertical_offset_um = {11'200, -700, 9'700, -2'200, 8'100, -3'700, 6'600, -5'100, 5'100, -6'600,
                           3'700, -8'100, 2'200, -9'700, 700, -11'200},
});

constexpr Model kPuckHires = with_rings({
    .id = ModelId::puck_hires,
    .name = "Puck Hi-Res",
    .product = 0x24,
    .lasers = 16,
    .firings_per_block = 2,
    .lasers_at_once = 1,
    .distance_unit_mm = 2,
    .laser_interval_ns = 2'304,
    .recharge_ns = 18'432,
    .firing_period_ns = 55'296,
    .elevation_mdeg = {-10'000, 667, -8'667, 2'000, -7'333, 3'333, -6'000, 4'667, -4'667, 6'000,
                       -3'333, 7'333, -2'000, 8'667, -667, 10'000},
});

constexpr Model kVlp32c = with_rings({
    .id = ModelId::vlp32c,
    .name = "VLP-32C",
    .product = 0x28,
    .lasers = 32,
    .firings_per_block = 1,
    .lasers_at_once = 2,
    .distance_unit_mm = 4,
    .laser_interval_ns = 2'304,
    .recharge_ns = 18'432,
    .firing_period_ns = 55'296,
    .elevation_mdeg = {-25'000, -1'000, -1'667, -15'639, -11'310, 0,      -667,   -8'843,
                       -7'254,  333,    -333,   -6'148,  -5'333,  1'333,  667,    -4'000,
                       -4'667,  1'667,  1'000,  -3'667,  -3'333,  3'333,  2'333,  -2'667,
                       -3'000,  7'000,  4'667,  -2'333,  -2'000,  15'000, 10'333, -1'333},
    .azimuth_offset_mdeg = {1'400, -4'200, 1'400, -1'400, 1'400, -1'400, 4'200, -1'400,
                            1'400, -4'200, 1'400, -1'400, 4'200, -1'400, 4'200, -1'400,
                            1'400, -4'200, 1'400, -4'200, 4'200, -1'400, 1'400, -1'400,
                            1'400, -1'400, 1'400, -4'200, 4'200, -1'400, 1'400, -1'400},
});

constexpr std::array kModels{kHdl32e, kVlp16, kPuckHires, kVlp32c};

constexpr bool is_consistent(const Model& model) noexcept {
  std::uint32_t rings = 0;
  for (std::size_t i = 0; i < model.lasers; ++i) rings |= std::uint32_t{1} << model.ring[i];
  const std::uint64_t all_rings = (std::uint64_t{1} << model.lasers) - 1;
  const std::uint32_t shots = model.lasers / model.lasers_at_once;
  return rings == all_rings &&  // a permutation: no two beams have the same elevation
         std::size_t{model.lasers} * model.firings_per_block == wire_layout::kReturnsPerBlock &&
         shots * model.laser_interval_ns + model.recharge_ns == model.firing_period_ns;
}
static_assert(std::ranges::all_of(kModels, is_consistent));

constexpr bool ids_are_indices() noexcept {
  for (std::size_t i = 0; i < kModels.size(); ++i) {
    if (static_cast<std::size_t>(kModels[i].id) != i) return false;
  }
  return true;
}
static_assert(ids_are_indices());

// The advertised figures.
static_assert(kHdl32e.packet_period_ns(false) == 552'960);
static_assert(kHdl32e.packet_period_ns(true) == 276'480);
static_assert(kVlp16.packet_period_ns(false) == 1'327'104);
static_assert(kPuckHires.packet_period_ns(false) == kVlp16.packet_period_ns(false));
static_assert(kVlp32c.packet_period_ns(false) == 663'552);
// The last laser of an HDL-32E packet, as the manual's appendix E has it: 11·46.08 + 31·1.152 µs.
static_assert(11 * kHdl32e.block_period_ns() + kHdl32e.laser_time_ns(31) == 542'592);

constexpr bool hdl32e_banks_interleave() noexcept {
  for (std::size_t c = 0; c < kHdl32e.lasers; ++c) {
    if (kHdl32e.ring[c] != (c % 2 == 0 ? c / 2 : 16 + (c - 1) / 2)) return false;
  }
  return true;
}
static_assert(hdl32e_banks_interleave());

}  // namespace

const Model& model_of(ModelId id) noexcept { return kModels[static_cast<std::size_t>(id)]; }

std::span<const Model> all_models() noexcept { return kModels; }

std::optional<ModelId> model_of_product(std::uint8_t product) noexcept {
  const auto* const found = std::ranges::find(kModels, product, &Model::product);
  if (found == kModels.end()) return std::nullopt;
  return found->id;
}

}  // namespace convexcut::velodyne
