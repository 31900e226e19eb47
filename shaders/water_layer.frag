#include "frame.glsl"

// A layer of the water's surface, its nearest faces that lie beyond another layer: unit normals in the eye's space, and
// the depth (m) in w, negative where the water touches a wall, 0 where there is no surface.
uniform int beyondLayer;  // 0: beyond the eye
uniform int wet;          // the faces are those to walls
layout(binding = 2) uniform sampler2D before;

in vec3 place;
in vec3 normal;

out vec4 layer;

// Interpolated normals that cancel out give way to the triangle's own.
vec3 unitNormal(vec3 normal, vec3 place) {
  float length2 = dot(normal, normal);
  vec3 face = cross(dFdx(place), dFdy(place));
  if (!gl_FrontFacing) face = -face;
  float face2 = dot(face, face);
  return length2 > 1e-6 ? normal * inversesqrt(length2)
                        : face2 > 0.0 ? face * inversesqrt(face2) : vec3(0.0, 0.0, 1.0);
}

void main() {
  float depth = -place.z;
  if (beyondLayer != 0) {
    float from = abs(texelFetch(before, ivec2(gl_FragCoord.xy), 0).w);
    if (from == 0.0 || depth <= 1.0001 * from) discard;
  }
  layer = vec4(unitNormal(normal, place), wet != 0 ? -depth : depth);
}
