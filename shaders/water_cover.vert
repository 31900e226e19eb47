#include "frame.glsl"

// A triangle of the water's surface where it is the nearest to the eye.
layout(location = 0) in vec3 position;

centroid out vec3 place;  // in clip space: x, y, w

void main() {
  gl_Position = clip * (view * vec4(position, 1.0));
  place = gl_Position.xyw;
}
