#include "conformance/generators/generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "conformance/compare/outline.h"
#include "conformance/oracle/oracle.h"
#include "conformance/scene/assemble.h"
#include "conformance/scene/window_position.h"

namespace edgecase::conformance {
namespace {

Scene scenes(const Generator& generator, std::uint64_t seed, std::uint64_t first, std::uint64_t count, int bits = 8) {
  Scene scene;
  scene.setting = generator.setting;
  scene.rules.subpixel_bits = bits;
  for (std::uint64_t i = first; i < first + count; ++i) append_scene(generator, seed, i, scene);
  return scene;
}

GridTriangle snapped(const Scene& scene, const Triangle& t) {
  return {oracle::snap(scene.rules, t[0]), oracle::snap(scene.rules, t[1]), oracle::snap(scene.rules, t[2])};
}

std::uint64_t digest(const Scene& scene) {
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a over grid coordinates
  for (const Triangle& triangle : scene.triangles) {
    for (const GridPoint& p : snapped(scene, triangle)) {
      for (const std::int64_t v : {p.x, p.y}) hash = (hash ^ static_cast<std::uint64_t>(v)) * 0x100000001b3;
    }
  }
  return hash;
}

TEST(Generators, MakeTheSameTrianglesEverywhere) {
  // Recorded once: a change here means that every reported seed of the past names other triangles.
  const std::map<std::string_view, std::uint64_t> recorded{
      {"fan", 9754777507021975571u},
      {"grid", 6909824844277225037u},
      {"triangulation", 10598263590025427068u},
      {"strip", 10718520412250980881u},
      {"refinement", 16490012893571826398u},
      {"random", 11013290841486168273u},
      {"ties", 11294867062831296997u},
      {"range", 500351732551055826u},
      {"near_corner_scissor", 16134352526467627886u},
      {"near_corner_small", 13981501639455335586u},
      {"far_corner", 16813038179702320542u},
      {"far_corner_wide", 6943497341343357526u},
      {"far_corner_scissor", 15366741500458511254u},
      {"far_corner_samples4", 5758703865772455215u},
      {"sliver", 545889064570146556u},
      {"tiny", 8802546076141573589u},
      {"samples2", 12659351050891713333u},
      {"samples4", 6206639676614255157u},
      {"samples8", 321072529291982613u},
      {"samples16", 18050617951292152069u},
      {"scissor_inside", 13150480133311033089u},
      {"scissor_across", 2582017447674807194u},
      {"scissor_pixel", 13511447903766523877u},
      {"scissor_empty", 13872866387816004404u},
      {"floats", 16097070988458644877u},
      {"float_ties", 8440445900174063730u},
      {"far_rectangle", 2721263461180186700u},
      {"straddle_wide", 14107114777668808581u},
      {"straddle_tall", 8396379434067633687u},
      {"needle_row", 56907854777952216u},
      {"needle_column", 9710792056754524351u},
      {"spokes", 17142157929875484355u},
      {"range_ends", 14302128381108455005u},
      {"border16", 6610607210369440676u},
      {"viewport_ends", 10701669787501769225u},
      {"samples16_tiny", 16811236644642948237u},
      {"cull_back", 12591053072861195493u},
      {"cull_front", 8230529615380369338u},
      {"strips", 17949252234502837213u},
      {"fans", 9492326321114397997u},
  };
  for (const Generator& generator : generators()) {
    const std::uint64_t actual = digest(scenes(generator, 1, 0, 200));
    const auto found = recorded.find(generator.name);
    EXPECT_TRUE(found != recorded.end() && found->second == actual)
        << "      {\"" << generator.name << "\", " << actual << "u},";
  }
}

TEST(Generators, DrawAnySceneWithoutTheOnesBeforeIt) {
  for (const Generator& generator : generators()) {
    const Scene all = scenes(generator, 7, 0, 21);
    const Scene before = scenes(generator, 7, 0, 20);
    const Scene last = scenes(generator, 7, 20, 1);
    ASSERT_EQ(all.triangles.size(), before.triangles.size() + last.triangles.size()) << generator.name;
    for (std::size_t i = 0; i < last.triangles.size(); ++i) {
      EXPECT_EQ(all.triangles[before.triangles.size() + i], last.triangles[i]) << generator.name;
    }
  }
}

TEST(Generators, DifferBySeed) {
  for (const Generator& generator : generators()) {
    EXPECT_NE(digest(scenes(generator, 1, 0, 50)), digest(scenes(generator, 2, 0, 50))) << generator.name;
  }
}

TEST(Generators, MakeWatertightMeshesOnEveryGrid) {
  for (const Generator& generator : generators()) {
    for (const int bits : {4, 8}) {
      const Scene scene = scenes(generator, 3, 0, 400, bits);
      for (const Mesh& mesh : scene.meshes) {
        ASSERT_GT(mesh.count, 0u);
        ASSERT_LE(mesh.first + mesh.count, scene.triangles.size());
        std::vector<GridTriangle> triangles;
        for (std::size_t i = mesh.first; i < mesh.first + mesh.count; ++i) {
          triangles.push_back(snapped(scene, scene.triangles[i]));
        }
        const auto fault = mesh_fault(triangles);
        ASSERT_FALSE(fault) << generator.name << " with " << bits << " bits, triangles from " << mesh.first << ": "
                            << *fault;
      }
    }
  }
}

TEST(Generators, PutEveryVertexOnTheGrid) {
  for (const Generator& generator : generators()) {
    if (generator.category == "float") continue;
    for (const Triangle& triangle : scenes(generator, 4, 0, 200).triangles) {
      for (const Position& p : triangle) {
        EXPECT_EQ(p.x * 256, std::floor(p.x * 256)) << generator.name;
        EXPECT_EQ(p.y * 256, std::floor(p.y * 256)) << generator.name;
      }
    }
  }
}

std::uint64_t clip_digest(const Scene& scene) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const ClipTriangle& triangle : scene.clip->triangles) {
    for (const ClipPosition& p : triangle) {
      for (const float v : {p.x, p.y, p.z, p.w}) hash = (hash ^ std::bit_cast<std::uint32_t>(v)) * 0x100000001b3;
    }
  }
  return hash;
}

