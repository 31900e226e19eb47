#include "frame.glsl"

// A square in the ground plane around the scene.
uniform vec4 origin;  // its middle; w: half its side (m)
uniform vec4 axisU;
uniform vec4 axisV;

out vec2 plane;  // metres from the middle

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  plane = corner * origin.w;
  gl_Position = clip * view * vec4(origin.xyz + plane.x * axisU.xyz + plane.y * axisV.xyz, 1.0);
}
