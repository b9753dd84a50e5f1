// SPDX-License-Identifier: Apache-2.0
#include "support/test_reader.hpp"

#include <string>

#include <dds/ddsi/ddsi_serdata.h>

namespace convexcut::daemon::testing {

Qos ros2_default_qos() {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 10);
  const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &plain_cdr);
  return qos;
}

TestReader::TestReader(const Participant& participant, const Ros2Type& type,
                       std::string_view dds_topic, const dds_qos_t* qos)
    : topic_(require(dds_create_topic(participant.handle(), type.descriptor,
                                      std::string(dds_topic).c_str(), nullptr, nullptr),
                     dds_topic)),
      reader_(require(dds_create_reader(participant.handle(), topic_.get(), qos, nullptr),
                      dds_topic)) {}

std::uint32_t TestReader::matched_writers() const {
  dds_subscription_matched_status_t status{};
  static_cast<void>(dds_get_subscription_matched_status(reader_.get(), &status));
  return status.current_count;
}

std::vector<std::uint8_t> TestReader::take_cdr() {
  ddsi_serdata* serialised = nullptr;
  dds_sample_info_t info;
  if (dds_takecdr(reader_.get(), &serialised, 1, &info, DDS_ANY_STATE) < 1) return {};
  std::vector<std::uint8_t> bytes(ddsi_serdata_size(serialised));
  ddsi_serdata_to_ser(serialised, 0, bytes.size(), bytes.data());
  ddsi_serdata_unref(serialised);
  return bytes;
}

LevelledScan made_up_scan(std::size_t n) {
  LevelledScan scan;
  scan.index = 7;
  scan.stamp = from_ns<HostTime>(1'700'000'000'123'456'789);
  scan.last_firing = scan.stamp + std::chrono::milliseconds{100};
  scan.coverage = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto v = static_cast<float>(i);
    scan.x.push_back(v * 0.25F);
    scan.y.push_back(-v * 0.5F);
    scan.z.push_back(v * 0.125F - 3.0F);
    scan.intensity.push_back(static_cast<std::uint8_t>(i % 256));
    scan.ring.push_back(static_cast<std::uint8_t>(i % 32));
    scan.time_ns.push_back(static_cast<std::uint32_t>(i * 1152));
    scan.label.push_back(i % 3 == 0 ? Label::structure : Label::other);
  }
  scan.structure_points = static_cast<std::uint32_t>((n + 2) / 3);
  return scan;
}

}  // namespace convexcut::daemon::testing
