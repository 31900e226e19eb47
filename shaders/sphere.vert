#include "frame.glsl"

// One quad a sphere, facing the eye, that just covers the sphere's outline in perspective: the rays that touch the
// sphere form a cone, and `place` is (cos, sin) inside that cone's circle of radius 1.
layout(location = 0) in vec4 sphere;  // centre (m), colour value in [0, 1]

uniform float radius;

out vec2 place;
out vec3 ray;
flat out vec3 center;
flat out float value;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  center = (view * vec4(sphere.xyz, 1.0)).xyz;
  value = sphere.w;
  place = corner;

  float distance2 = dot(center, center);
  float inside = 1.0 - radius * radius / distance2;
  if (inside <= 0.0) {  // the eye is in the sphere
    gl_Position = vec4(0.0, 0.0, -2.0, 1.0);
    ray = vec3(0.0);
    return;
  }
  vec3 axis = center * inversesqrt(distance2);
  vec3 side = normalize(cross(abs(axis.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), axis));
  vec3 other = cross(axis, side);
  float rim = radius * sqrt(inside);
  ray = center * inside + rim * (corner.x * side + corner.y * other);
  gl_Position = clip * vec4(ray, 1.0);
}
