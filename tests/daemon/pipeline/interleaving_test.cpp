// SPDX-License-Identifier: Apache-2.0
//
// The same packets and samples give the same scans however the streams interleave and whenever
// somebody asks for results: what a replay of a recorded live run rests on. Does not prove that a
// recording has the same packets and samples (replay/record_test.cpp,
// program/live_recording_test.cpp).
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/pipeline/pipeline.hpp"
#include "daemon/sources/recordings.hpp"
#include "tests/support/room.hpp"

namespace convexcut::daemon {
namespace {

// Keeps everything, in order.
template <class Sample>
class Keep final : public Sink<Sample> {
 public:
  [[nodiscard]] Sample* claim() noexcept override { return slot_.get(); }
  void commit() noexcept override { samples_.push_back(*slot_); }
  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }
  [[nodiscard]] std::vector<Sample>& samples() { return samples_; }

 private:
  std::unique_ptr<Sample> slot_ = std::make_unique<Sample>();
  std::vector<Sample> samples_;
};

class Interleaving : public test::RoomTest {
 protected:
  void SetUp() override {
    make_room({"--seconds", "2"});
    NullSink<EncoderSample> angles;
    Recordings recordings({lidar(), imu(), {}, {}}, config_, lidar_, imu_, angles);
    while (recordings.step()) {
    }
    recordings.finish();
    delay_packets();
  }

  // As a busy host stamps them, and without PPS: so that the mapping of the lidar's clock keeps
  // changing a little, and it matters when it is asked.
  void delay_packets() {
    std::mt19937 random(3);
    HostTime before = HostTime::min();
    for (ReturnBatch& batch : lidar_.samples()) {
      batch.pps = PpsState::absent;
      batch.arrival += std::chrono::microseconds{50 + random() % 3000};
      batch.arrival = before = std::max(before, batch.arrival);
    }
  }

  void collect(Pipeline& pipeline, HostTime now, std::vector<LevelledScan>& scans) const {
    LevelledScan scan;
    reserve(scan, Pipeline::kMaxReturnsPerScan);
    while (pipeline.next_scan(now, scan)) scans.push_back(scan);
  }

  // In order of arrival, with results asked for after each record, as `process` does.
  std::vector<LevelledScan> in_order() const {
    Pipeline pipeline(pipeline_options(config_));
    std::vector<LevelledScan> scans;
    std::size_t next_imu = 0;
    const auto& samples = imu_.samples();
    for (const ReturnBatch& batch : lidar_.samples()) {
      while (next_imu < samples.size() && samples[next_imu].arrival <= batch.arrival) {
        pipeline.on_imu(samples[next_imu++]);
      }
      pipeline.on_lidar(batch);
      collect(pipeline, batch.arrival, scans);
    }
    return scans;
  }

  // In pieces of random length, as a worker finds them in its rings. A scan is asked for when its
  // orientations are there, never because its time is up.
  std::vector<LevelledScan> in_pieces(std::mt19937& random) const {
    Pipeline pipeline(pipeline_options(config_));
    std::vector<LevelledScan> scans;
    std::size_t next_imu = 0;
    std::size_t next_lidar = 0;
    const auto& samples = imu_.samples();
    const auto& batches = lidar_.samples();
    while (next_lidar < batches.size() || next_imu < samples.size()) {
      for (std::size_t n = random() % 30; n > 0 && next_imu < samples.size(); --n) {
        pipeline.on_imu(samples[next_imu++]);
      }
      // Not more than two scans' worth: more than that cannot wait.
      for (std::size_t n = random() % 300; n > 0 && next_lidar < batches.size(); --n) {
        if (pipeline.waiting() + 1 >= Pipeline::kMaxWaiting) break;
        pipeline.on_lidar(batches[next_lidar++]);
      }
      collect(pipeline, HostTime::min(), scans);
    }
    EXPECT_EQ(pipeline.scans_dropped(), 0U);
    return scans;
  }

  config::Config config_;
  Keep<ReturnBatch> lidar_;
  Keep<ImuSample> imu_;
};

void expect_same(const LevelledScan& a, const LevelledScan& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.last_firing, b.last_firing);
  EXPECT_EQ(a.dropped_no_orientation, b.dropped_no_orientation);
  EXPECT_EQ(a.structure_points, b.structure_points);
  EXPECT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z) << "of " << a.size() << " points";
  EXPECT_TRUE(a.time_ns == b.time_ns && a.label == b.label && a.ring == b.ring);
}

TEST_F(Interleaving, DoesNotChangeAScan) {
  const std::vector<LevelledScan> expected = in_order();
  ASSERT_GE(expected.size(), 15U);
  std::mt19937 random(5);
  for (int round = 0; round < 4; ++round) {
    const std::vector<LevelledScan> found = in_pieces(random);
    ASSERT_GE(found.size() + 1, expected.size());
    for (std::size_t i = 0; i < std::min(found.size(), expected.size()); ++i) {
      SCOPED_TRACE("scan " + std::to_string(i));
      expect_same(found[i], expected[i]);
    }
  }
}

}  // namespace
}  // namespace convexcut::daemon
