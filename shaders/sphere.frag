#include "frame.glsl"
#include "coverage.glsl"
#include "light.glsl"

uniform float radius;
layout(binding = 0) uniform sampler1D colorMap;

in vec2 place;
in vec3 ray;
flat in vec3 center;
flat in float value;

out vec4 color;

void main() {
  int mask = coverage(place, dFdx(place), dFdy(place));
  if (mask == 0) discard;
  gl_SampleMask[0] = mask;

  // First hit of the ray, and the point nearest to the sphere where only a sample beside the centre hits.
  vec3 direction = normalize(ray);
  float along = dot(direction, center);
  vec3 miss = along * direction - center;
  float halfChord = sqrt(max(radius * radius - dot(miss, miss), 0.0));
  vec3 point = (along - halfChord) * direction;
  vec3 normal = normalize(point - center);

  vec3 toEye = -direction;
  float facing = max(dot(normal, toEye), 0.0);
  vec3 albedo = texture(colorMap, (value * 255.0 + 0.5) / 256.0).rgb;
  Light light = light(normal, toEye);
  // Where spheres turn away from the eye they meet their neighbours, and little light gets in.
  float contact = mix(0.42, 1.0, smoothstep(0.0, 0.75, facing));
  vec3 lit = albedo * light.onSurface * contact + 0.07 * light.gleam;
  color = vec4(encodeSrgb(lit), 1.0);

  float clipZ = clip[2][2] * point.z + clip[3][2];
  gl_FragDepth = clamp(0.5 * clipZ / -point.z + 0.5, 0.0, 1.0);
}
