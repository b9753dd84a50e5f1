// SPDX-License-Identifier: Apache-2.0
//
// Random packets of every model against the formulas written out once more, in double and with the
// C library's functions. Does not prove: the tables, which both share, nor glitch handling, which
// the oracle leaves out.
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "core/simd/simd_path.hpp"
#include "drivers/velodyne/decoder.hpp"
#include "drivers/velodyne/sin_cos.hpp"
#include "tests/drivers/velodyne/packets.hpp"

namespace convexcut::velodyne {
namespace {

using test::DataPacket;

struct Expected {
  double x, y, z, range;
  std::int64_t time_ns;
  std::uint8_t ring, intensity;
};

// A packet and what must come of it, in order.
struct Case {
  DataPacket packet;
  std::vector<Expected> returns;
};

Expected expected_return(const Model& model, std::size_t group, std::size_t slot,
                         double block_azimuth_deg, double step_deg, std::uint16_t ticks,
                         std::uint8_t intensity) {
  const std::size_t laser = slot % model.lasers;
  const auto firing = static_cast<std::int64_t>(slot / model.lasers);
  const std::int64_t in_block = firing * model.firing_period_ns + model.laser_time_ns(laser);
  const double share = static_cast<double>(in_block) / model.block_period_ns();
  const double alpha =
      (block_azimuth_deg + step_deg * share + model.azimuth_offset_mdeg[laser] * 1e-3) * M_PI /
      180.0;
  const double omega = model.elevation_mdeg[laser] * 1e-3 * M_PI / 180.0;
  const double r = ticks * model.distance_unit_mm * 1e-3;
  return {r * std::cos(omega) * std::cos(alpha),
          -r * std::cos(omega) * std::sin(alpha),
          r * std::sin(omega) + model.vertical_offset_um[laser] * 1e-6,
          r,
          static_cast<std::int64_t>(group) * model.block_period_ns() + in_block,
          model.ring[laser],
          intensity};
}

Case random_case(const Model& model, bool dual, std::mt19937& random) {
  std::uniform_int_distribution<int> ticks(0, 65535);
  std::uniform_int_distribution<int> byte(0, 255);
  std::uniform_int_distribution<int> azimuth(0, 35999);
  std::uniform_int_distribution<int> step(8, 33);
  const std::size_t per_group = dual ? 2 : 1;
  const int first = azimuth(random);
  const int turn = step(random);
  Case made;
  made.packet.azimuths(static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(turn),
                       per_group);
  made.packet.mode(dual ? test::kDual : test::kSingle).product(model.product);
  for (std::size_t group = 0; group < 12 / per_group; ++group) {
    for (std::size_t slot = 0; slot < 32; ++slot) {
      std::uint16_t previous = 0;
      for (std::size_t i = 0; i < per_group; ++i) {
        // A quarter without a return; in dual mode, now and then the same echo twice.
        auto distance = static_cast<std::uint16_t>(byte(random) < 64 ? 0 : ticks(random));
        if (i == 1 && byte(random) < 64) distance = previous;
        const auto intensity = static_cast<std::uint8_t>(byte(random));
        made.packet.echo(group * per_group + i, slot, distance, intensity);
        if (distance != 0 && distance != previous) {
          made.returns.push_back(expected_return(model, group, slot,
                                                 (first + turn * static_cast<int>(group)) * 0.01,
                                                 turn * 0.01, distance, intensity));
        }
        previous = distance;
      }
    }
  }
  return made;
}

void expect_equal(const ReturnBatch& batch, const std::vector<Expected>& expected) {
  ASSERT_EQ(batch.return_count, expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    // Half a float's last place at 131 m (262 m for the VLP-32C) and a microdegree of rounding.
    ASSERT_NEAR(batch.x_lidar[i], expected[i].x, 2e-5);
    ASSERT_NEAR(batch.y_lidar[i], expected[i].y, 2e-5);
    ASSERT_NEAR(batch.z_lidar[i], expected[i].z, 2e-5);
    ASSERT_NEAR(batch.range_m[i], expected[i].range, 2e-5);
    ASSERT_EQ(batch.offset_ns[i], expected[i].time_ns);
    ASSERT_EQ(batch.ring[i], expected[i].ring);
    ASSERT_EQ(batch.intensity[i], expected[i].intensity);
  }
}

class DecoderOracle : public ::testing::TestWithParam<std::tuple<ModelId, bool>> {};

TEST_P(DecoderOracle, RandomPacketsComeOutAsTheFormulasSay) {
  const auto [id, dual] = GetParam();
  const Model& model = model_of(id);
  const DataDecoder decoder(model, {.vertical_offsets = true});
  // The same packets in every run. NOLINTNEXTLINE(cert-msc32-c,cert-msc51-cpp)
  std::mt19937 random(20240117);
  for (int repetition = 0; repetition < 50; ++repetition) {
    const Case made = random_case(model, dual, random);
    ReturnBatch batch;
    ASSERT_EQ(decoder.decode(made.packet.bytes(), HostTime{}, batch), DecodeStatus::ok);
    expect_equal(batch, made.returns);
    if (HasFatalFailure()) return;
  }
}

// Every column up to the number of returns, as bits.
std::vector<std::uint32_t> bits_of(const ReturnBatch& batch) {
  std::vector<std::uint32_t> bits{batch.return_count, batch.firing_count};
  for (std::size_t i = 0; i < batch.return_count; ++i) {
    for (const float value :
         {batch.x_lidar[i], batch.y_lidar[i], batch.z_lidar[i], batch.range_m[i]}) {
      bits.push_back(std::bit_cast<std::uint32_t>(value));
    }
    bits.push_back(batch.offset_ns[i]);
    bits.push_back(static_cast<std::uint32_t>(batch.intensity[i]) << 16U |
                   static_cast<std::uint32_t>(batch.ring[i]) << 8U |
                   static_cast<std::uint32_t>(batch.echo[i]) << 1U |
                   static_cast<std::uint32_t>(batch.farthest[i]));
  }
  for (std::size_t i = 0; i < batch.firing_count; ++i) {
    bits.push_back(static_cast<std::uint32_t>(batch.firings[i].azimuth.microdegrees()));
    bits.push_back(static_cast<std::uint32_t>(batch.firings[i].first_return << 16U |
                                              batch.firings[i].return_count));
  }
  return bits;
}

TEST_P(DecoderOracle, EveryInstructionSetGivesTheSameBits) {
  const auto [id, dual] = GetParam();
  const DataDecoder decoder(model_of(id));
  // NOLINTNEXTLINE(cert-msc32-c,cert-msc51-cpp)
  std::mt19937 random(7);
  for (int repetition = 0; repetition < 20; ++repetition) {
    const Case made = random_case(model_of(id), dual, random);
    std::vector<std::uint32_t> first;
    for (const std::string_view path : simd_paths()) {
      ASSERT_TRUE(use_simd_path(path));
      ReturnBatch batch;
      ASSERT_EQ(decoder.decode(made.packet.bytes(), HostTime{}, batch), DecodeStatus::ok);
      if (first.empty()) first = bits_of(batch);
      EXPECT_EQ(bits_of(batch), first) << path;
    }
    ASSERT_TRUE(use_simd_path("auto"));
  }
}

// The kernels' lanes against the same arithmetic on one return, with whole microdegrees as
// integers: the promise is one rounding to float and nothing else.
TEST(DecoderBits, AreThoseOfTheFormulasInDouble) {
  const Model& model = model_of(ModelId::hdl32e);
  // NOLINTNEXTLINE(cert-msc32-c,cert-msc51-cpp)
  std::mt19937 random(11);
  const DataDecoder decoder(model);
  for (int first = 0; first < 36'000; first += 97) {
    const std::uint16_t step = static_cast<std::uint16_t>(random() % 34);
    DataPacket packet;
    packet.azimuths(static_cast<std::uint16_t>(first), step);
    for (std::size_t slot = 0; slot < 32; ++slot) {
      packet.echo(3, slot, static_cast<std::uint16_t>(random() % 65'535 + 1));
    }
    ReturnBatch batch;
    ASSERT_EQ(decoder.decode(packet.bytes(), HostTime{}, batch), DecodeStatus::ok);
    ASSERT_EQ(batch.return_count, 32);
    for (std::size_t i = 0; i < 32; ++i) {
      const std::int64_t share =
          ((std::int64_t{model.laser_time_ns(i)} << 32) + 23'040) / model.block_period_ns();
      const std::int64_t turned =
          (std::int64_t{step} * 10'000 * share + (std::int64_t{1} << 31)) >> 32;
      const std::int64_t block = (std::int64_t{first} + 3 * step) % 36'000;
      const SinCos azimuth = sin_cos(Azimuth::from_microdegrees(block * 10'000 + turned));
      const SinCos elevation =
          sin_cos(Azimuth::from_microdegrees(std::int64_t{model.elevation_mdeg[i]} * 1000));
      const double range = std::round(static_cast<double>(batch.range_m[i]) * 500.0) * (2 * 1e-3);
      ASSERT_EQ(batch.x_lidar[i], static_cast<float>(range * (elevation.cos * azimuth.cos)));
      ASSERT_EQ(batch.y_lidar[i], static_cast<float>(range * (-elevation.cos * azimuth.sin)));
      ASSERT_EQ(batch.z_lidar[i], static_cast<float>(range * elevation.sin));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllModels, DecoderOracle,
                         ::testing::Combine(::testing::Values(ModelId::hdl32e, ModelId::vlp16,
                                                              ModelId::puck_hires, ModelId::vlp32c),
                                            ::testing::Bool()));

}  // namespace
}  // namespace convexcut::velodyne
