#include "viewer/panel.h"

#include <gtest/gtest.h>

namespace alcove::sample {
namespace {

TEST(SmoothedTimes, TimesOfTheFirstFrameAreNotSmoothed) {
  SmoothedTimes times;
  times.add({{"gtao", 2.0}, {"picture", 1.0}});
  EXPECT_DOUBLE_EQ(times.total_ms(), 3.0);
}

TEST(SmoothedTimes, OneSlowFrameChangesTheSmoothedTimesLittleAndManySlowFramesFully) {
  SmoothedTimes times;
  times.add({{"gtao", 2.0}});
  times.add({{"gtao", 12.0}});
  EXPECT_GT(times.total_ms(), 2.0);
  EXPECT_LT(times.total_ms(), 3.0);
  for (int i = 0; i < 200; ++i) times.add({{"gtao", 12.0}});
  EXPECT_NEAR(times.total_ms(), 12.0, 0.01);
}

TEST(SmoothedTimes, ChangedListOfPassesRestartsTheSmoothingAndAFrameWithoutTimesIsIgnored) {
  SmoothedTimes times;
  times.add({{"gtao", 2.0}});
  times.add({});
  EXPECT_DOUBLE_EQ(times.total_ms(), 2.0);
  times.add({{"gtao", 4.0}, {"gtso", 1.0}});
  EXPECT_DOUBLE_EQ(times.total_ms(), 5.0);
}

}  // namespace
}  // namespace alcove::sample
