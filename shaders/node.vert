#include "frame.glsl"

// One quad a disc, in the disc's plane, cut by the clip plane.
layout(location = 0) in vec4 disc;        // centre and radius (m)
layout(location = 1) in vec4 wallNormal;  // into the fluid; w: colour value in [0, 1]
layout(location = 2) in float vessel;

out vec2 place;  // in the unit circle
out vec3 inView;
flat out vec3 normal;  // in the eye's space
flat out float value;
flat out int hollow;  // a disc that must not hide the fluid behind it

void main() {
  vec3 n = wallNormal.xyz;
  vec3 side = normalize(cross(abs(n.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), n));
  place = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 world = disc.xyz + disc.w * (place.x * side + place.y * cross(n, side));
  normal = mat3(view) * n;
  value = wallNormal.w;
  hollow = vessel != 0.0 && dot(n, eye.xyz - disc.xyz) < 0.0 ? 1 : 0;
  inView = (view * vec4(world, 1.0)).xyz;
  gl_Position = clip * vec4(inView, 1.0);
  gl_ClipDistance[0] = clipPlane.w - dot(clipPlane.xyz, world);
}
