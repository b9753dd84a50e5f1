// SPDX-License-Identifier: Apache-2.0
//
// The metrics on hand-made cases and by their properties. Does not prove that the paper counted the
// same way where it does not say how.
#include <algorithm>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "replay/evaluation/patch_metrics.hpp"
#include "replay/evaluation/point_metrics.hpp"
#include "replay/evaluation/summary.hpp"

namespace convexcut::evaluation {
namespace {

using simulation::SurfaceLabel;

constexpr Label kKept = Label::structure;
constexpr Label kGone = Label::other;
constexpr SurfaceLabel kWall = SurfaceLabel::structure;
constexpr SurfaceLabel kDesk = SurfaceLabel::object;
constexpr SurfaceLabel kPerson = SurfaceLabel::dynamic;
constexpr SurfaceLabel kGhost = SurfaceLabel::none;

TEST(PointMetrics, CountsEveryCombinationOnce) {
  const std::vector<Label> result{kKept, kKept, kKept, kGone, kGone, kGone, kKept, kGone};
  const std::vector<SurfaceLabel> truth{kWall, kWall, kDesk, kWall, kDesk, kPerson, kGhost, kGhost};
  const PointCounts counts = count_points(result, truth);
  EXPECT_EQ(counts.true_positive, 2U);
  EXPECT_EQ(counts.false_positive, 1U);
  EXPECT_EQ(counts.false_negative, 1U);
  EXPECT_EQ(counts.true_negative, 2U);
  EXPECT_EQ(counts.dynamic, 1U);
  EXPECT_EQ(counts.unjudged, 2U);
  EXPECT_EQ(counts.unjudged_kept, 1U);
  EXPECT_EQ(counts.judged(), 6U);
  EXPECT_DOUBLE_EQ(dynamic_ratio(counts), 1.0 / 6.0);
  const Score score = score_of(counts);
  EXPECT_DOUBLE_EQ(score.precision, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.recall, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.f, 2.0 / 3.0);
}

TEST(PointMetrics, FIsTheHarmonicMeanOfPrecisionAndRecall) {
  const Score score = score_of(30, 10, 30);
  EXPECT_DOUBLE_EQ(score.precision, 0.75);
  EXPECT_DOUBLE_EQ(score.recall, 0.5);
  EXPECT_DOUBLE_EQ(score.f, 2.0 * 0.75 * 0.5 / 1.25);
}

TEST(PointMetrics, WhereThereIsNothingTheConventionsHold) {
  const Score nothing = score_of(0, 0, 0);
  EXPECT_EQ(nothing.precision, 1.0);
  EXPECT_EQ(nothing.recall, 1.0);
  EXPECT_EQ(nothing.f, 1.0);
  const Score nothing_kept = score_of(0, 0, 5);
  EXPECT_EQ(nothing_kept.precision, 0.0);
  EXPECT_EQ(nothing_kept.recall, 0.0);
  EXPECT_EQ(nothing_kept.f, 0.0);
  const Score no_structure = score_of(0, 5, 0);
  EXPECT_EQ(no_structure.precision, 0.0);
  EXPECT_EQ(no_structure.recall, 1.0);
  EXPECT_EQ(no_structure.f, 0.0);
  EXPECT_EQ(dynamic_ratio({}), 0.0);
}

TEST(PointMetrics, PerfectLabelsScoreOneAndScoresStayInRange) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 50; ++round) {
    std::vector<SurfaceLabel> truth(200);
    std::vector<Label> perfect(200), chance(200);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      truth[i] = static_cast<SurfaceLabel>(random() % 4);
      perfect[i] = truth[i] == kWall ? kKept : kGone;
      chance[i] = random() % 2 == 0 ? kKept : kGone;
    }
    const Score best = score_of(count_points(perfect, truth));
    EXPECT_EQ(best.precision, 1.0);
    EXPECT_EQ(best.recall, 1.0);
    EXPECT_EQ(best.f, 1.0);
    const Score some = score_of(count_points(chance, truth));
    EXPECT_GT(some.f, 0.0);
    EXPECT_LT(some.f, 1.0);
    EXPECT_GE(some.f, std::min(some.precision, some.recall));
    EXPECT_LE(some.f, std::max(some.precision, some.recall));
  }
}

