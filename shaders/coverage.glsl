// Which of the pixel's samples the unit circle covers: the place in it, carried to each sample.
int coverage(vec2 place, vec2 alongX, vec2 alongY) {
  int mask = 0;
  for (int i = 0; i < 4; ++i) {
    vec2 offset = i % 2 == 0 ? samples[i / 2].xy : samples[i / 2].zw;
    vec2 p = place + offset.x * alongX + offset.y * alongY;
    if (dot(p, p) <= 1.0) mask |= 1 << i;
  }
  return mask;
}