TEST(ClipGenerators, MakeTheSameTrianglesEverywhere) {
  const std::map<std::string_view, std::uint64_t> recorded{
      {"viewport_target", 8392404702350791666u},
      {"viewport_offset", 10542471893156065547u},
      {"viewport_fractional", 17447858661695073601u},
      {"viewport_larger", 8278574336295672819u},
      {"viewport_flipped", 6629143180877235703u},
      {"clip", 14185208827670739430u},
      {"clip_fractional", 4712831387426523879u},
      {"clip_flipped", 15947028083121441635u},
      {"clip_larger", 7954391216793282508u},
      {"clip_samples4", 3684515973587697107u},
      {"clip_far", 17613978929882454307u},
      {"clip_far_samples4", 11884109551392691426u},
      {"clip_far_scissor4", 14339109982889483292u},
      {"viewport_flipped_ties", 17890379726840434341u},
      {"cull_turned", 11120628764691582629u},
      {"cull_across", 7957413565275903017u},
      {"cull_across_samples4", 12086737043603791781u},
      {"cull_beside_clipped", 11547457233048517285u},
      {"cull_beside_clipped_samples4", 7574131210768435998u},
      {"clip_behind", 953389554067082917u},
      {"clip_fans", 10093439197303799405u},
      {"clip_grids", 3696774210683208045u},
      {"clip_grids_fractional", 4030919066084114556u},
      {"clip_grids_samples4", 8524698261825660885u},
  };
  for (const Generator& generator : clip_generators()) {
    const std::uint64_t actual = clip_digest(scenes(generator, 1, 0, 200));
    const auto found = recorded.find(generator.name);
    EXPECT_TRUE(found != recorded.end() && found->second == actual)
        << "      {\"" << generator.name << "\", " << actual << "u},";
    EXPECT_NE(actual, clip_digest(scenes(generator, 2, 0, 200)));
  }
}

TEST(ClipGenerators, DrawAnySceneWithoutTheOnesBeforeIt) {
  for (const Generator& generator : clip_generators()) {
    const Scene all = scenes(generator, 7, 0, 21);
    const Scene last = scenes(generator, 7, 20, 1);
    EXPECT_EQ(all.clip->viewport, *generator.viewport);
    EXPECT_TRUE(all.triangles.empty());
    ASSERT_GE(all.clip->triangles.size(), last.clip->triangles.size());
    const auto skipped = static_cast<std::ptrdiff_t>(all.clip->triangles.size() - last.clip->triangles.size());
    EXPECT_TRUE(
        std::equal(all.clip->triangles.begin() + skipped, all.clip->triangles.end(), last.clip->triangles.begin()))
        << generator.name;
    EXPECT_EQ(last.meshes.size(), generator.category == "clip_mesh" ? 1u : 0u);
  }
}

