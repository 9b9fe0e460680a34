// Passes positions on and numbers the triangles of the draw, three vertices each; with PRIMITIVE_ID the fragment shader
// asks for the number instead, because strips, fans and indices share vertices between triangles.
// No #version line: the build (Vulkan) or the program (OpenGL) puts one in front.

layout(location = 0) in vec4 position;  // in clip space
#ifdef PRIMITIVE_ID
void main() { gl_Position = position; }
#else
#ifdef VULKAN
#define TRIANGLE (uint(gl_VertexIndex) / 3u)
#else
// Not gl_VertexID: softpipe splits long draws, and counts it from the start of each part.
layout(location = 1) in uint vertex_triangle;
#define TRIANGLE vertex_triangle
#endif

layout(location = 0) flat out uint triangle;

void main() {
  gl_Position = position;
  triangle = TRIANGLE;
}
#endif
