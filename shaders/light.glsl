// The light in every picture: one lamp that goes with the eye, and a sky over warmer ground.
struct Light {
  vec3 onSurface;  // times the albedo
  float gleam;
};

// Both vectors are units in the eye's space.
Light light(vec3 normal, vec3 toEye) {
  vec3 worldUp = normalize(mat3(view) * up.xyz);
  vec3 key = normalize(vec3(-0.45, 0.75, 0.6));
  vec3 sky = mix(vec3(0.46, 0.44, 0.42), vec3(0.80, 0.84, 0.90), 0.5 + 0.5 * dot(normal, worldUp));
  float diffuse = max(dot(normal, key), 0.0);
  float gleam = pow(max(dot(normal, normalize(key + toEye)), 0.0), 48.0);
  return Light(0.62 * sky + 0.62 * diffuse, gleam);
}
