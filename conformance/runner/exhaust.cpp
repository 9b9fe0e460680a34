#include "conformance/runner/exhaust.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "conformance/oracle/lattice_oracle.h"
#include "conformance/runner/reference.h"

namespace edgecase::conformance {
namespace {

using oracle::LatticeOracle;

// A tenth of a second of the slowest driver; what a kill loses at most is one of these a thread.
constexpr std::uint64_t kChunkTriangles = std::uint64_t{1} << 18;
// Vertices, masks expected and masks observed stay in a second-level cache.
constexpr std::uint64_t kBatchTriangles = 4096;

std::uint64_t choose3(std::uint64_t n) { return n < 3 ? 0 : n * (n - 1) / 2 * (n - 2) / 3; }

using Triple = std::array<std::size_t, 3>;

// Triples that begin with a point below i number choose3(n) - choose3(n - i); of those that begin with i, each second
// point j has n - 1 - j thirds.
Triple triple_at(std::uint64_t points, std::uint64_t index) {
  std::uint64_t i = 0;
  while (choose3(points) - choose3(points - i - 1) <= index) ++i;
  index -= choose3(points) - choose3(points - i);
  std::uint64_t j = i + 1;
  while (index >= points - 1 - j) index -= points - 1 - j++;
  return {i, j, j + 1 + index};
}

// Steps to the triple with the next pair of first points.
void next_pair(std::size_t points, Triple& triple) {
  if (++triple[1] == points - 1) triple[1] = ++triple[0] + 1;
  triple[2] = triple[1] + 1;
}

Setting setting_of(const ExhaustPlan& plan) {
  Setting setting;
  setting.target = plan.target;
  return setting;
}

// What one thread holds.
class Exhauster {
 public:
  Exhauster(const ExhaustPlan& plan, const LatticeOracle& lattice, std::unique_ptr<Subject> subject)
      : plan_(plan), lattice_(lattice), subject_(std::move(subject)) {
    scene_.setting = setting_of(plan);
    scene_.rules = subject_->info().rules;
    must_.resize(kBatchTriangles);
  }

  tl::expected<Exhaustion, Error> chunk(std::uint64_t first, std::uint64_t count) {
    Exhaustion found;
    Triple triple = triple_at(lattice_.points(), first);
    for (std::uint64_t done = 0; done < count;) {
      const std::uint64_t batch = std::min(kBatchTriangles, count - done);
      fill(triple, batch);
      if (auto drawn = subject_->draw(scene_, observed_); !drawn) return tl::unexpected(drawn.error());
      if (auto compared = compare(first + done, found); !compared) return tl::unexpected(compared.error());
      done += batch;
    }
    found.triangles = count;
    found.samples_compared =
        count * static_cast<std::uint64_t>(plan_.target.width) * static_cast<std::uint64_t>(plan_.target.height);
    return found;
  }

 private:
  // Puts `count` triangles from `triple` on into scene_ and their masks into must_, and moves `triple` past them.
  void fill(Triple& triple, std::uint64_t count) {
    scene_.triangles.resize(count);
    for (std::size_t i = 0; i < count;) {
      auto& [a, b, c] = triple;
      const std::size_t run = std::min(count - i, lattice_.points() - c);
      lattice_.cover(a, b, c, std::span(must_).subspan(i, run));
      for (std::size_t k = 0; k < run; ++k) {
        scene_.triangles[i + k] = {lattice_.position(a), lattice_.position(b), lattice_.position(c + k)};
      }
      i += run;
      c += run;
      if (c == lattice_.points()) next_pair(lattice_.points(), triple);
    }
  }

  std::uint64_t packed(MaskView mask) const {
    std::uint64_t result = 0;
    for (std::size_t y = 0; y < mask.size(); ++y)
      result |= mask[y] << (y * static_cast<std::size_t>(plan_.target.width));
    return result;
  }

  tl::expected<void, Error> compare(std::uint64_t first, Exhaustion& found) {
    for (std::size_t i = 0; i < scene_.triangles.size(); ++i) {
      const std::uint64_t observed = packed(observed_[i]);
      const std::uint64_t wrong = observed ^ must_[i];
      if (wrong != 0 || (first + i) % kExhaustOracleShare == 0) {
        if (auto confirmed = confirm(i); !confirmed) return confirmed;
      }
      if (wrong != 0) {
        found.wrong += static_cast<std::uint64_t>(std::popcount(wrong));
        found.missing += static_cast<std::uint64_t>(std::popcount(wrong & must_[i]));
        const int bit = std::countr_zero(wrong);
        if (!found.first) {
          found.first = {first + i, bit % plan_.target.width, bit / plan_.target.width, (must_[i] >> bit & 1) != 0};
        }
      }
      const bool concerned =
          plan_.deviation != nullptr && plan_.deviation->in_window.may_concern(scene_.setting, scene_.triangles[i]);
      if (concerned ? observed != predicted(i) : wrong != 0) ++found.unexplained;
    }
    return {};
  }

  tl::expected<void, Error> confirm(std::size_t i) {
    unpack(must_[i]);
    return reference_.confirm(scene_, i, scratch_);
  }

  std::uint64_t predicted(std::size_t i) {
    unpack(must_[i]);
    plan_.deviation->in_window.predict(scene_.setting, scene_.triangles[i], scratch_);
    return packed(scratch_);
  }

  // Into scratch_.
  void unpack(std::uint64_t mask) {
    const auto width = static_cast<std::size_t>(plan_.target.width);
    scratch_.resize(static_cast<std::size_t>(plan_.target.height));
    for (std::size_t y = 0; y < scratch_.size(); ++y) {
      const std::uint64_t row = width == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << width) - 1;
      scratch_[y] = mask >> (y * width) & row;
    }
  }

