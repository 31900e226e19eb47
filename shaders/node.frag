#include "frame.glsl"
#include "coverage.glsl"
#include "light.glsl"

layout(binding = 0) uniform sampler1D colorMap;

in vec2 place;
in vec3 inView;
flat in vec3 normal;
flat in float value;
flat in int hollow;

out vec4 color;

void main() {
  vec2 alongX = dFdx(place), alongY = dFdy(place);
  int mask = coverage(place, alongX, alongY);
  // A line along the rim, about a pixel wide, tells discs apart.
  float pixel = length(fwidth(place));
  float inner = max(1.0 - 1.2 * pixel, 0.85);
  if (hollow != 0) mask &= ~coverage(place / inner, alongX / inner, alongY / inner);
  if (mask == 0) discard;
  gl_SampleMask[0] = mask;

  vec3 toEye = -normalize(inView);
  vec3 albedo = texture(colorMap, (value * 255.0 + 0.5) / 256.0).rgb;
  // From behind the same disc is darker.
  Light light = light(dot(normal, toEye) < 0.0 ? -normal : normal, toEye);
  float shade = dot(normal, toEye) < 0.0 ? 0.45 : 1.0;
  float line = smoothstep(inner - pixel, inner, length(place));
  color = vec4(encodeSrgb(albedo * light.onSurface * shade * mix(1.0, 0.45, line)), 1.0);
}
