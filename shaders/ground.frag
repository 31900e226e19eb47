#include "frame.glsl"

uniform vec4 origin;      // w: half its side (m)
uniform vec4 gridOffset;  // of the middle from a grid line (m); z: distance of grid lines (m)
uniform vec4 shadowArea;  // lower corner relative to the middle, extent (m)
layout(binding = 1) uniform sampler2D shadowMap;

in vec2 plane;

out vec4 color;

// How much of the pixel the grid's lines cover, `width` pixels wide.
float grid(vec2 p, float distance, float width) {
  vec2 cells = p / distance;
  vec2 pixel = max(fwidth(cells), vec2(1e-6));
  vec2 toLine = abs(fract(cells - 0.5) - 0.5) / pixel;
  vec2 line = clamp(0.5 * width + 0.5 - toLine, 0.0, 1.0);
  // Lines closer than a few pixels would only flicker.
  line *= 1.0 - smoothstep(0.15, 0.45, pixel);
  return max(line.x, line.y);
}

void main() {
  float fade = 1.0 - smoothstep(0.35, 1.0, length(plane) / origin.w);
  vec2 p = plane + gridOffset.xy;
  float lines = 0.16 * grid(p, gridOffset.z, 1.0) + 0.20 * grid(p, 5.0 * gridOffset.z, 1.4);
  float shadow = texture(shadowMap, (plane - shadowArea.xy) / shadowArea.zw).r;

  vec4 floorColor = vec4(0.86, 0.875, 0.89, 0.75);
  vec3 rgb = floorColor.rgb;
  rgb = mix(rgb, vec3(0.28, 0.34, 0.42), min(lines, 1.0));
  rgb *= 1.0 - 0.62 * shadow;
  color = vec4(rgb, max(floorColor.a, shadow) * fade);
}
