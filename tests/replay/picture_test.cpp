// SPDX-License-Identifier: Apache-2.0
//
// The picture is read back and its pixels are looked at: size, which mark is where, what is left
// out. Whether it is pleasant to look at is not proved.
#include "replay/picture.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "replay/picture/canvas.hpp"
#include "replay/picture/font.hpp"
#include "replay/picture/theme.hpp"
#include "tests/support/recordings.hpp"

namespace convexcut::replay {
namespace {

using test::TemporaryDirectory;

struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgb;

  // How far a pixel is from a colour, 0 … 441.
  [[nodiscard]] double distance(std::uint32_t x, std::uint32_t y, Colour colour) const {
    const std::size_t at = (std::size_t{y} * width + x) * 3;
    return std::hypot(rgb[at] - 255.0 * static_cast<double>(colour.red),
                      rgb[at + 1] - 255.0 * static_cast<double>(colour.green),
                      rgb[at + 2] - 255.0 * static_cast<double>(colour.blue));
  }
};

Image read_png(const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, file.c_str()) == 0)
    throw std::runtime_error(png.message);
  png.format = PNG_FORMAT_RGB;
  Image image{png.width, png.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(png))};
  if (png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(png.message);
  }
  return image;
}

// The two plots are in the two halves; the legend is below the right one.
struct Region {
  std::uint32_t left, top, right, bottom;
};
constexpr Region kFromAbove{64, 100, 764, 752};
constexpr Region kSlice{848, 100, 1560, 440};

