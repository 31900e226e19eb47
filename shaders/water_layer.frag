#include "frame.glsl"

// A layer of the water's surface, its nearest faces that lie beyond another layer: normals in the eye's space, and the depth
// (m) in w, negative where the water touches a wall, 0 where there is no surface. Triangles are small, so a processor that
// draws pictures runs this many times more often than there are pixels: what can be done for a pixel later is not done here.
uniform int beyondLayer;  // 0: beyond the eye
uniform int wet;          // the faces are those to walls
layout(binding = 2) uniform sampler2D before;

in vec3 normal;

out vec4 layer;

void main() {
  float depth = 1.0 / gl_FragCoord.w;
  if (beyondLayer != 0) {
    float from = abs(texelFetch(before, ivec2(gl_FragCoord.xy), 0).w);
    if (from == 0.0 || depth <= 1.0001 * from) discard;
  }
  layer = vec4(normal, wet != 0 ? -depth : depth);
}
