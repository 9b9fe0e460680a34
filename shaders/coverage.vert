// Passes positions on and numbers the triangles of the draw, three vertices each.
// No #version line: the build (Vulkan) or the program (OpenGL) puts one in front.

layout(location = 0) in vec2 position;  // normalized device coordinates
#ifdef VULKAN
#define TRIANGLE (uint(gl_VertexIndex) / 3u)
#else
// Not gl_VertexID: softpipe splits long draws, and counts it from the start of each part.
layout(location = 1) in uint vertex_triangle;
#define TRIANGLE vertex_triangle
#endif

layout(location = 0) flat out uint triangle;

void main() {
  gl_Position = vec4(position, 0.0, 1.0);
  triangle = TRIANGLE;
}