// Middle of the pixels of about that colour.
std::optional<Pixel> middle(const Image& image, const Region& region, Colour colour) {
  Pixel sum;
  int count = 0;
  for (std::uint32_t y = region.top; y < region.bottom; ++y) {
    for (std::uint32_t x = region.left; x < region.right; ++x) {
      if (image.distance(x, y, colour) > 60.0) continue;
      sum.x += x;
      sum.y += y;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return Pixel{sum.x / count, sum.y / count};
}

class Points {
 public:
  // Enough points at one place to be seen.
  Points& heap(float x, float y, float z, Label label) {
    for (int i = 0; i < 40; ++i) add(x + 0.002F * static_cast<float>(i % 5), y, z, label);
    return *this;
  }
  Points& add(float x, float y, float z, Label label) {
    x_.push_back(x);
    y_.push_back(y);
    z_.push_back(z);
    label_.push_back(label);
    return *this;
  }
  // A box of structure, so that the extents are the same whatever else is drawn.
  Points& room() {
    for (const float x : {-5.0F, 5.0F}) {
      for (const float y : {-5.0F, 5.0F}) {
        for (const float z : {-1.0F, 1.5F}) heap(x, y, z, Label::structure);
      }
    }
    return *this;
  }
  [[nodiscard]] PictureInput input() const { return {{x_, y_, z_}, label_, "test", {}, 0.05}; }

 private:
  std::vector<float> x_, y_, z_;
  std::vector<Label> label_;
};

Image picture(const PictureInput& input) {
  const TemporaryDirectory folder;
  render_picture(input, folder.path() / "scan.png");
  return read_png(folder.path() / "scan.png");
}

TEST(Picture, HasItsSize) {
  const Image image = picture(Points().room().input());
  EXPECT_EQ(image.width, 1600U);
  EXPECT_EQ(image.height, 820U);
}

TEST(Picture, ForwardIsUpAndLeftIsLeftSeenFromAbove) {
  const Points points = Points().room().heap(3.0F, 2.0F, 0.0F, Label::other);
  const Image image = picture(points.input());
  const auto at = middle(image, kFromAbove, theme::kOther);
  ASSERT_TRUE(at.has_value());
  // The room is symmetric: the lidar is in the middle of the field.
  const double scale = 652.0 / (10.0 * 1.08);
  EXPECT_NEAR(at->x, 414.0 - 2.0 * scale, 2.0);
  EXPECT_NEAR(at->y, 426.0 - 3.0 * scale, 2.0);
}

TEST(Picture, SliceRunsFromBehindOnTheLeftToAheadOnTheRight) {
  const Points points = Points()
                            .room()
                            .heap(-4.0F, 0.0F, -1.0F, Label::structure)
                            .heap(4.0F, 0.0F, 1.0F, Label::structure)
                            .heap(-4.0F, 0.0F, 1.0F, Label::structure)
                            .heap(2.0F, 0.0F, 0.5F, Label::other);
  const Image image = picture(points.input());
  const auto at = middle(image, kSlice, theme::kOther);
  ASSERT_TRUE(at.has_value());
  const double scale = 712.0 / (8.0 * 1.08);
  EXPECT_NEAR(at->x, 1204.0 + 2.0 * scale, 2.0);
  EXPECT_NEAR(at->y, 270.0 - 0.5 * scale, 2.0);
}

TEST(Picture, SliceAngleTurnsFromForwardToTheLeft) {
  // On the left of the lidar: in a slice at 90° it is ahead.
  const Points points = Points()
                            .heap(0.0F, 4.0F, 1.0F, Label::structure)
                            .heap(0.0F, 4.0F, -1.0F, Label::structure)
                            .heap(0.0F, -4.0F, -1.0F, Label::structure)
                            .heap(0.0F, 2.0F, -0.5F, Label::other);
  PictureInput input = points.input();
  input.slice_angle = Degrees{90.0};
  const auto at = middle(picture(input), kSlice, theme::kOther);
  ASSERT_TRUE(at.has_value());
  EXPECT_GT(at->x, 1204.0 + 100.0);
  input.slice_angle = Degrees{0.0};
  EXPECT_FALSE(middle(picture(input), kSlice, theme::kOther).has_value());
}

TEST(Picture, HullIsDrawnAroundTheSlice) {
  const Points points = Points()
                            .heap(-4.0F, 0.0F, -1.0F, Label::structure)
                            .heap(4.0F, 0.0F, -1.0F, Label::structure)
                            .heap(0.0F, 0.0F, 1.0F, Label::structure);
  const Image image = picture(points.input());
  // Half way along the lower edge there is no point, but the line.
  const double scale = 712.0 / (8.0 * 1.08);
  const auto x = static_cast<std::uint32_t>(1204.0 + 1.5 * scale);
  const auto y = static_cast<std::uint32_t>(270.0 + 1.0 * scale);
  double nearest = 441.0;
  for (std::uint32_t row = y - 3; row <= y + 3; ++row) {
    nearest = std::min(nearest, image.distance(x, row, theme::kInk));
  }
  EXPECT_LT(nearest, 90.0);
}

TEST(Picture, ACloudWithoutLabelsHasOneColour) {
  const Points points = Points().room().heap(3.0F, 2.0F, 0.0F, Label::other);
  PictureInput input = points.input();
  input.label = {};
  const Image image = picture(input);
  EXPECT_FALSE(middle(image, kFromAbove, theme::kOther).has_value());
  EXPECT_FALSE(middle(image, kFromAbove, theme::kStructure).has_value());
  EXPECT_TRUE(middle(image, kFromAbove, theme::kUnlabelled).has_value());
}

TEST(Picture, WhatIsNoMeasurementIsLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const Points clean = Points().room().heap(1.0F, 0.0F, 0.0F, Label::other);
  const Points dirty = Points()
                           .room()
                           .add(kNan, 1.0F, 1.0F, Label::other)
                           .add(1.0F, kInf, 1.0F, Label::structure)
                           .add(0.0F, 0.0F, 0.0F, Label::other)
                           .heap(1.0F, 0.0F, 0.0F, Label::other);
  EXPECT_EQ(picture(clean.input()).rgb, picture(dirty.input()).rgb);
}

TEST(Picture, AFewFarPointsDoNotShrinkTheRoom) {
  Points points;
  for (int i = 0; i < 10; ++i) points.room();
  points.heap(3.0F, 2.0F, 0.0F, Label::other);
  const auto near = middle(picture(points.input()), kFromAbove, theme::kOther);
  points.add(80.0F, 0.0F, 0.0F, Label::structure).add(0.0F, 1e30F, 0.0F, Label::structure);
  const auto with_far = middle(picture(points.input()), kFromAbove, theme::kOther);
  ASSERT_TRUE(near.has_value() && with_far.has_value());
  EXPECT_NEAR(near->x, with_far->x, 3.0);
  EXPECT_NEAR(near->y, with_far->y, 3.0);
}

TEST(Picture, AbsurdCoordinatesGiveAPictureAllTheSame) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const Points points = Points()
                            .add(kLargest, 0.0F, 1.0F, Label::structure)
                            .add(-kLargest, 0.0F, -kLargest, Label::structure)
                            .add(0.0F, kLargest, kLargest, Label::other);
  EXPECT_EQ(picture(points.input()).width, 1600U);
}

TEST(Picture, AnEmptyCloudGivesAPicture) {
  EXPECT_EQ(picture({{}, {}, "empty", {}, 0.05}).width, 1600U);
}

TEST(Picture, TheSameInputGivesTheSameFile) {
  const Points points = Points().room().heap(1.0F, 0.5F, 0.0F, Label::other);
  const TemporaryDirectory folder;
  render_picture(points.input(), folder.path() / "a.png");
  render_picture(points.input(), folder.path() / "b.png");
  EXPECT_EQ(test::read_bytes(folder.path() / "a.png"), test::read_bytes(folder.path() / "b.png"));
}

TEST(Picture, SpansOfDifferentLengthsAreRefused) {
  const std::vector<float> three(3, 1.0F);
  const std::vector<Label> two(2, Label::other);
  const TemporaryDirectory folder;
  EXPECT_THROW(render_picture({{three, three, three}, two, "", {}, 0.05}, folder.path() / "x.png"),
               std::invalid_argument);
}

TEST(Picture, AFileThatCannotBeWrittenIsNamed) {
  const Points points = Points().room();
  try {
    render_picture(points.input(), "/nonexistent/folder/scan.png");
    FAIL() << "expected an exception";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("/nonexistent/folder/scan.png"));
  }
}

