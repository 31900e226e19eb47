#include "frame.glsl"

// A triangle of a wall, cut by the clip plane.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 wallNormal;

out vec3 place;   // in the eye's space
out vec3 normal;  // in the eye's space, into the fluid

void main() {
  vec4 inView = view * vec4(position, 1.0);
  place = inView.xyz;
  normal = mat3(view) * wallNormal;
  gl_Position = clip * inView;
  gl_ClipDistance[0] = clipPlane.w - dot(clipPlane.xyz, position);
}
