// SPDX-License-Identifier: Apache-2.0
//
// The colours and sizes of the picture. Structure and the rest differ in lightness as well as in
// hue, and the hues are two of Okabe and Ito's, which stay apart in every common colour blindness.
#pragma once

#include "replay/picture/canvas.hpp"

namespace convexcut::replay::theme {

inline constexpr Colour kPaper = Colour::hex(0xFFFFFF);
inline constexpr Colour kGround = Colour::hex(0xFAFAF8);
inline constexpr Colour kGrid = Colour::hex(0xE4E4E0);
inline constexpr Colour kAxis = Colour::hex(0xB8B8B2);
inline constexpr Colour kInk = Colour::hex(0x222428);
inline constexpr Colour kQuiet = Colour::hex(0x6B6F76);  // numbers and names of axes

inline constexpr Colour kStructure = Colour::hex(0x0072B2);  // blue
inline constexpr Colour kOther = Colour::hex(0xD55E00);      // vermillion
inline constexpr Colour kUnlabelled = Colour::hex(0x3A4750);

// Heights of capitals, pixels.
inline constexpr double kTitleSize = 17.0;
inline constexpr double kHeadingSize = 12.0;
inline constexpr double kTextSize = 11.0;
inline constexpr double kNumberSize = 9.5;

}  // namespace convexcut::replay::theme
