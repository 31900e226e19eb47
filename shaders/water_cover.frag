#include "frame.glsl"

// The water's colours, one for each pixel whose centre it covers, onto all samples that it covers.
layout(binding = 2) uniform sampler2D colors;

centroid in vec3 place;

out vec4 color;

void main() {
  vec2 pixel = viewport.xy + (0.5 + 0.5 * place.xy / place.z) * viewport.zw;
  vec4 found = texture(colors, pixel / vec2(textureSize(colors, 0)));
  if (found.a < 0.01) discard;
  color = vec4(found.rgb / found.a, 1.0);
}
