#include "frame.glsl"

in float height;  // from the bottom (0) to the top (1)

out vec4 color;

void main() {
  color = vec4(mix(vec3(0.925, 0.935, 0.945), vec3(0.700, 0.755, 0.810), smoothstep(0.0, 1.0, height)), 1.0);
}
