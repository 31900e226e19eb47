#include "frame.glsl"

// A rectangle in space.
uniform vec4 corner, across, side;  // its lower left corner and its sides (m)

out vec2 place;  // in the picture, from the top left

void main() {
  vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  place = vec2(at.x, 1.0 - at.y);
  gl_Position = clip * view * vec4(corner.xyz + at.x * across.xyz + at.y * side.xyz, 1.0);
}
