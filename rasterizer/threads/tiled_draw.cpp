#include "rasterizer/threads/tiled_draw.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "rasterizer/threads/wait.h"

namespace edgecase::rasterizer {
namespace {

std::size_t divided_up(std::size_t a, std::size_t b) { return (a + b - 1) / b; }

/// Strips of a tile are added to the mask so many at a time.
constexpr std::size_t kStripsAtOnce = 2;

}  // namespace

TiledDraw::TiledDraw(const FastRasterizer& fast, std::span<const Triangle> triangles, const Plan& plan, StripMask& mask,
                     Memory& memory)
    : fast_(fast),
      triangles_(triangles),
      plan_(plan),
      mask_(mask),
      chunks_(divided_up(triangles.size(), plan.chunk)),
      memory_(memory),
      agenda_(plan.tile_work, plan.parts, plan.least_help) {
  if (!binned()) {
    apart_.resize(static_cast<std::size_t>(plan.threads));
    agenda_.begin();  // for the canvas in place: a mask apart must be worth adding
    return;
  }
  while (memory_.bins.size() < chunks_) memory_.bins.push_back(std::make_unique<Bins>());
  for (std::size_t chunk = 0; chunk < chunks_; ++chunk) memory_.bins[chunk]->done.store(false);
}

void TiledDraw::work(Canvas& canvas) {
  const std::size_t to_bin = binned() ? chunks_ : 0;
  for (std::size_t chunk = next_to_bin_++; chunk < to_bin; chunk = next_to_bin_++) bin(chunk);
  int tile = in_place(canvas) ? 0 : -1;
  while (const auto part = agenda_.next(tile)) {
    tile = part->tile;
    draw(*part, canvas);
  }
  finish(canvas);
}

std::span<const TiledDraw::Triangle> TiledDraw::triangles_of(std::size_t chunk, std::size_t end) const {
  const std::size_t first = std::min(chunk * plan_.chunk, triangles_.size());
  return triangles_.subspan(first, std::min(end * plan_.chunk, triangles_.size()) - first);
}

void TiledDraw::bin(std::size_t chunk) {
  const std::span<const Triangle> triangles = triangles_of(chunk, chunk + 1);
  const auto columns = static_cast<std::size_t>(plan_.grid.columns()),
             rows = static_cast<std::size_t>(plan_.grid.rows());
  const std::size_t blocks = divided_up(triangles.size(), kReachBlock);
  Bins& bins = *memory_.bins[chunk];
  bins.reach.resize(blocks * (columns + rows));
  bins.begin.assign(1, 0);
  fast_.find_reach(triangles, plan_.grid, bins.reach);
  std::vector<std::uint64_t> picked(blocks);
  std::vector<std::size_t> from(blocks);
  std::size_t size = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      // Where tiles are many, most words are empty, and which of them are is hard to predict: those that are not are
      // picked out without a branch.
      std::size_t count = 0;
      const std::uint64_t* words = bins.reach.data();
      for (std::size_t block = 0; block < blocks; ++block, words += columns + rows) {
        picked[count] = words[column] & words[columns + row];
        from[count] = block;
        count += picked[count] != 0 ? 1 : 0;
      }
      const std::size_t most = size + count * kReachBlock;
      if (bins.triangles.size() < most) bins.triangles.resize(2 * most);
      Triangle* to = bins.triangles.data() + size;
      for (std::size_t i = 0; i < count; ++i) {
        const Triangle* const block = triangles.data() + from[i] * kReachBlock;
        for (std::uint64_t bits = picked[i]; bits != 0; bits &= bits - 1) *to++ = block[std::countr_zero(bits)];
      }
      size = static_cast<std::size_t>(to - bins.triangles.data());
      bins.begin.push_back(static_cast<std::uint32_t>(size));
    }
  }
  bins.done.store(true, std::memory_order_release);
}

void TiledDraw::draw(const Part& part, Canvas& canvas) {
  const std::size_t begin = plan_.parts.begin(part.number), end = plan_.parts.begin(part.number + 1);
  if (!binned()) {
    draw_whole(triangles_of(begin, end), canvas);
    ++canvas.drawn_;
    return;
  }
  if (canvas.tile_ != part.tile) finish(canvas);
  for (std::size_t chunk = begin; chunk < end; ++chunk) draw_bin(part.tile, chunk, canvas);
}

