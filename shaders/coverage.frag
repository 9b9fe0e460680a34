// Notes the samples that a fragment covers in the mask of its triangle. The words are those of conformance/scene/mask.h,
// every 64-bit word seen as two 32-bit words, the less significant first, or short rows of one 32-bit word. The sample
// count is a power of two and at most 16, so that the samples of one pixel lie in one 32-bit word.
// No #version line: the build (Vulkan) or the program (OpenGL) puts one in front.

#ifdef VULKAN
layout(constant_id = 0) const uint samples = 1u;
layout(push_constant) uniform Layout {
  uint row_words;  // 32-bit words of one row
  uint rows;
  uint columns;
} mask;
#define ROW_WORDS mask.row_words
#define ROWS mask.rows
#define COLUMNS mask.columns
#else
uniform uint samples;
uniform uint row_words;
uniform uint rows;
uniform uint columns;
#define ROW_WORDS row_words
#define ROWS rows
#define COLUMNS columns
#endif

// A driver without gl_SampleMaskIn has one sample, which every fragment covers.
#ifdef NO_SAMPLE_MASK
#define COVERED 1u
#else
#define COVERED (uint(gl_SampleMaskIn[0]) & ((1u << samples) - 1u))
#endif

#ifdef PRIMITIVE_ID
#define TRIANGLE uint(gl_PrimitiveID)
#else
layout(location = 0) flat in uint triangle;
#define TRIANGLE triangle
#endif
#ifdef COLOUR_TARGET
layout(location = 0) out vec4 colour;  // nobody reads it: a target of its own makes a driver take other paths
#endif
layout(std430, binding = 0) buffer Masks { uint words[]; };

void main() {
  uvec2 pixel = uvec2(gl_FragCoord.xy);
#ifdef COLOUR_TARGET
  colour = vec4(1.0);
#endif
  // There is nothing to cover beyond the target. A driver may run fragments there all the same, as llvmpipe does up to
  // the next multiple of four pixels (conformance/models/llvmpipe_wrap.h): they would be noted in the next mask.
  if (pixel.x >= COLUMNS || pixel.y >= ROWS) return;
  uint bit = pixel.x * samples;
  uint word = (TRIANGLE * ROWS + pixel.y) * ROW_WORDS + (bit >> 5u);
  atomicOr(words[word], COVERED << (bit & 31u));
}
