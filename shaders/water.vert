#include "frame.glsl"

// The whole picture, behind every layer of water: where its depth is the greater one there is water.
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  gl_Position = vec4(corner, 1.0, 1.0);
}
