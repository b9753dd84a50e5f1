// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/methods.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include "bench/accuracy/baselines.hpp"
#include "core/convex_cut/engine.hpp"
#include "core/convex_cut/robust/robust_cut.hpp"

namespace convexcut::bench {
namespace {

constexpr std::size_t kMostPoints = 150'000;

void require_ok(CutStatus status) {
  if (status != CutStatus::ok) throw std::runtime_error("a simulated cloud was refused");
}

class Paper : public Method {
 public:
  void label(const CloudView& cloud, const Vec3& /*position_m*/, std::span<Label> labels) override {
    require_ok(engine_.label(cloud, labels));
  }

 private:
  ConvexCutEngine engine_{{}, kMostPoints, 1};
};

class Robust : public Method {
 public:
  explicit Robust(const RobustParameters& parameters, bool told = false)
      : cut_(parameters, kMostPoints), told_(told) {}
  void label(const CloudView& cloud, const Vec3& position_m, std::span<Label> labels) override {
    require_ok(cut_.label(cloud, labels, told_ ? std::optional(position_m) : std::nullopt));
  }

 private:
  RobustCut cut_;
  bool told_;
};

// Labels that do not wait for what their revolution shows; learnt from is one in `stride` of them.
class RobustAtOnce : public Method {
 public:
  explicit RobustAtOnce(unsigned stride) : stride_(stride) {}
  void label(const CloudView& cloud, const Vec3& /*position_m*/, std::span<Label> labels) override {
    require_ok(cut_.label_at_once(cloud, labels));
    const bool is_time = ++revolutions_ % stride_ == 0;
    cut_.learn(is_time ? RobustCut::Learning::now : RobustCut::Learning::later);
  }

 private:
  RobustCut cut_{{}, kMostPoints};
  unsigned stride_;
  unsigned revolutions_ = 0;
};

class Function : public Method {
 public:
  using Call = void (*)(const CloudView&, std::span<Label>);
  explicit Function(Call call) : call_(call) {}
  void label(const CloudView& cloud, const Vec3& /*position_m*/, std::span<Label> labels) override {
    call_(cloud, labels);
  }

 private:
  Call call_;
};

[[nodiscard]] NamedMethod robust(std::string name, std::string description,
                                 const RobustParameters& parameters) {
  return {std::move(name), std::move(description),
          [parameters] { return std::make_unique<Robust>(parameters); }};
}

[[nodiscard]] NamedMethod at_once(std::string name, std::string description, unsigned stride) {
  return {std::move(name), std::move(description),
          [stride] { return std::make_unique<RobustAtOnce>(stride); }};
}

[[nodiscard]] NamedMethod baseline(std::string name, std::string description, Function::Call call) {
  return {std::move(name), std::move(description),
          [call] { return std::make_unique<Function>(call); }};
}

[[nodiscard]] NamedMethod without(std::string name, std::string description,
                                  bool RobustParameters::*part) {
  RobustParameters parameters;
  parameters.*part = false;
  return robust(std::move(name), std::move(description), parameters);
}

}  // namespace

std::vector<NamedMethod> compared_methods() {
  return {{"paper", "Convex Cut as published, d = 0.05 m, e = 0.08 m",
           [] { return std::make_unique<Paper>(); }},
          robust("robust", "the second method", {}),
          baseline("farthest-column", "farthest horizontal range of each azimuth column",
                   label_farthest_column),
          baseline("half-space RANSAC", "planes with 98 % of the cloud on one side",
                   label_half_space_ransac),
          baseline("3D hull", "within 12 cm of the cloud's convex hull", label_hull)};
}

std::vector<NamedMethod> ablations() {
  RobustParameters one;
  one.window = 1;
  RobustParameters ten;
  ten.window = 10;
  return {
      robust("robust", "all parts", {}),
      robust("window 1", "one revolution alone", one),
      robust("window 10", "ten revolutions", ten),
      without("no free space", "every plane is kept", &RobustParameters::free_space),
      without("no furniture rule", "fronts before walls are kept", &RobustParameters::furniture),
      without("no fixture rule", "what is flat on a wall is kept", &RobustParameters::fixtures),
      without("no pillars", "planes only", &RobustParameters::pillars),
      without("no curved part", "planes only", &RobustParameters::curved),
      without("no mirror test", "mirror images are kept", &RobustParameters::mirrors),
      without("no memory of verdicts", "each revolution decides alone", &RobustParameters::steady),
      without("no upright correction", "gravity is believed", &RobustParameters::upright),
      without("no alignment", "each revolution's pose is believed", &RobustParameters::align),
      at_once("labels at once", "by the revolutions before; learnt from after", 1),
      at_once("learning of 1 in 2", "labels at once, every second revolution is learnt from", 2),
      at_once("learning of 1 in 4", "labels at once, every fourth", 4)};
}

NamedMethod robust_with_positions() {
  return {"robust, told positions", "the rig's positions are given",
          [] { return std::make_unique<Robust>(RobustParameters{}, true); }};
}

}  // namespace convexcut::bench
