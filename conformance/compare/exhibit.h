// Exhibit: everything that a picture of one scene shows, and what is made of its samples.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "conformance/compare/compare.h"
#include "conformance/compare/outline.h"
#include "conformance/scene/explanation.h"
#include "conformance/scene/mask.h"
#include "conformance/scene/rule_set.h"
#include "conformance/scene/scene.h"

namespace edgecase::conformance {

/// One triangle, or one mesh, with what the rules say and what a subject did. The masks hold one mask for each triangle
/// of the scene, in its layout.
struct Before {
  std::string label;
  std::string label_after;
  std::vector<GridTriangle> snapped;
};

struct Exhibit {
  std::string title;    ///< one line
  std::string subject;  ///< may be empty when there is nothing observed
  std::string command;  ///< one line that reproduces this; may be empty
  Scene scene;
  const RuleSet* rule_set = &kExactRules;  ///< what `must` and `may` are by
  std::vector<GridTriangle> snapped;       ///< the scene's triangles on the subpixel grid of its rules
  MaskBatch must;
  MaskBatch may;       ///< no masks if the rules leave nothing open
  MaskBatch observed;  ///< no masks: the exhibit shows only what the rules say
  /// Its triangle is an index into scene.triangles.
  std::optional<WrongSample> wrong;
  /// If present, the exhibit is of a change that must not matter: `must` is what was covered before it, by these
  /// triangles, and the picture shows that on the left.
  std::optional<Before> before;
  /// What is wrong with it, in words; where empty, its kind says it.
  std::string meaning;
  /// Of the wrong sample, in the triangle it names.
  std::optional<Explanation> explanation;
};

/// What became of one sample, all triangles of the exhibit taken together.
enum class Mark {
  empty,         ///< not covered, rightly
  covered,       ///< covered as often as the rules say
  missing,       ///< covered less often
  unexpected,    ///< covered, where the rules cover nothing
  doubled,       ///< covered more often than the rules say, where they do cover
  open_empty,    ///< left open by the rules, and not covered
  open_covered,  ///< left open by the rules, and covered
};

inline constexpr int kMarks = 7;

struct SampleState {
  Mark mark = Mark::empty;
  int observed = 0;  ///< how many triangles covered it
};

SampleState sample_state(const Exhibit& exhibit, int x, int y, int sample);

/// Pixels x .. x + width - 1 of rows y .. y + height - 1, all inside the target.
struct Window {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  bool contains(int px, int py) const { return px >= x && px < x + width && py >= y && py < y + height; }
};

/// The part of the target that matters, at most 48x32 pixels and less for several samples a pixel: the triangles and
/// all that is wrong with a little room around, or as much of that as surrounds the first wrong sample.
Window choose_window(const Exhibit& exhibit);

/// How many samples of the window bear each mark, indexed by Mark.
std::array<int, kMarks> count_marks(const Exhibit& exhibit, const Window& window);

}  // namespace edgecase::conformance
