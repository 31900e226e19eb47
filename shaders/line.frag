#include "frame.glsl"

uniform float width;
uniform vec4 lineColor;

in float across;
in vec3 world;

out vec4 color;

void main() {
  float alpha = lineColor.a * clamp(0.5 * width + 0.5 - abs(across), 0.0, 1.0);
  // The part of the walls that the clip plane cuts away is only hinted at.
  if (dot(clipPlane.xyz, world) > clipPlane.w) alpha *= 0.4;
  color = vec4(lineColor.rgb, alpha);
}
