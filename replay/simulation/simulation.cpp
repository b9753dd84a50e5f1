// SPDX-License-Identifier: Apache-2.0
#include "replay/simulation/simulation.hpp"

#include "replay/simulation/stream.hpp"

namespace convexcut::simulation {
namespace {

void fill(DataBlock& block, const SimulatedFiring& firing, std::size_t echo) {
  block.azimuth = firing.azimuth;
  for (std::size_t laser = 0; laser < block.returns.size(); ++laser) {
    const SimulatedReturn& from = firing.returns[echo][laser];
    block.returns[laser] = {from.range_2mm, from.intensity};
  }
}

}  // namespace

RigOptions planned_rig(const Scene& scene, bool travels, const Vec3& aside_m) {
  const RigPlan& plan = scene.rig();
  RigOptions rig;
  rig.yaw = plan.yaw;
  if (travels && !plan.path.empty()) {
    std::vector<Vec3> way_points = plan.path.way_points();
    for (Vec3& point : way_points) point += aside_m;
    rig.path = RigPath(std::move(way_points), plan.path.speed_m_s(), plan.path.end());
  } else {
    rig.path = RigPath({plan.position + aside_m}, 1.0, PathEnd::stop);
  }
  return rig;
}

LidarStream::LidarStream(const Scene& scene, const SimulationOptions& options)
    : simulator_(scene, RigMotion(options.rig, options.seed), options.lidar, options.seed),
      link_(options.link, options.seed, kNetworkStream),
      dual_(options.lidar.dual),
      packets_(static_cast<std::uint64_t>(
          options.length / (LidarSimulator::kFiringPeriod * simulator_.firings_per_packet()))) {
  packet_.dual = dual_;
}

std::uint64_t LidarStream::firings() const noexcept {
  return packets_ * static_cast<std::uint64_t>(simulator_.firings_per_packet());
}

bool LidarStream::next(OnFiring on_firing, LidarLink::Emit on_datagram) {
  if (done_ == packets_) {
    link_.finish(on_datagram);
    return false;
  }
  const auto per_packet = static_cast<std::uint64_t>(simulator_.firings_per_packet());
  const std::uint64_t first = done_++ * per_packet;
  const std::uint64_t end = first + per_packet;
  std::size_t block = 0;
  for (std::uint64_t i = first; i < end; ++i) {
    simulator_.fire(i, firing_);
    on_firing(firing_);
    fill(packet_.blocks[block++], firing_, 0);
    if (dual_) fill(packet_.blocks[block++], firing_, 1);
  }
  link_.send(packet_,
             {.first_firing = LidarSimulator::kFiringPeriod * static_cast<std::int64_t>(first),
              .elapsed = LidarSimulator::kFiringPeriod * static_cast<std::int64_t>(end),
              .complete = simulator_.time_of(static_cast<std::int64_t>(end))},
             on_datagram);
  return true;
}

}  // namespace convexcut::simulation
