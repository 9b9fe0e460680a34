// What drivers make of scissors, culling and primitives that they assemble: exactly what the triangles alone would
// give.
#include <numeric>

#include "conformance/tests/driver_subject_checks.h"

namespace edgecase::conformance {
namespace {

class Settings : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    auto made = make_subject(GetParam());
    if (!made && std::string(GetParam()) == "swiftshader" && made.error().kind == ErrorKind::absent) {
      GTEST_SKIP() << made.error().message;
    }
    ASSERT_TRUE(made) << made.error().message;
    subject_ = std::move(*made);
    // On whole pixels and halves, which every subject's grid has.
    scene_ = random_scene(square_setting(40), 300, -20, 60, 128, 11);
  }

  /// The masks of scene_, of those triangles alone that `keep` keeps, and within scissor_ if there is one.
  template <typename Keep>
  std::vector<std::vector<std::uint64_t>> expected(Keep keep) const {
    const MaskLayout layout(scene_.setting);
    std::vector<std::vector<std::uint64_t>> masks;
    for (std::size_t i = 0; i < scene_.triangles.size(); ++i) {
      std::vector<std::uint64_t> mask = exact_mask(scene_.setting, scene_.triangles[i]);
      const auto& scissor = scene_.setting.scissor;
      for (int y = 0; y < layout.target.height; ++y) {
        for (int x = 0; x < layout.target.width; ++x) {
          const bool inside = !scissor || (x >= scissor->x && x < scissor->x + scissor->width && y >= scissor->y &&
                                           y < scissor->y + scissor->height);
          if (!keep(i) || !inside) mask[layout.bit(x, y, 0) / 64] &= ~(std::uint64_t{1} << layout.bit(x, y, 0) % 64);
        }
      }
      masks.push_back(std::move(mask));
    }
    return masks;
  }

  template <typename Keep>
  void expect_drawn(Keep keep) {
    const auto wanted = expected(keep);
    const MaskBatch masks = drawn(*subject_, scene_);
    ASSERT_EQ(masks.size(), wanted.size());
    for (std::size_t i = 0; i < masks.size(); ++i) {
      ASSERT_THAT(masks[i], testing::ElementsAreArray(wanted[i])) << "triangle " << i;
    }
  }

  void assemble(Topology topology, std::vector<Position> vertices, std::vector<std::uint32_t> indices) {
    scene_.assembly = Assembly{topology, std::move(vertices), std::move(indices)};
    scene_.triangles.clear();
  }

  std::unique_ptr<Subject> subject_;
  Scene scene_;
};

constexpr auto kAll = [](std::size_t) { return true; };

std::vector<Position> points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Position> result;
  while (result.size() < count) result.push_back(random_triangle(random, -8, 48, 128)[0]);
  return result;
}

std::string alphanumeric(const testing::TestParamInfo<const char*>& subject) {
  std::string name(subject.param);
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}
INSTANTIATE_TEST_SUITE_P(Drivers, Settings,
                         testing::Values("lavapipe", "lavapipe:bgra8", "osmesa-llvmpipe", "swiftshader"), alphanumeric);

TEST_P(Settings, ScissorsOfAnySizeAndPlace) {
  for (const Rect& scissor : {Rect{0, 0, 40, 40}, Rect{7, 9, 20, 11}, Rect{-5, -6, 12, 90}, Rect{39, 39, 1, 1},
                              Rect{16, 16, 16, 16}, Rect{5, 5, 0, 10}, Rect{5, 5, 10, -3}, Rect{40, 0, 5, 5},
                              Rect{-30, 0, 30, 40}, Rect{20, 20, 1'000'000, 1'000'000}}) {
    scene_.setting.scissor = scissor;
    expect_drawn(kAll);
  }
  scene_.setting.scissor.reset();
  expect_drawn(kAll);
}

TEST_P(Settings, BothCullModesAndFrontFaces) {
  const auto clockwise = [this](std::size_t i) {
    const auto& [a, b, c] = scene_.triangles[i];
    return (b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x);
  };
  for (const CullMode cull : {CullMode::front, CullMode::back, CullMode::none}) {
    for (const FrontFace front : {FrontFace::clockwise, FrontFace::counter_clockwise}) {
      scene_.setting.cull = cull;
      scene_.setting.front_face = front;
      expect_drawn([&](std::size_t i) {
        const bool is_front = clockwise(i) == (front == FrontFace::clockwise);
        return cull == CullMode::none || is_front == (cull == CullMode::back);
      });
    }
  }
}

TEST_P(Settings, Strips) {
  if (!subject_->info().assembly) GTEST_SKIP() << "it cannot number the triangles";
  const auto v = points(200, 1);
  assemble(Topology::strip, v, {});
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    scene_.triangles.push_back(i % 2 == 0 ? Triangle{v[i], v[i + 1], v[i + 2]} : Triangle{v[i + 1], v[i], v[i + 2]});
  }
  expect_drawn(kAll);
}