TEST(PointMetrics, SurfacesAreTalliedOverScans) {
  std::vector<SurfaceCounts> by_surface;
  for (int scan = 0; scan < 2; ++scan) {
    add_surfaces(std::vector{kKept, kGone, kKept, kGone, kKept},
                 std::vector{kWall, kWall, kDesk, kDesk, kGhost},
                 std::vector<std::uint16_t>{0, 0, 3, 3, 3}, by_surface);
  }
  ASSERT_EQ(by_surface.size(), 4U);
  EXPECT_EQ(by_surface[0].points, 4U);
  EXPECT_EQ(by_surface[0].kept, 2U);
  EXPECT_EQ(by_surface[0].wrong, 2U);
  EXPECT_EQ(by_surface[1].points, 0U);
  EXPECT_EQ(by_surface[3].points, 4U);
  EXPECT_EQ(by_surface[3].kept, 2U);
  EXPECT_EQ(by_surface[3].wrong, 2U);
}

TEST(PointMetrics, RefusesColumnsOfDifferentLength) {
  const std::vector<Label> two(2);
  const std::vector<SurfaceLabel> three(3);
  EXPECT_THROW(static_cast<void>(count_points(two, three)), std::invalid_argument);
  std::vector<SurfaceCounts> by_surface;
  const std::vector<SurfaceLabel> truth(2);
  EXPECT_THROW(add_surfaces(two, truth, std::vector<std::uint16_t>(3), by_surface),
               std::invalid_argument);
}

TEST(Summary, GivesMeanDeviationAndWorst) {
  Summary summary;
  for (const double value : {0.9, 0.7, 0.8, 0.7}) summary.add(value);
  EXPECT_EQ(summary.count(), 4U);
  EXPECT_DOUBLE_EQ(summary.mean(), 0.775);
  EXPECT_NEAR(summary.standard_deviation(), 0.0957427107756338, 1e-15);
  EXPECT_EQ(summary.worst(), 0.7);
  EXPECT_EQ(summary.worst_at(), 1U);
}

TEST(Summary, OfOneOrNoValueHasNoDeviation) {
  Summary summary;
  EXPECT_EQ(summary.mean(), 0.0);
  EXPECT_EQ(summary.worst(), 0.0);
  summary.add(0.5);
  EXPECT_EQ(summary.mean(), 0.5);
  EXPECT_EQ(summary.standard_deviation(), 0.0);
}

// Patches of ten points each, in order: the truth, and how many points are kept; these are a patch
// of the output.
struct Patch {
  SurfaceLabel truth;
  int kept;
};

class Cloud {
 public:
  explicit Cloud(const std::vector<Patch>& patches) {
    for (std::size_t p = 0; p < patches.size(); ++p) {
      for (int i = 0; i < 10; ++i) {
        input.push_back(static_cast<std::uint32_t>(p));
        const bool is_kept = i < patches[p].kept;
        result.push_back(is_kept ? kKept : kGone);
        output.push_back(is_kept ? static_cast<std::uint32_t>(p) : kNoPatch);
        truth.push_back(patches[p].truth);
      }
    }
  }
  [[nodiscard]] PatchCounts count() const { return count_patches(input, result, output, truth); }

  std::vector<std::uint32_t> input, output;
  std::vector<Label> result;
  std::vector<SurfaceLabel> truth;
};

