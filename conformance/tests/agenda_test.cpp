#include "rasterizer/threads/agenda.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <thread>
#include <vector>

namespace edgecase::rasterizer {
namespace {

const Parts kWhole = Parts::even(1, 1), kThree = Parts::even(3, 3), kFour = Parts::even(4, 4);

TEST(Agenda, TilesBeginInTheOrderOfFallingWork) {
  const std::array<double, 4> work{10, 40, 0, 20};
  Agenda agenda(work, kWhole, 5);
  std::vector<int> order;
  for (int tile = -1; const auto part = agenda.next(tile);) order.push_back(tile = part->tile);
  EXPECT_THAT(order, testing::ElementsAre(1, 3, 0, 2));
}

TEST(Agenda, AThreadKeepsItsTileUntilThePartsAreTaken) {
  const std::array<double, 2> work{40, 20};
  Agenda agenda(work, kThree, 5);
  EXPECT_EQ(agenda.next(-1), (Part{0, 0}));
  EXPECT_EQ(agenda.next(-1), (Part{1, 0}));  // another thread
  EXPECT_EQ(agenda.next(0), (Part{0, 1}));
  EXPECT_EQ(agenda.next(0), (Part{0, 2}));
}

TEST(Agenda, WhoHasNoTileHelpsWhereMostIsLeftIfThatIsWorthIt) {
  const std::array<double, 2> work{40, 20};
  Agenda agenda(work, kFour, 8);
  agenda.next(-1);
  agenda.next(-1);                           // both are begun: 30 and 15 are left
  EXPECT_EQ(agenda.next(-1), (Part{0, 1}));  // 20 and 15
  EXPECT_EQ(agenda.next(-1), (Part{0, 2}));  // 10 and 15
  EXPECT_EQ(agenda.next(-1), (Part{1, 1}));  // 10 and 10
  EXPECT_EQ(agenda.next(-1), (Part{0, 3}));  // none and 10
  EXPECT_EQ(agenda.next(-1), (Part{1, 2}));  // none and 5
  EXPECT_EQ(agenda.next(-1), std::nullopt);
  EXPECT_EQ(agenda.next(1), (Part{1, 3}));  // its own thread goes on to the end
  EXPECT_EQ(agenda.next(1), std::nullopt);
}

TEST(Agenda, WhatIsBegunForAThreadIsLeftToItIfHelpIsNotWorthIt) {
  const std::array<double, 2> work{20, 40};
  Agenda agenda(work, kFour, 25);
  EXPECT_EQ(agenda.begin(), 1);
  EXPECT_EQ(agenda.next(-1), (Part{0, 0}));
  EXPECT_EQ(agenda.next(-1), (Part{1, 0}));  // 40 are left, then 30 and 20
  EXPECT_EQ(agenda.next(-1), (Part{1, 1}));
  EXPECT_EQ(agenda.next(-1), std::nullopt);
  EXPECT_EQ(agenda.next(1), (Part{1, 2}));
}

TEST(Agenda, WhatIsLeftIsWorkNotParts) {
  const std::array<double, 1> work{80};
  const Parts falling = Parts::falling(16, 2, std::array{1.0});  // 20 20, 10 10, then four of 5
  Agenda agenda(work, falling, 30);
  agenda.next(-1);
  EXPECT_EQ(agenda.next(-1), (Part{0, 1}));
  EXPECT_EQ(agenda.next(-1), (Part{0, 2}));
  EXPECT_EQ(agenda.next(-1), std::nullopt);
  EXPECT_EQ(agenda.next(0), (Part{0, 3}));
}

TEST(Agenda, ManyThreadsGetEveryPartOnce) {
  constexpr std::size_t kParts = 1'000, kThreads = 8;
  const std::vector<double> work{5, 0, 300, 7, 7, 90, 1};
  const Parts parts = Parts::even(kParts, kParts);
  for (int round = 0; round < 20; ++round) {
    Agenda agenda(work, parts, 2);
    std::array<std::vector<Part>, kThreads> taken;
    {
      std::vector<std::jthread> threads;
      for (auto& own : taken) {
        threads.emplace_back([&] {
          int tile = -1;
          while (const auto part = agenda.next(tile)) {
            tile = part->tile;
            own.push_back(*part);
          }
        });
      }
    }
    std::vector<int> times(work.size() * kParts);
    for (const auto& own : taken) {
      for (const Part& part : own) ++times[static_cast<std::size_t>(part.tile) * kParts + part.number];
    }
    ASSERT_THAT(times, testing::Each(1));
  }
}

}  // namespace
}  // namespace edgecase::rasterizer
