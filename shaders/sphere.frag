#include "frame.glsl"

uniform float radius;
layout(binding = 0) uniform sampler1D colorMap;

in vec2 place;
in vec3 ray;
flat in vec3 center;
flat in float value;

out vec4 color;

// Which of the pixel's samples the outline covers: the place in the unit circle, carried to each sample.
int coverage(vec2 alongX, vec2 alongY) {
  int mask = 0;
  for (int i = 0; i < 4; ++i) {
    vec2 offset = i % 2 == 0 ? samples[i / 2].xy : samples[i / 2].zw;
    vec2 p = place + offset.x * alongX + offset.y * alongY;
    if (dot(p, p) <= 1.0) mask |= 1 << i;
  }
  return mask;
}

void main() {
  int mask = coverage(dFdx(place), dFdy(place));
  if (mask == 0) discard;
  gl_SampleMask[0] = mask;

  // First hit of the ray, and the point nearest to the sphere where only a sample beside the centre hits.
  vec3 direction = normalize(ray);
  float along = dot(direction, center);
  vec3 miss = along * direction - center;
  float halfChord = sqrt(max(radius * radius - dot(miss, miss), 0.0));
  vec3 point = (along - halfChord) * direction;
  vec3 normal = normalize(point - center);

  vec3 worldUp = normalize(mat3(view) * up.xyz);
  vec3 key = normalize(vec3(-0.45, 0.75, 0.6));
  vec3 toEye = -direction;
  float facing = max(dot(normal, toEye), 0.0);

  vec3 albedo = texture(colorMap, (value * 255.0 + 0.5) / 256.0).rgb;
  vec3 sky = mix(vec3(0.46, 0.44, 0.42), vec3(0.80, 0.84, 0.90), 0.5 + 0.5 * dot(normal, worldUp));
  float diffuse = max(dot(normal, key), 0.0);
  float gleam = pow(max(dot(normal, normalize(key + toEye)), 0.0), 48.0);
  // Where spheres turn away from the eye they meet their neighbours, and little light gets in.
  float contact = mix(0.42, 1.0, smoothstep(0.0, 0.75, facing));
  vec3 lit = albedo * (0.62 * sky + 0.62 * diffuse) * contact + 0.07 * gleam;
  color = vec4(encodeSrgb(lit), 1.0);

  float clipZ = clip[2][2] * point.z + clip[3][2];
  gl_FragDepth = clamp(0.5 * clipZ / -point.z + 0.5, 0.0, 1.0);
}
