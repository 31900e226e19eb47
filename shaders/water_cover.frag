#include "frame.glsl"

// The water's colours onto the picture. A pixel at its outline shows as much of it as there is water among the pixels
// around, the nearer the more.
layout(binding = 2) uniform sampler2D colors;
layout(binding = 3) uniform sampler2D entries;

out vec4 color;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 size = vec2(textureSize(colors, 0));
  // Each of these is the mean of four pixels, so that together they weigh a square of nine by 1, 2 and 4 sixteenths.
  float share = 0.0;
  for (int k = 0; k < 4; ++k)
    share += 0.25 * texture(colors, (gl_FragCoord.xy + vec2(k & 1, k >> 1) - 0.5) / size).a;
  vec4 own = texelFetch(colors, pixel, 0);
  if (own.a < 0.5) discard;
  color = vec4(own.rgb, share);
  // The farthest around, so that lines on walls that the water touches are before it.
  float depth = abs(texelFetch(entries, pixel, 0).w);
  for (int k = -1; k <= 1; k += 2) {
    depth = max(depth, abs(texelFetch(entries, pixel + ivec2(k, 0), 0).w));
    depth = max(depth, abs(texelFetch(entries, pixel + ivec2(0, k), 0).w));
  }
  gl_FragDepth = 0.5 + 0.5 * (clip[3][2] / depth - clip[2][2]) + 1e-7;
}
