// Tests of the sine and cosine functions with which directions are computed.
#include "core/sin_cos.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace retrace::testing::sin_cos_test {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The expected values are computed in extended precision.
TEST(SinCos, MultiplesOf15DegreesAreTheNearestNumbers) {
  for (int step = -96; step <= 96; ++step) {
    const auto [sine, cosine] = sin_cos_deg(15.0 * step);
    const long double angle = std::numbers::pi_v<long double> / 12.0L * step;
    EXPECT_NEAR(sine, static_cast<double>(std::sin(angle)), kEpsilon / 2.0) << step;
    EXPECT_NEAR(cosine, static_cast<double>(std::cos(angle)), kEpsilon / 2.0) << step;
    EXPECT_NEAR(sine * sine + cosine * cosine, 1.0, kEpsilon);
    const int in_half_turn = std::abs(step % 12);
    if (in_half_turn == 0) {
      EXPECT_EQ(sine, 0.0) << step;
    } else if (in_half_turn == 6) {
      EXPECT_EQ(cosine, 0.0) << step;
    } else if (in_half_turn == 2 || in_half_turn == 10) {
      EXPECT_EQ(std::abs(sine), 0.5) << step;
    }
  }
}

TEST(SinCos, HaveTheSymmetriesOfTheCircleToTheLastBit) {
  for (int step = -48; step <= 48; ++step) {
    const double deg = 15.0 * step;
    const auto [sine, cosine] = sin_cos_deg(deg);
    EXPECT_EQ(sin_cos_deg(-deg).sin, -sine) << deg;
    EXPECT_EQ(sin_cos_deg(-deg).cos, cosine) << deg;
    EXPECT_EQ(sin_cos_deg(180.0 - deg).sin, sine) << deg;
    EXPECT_EQ(sin_cos_deg(90.0 - deg).sin, cosine) << deg;
    EXPECT_EQ(sin_cos_deg(deg + 360.0).sin, sine) << deg;
  }
}

TEST(SinCos, AreThoseOfRadiansAsWell) {
  EXPECT_EQ(sin_cos(Angle::from_rad(0.5 * std::numbers::pi)).cos, 0.0);
  EXPECT_EQ(sin_cos(Angle::from_rad(-std::numbers::pi)).sin, 0.0);
  EXPECT_EQ(sin_cos(Angle::from_rad(std::numbers::pi / 6.0)).sin, 0.5);
}

// An angle counts as a multiple of 15 degrees if it differs from the multiple by at most the rounding error of the
// conversion to radians. The sine and cosine of all other angles are those of the standard library.
TEST(SinCos, OfOtherAnglesAreThoseOfTheLibrary) {
  for (const double deg : {1e-300, 1e-12, 14.999999, 90.0 - 1e-12, 90.0 + 1e-12, -271.3, 44.9999999999})
    for (const double sign : {-1.0, 1.0}) {
      const Angle angle = Angle::from_deg(sign * deg);
      EXPECT_EQ(sin_cos(angle).sin, std::sin(angle.rad())) << deg;
      EXPECT_EQ(sin_cos(angle).cos, std::cos(angle.rad())) << deg;
    }
}

}  // namespace
}  // namespace retrace::testing::sin_cos_test
