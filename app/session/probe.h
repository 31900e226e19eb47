// What walls take of one particle's support, by every method of gamma: worked out beside the simulation, on a
// thread of its own. No window, no OpenGL.
#pragma once

#include <array>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/session/ui_state.h"
#include "core/base/parallel.h"
#include "core/gamma/gamma_method.h"
#include "core/scene/scene.h"
#include "core/walls/boundary.h"

namespace migiwa {

/// A sphere of radius 1 made of triangles, for drawing a ball and for asking where walls cut it.
struct BallMesh {
  std::vector<Vec3f> vertices;
  std::vector<std::array<std::size_t, 3>> triangles;  ///< counterclockwise from outside

  /// An icosahedron whose triangles were divided into four, three times: 642 vertices, on the sphere.
  static const BallMesh& unit();
};

/// The walls of a scene with the settings of now, and every method of gamma for them. Methods that take long
/// to make are made one after the other.
class Probe {
 public:
  explicit Probe(const Scene& scene);
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  /// Whether it is one for these settings, too.
  bool fits(const Scene& scene) const;
  /// Makes another method; false when there are all.
  bool makeNext();
  /// What the methods that there are say of a place (m) at a time (s). The first one is that with which the
  /// simulation corrects, as `migiwa gamma --points` has it.
  WallAnswers ask(const Vec3f& at, double time);

 private:
  struct Entry {
    std::string name;
    PickedGamma picked;
    std::string fault;  ///< why it cannot be used at these walls
  };
  Scene scene_;
  ThreadPool pool_;
  Boundary boundary_;
  double time_ = 0;
  PickedGamma reference_;
  std::vector<Entry> entries_;
  int next_ = 0;  ///< of the methods that have a name
};

/// Between the panel of the particle that is looked into and the probe that works in the background.
class ProbeSession {
 public:
  /// Asks about the particle as it is now, and takes in what is known; returns whether there is news. Answers
  /// to a question that is out of date are shown until there is another: they say of when they are. While a
  /// run plays, few are asked, for the simulation needs the processor.
  bool poll(InspectModel& model, const Scene& scene, const Settings& now);
  /// Another scene takes the place of this one.
  void forget(InspectModel& model);
  /// Waits for what is under way.
  void wait() const;

 private:
  struct Outcome {
    std::shared_ptr<Probe> probe;
    WallAnswers answers;
  };

  bool isUpToDate(const InspectModel& model, const Scene& asked) const;

  std::shared_ptr<Probe> probe_;
  std::future<Outcome> asking_;
  std::chrono::steady_clock::time_point asked_{};
  bool dropped_ = false;
};

}  // namespace migiwa
