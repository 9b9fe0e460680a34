#include <gtest/gtest.h>

#include <concepts>
#include <limits>
#include <random>

#include "rasterizer/int.h"

namespace edgecase::rasterizer {
namespace {

template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept Multipliable = requires(A a, B b) {
  a* b;
};
template <class A>
concept Negatable = requires(A a) {
  -a;
};

// Storing into too narrow a type does not compile; widening does, and nothing enters unchecked.
static_assert(std::convertible_to<Int<8>, Int<9>>);
static_assert(!std::constructible_from<Int<8>, Int<9>>);
static_assert(!std::assignable_from<Int<8>&, Int<9>>);
static_assert(std::assignable_from<Int<9>&, Int<8>>);
static_assert(!std::constructible_from<Int<32>, int>);
static_assert(!std::assignable_from<Int<32>&, int>);
static_assert(!std::convertible_to<Int<32>, int>);

// Neither does an operation whose result would have no type.
static_assert(Addable<Int<127>, Int<1>>);
static_assert(!Addable<Int<128>, Int<1>>);
static_assert(Multipliable<Int<64>, Int<64>>);
static_assert(!Multipliable<Int<65>, Int<64>>);
static_assert(Negatable<Int<127>> && !Negatable<Int<128>>);

static_assert(std::same_as<decltype(Int<8>() + Int<12>()), Int<13>>);
static_assert(std::same_as<decltype(Int<8>() - Int<12>()), Int<13>>);
static_assert(std::same_as<decltype(Int<8>() * Int<12>()), Int<20>>);
static_assert(std::same_as<decltype(-Int<8>()), Int<9>>);
static_assert(std::same_as<decltype(Int<8>() | Int<12>()), Int<12>>);
static_assert(std::same_as<decltype(Int<8>().shifted_left<3>()), Int<11>>);
static_assert(std::same_as<decltype(Int<8>().shifted_right<3>()), Int<5>>);

static_assert(std::same_as<Int<32>::Storage, std::int32_t> && std::same_as<Int<33>::Storage, std::int64_t>);
static_assert(std::same_as<Int<64>::Storage, std::int64_t> && std::same_as<Int<65>::Storage, Int128>);

static_assert(Int<1>::kMin == -1 && Int<1>::kMax == 0);
static_assert(Int<8>::kMin == -128 && Int<8>::kMax == 127);
static_assert(Int<64>::kMin == std::numeric_limits<std::int64_t>::min());
static_assert(Int<128>::kMax > 0 && Int<128>::kMin < 0);

static_assert(width_of(0) == 1 && width_of(-1) == 1 && width_of(1) == 2 && width_of(127) == 8 && width_of(128) == 9);
static_assert(width_of(-128) == 8 && width_of(-129) == 9);

template <int Bits>
constexpr Int<Bits> lowest() {
  return *Int<Bits>::checked(static_cast<std::int64_t>(Int<Bits>::kMin));
}
template <int Bits>
constexpr Int<Bits> highest() {
  return *Int<Bits>::checked(static_cast<std::int64_t>(Int<Bits>::kMax));
}

// The extremes are computed at compile time, where an overflow would be an error.
static_assert((lowest<64>() * lowest<64>()).value() == Int128{1} << 126);
static_assert((lowest<32>() * lowest<32>()).value() == std::int64_t{1} << 62);
static_assert((lowest<32>() + lowest<32>()).value() == -(std::int64_t{1} << 32));
static_assert((lowest<64>() - highest<64>()).value() == -(Int128{1} << 64) + 1);
static_assert((-lowest<64>()).value() == Int128{1} << 63);

TEST(RasterizerInt, CheckedTakesExactlyTheRange) {
  EXPECT_EQ(Int<8>::checked(127)->value(), 127);
  EXPECT_EQ(Int<8>::checked(-128)->value(), -128);
  EXPECT_FALSE(Int<8>::checked(128));
  EXPECT_FALSE(Int<8>::checked(-129));
  EXPECT_TRUE(Int<64>::checked(std::numeric_limits<std::int64_t>::min()));
  EXPECT_TRUE(Int<100>::checked(std::numeric_limits<std::int64_t>::max()));
}

TEST(RasterizerInt, RightShiftRoundsDown) {
  EXPECT_EQ(Int<8>::checked(-1)->shifted_right<4>().value(), -1);
  EXPECT_EQ(Int<8>::checked(-16)->shifted_right<4>().value(), -1);
  EXPECT_EQ(Int<8>::checked(-17)->shifted_right<4>().value(), -2);
  EXPECT_EQ(Int<8>::checked(15)->shifted_right<4>().value(), 0);
}

TEST(RasterizerInt, LeftShiftKeepsTheSign) {
  EXPECT_EQ((lowest<32>().shifted_left<16>().value()), -(std::int64_t{1} << 47));
  EXPECT_EQ((highest<32>().shifted_left<1>().value()), (std::int64_t{1} << 32) - 2);
}

TEST(RasterizerInt, ClampSaturatesAndKeepsWhatIsInside) {
  const auto low = *Int<8>::checked(-3), high = *Int<8>::checked(100);
  EXPECT_EQ(clamp(*Int<40>::checked(-4'000'000'000), low, high).value(), -3);
  EXPECT_EQ(clamp(*Int<40>::checked(4'000'000'000), low, high).value(), 100);
  EXPECT_EQ(clamp(*Int<40>::checked(99), low, high).value(), 99);
}

TEST(RasterizerInt, ComparesAcrossWidths) {
  EXPECT_LT(lowest<64>(), lowest<8>());
  EXPECT_GT(*Int<100>::checked(128), highest<8>());
  EXPECT_EQ(*Int<100>::checked(-5), *Int<4>::checked(-5));
}

TEST(RasterizerInt, AgreesWithPlainArithmetic) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 100'000; ++i) {
    const auto x = static_cast<std::int64_t>(random()) >> (random() % 64);
    const auto y = static_cast<std::int64_t>(random()) >> (random() % 64);
    const auto a = *Int<64>::checked(x), b = *Int<64>::checked(y);
    ASSERT_TRUE((a + b).value() == Int128{x} + y);
    ASSERT_TRUE((a - b).value() == Int128{x} - y);
    ASSERT_TRUE((a * b).value() == Int128{x} * y);
    ASSERT_TRUE((a | b).value() == (x | y));
    ASSERT_EQ(a < b, x < y);
  }
}

TEST(RasterizerStepper, WidthHoldsTheFarthestValueAndNoLess) {
  // -128 and 16 steps of -128: -2176, which 12 bits do not hold but 13 do.
  using S = Stepper<8, 8, 16>;
  static_assert(S::Value::kBits == 13);
  S stepper(lowest<8>(), lowest<8>());
  for (int i = 0; i < 16; ++i) stepper.next();
  EXPECT_EQ(stepper.value().value(), -128 * 17);
  // A wide start dominates.
  static_assert(Stepper<40, 8, 16>::Value::kBits == 41);
  static_assert(Stepper<8, 8, 17>::Value::kBits == 14);
}

}  // namespace
}  // namespace edgecase::rasterizer
