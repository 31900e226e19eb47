#include "frame.glsl"
#include "light.glsl"

// The near side of a vessel is glass, so that the fluid can be seen through it.
uniform int glass;

in vec3 place;
in vec3 normal;

out vec4 color;

void main() {
  vec3 toEye = -normalize(place);
  if (glass != 0) {
    // Its outside: thin where it faces the eye, dark and firm at the outline.
    vec3 outward = -normalize(normal);
    float rim = pow(1.0 - clamp(dot(outward, toEye), 0.0, 1.0), 2.5);
    float gleam = light(outward, toEye).gleam;
    color = vec4(mix(vec3(0.97, 0.985, 1.0), vec3(0.30, 0.37, 0.45), rim), mix(0.10, 0.80, rim));
    color = mix(color, vec4(1.0), 0.45 * gleam);
    return;
  }
  if (!gl_FrontFacing) {
    // Through the cut the eye looks into the solid; what it sees there is the far side, which, flat, stands for
    // the face of the cut.
    color = vec4(encodeSrgb(vec3(0.47, 0.150, 0.085)), 1.0);
    return;
  }
  Light light = light(normalize(normal), toEye);
  color = vec4(encodeSrgb(vec3(0.60, 0.525, 0.43) * light.onSurface + 0.05 * light.gleam), 1.0);
}