TEST_P(Settings, Fans) {
  if (!subject_->info().assembly) GTEST_SKIP() << "it cannot number the triangles";
  const auto v = points(200, 2);
  assemble(Topology::fan, v, {});
  for (std::size_t i = 0; i + 2 < v.size(); ++i) scene_.triangles.push_back({v[0], v[i + 1], v[i + 2]});
  expect_drawn(kAll);
}

TEST_P(Settings, IndexedLists) {
  if (!subject_->info().assembly) GTEST_SKIP() << "it cannot number the triangles";
  const auto v = points(10, 3);
  std::mt19937 random(3);
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < 300; ++i) indices.push_back(static_cast<std::uint32_t>(random() % v.size()));
  assemble(Topology::list, v, indices);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    scene_.triangles.push_back({v[indices[i]], v[indices[i + 1]], v[indices[i + 2]]});
  }
  expect_drawn(kAll);
}

// Runs of 3 to 7 vertices; a run of fewer than 3 makes no triangle and takes no number.
TEST_P(Settings, StripsAndFansWithRestarts) {
  if (!subject_->info().assembly) GTEST_SKIP() << "it cannot number the triangles";
  const auto v = points(12, 4);
  for (const Topology topology : {Topology::strip, Topology::fan}) {
    std::mt19937 random(4);
    std::vector<std::uint32_t> indices;
    std::vector<Triangle> triangles;
    for (int run = 0; run < 60; ++run) {
      std::vector<std::uint32_t> part(1 + random() % 7);
      for (std::uint32_t& index : part) index = static_cast<std::uint32_t>(random() % v.size());
      for (std::size_t i = 0; i + 2 < part.size(); ++i) {
        const bool swapped = topology == Topology::strip && i % 2 == 1;
        const Position first = v[topology == Topology::fan ? part[0] : part[i + (swapped ? 1 : 0)]];
        triangles.push_back({first, v[part[i + (swapped ? 0 : 1)]], v[part[i + 2]]});
      }
      indices.insert(indices.end(), part.begin(), part.end());
      indices.push_back(kRestartIndex);
    }
    assemble(topology, v, indices);
    scene_.triangles = triangles;
    expect_drawn(kAll);
  }
}

TEST_P(Settings, AssembliesAreCulledByTheirCommonFace) {
  if (!subject_->info().assembly) GTEST_SKIP() << "it cannot number the triangles";
  const std::vector<Position> v{{0, 0}, {0, 20}, {20, 0}, {20, 20}, {39, 0}, {39, 20}};
  assemble(Topology::strip, v, {});
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    scene_.triangles.push_back(i % 2 == 0 ? Triangle{v[i], v[i + 1], v[i + 2]} : Triangle{v[i + 1], v[i], v[i + 2]});
  }
  scene_.setting.cull = CullMode::front;  // the strip runs counter-clockwise, and clockwise is front
  expect_drawn(kAll);
  scene_.setting.cull = CullMode::back;
  expect_drawn([](std::size_t) { return false; });
}

TEST(RefusedSettings, AreNamed) {
  const auto softpipe = subject_or_failure("osmesa-softpipe");
  const auto llvmpipe = subject_or_failure("osmesa-llvmpipe");
  ASSERT_TRUE(softpipe != nullptr && llvmpipe != nullptr);
  Scene scene;
  scene.setting.cull = CullMode::back;
  EXPECT_EQ(softpipe->refusal(scene), "culling");
  scene.setting = square_setting(8);
  scene.assembly.emplace();
  EXPECT_EQ(softpipe->refusal(scene), "strips, fans and indices");
  scene.assembly->indices = {kRestartIndex};
  EXPECT_EQ(llvmpipe->refusal(scene), "a restart index in a list of triangles");
  scene.assembly.reset();
  scene.clip.emplace();
  EXPECT_EQ(softpipe->refusal(scene), "clip space");
  scene.clip->viewport = {0, 8, 8, -8};
  EXPECT_EQ(llvmpipe->refusal(scene), "a viewport of negative height");
  scene.clip->viewport = {0, 0, 20000, 8};
  EXPECT_EQ(llvmpipe->refusal(scene), "a viewport of 20000x8 exceeds 16384 pixels a side");
  scene.clip->viewport = {-40000, 0, 8, 8};
  EXPECT_EQ(llvmpipe->refusal(scene), "a viewport that reaches -40000 lies beyond 32767 px");
  scene.clip->viewport = {0, 0, 8, 8};
  EXPECT_EQ(llvmpipe->refusal(scene), std::nullopt);
}

}  // namespace
}  // namespace edgecase::conformance
