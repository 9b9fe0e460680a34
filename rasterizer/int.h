// Int<Bits>: a two's complement integer whose width is part of its type, so that overflow cannot compile.
//
// An Int<B> holds -2^(B-1) .. 2^(B-1) - 1. Every operation returns the narrowest width that holds each of its results,
// the way the adders and multipliers of a circuit are sized:
//
//   A-bit + B-bit     max(A, B) + 1 bits
//   A-bit * B-bit     A + B bits; the largest product, (-2^(A-1)) * (-2^(B-1)) = 2^(A+B-2), is why not A + B - 1
//   -A                A + 1 bits, for -(-2^(A-1))
//   A << N, A >> N    A + N and A - N bits; the right shift rounds down (floor)
//
// Widening is implicit; nothing narrows but clamp(), which saturates, and Int::checked(), which may refuse.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <compare>
#include <cstdint>
#include <optional>
#include <type_traits>

namespace edgecase::rasterizer {

__extension__ typedef __int128 Int128;

inline constexpr int kMaxBits = 128;

template <int Bits>
class Int {
  static_assert(Bits >= 1 && Bits <= kMaxBits);

 public:
  static constexpr int kBits = Bits;
  using Storage =
      std::conditional_t<(Bits <= 32), std::int32_t, std::conditional_t<(Bits <= 64), std::int64_t, Int128>>;
  static constexpr Storage kMin = static_cast<Storage>(Storage{-1} << (Bits - 1));
  static constexpr Storage kMax = static_cast<Storage>(~kMin);

  constexpr Int() = default;

  template <int Narrower>
  requires(Narrower < Bits) constexpr Int(Int<Narrower> narrower) : value_(narrower.value()) {}

  /// `value`, if it fits.
  static constexpr std::optional<Int> checked(std::int64_t value) {
    if (value < kMin || value > kMax) return std::nullopt;
    return Int(static_cast<Storage>(value), Proven{});
  }

  constexpr Storage value() const { return value_; }

  template <int B>
  requires(std::max(Bits, B) + 1 <= kMaxBits) constexpr auto operator+(Int<B> right) const {
    using Sum = Int<std::max(Bits, B) + 1>;
    return Sum::proven(Sum(*this).value() + Sum(right).value());
  }

  template <int B>
  requires(std::max(Bits, B) + 1 <= kMaxBits) constexpr auto operator-(Int<B> right) const {
    using Difference = Int<std::max(Bits, B) + 1>;
    return Difference::proven(Difference(*this).value() - Difference(right).value());
  }

  template <int B>
  requires(Bits + B <= kMaxBits) constexpr auto operator*(Int<B> right) const {
    using Product = Int<Bits + B>;
    return Product::proven(Product(*this).value() * Product(right).value());
  }

  constexpr auto operator-() const requires(Bits + 1 <= kMaxBits) {
    using Negated = Int<Bits + 1>;
    return Negated::proven(-Negated(*this).value());
  }

  /// Bitwise or: negative if either operand is.
  template <int B>
  constexpr auto operator|(Int<B> right) const {
    using Or = Int<std::max(Bits, B)>;
    return Or::proven(Or(*this).value() | Or(right).value());
  }

  /// This value times 2^N.
  template <int N>
  requires(N >= 0 && Bits + N <= kMaxBits) constexpr auto shifted_left() const {
    using Shifted = Int<Bits + N>;
    return Shifted::proven(Shifted(*this).value() << N);
  }

  /// This value divided by 2^N, rounded down.
  template <int N>
  requires(N >= 0 && N < Bits) constexpr auto shifted_right() const { return Int<Bits - N>::proven(value_ >> N); }

  template <int B>
  constexpr bool operator==(Int<B> right) const {
    return value_ == right.value();
  }
  template <int B>
  constexpr std::strong_ordering operator<=>(Int<B> right) const {
    return value_ <=> right.value();
  }

 private:
  template <int>
  friend class Int;
  template <int, int, int>
  friend class Stepper;
  template <int A, int B>
  friend constexpr Int<B> clamp(Int<A>, Int<B>, Int<B>);

  struct Proven {};
  constexpr Int(Storage value, Proven) : value_(value) {}

  /// For the operations above: `value` is known to fit from the widths of what it was computed from.
  template <class T>
  static constexpr Int proven(T value) {
    assert(value >= kMin && value <= kMax);
    return Int(static_cast<Storage>(value), Proven{});
  }

  Storage value_ = 0;
};

/// The narrowest width that holds `value`.
constexpr int width_of(std::int64_t value) {
  return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(value < 0 ? ~value : value))) + 1;
}

/// A number known at compile time, in the narrowest width that holds it.
template <std::int64_t Value>
inline constexpr Int<width_of(Value)> constant = *Int<width_of(Value)>::checked(Value);

/// `value` moved into [low, high]; this way of narrowing never changes a value inside these bounds. low <= high.
template <int A, int B>
constexpr Int<B> clamp(Int<A> value, Int<B> low, Int<B> high) {
  if (value < low) return low;
  if (value > high) return high;
  return Int<B>::proven(value.value());
}

/// A sum of equal steps: `start`, then after each next() one `step` more. At most MaxSteps steps may be taken, so the
/// width of every value on the way is known: the steps alone add up to at most MaxSteps * 2^(Step-1) in magnitude.
template <int Start, int Step, int MaxSteps>
class Stepper {
 public:
  static constexpr int kTotalStepBits = Step + width_of(MaxSteps - 1) - 1;
  using Value = Int<std::max(Start, kTotalStepBits) + 1>;

  constexpr Stepper() = default;
  constexpr Stepper(Int<Start> start, Int<Step> step) : value_(start), step_(step) {}
  constexpr Value value() const { return value_; }
  constexpr void next() { value_ = Value::proven(value_.value() + step_.value()); }

 private:
  Value value_;
  Value step_;
};

}  // namespace edgecase::rasterizer
