#include "frame.glsl"

// One quad a segment, `width` pixels wide plus a soft edge.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;

uniform float width;

out float across;  // pixels from the line's middle
out vec3 world;

void main() {
  vec4 a = view * vec4(from, 1.0), b = view * vec4(to, 1.0);
  // What lies behind the eye has no place on the screen: cut the segment at the near plane.
  float near = clip[3][2] / (clip[2][2] - 1.0);
  float zNear = -near * 1.001;
  vec3 pa = from, pb = to;
  if (a.z > zNear && b.z > zNear) {
    gl_Position = vec4(0.0, 0.0, -2.0, 1.0);
    across = 0.0;
    world = from;
    return;
  }
  if (a.z > zNear) {
    float t = (zNear - a.z) / (b.z - a.z);
    a = mix(a, b, t), pa = mix(pa, pb, t);
  } else if (b.z > zNear) {
    float t = (zNear - b.z) / (a.z - b.z);
    b = mix(b, a, t), pb = mix(pb, pa, t);
  }
  vec4 clipA = clip * a, clipB = clip * b;
  vec2 screenA = clipA.xy / clipA.w * viewport.zw * 0.5, screenB = clipB.xy / clipB.w * viewport.zw * 0.5;
  vec2 along = screenB - screenA;
  along = dot(along, along) > 1e-8 ? normalize(along) : vec2(1.0, 0.0);
  vec2 side = vec2(-along.y, along.x);
  bool end = (gl_VertexID >> 1) == 1;
  across = ((gl_VertexID & 1) == 1 ? 1.0 : -1.0) * (0.5 * width + 1.0);
  vec4 position = end ? clipB : clipA;
  world = end ? pb : pa;
  position.xy += (side * across + along * (end ? 0.5 : -0.5) * width) / (viewport.zw * 0.5) * position.w;
  gl_Position = position;
}
