// A worker whose driver does what worker_test.cpp asks: the first vertex of the first triangle says what goes wrong.
// Its masks are no coverage: every word of mask i holds the bits of triangle i's first x.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "conformance/scene/mask.h"
#include "conformance/subjects/worker_server.h"

namespace edgecase::conformance {
namespace {

// Half the enclosing viewport, by which window positions are divided on their way here.
constexpr float kMaxCoordinate = 1024;

void say_own_pid(const char* file) {
  const std::string text = std::to_string(getpid());
  const int descriptor = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (write(descriptor, text.data(), text.size()) < 0) std::abort();
  close(descriptor);
}

class MisbehavingDriver final : public Driver {
 public:
  explicit MisbehavingDriver(const char* pid_file) : pid_file_(pid_file) {
    info_.device = "misbehaving";
    info_.rules = {4, SnapRounding::truncate};
    info_.sample_counts = {1, 2};
    info_.max_target = 64;
    info_.max_coordinate = static_cast<double>(kMaxCoordinate);
  }

  const SubjectInfo& info() const override { return info_; }
  std::size_t max_mask_bytes() const override { return 4096; }
  tl::expected<double, Error> draw(const Setting& setting, const Primitives& primitives,
                                   std::span<std::uint32_t> masks) override {
    const auto first_x = [&](std::size_t triangle) { return primitives.vertex(3 * triangle).x * kMaxCoordinate; };
    const float what = first_x(0);
    if (what == 900) {
      std::fputs("the driver's own complaint\nin two lines\n", stderr);
      std::abort();
    }
    if (what == 901) {
      if (pid_file_ != nullptr) say_own_pid(pid_file_);
      for (;;) pause();
    }
    if (what == 902) std::exit(0);
    if (what == 903) return tl::unexpected(Error{ErrorKind::subject, "will not"});
    if (what == 904) {
      for (int line = 0; line < 40'000; ++line) std::puts("chatter that would fill any pipe in a moment");
    }
    const std::size_t words = MaskLayout(setting).driver_words();
    for (std::size_t i = 0; i < primitives.triangles; ++i) {
      std::ranges::fill(masks.subspan(i * words, words), std::bit_cast<std::uint32_t>(first_x(i)));
    }
    return 0.25;
  }

 private:
  const char* pid_file_;
  SubjectInfo info_;
};

tl::expected<std::unique_ptr<Driver>, Error> open_driver(std::string_view how, const char* pid_file) {
  if (how == "absent") return tl::unexpected(Error{ErrorKind::absent, "no such driver"});
  if (how == "abort") std::abort();
  if (how == "hang") {
    for (;;) pause();
  }
  if (how == "environment" && std::string_view(std::getenv("EDGECASE_TEST_VARIABLE")) != "worker's") std::abort();
  return std::make_unique<MisbehavingDriver>(pid_file);
}

}  // namespace
}  // namespace edgecase::conformance

int main(int argc, char** argv) {
  using namespace edgecase::conformance;
  serve_driver([&] { return open_driver(argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : nullptr); });
}