TEST(ClipGenerators, StayInsideOrCross) {
  const auto outside = [](const ClipTriangle& triangle) {
    return std::ranges::any_of(triangle, [](const ClipPosition& p) {
      return std::fabs(p.x) > p.w || std::fabs(p.y) > p.w || p.z < 0 || p.z > p.w;
    });
  };
  for (const Generator& generator : clip_generators()) {
    const Scene scene = scenes(generator, 1, 0, 400);
    const auto crossing = std::ranges::count_if(scene.clip->triangles, outside);
    if (generator.name.starts_with("cull_beside_clipped")) {
      const auto of_many = std::ranges::count_if(scenes(generator, 1, 0, 20'000).clip->triangles, outside);
      EXPECT_TRUE(of_many > 3 && of_many < 20) << generator.name << ": " << of_many;
    } else if (generator.category == "viewport" || generator.name == "cull_turned") {
      EXPECT_EQ(crossing, 0) << generator.name;
    } else {
      EXPECT_GT(crossing, generator.name == "clip_behind" ? 150 : 250) << generator.name;
    }
  }
}

TEST(Generators, ReachEverySample) {
  for (const int samples : {2, 4, 8, 16}) {
    const Scene scene = scenes(*find_generator("samples" + std::to_string(samples)), 5, 0, 300);
    ASSERT_EQ(scene.setting.samples(), samples);
    std::vector<int> on_edge(static_cast<std::size_t>(samples));
    for (const Triangle& t : scene.triangles) {
      for (int s = 0; s < samples; ++s) {
        for (int y = 8; y < 24; ++y) {
          for (int x = 8; x < 24; ++x) {
            const Explanation e = oracle::explain(scene.setting, scene.rules, t, x, y, s);
            const bool tie =
                std::ranges::any_of(e.edges, [](const EdgeExplanation& edge) { return edge.value == "0"; });
            on_edge[static_cast<std::size_t>(s)] += tie && !e.degenerate ? 1 : 0;
          }
        }
      }
    }
    EXPECT_GT(*std::ranges::min_element(on_edge), 5) << samples;
  }
}

// Each family must do what it is for, or a fault that only it could catch goes by.
TEST(Generators, ReachWhatTheyAreFor) {
  const auto on_edge_share = [](const Scene& scene) {
    std::size_t hit = 0;
    for (const Triangle& t : scene.triangles) {
      bool on_edge = false;
      for (int y = 0; y < scene.setting.target.height && !on_edge; ++y) {
        for (int x = 0; x < scene.setting.target.width && !on_edge; ++x) {
          const Explanation e = oracle::explain(scene.setting, scene.rules, t, x, y, 0);
          int zeros = 0, negative = 0;
          for (const EdgeExplanation& edge : e.edges) {
            zeros += edge.value == "0" ? 1 : 0;
            negative += edge.value.starts_with('-') ? 1 : 0;
          }
          on_edge = !e.degenerate && zeros > 0 && negative == 0;
        }
      }
      hit += on_edge ? 1 : 0;
    }
    return static_cast<double>(hit) / static_cast<double>(scene.triangles.size());
  };
  EXPECT_GT(on_edge_share(scenes(*find_generator("ties"), 5, 0, 300)), 0.6);
  EXPECT_GT(on_edge_share(scenes(*find_generator("fan"), 5, 0, 20)), 0.3);
  EXPECT_GT(on_edge_share(scenes(*find_generator("sliver"), 5, 0, 300)), 0.2);

  const Scene turned = scenes(*find_generator("cull_turned"), 5, 0, 300);
  const auto triangles = exact_window_triangles(turned);
  ASSERT_TRUE(triangles);
  const auto turned_over = std::ranges::count_if(*triangles, [&](const Triangle& t) {
    const auto area = [](const auto& a, const auto& b, const auto& c) {
      return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const GridTriangle s = snapped(turned, t);
    return area(s[0], s[1], s[2]) != 0 && (area(s[0], s[1], s[2]) > 0) != (area(t[0], t[1], t[2]) > 0);
  });
  EXPECT_GT(turned_over, 100);

  for (const char* name : {"strips", "fans"}) {
    const Scene scene = scenes(*find_generator(name), 5, 0, 300);
    EXPECT_EQ(assemble(*scene.assembly), scene.triangles);
    EXPECT_EQ(std::ranges::count(scene.assembly->indices, kRestartIndex), 299);
  }

  std::set<std::size_t> spokes;
  for (const Mesh& mesh : scenes(*find_generator("fan"), 5, 0, 2000).meshes) spokes.insert(mesh.count);
  EXPECT_LE(*spokes.begin(), 3u);
  EXPECT_GE(*spokes.rbegin(), 60u);
}

}  // namespace
}  // namespace edgecase::conformance
