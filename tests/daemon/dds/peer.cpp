// SPDX-License-Identifier: Apache-2.0
//
// daemon_dds_peer DOMAIN PROFILE TOPIC: a program like a ROS 2 node, for network_test. Reads
// PointCloud2 from TOPIC with ROS 2's default QoS. Prints "ready" when it has matched a writer,
// then "points WIDTH BYTES" for each cloud. Ends when its stdin is closed.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <unistd.h>

#include "daemon/dds/participant.hpp"
#include "daemon/dds/ros2_type.hpp"
#include "support/test_reader.hpp"

namespace convexcut::daemon {
namespace {

// The waitset wakes up for the reader's status (matched) and for its data.
void wait_for(dds_entity_t waitset) {
  dds_attach_t triggered;
  static_cast<void>(dds_waitset_wait(waitset, &triggered, 1, DDS_INFINITY));
}

void run(const config::Dds& settings) {
  const Participant participant(settings);
  testing::TestReader reader(participant, kPointCloud2Type, settings.points_topic,
                             testing::ros2_default_qos().get());
  const Entity waitset = require(dds_create_waitset(participant.handle()), "waitset");
  dds_set_status_mask(reader.handle(), DDS_SUBSCRIPTION_MATCHED_STATUS | DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(waitset.get(), reader.handle(), 0);
  while (reader.matched_writers() == 0) wait_for(waitset.get());
  static_cast<void>(std::puts("ready"));
  while (true) {
    wait_for(waitset.get());
    static_cast<void>(reader.matched_writers());  // clears the status that may have woken us up
    while (reader.take<sensor_msgs_msg_dds__PointCloud2_>([](const auto& cloud) {
      static_cast<void>(std::printf("points %u %u\n", cloud.width, cloud.data._length));
    })) {
    }
  }
}

}  // namespace
}  // namespace convexcut::daemon

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  static_cast<void>(std::setvbuf(stdout, nullptr, _IOLBF, 0));
  // Goes with the test, even when that crashes.
  std::thread([] {
    char byte = 0;
    while (::read(STDIN_FILENO, &byte, 1) > 0) {
    }
    std::_Exit(0);
  }).detach();
  convexcut::config::Dds settings;
  settings.domain = static_cast<std::uint32_t>(std::strtoul(argv[1], nullptr, 10));
  settings.profile = argv[2];
  settings.points_topic = argv[3];
  convexcut::daemon::run(settings);
}