TEST(Picture, NothingButTheWholeFileRemains) {
  const TemporaryDirectory folder;
  render_picture(Points().room().input(), folder.path() / "scan.png");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    ++files;
  }
  EXPECT_EQ(files, 1U);
}

TEST(Canvas, WhatLiesFarOutsideIsNotDrawnAndHarmsNothing) {
  Canvas canvas(20, 10, theme::kPaper);
  canvas.line({-1e12, 5.0}, {1e12, 5.0}, 2.0, theme::kInk);
  canvas.disc({1e12, -1e12}, 5.0, theme::kInk);
  canvas.text({-500.0, 1e9}, 10.0, theme::kInk, "far away");
  canvas.fill({-1e9, -1e9, 10, 10}, theme::kInk);
  const TemporaryDirectory folder;
  canvas.write_png(folder.path() / "line.png");
  const Image image = read_png(folder.path() / "line.png");
  EXPECT_LT(image.distance(10, 4, theme::kInk), 20.0);
  EXPECT_LT(image.distance(10, 0, theme::kPaper), 1.0);
}

TEST(Font, EveryPrintableCharacterButTheBlankHasDots) {
  for (char c = '!'; c <= '~'; ++c) {
    bool any = false;
    for (int row = 0; row < Glyph::kRows; ++row) {
      for (int column = 0; column < Glyph::kColumns; ++column) any |= glyph(c).dot(column, row);
    }
    EXPECT_TRUE(any) << c;
  }
}

TEST(Font, OtherCharactersAreAQuestionMark) {
  EXPECT_EQ(&glyph('\n'), &glyph('?'));
  EXPECT_EQ(&glyph(static_cast<char>(0xC3)), &glyph('?'));
}

}  // namespace
}  // namespace convexcut::replay
