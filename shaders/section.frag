#include "frame.glsl"

// The picture as it is: its colours have a meaning that light would change.
layout(binding = 0) uniform sampler2D picture;

in vec2 place;

out vec4 color;

void main() {
  vec4 shown = texture(picture, place);
  if (shown.a < 0.5) discard;
  color = vec4(shown.rgb / shown.a, 1.0);
}