  const ExhaustPlan& plan_;
  const LatticeOracle& lattice_;
  std::unique_ptr<Subject> subject_;
  Reference reference_{nullptr};
  Scene scene_;
  MaskBatch observed_;
  std::vector<std::uint64_t> must_;
  std::vector<std::uint64_t> scratch_;
};

// Hands out chunks in order and puts what comes back in order again. Guarded by one mutex.
class Queue {
 public:
  Queue(Exhaustion done, std::uint64_t end, const std::function<void(const Exhaustion&)>& on_progress)
      : done_(std::move(done)),
        earlier_seconds_(done_.seconds),
        next_(done_.triangles),
        end_(end),
        tell_(on_progress) {}

  /// First triangle and number of triangles; nothing if there is no more to do.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> take() {
    const std::lock_guard lock(mutex_);
    if (error_ || next_ == end_) return std::nullopt;
    const std::uint64_t first = std::exchange(next_, std::min(end_, next_ + kChunkTriangles));
    return std::pair(first, next_ - first);
  }

  void finish(std::uint64_t first, tl::expected<Exhaustion, Error> found) {
    const std::lock_guard lock(mutex_);
    if (!found) {
      fail(found.error());
      return;
    }
    waiting_.emplace(first, *found);
    for (auto it = waiting_.begin(); it != waiting_.end() && it->first == done_.triangles; it = waiting_.erase(it)) {
      done_.add(it->second);
    }
    done_.seconds = earlier_seconds_ + std::chrono::duration<double>(Clock::now() - start_).count();
    tell_(done_);
  }

  void stop(const Error& error) {
    const std::lock_guard lock(mutex_);
    fail(error);
  }

  tl::expected<Exhaustion, Error> result() && {
    if (error_) return tl::unexpected(*error_);
    return std::move(done_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  void fail(const Error& error) {
    if (!error_) error_ = error;
  }

  std::mutex mutex_;
  Exhaustion done_;
  const double earlier_seconds_;
  std::uint64_t next_;
  const std::uint64_t end_;
  const std::function<void(const Exhaustion&)>& tell_;
  std::map<std::uint64_t, Exhaustion> waiting_;
  std::optional<Error> error_;
  const Clock::time_point start_ = Clock::now();
};

}  // namespace

void Exhaustion::add(const Exhaustion& later) {
  triangles += later.triangles;
  samples_compared += later.samples_compared;
  wrong += later.wrong;
  missing += later.missing;
  unexplained += later.unexplained;
  if (!first) first = later.first;
}

std::uint64_t exhaust_triangles(const ExhaustPlan& plan) {
  return choose3(LatticeOracle::points_of(plan.target, plan.lattice_bits));
}

Triangle exhaust_triangle(const ExhaustPlan& plan, std::uint64_t index) {
  const LatticeOracle lattice(plan.target, plan.lattice_bits);
  const Triple triple = triple_at(lattice.points(), index);
  return {lattice.position(triple[0]), lattice.position(triple[1]), lattice.position(triple[2])};
}

std::optional<Error> check_exhaust(const ExhaustPlan& plan, const Subject& subject) {
  const SubjectInfo& info = subject.info();
  const auto bad = [](std::string message) { return Error{ErrorKind::bad_input, std::move(message)}; };
  const auto [width, height] = plan.target;
  if (width * height > LatticeOracle::kMostPixels) {
    return bad(fmt::format("--target {}x{}: {} pixels, exhaustion takes at most {}", width, height, width * height,
                           LatticeOracle::kMostPixels));
  }
  if (const std::size_t points = LatticeOracle::points_of(plan.target, plan.lattice_bits);
      points > LatticeOracle::kMostPoints) {
    return bad(fmt::format("--lattice-bits {}: {} lattice points over {}x{} pixels, exhaustion takes at most {}",
                           plan.lattice_bits, points, width, height, LatticeOracle::kMostPoints));
  }
  if (plan.lattice_bits > info.rules.subpixel_bits) {
    return bad(fmt::format("--lattice-bits {}: {} has {} subpixel bits", plan.lattice_bits, info.name,
                           info.rules.subpixel_bits));
  }
  // No triangle asks for more than the one that spans the target.
  const auto right = static_cast<float>(width);
  const auto bottom = static_cast<float>(height);
  Scene widest;
  widest.setting = setting_of(plan);
  widest.rules = info.rules;
  widest.triangles = {{Position{0, 0}, Position{right, 0}, Position{right, bottom}}};
  if (const auto refusal = subject.refusal(widest)) {
    return bad(fmt::format("--subject {}: cannot draw this: {}", info.name, *refusal));
  }
  return std::nullopt;
}

tl::expected<Exhaustion, Error> exhaust(const ExhaustPlan& plan, std::unique_ptr<Subject> subject, Exhaustion done,
                                        const std::function<void(const Exhaustion&)>& on_progress) {
  const LatticeOracle lattice(plan.target, plan.lattice_bits);
  Queue queue(std::move(done), exhaust_triangles(plan), on_progress);
  const auto work = [&](std::unique_ptr<Subject> own) {
    Exhauster exhauster(plan, lattice, std::move(own));
    while (const auto part = queue.take()) queue.finish(part->first, exhauster.chunk(part->first, part->second));
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < plan.jobs; ++i) {
    helpers.emplace_back([&] {
      auto own = make_subject(plan.subject);
      if (!own) return queue.stop(own.error());
      work(std::move(*own));
    });
  }
  work(std::move(subject));
  helpers.clear();  // joins
  return std::move(queue).result();
}

}  // namespace edgecase::conformance
