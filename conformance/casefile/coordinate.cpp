#include "conformance/casefile/coordinate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <system_error>

#include "conformance/casefile/casefile.h"

namespace edgecase::conformance {
namespace {

/// A number as it was written: (-1)^negative * digits * base^exponent, the digits without leading or trailing zeros and
/// the exponent counted from the last of them, so that equal numbers of one base have equal parts. Zero has no digits.
struct Written {
  bool negative = false;
  std::string digits;
  long exponent = 0;
};

/// Far beyond every exponent that matters, and small enough that sums with a file's length stay in a long.
constexpr long kHugeExponent = 1'000'000'000;

bool is_digit(char c, bool hexadecimal) {
  const char lower = static_cast<char>(c | 0x20);
  return (c >= '0' && c <= '9') || (hexadecimal && lower >= 'a' && lower <= 'f');
}

/// Reads `[+-]digits` to the end of the text; clamps to kHugeExponent.
std::optional<long> read_exponent(std::string_view text) {
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  if (text.empty()) return std::nullopt;
  long value = 0;
  for (const char c : text) {
    if (!is_digit(c, false)) return std::nullopt;
    value = std::min(value * 10 + (c - '0'), kHugeExponent);
  }
  return negative ? -value : value;
}

/// Grammar: digits with at most one point in, before or after them, then an optional exponent: `e` for powers of ten,
/// or `p` for powers of two. The exponent of a hexadecimal number is in bits here, that of a decimal in digits.
std::optional<Written> read_number(std::string_view text, bool hexadecimal) {
  Written number;
  const long per_digit = hexadecimal ? 4 : 1;
  bool any_digit = false;
  bool point = false;
  std::size_t i = 0;
  for (; i < text.size(); ++i) {
    if (text[i] == '.' && !point) {
      point = true;
    } else if (is_digit(text[i], hexadecimal)) {
      any_digit = true;
      if (point) number.exponent -= per_digit;
      if (!number.digits.empty() || text[i] != '0') number.digits += text[i];
    } else {
      break;
    }
  }
  if (!any_digit) return std::nullopt;
  if (i < text.size()) {
    if ((text[i] | 0x20) != (hexadecimal ? 'p' : 'e')) return std::nullopt;
    const auto exponent = read_exponent(text.substr(i + 1));
    if (!exponent) return std::nullopt;
    number.exponent += *exponent;
  }
  while (!number.digits.empty() && number.digits.back() == '0') {
    number.digits.pop_back();
    number.exponent += per_digit;
  }
  return number;
}

std::string not_exact(const Written& number, float nearest) {
  return fmt::format("is not exact in binary32; the nearest is \"{}\"",
                     write_coordinate(number.negative ? -nearest : nearest));
}

std::string outside(float limit) { return fmt::format("is not from {} to {}", -limit, limit); }

/// The digits of |value| in base ten, all of them: a binary32 number has at most 112 significant ones.
Written all_digits(float value) {
  std::array<char, 192> buffer;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), std::fabs(value), std::chars_format::scientific, 120);
  return *read_number({buffer.data(), static_cast<std::size_t>(end.ptr - buffer.data())}, false);
}

tl::expected<float, std::string> from_decimal(const Written& number, std::string_view text, float limit) {
  // The number lies in [10^(magnitude - 1), 10^magnitude).
  const long magnitude = static_cast<long>(number.digits.size()) + number.exponent;
  float value = 0;
  // std::from_chars rounds the text itself to the nearest binary32, once; beyond its range it leaves `value` alone.
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool too_large = read.ec == std::errc::result_out_of_range && magnitude > 0;
  if (too_large || value > limit) return tl::unexpected(outside(limit));
  const Written digits = all_digits(value);
  if (digits.digits != number.digits || digits.exponent != number.exponent)
    return tl::unexpected(not_exact(number, value));
  return value;
}

tl::expected<float, std::string> from_hexadecimal(const Written& number, float limit) {
  // The first 13 digits hold at least 49 significant bits, more than twice the 24 of a binary32 number. A sticky bit
  // below them for the rest therefore neither makes such a number of another one nor changes which one is nearest.
  const std::string_view kept = std::string_view(number.digits).substr(0, 13);
  std::uint64_t significand = 0;
  std::from_chars(kept.data(), kept.data() + kept.size(), significand, 16);
  if (kept.size() < number.digits.size()) significand |= 1;
  const long exponent = number.exponent + 4 * static_cast<long>(number.digits.size() - kept.size());
  // Exact: 52 bits fit a double, and beyond these bounds on the exponent the value is out of range or less than 2^-248.
  const double value =
      std::ldexp(static_cast<double>(significand), static_cast<int>(std::clamp(exponent, -300L, 300L)));
  if (value > static_cast<double>(limit)) return tl::unexpected(outside(limit));
  const float rounded = static_cast<float>(value);
  if (static_cast<double>(rounded) != value) return tl::unexpected(not_exact(number, rounded));
  return rounded;
}

tl::expected<float, std::string> parse(std::string_view text, float limit) {
  const bool negative = !text.empty() && text[0] == '-';
  std::string_view magnitude = text.substr(negative ? 1 : 0);
  for (const std::string_view word : {"nan", "inf", "infinity"}) {
    const auto equal_letter = [](char a, char b) { return (a | 0x20) == b; };
    if (std::equal(magnitude.begin(), magnitude.end(), word.begin(), word.end(), equal_letter))
      return tl::unexpected(std::string("is not finite"));
  }
  const bool hexadecimal = magnitude.starts_with("0x") || magnitude.starts_with("0X");
  if (hexadecimal) magnitude.remove_prefix(2);
  auto number = read_number(magnitude, hexadecimal);
  if (!number) return tl::unexpected(std::string("is not a decimal or hexadecimal number"));
  number->negative = negative;
  tl::expected<float, std::string> value = 0.0f;
  if (!number->digits.empty()) {
    value = hexadecimal ? from_hexadecimal(*number, limit) : from_decimal(*number, magnitude, limit);
  }
  if (value && negative) return -*value;
  return value;
}

}  // namespace

tl::expected<float, std::string> parse_coordinate(std::string_view text) { return parse(text, kMaxCaseCoordinate); }

tl::expected<float, std::string> parse_finite(std::string_view text) {
  return parse(text, std::numeric_limits<float>::max());
}

std::string write_coordinate(float value) {
  // Longer decimals are harder to read than powers of two. 16 characters hold every point of the 1/512 grid.
  constexpr std::size_t kLongestDecimal = 16;
  std::array<char, 256> buffer;
  auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, 149);
  std::string decimal(buffer.data(), end.ptr);
  decimal.erase(decimal.find_last_not_of('0') + 1);
  if (decimal.back() == '.') decimal.pop_back();
  if (decimal.size() <= kLongestDecimal) return decimal;
  end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), std::fabs(value), std::chars_format::hex);
  return fmt::format("{}0x{}", std::signbit(value) ? "-" : "",
                     std::string_view(buffer.data(), static_cast<std::size_t>(end.ptr - buffer.data())));
}

}  // namespace edgecase::conformance
