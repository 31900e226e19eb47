#version 450 core

// app/render/frame_uniforms.h
layout(std140, binding = 0) uniform Frame {
  mat4 view;
  mat4 clip;
  vec4 eye;
  vec4 up;
  vec4 clipPlane;
  vec4 viewport;
  vec4 samples[2];
};

vec3 encodeSrgb(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}
