#include "frame.glsl"

// A triangle of the water's surface.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 waterNormal;

out vec3 normal;  // in the eye's space, out of the water

void main() {
  normal = mat3(view) * waterNormal;
  gl_Position = clip * (view * vec4(position, 1.0));
}