void TiledDraw::draw_whole(std::span<const Triangle> triangles, Canvas& canvas) {
  if (in_place(canvas)) return fast_.cover_union(triangles, mask_);
  if (canvas.tile_ < 0) {
    canvas.tile_ = 0;
    canvas.mask_.begin(plan_.grid.tile(0));
    apart_[apart_count_.fetch_add(1, std::memory_order_relaxed)] = &canvas;
  }
  fast_.cover_tile(triangles, canvas.mask_);
}

void TiledDraw::draw_bin(int tile, std::size_t chunk, Canvas& canvas) const {
  const Bins& bins = *memory_.bins[chunk];
  // Who has taken the chunk is binning it at this moment.
  wait_until([&] { return bins.done.load(std::memory_order_acquire); });
  const std::uint32_t* const begin = bins.begin.data() + tile;
  const auto triangles = std::span(std::as_const(bins.triangles)).subspan(begin[0], begin[1] - begin[0]);
  if (triangles.empty()) return;
  if (canvas.tile_ < 0) {
    canvas.tile_ = tile;
    canvas.mask_.begin(plan_.grid.tile(tile));
  }
  draw_in_order(triangles, canvas);
}

void TiledDraw::draw_in_order(std::span<const Triangle> triangles, Canvas& canvas) const {
  const auto wait = [&](std::size_t count) {
    std::copy_n(triangles.begin(), count, canvas.triangles_.begin() + static_cast<std::ptrdiff_t>(canvas.waiting_));
    canvas.waiting_ += count;
    triangles = triangles.subspan(count);
  };
  if (canvas.waiting_ > 0) {
    wait(std::min(kMaxLanes - canvas.waiting_, triangles.size()));
    if (canvas.waiting_ < kMaxLanes) return;
    draw_waiting(canvas);
  }
  const std::size_t whole = triangles.size() / kMaxLanes * kMaxLanes;
  fast_.cover_tile(triangles.first(whole), canvas.mask_);
  triangles = triangles.subspan(whole);
  wait(triangles.size());
}

void TiledDraw::draw_waiting(Canvas& canvas) const {
  fast_.cover_tile(std::span(canvas.triangles_).first(canvas.waiting_), canvas.mask_);
  canvas.waiting_ = 0;
}

void TiledDraw::add_canvases() {
  // Who has taken a part is drawing it at this moment: nobody waits for a thread that has not begun.
  wait_until([&] { return drawn_.load(std::memory_order_acquire) == plan_.parts.count(); });
  const std::size_t count = apart_count_.load(std::memory_order_relaxed);
  if (count == 0) return;
  const auto strips = static_cast<std::size_t>(mask_.strips().count);
  // Twice as many groups as threads: it takes all of them as long.
  const std::size_t group = std::max(strips / (2 * static_cast<std::size_t>(plan_.threads)), kStripsAtOnce);
  for (std::size_t first = next_to_add_.fetch_add(group, std::memory_order_relaxed); first < strips;
       first = next_to_add_.fetch_add(group, std::memory_order_relaxed)) {
    for (std::size_t i = 0; i < count; ++i) {
      fast_.add_strips(apart_[i]->mask_, mask_, first, std::min(first + group, strips));
    }
  }
}

void TiledDraw::finish(Canvas& canvas) {
  if (!binned()) {
    if (canvas.drawn_ > 0) drawn_.fetch_add(std::exchange(canvas.drawn_, 0), std::memory_order_release);
    add_canvases();
    canvas.tile_ = -1;
    return;
  }
  if (canvas.tile_ < 0) return;
  if (canvas.waiting_ > 0) draw_waiting(canvas);
  // Threads that have helped each other with a tile add theirs to the same words under a lock.
  const auto strips = static_cast<std::size_t>(canvas.mask_.strips().count);
  const std::size_t groups = divided_up(strips, kStripsAtOnce);
  for (std::size_t i = 0; i < groups; ++i) {
    const std::size_t group = (i + canvas.number_) % groups;
    auto& lock = memory_.locks[(static_cast<std::size_t>(canvas.tile_) * groups + group) % memory_.locks.size()];
    const tbb::spin_mutex::scoped_lock locked(lock.mutex);
    fast_.add_strips(canvas.mask_, mask_, group * kStripsAtOnce, std::min((group + 1) * kStripsAtOnce, strips));
  }
  canvas.tile_ = -1;
}

}  // namespace edgecase::rasterizer
