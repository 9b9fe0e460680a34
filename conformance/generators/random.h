// Random numbers that are the same everywhere: the standard library's distributions differ between implementations.
#pragma once

#include <cassert>
#include <cstdint>
#include <string_view>

namespace edgecase::conformance {

/// SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom number generators", 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// The stream for item `index` of the family `name`: independent of every other item's.
  static Random stream(std::uint64_t seed, std::string_view name, std::uint64_t index) {
    return of_family(seed, name).item(index);
  }

  /// What the streams of all items of a family begin with.
  static Random of_family(std::uint64_t seed, std::string_view name) {
    Random random(seed);
    for (const char c : name) random.state_ = random.next() ^ static_cast<unsigned char>(c);
    return random;
  }
  Random item(std::uint64_t index) const {
    Random random = *this;
    random.state_ = random.next() ^ index;
    random.state_ = random.next();
    return random;
  }

  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;
  static constexpr std::uint64_t kFirstFactor = 0xbf58476d1ce4e5b9;
  static constexpr std::uint64_t kSecondFactor = 0x94d049bb133111eb;

  std::uint64_t next() {
    std::uint64_t z = state_ += kStep;
    z = (z ^ (z >> 30)) * kFirstFactor;
    z = (z ^ (z >> 27)) * kSecondFactor;
    return z ^ (z >> 31);
  }

  /// An integer from low to high, both included; high - low below 2^31. Uniform up to a bias of 2^-32.
  std::int64_t between(std::int64_t low, std::int64_t high) {
    assert(low <= high && high - low < (std::int64_t{1} << 31));
    const auto count = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<std::int64_t>(((next() >> 32) * count) >> 32);
  }

  bool one_in(std::int64_t n) { return between(1, n) == 1; }

 private:
  std::uint64_t state_;
};

}  // namespace edgecase::conformance
