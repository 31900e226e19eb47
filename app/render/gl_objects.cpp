#include "app/render/gl_objects.h"

namespace migiwa {
namespace {

template <class Object, class Create>
Object make(const Create& create) {
  GLuint name = 0;
  create(&name);
  return Object(name);
}

}  // namespace

GlBuffer makeBuffer() {
  return make<GlBuffer>([](GLuint* name) { glCreateBuffers(1, name); });
}
GlVertexArray makeVertexArray() {
  return make<GlVertexArray>([](GLuint* name) { glCreateVertexArrays(1, name); });
}
GlTexture makeTexture(GLenum target) {
  return make<GlTexture>([target](GLuint* name) { glCreateTextures(target, 1, name); });
}
GlRenderbuffer makeRenderbuffer() {
  return make<GlRenderbuffer>([](GLuint* name) { glCreateRenderbuffers(1, name); });
}
GlFramebuffer makeFramebuffer() {
  return make<GlFramebuffer>([](GLuint* name) { glCreateFramebuffers(1, name); });
}

}  // namespace migiwa
