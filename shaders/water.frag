#include "frame.glsl"

// Light that comes to the eye from a point of the water's surface: a part is reflected, the rest has come through the
// water, refracted where it entered and where it left, from what is behind. A processor that draws pictures computes both
// sides of every condition, so there are few, and powers are sums of roots.
uniform vec4 loss;  // of light in water (1/m); w: height of the ground, which has no depth (m)
layout(binding = 2) uniform sampler2D exits;   // the layer of the surface through which light leaves
layout(binding = 3) uniform sampler2D behind;  // what is behind the water
layout(binding = 4) uniform sampler2D behindDepth;
layout(binding = 5) uniform sampler2D entries;  // the layer through which it comes to the eye

out vec4 color;

const float kIndex = 1.333;

// Within half a step of 255 of the exact curves.
vec3 toLinear(vec3 c) {
  return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878);
}
vec3 toSrgb(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0), s = sqrt(c), q = sqrt(s);
  return 0.662002687 * s + 0.684122060 * q - 0.323583601 * sqrt(q) - 0.0225411470 * c;
}

// What light comes from a direction (unit, eye's space), without anything of the scene.
vec3 surroundings(vec3 direction) {
  float height = dot(direction, mat3(view) * up.xyz);
  vec3 sky = mix(vec3(0.72, 0.84, 0.95), vec3(0.16, 0.36, 0.62), sqrt(max(height, 0.0)));
  const vec3 key = vec3(-0.4241, 0.7068, 0.5655);
  sky += clamp(500.0 * (dot(direction, key) - 0.985), 0.0, 6.0);
  return mix(vec3(0.44, 0.48, 0.52), sky, clamp(6.0 * height + 0.5, 0.0, 1.0));
}

vec2 pixelOf(vec3 p) {
  vec2 ndc = vec2(clip[0][0], clip[1][1]) * p.xy / max(-p.z, 1e-6);
  return viewport.xy + (0.5 + 0.5 * ndc) * viewport.zw;
}

ivec2 inViewport(vec2 pixel) {
  return ivec2(clamp(pixel, viewport.xy, viewport.xy + viewport.zw - 1.0));
}

// Depth (m) of what is behind the water.
float behindAt(vec2 pixel) {
  return abs(clip[3][2] / (2.0 * texelFetch(behindDepth, inViewport(pixel), 0).r - 1.0 + clip[2][2]));
}

// Fresnel's equations for unpolarised light; 1 where none passes.
float reflectance(float cosine, float fromOverTo) {
  float beyond = sqrt(max(1.0 - fromOverTo * fromOverTo * (1.0 - cosine * cosine), 0.0));
  float s = (fromOverTo * cosine - beyond) / (fromOverTo * cosine + beyond);
  float p = (cosine - fromOverTo * beyond) / (cosine + fromOverTo * beyond);
  return 0.5 * (s * s + p * p);
}

// How far (m) a point lies before the layer where light leaves the water; not positive where that is not there.
float inWater(vec3 q) {
  return abs(texelFetch(exits, inViewport(pixelOf(q)), 0).w) + q.z;
}

// Normals of a layer are not of unit length. Those that cancel out give way to the direction of sight.
vec3 unit(vec3 normal, vec3 instead) {
  float length2 = dot(normal, normal);
  return length2 > 1e-6 ? normal * inversesqrt(length2) : instead;
}

// The way (m) of a ray through the water from p on, where it is `straight` (m) to the other side straight behind: the last
// place that was in the water of a search by false position, which halves what it finds too far.
float wayThrough(vec3 p, vec3 direction, float straight) {
  const int kSteps = 4;
  float inside = 0.0, outside = 2.0 * straight, before = straight, beyond = inWater(p + outside * direction);
  if (beyond > 0.0) return outside;
  for (int k = 0; k < kSteps; ++k) {
    float way = mix(inside, outside, clamp(before / max(before - beyond, 1e-9), 0.3, 0.9));
    float found = inWater(p + way * direction);
    bool within = found > 0.0;
    inside = within ? way : inside;
    before = within ? found : 0.5 * before;
    outside = within ? outside : way;
    beyond = within ? 0.5 * beyond : found;
  }
  return inside;
}

// As it is shown. `p`, `n`: of the surface where the eye sees it, in the eye's space.
vec3 waterColor(vec3 p, vec3 n) {
  vec3 direction = normalize(p);
  // Triangles at the outline may turn a smooth normal away from the eye.
  float reflected = reflectance(max(-dot(direction, n), 0.02), 1.0 / kIndex);
  vec3 refracted = refract(direction, n, 1.0 / kIndex);

  float way = wayThrough(p, refracted, max(inWater(p), 0.0));
  vec3 q = p + way * refracted;
  vec2 own = pixelOf(q);
  vec4 found = texelFetch(exits, inViewport(own), 0);
  vec3 exit = unit(found.xyz, refracted);

  // Walls that the water touches are as if they had its index.
  bool free = found.w > 0.0;
  float mirrored = free ? reflectance(clamp(dot(refracted, exit), 0.02, 1.0), kIndex) : 0.0;
  vec3 onward = free ? refract(refracted, -exit, kIndex) : refracted;
  onward = dot(onward, onward) > 0.5 ? onward : reflect(refracted, exit);

  // What is behind, where the ray comes to if that is as far as straight behind, or else on the ground.
  vec3 upwards = mat3(view) * up.xyz;
  float height = dot(upwards, q) + dot(up.xyz, eye.xyz) - loss.w, falling = -dot(upwards, onward);
  float further = clamp(behindAt(own) + q.z, 0.0, -100.0 * q.z);
  if (falling > 1e-3) further = min(further, max(height, 0.0) / falling);
  vec3 end = q + further * onward;
  vec2 pixel = end.z < -1e-3 ? pixelOf(end) : own;
  // What stands in front of the water is not behind it.
  pixel = behindAt(pixel) < -0.98 * q.z ? own : pixel;
  vec2 shown = clamp(pixel, viewport.xy + 0.5, viewport.xy + viewport.zw - 0.5);
  vec3 seen = toLinear(texture(behind, shown / vec2(textureSize(behind, 0))).rgb);
  float outside = clamp(4.0 * distance(shown, pixel) / viewport.w, 0.0, 1.0);
  vec3 coming = mix(seen, surroundings(onward), max(mirrored, outside));
  return toSrgb(mix(exp(-way * loss.rgb) * coming, surroundings(reflect(direction, n)), reflected));
}

void main() {
  vec4 entry = texelFetch(entries, ivec2(gl_FragCoord.xy), 0);
  float depth = abs(entry.w);
  if (behindAt(gl_FragCoord.xy) < depth) discard;
  vec2 ndc = 2.0 * (gl_FragCoord.xy - viewport.xy) / viewport.zw - 1.0;
  vec3 p = depth * vec3(ndc / vec2(clip[0][0], clip[1][1]), -1.0);
  color = vec4(waterColor(p, unit(entry.xyz, -normalize(p))), 1.0);
}