TEST(PatchMetrics, ClassesAreThoseOfThePaper) {
  const Cloud cloud({{kDesk, 0}, {kPerson, 0}, {kDesk, 10}, {kWall, 10}, {kWall, 5}, {kWall, 0}});
  const PatchCounts counts = cloud.count();
  EXPECT_EQ(counts.objects_removed, 2U);  // A
  EXPECT_EQ(counts.objects_kept, 1U);     // B
  EXPECT_EQ(counts.structure_kept, 2U);   // C: half of the points is enough
  EXPECT_EQ(counts.structure_lost, 1U);   // D
  EXPECT_EQ(counts.object_fragments, 0U);
  EXPECT_DOUBLE_EQ(score_of(counts).precision, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(score_of(counts).recall, 2.0 / 3.0);
}

TEST(PatchMetrics, APieceOfARemovedObjectCountsAsKeptAndOneOfALostWallAsNothing) {
  const Cloud cloud({{kDesk, 4}, {kWall, 4}});
  const PatchCounts counts = cloud.count();
  EXPECT_EQ(counts.objects_removed, 1U);
  EXPECT_EQ(counts.objects_kept, 1U);
  EXPECT_EQ(counts.object_fragments, 1U);
  EXPECT_EQ(counts.structure_kept, 0U);
  EXPECT_EQ(counts.structure_lost, 1U);
}

TEST(PatchMetrics, APatchOfTheOutputThatTheInputDoesNotHaveCountsWhenItIsAnObjects) {
  Cloud cloud({{kWall, 10}, {kDesk, 10}});
  for (std::size_t i = 10; i < 20; ++i) cloud.input[i] = kNoPatch;
  const PatchCounts counts = cloud.count();
  EXPECT_EQ(counts.objects_kept, 1U);
  EXPECT_EQ(counts.object_fragments, 1U);
  EXPECT_EQ(counts.structure_kept, 1U);
}

TEST(PatchMetrics, AWallInTwoPiecesIsOnePatchKept) {
  Cloud cloud({{kWall, 10}});
  for (std::size_t i = 5; i < 10; ++i) cloud.output[i] = 1;
  const PatchCounts counts = cloud.count();
  EXPECT_EQ(counts.structure_kept, 1U);
  EXPECT_EQ(counts.objects_kept + counts.structure_lost, 0U);
}

// Such as one of 102 points at the end of a row of others that are gone.
TEST(PatchMetrics, AKeptPatchThatIsNotFoundInTheOutputAgainIsKept) {
  Cloud cloud({{kWall, 10}, {kDesk, 10}});
  std::ranges::fill(cloud.output, kNoPatch);
  const PatchCounts counts = cloud.count();
  EXPECT_EQ(counts.structure_kept, 1U);
  EXPECT_EQ(counts.objects_kept, 1U);
  EXPECT_EQ(counts.structure_lost + counts.objects_removed, 0U);
}

TEST(PatchMetrics, TheMajorityOfTheJudgedPointsDecidesWhatAPatchIs) {
  Cloud cloud({{kWall, 10}, {kWall, 10}, {kGhost, 10}});
  for (std::size_t i = 0; i < 5; ++i) cloud.truth[i] = kDesk;  // half and half: an object's
  for (std::size_t i = 10; i < 18; ++i) cloud.truth[i] = kGhost;
  const PatchCounts counts = cloud.count();
  EXPECT_EQ(counts.objects_kept, 1U);
  EXPECT_EQ(counts.structure_kept, 1U);  // by the two points that can be judged
  EXPECT_EQ(counts.objects_removed + counts.structure_lost, 0U);
}

// A room's floor and wall with a box before it, by the extractor itself.
class Room {
 public:
  Room() {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<float> even(0.0F, 1.0F);
    std::normal_distribution<float> noise(0.0F, 0.02F);
    for (int i = 0; i < 4000; ++i) {
      add(-3 + 6 * even(random), 3 * even(random), -1.1F + noise(random), kWall);
      add(-3 + 6 * even(random), 3 + noise(random), -1.1F + 2.7F * even(random), kWall);
      if (i % 4 == 0) {
        add(even(random), 2 + noise(random), -1.1F + 1.5F * even(random), kDesk);
      }
    }
  }
  void add(float px, float py, float pz, SurfaceLabel label) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
    truth.push_back(label);
    perfect.push_back(label == kWall ? kKept : kGone);
  }
  std::vector<float> x, y, z;
  std::vector<SurfaceLabel> truth;
  std::vector<Label> perfect;
};

TEST(PatchJudge, JudgesResultsOfOneCloud) {
  const Room room;
  PatchJudge judge;
  judge.set_input({room.x, room.y, room.z}, room.truth);
  const PatchCounts best = judge.judge(room.perfect);
  EXPECT_EQ(best.structure_kept, 2U);
  EXPECT_EQ(best.objects_removed, 1U);
  EXPECT_EQ(best.objects_kept + best.structure_lost, 0U);

  const std::vector<Label> all(room.perfect.size(), kKept);
  const PatchCounts everything = judge.judge(all);
  EXPECT_EQ(everything.structure_kept, 2U);
  EXPECT_EQ(everything.objects_kept, 1U);

  const std::vector<Label> none(room.perfect.size(), kGone);
  const PatchCounts nothing = judge.judge(none);
  EXPECT_EQ(nothing.structure_lost, 2U);
  EXPECT_EQ(nothing.objects_removed, 1U);
  EXPECT_EQ(score_of(nothing).recall, 0.0);
}

}  // namespace
}  // namespace convexcut::evaluation
