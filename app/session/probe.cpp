#include "app/session/probe.h"

#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <utility>

#include "core/simulation/gauges.h"

namespace migiwa {
namespace {

constexpr int kDivisions = 3;
constexpr std::chrono::milliseconds kBetweenQuestions(250);

BallMesh icosahedron() {
  const float g = 0.5F * (1 + std::sqrt(5.0F));  // the golden ratio
  BallMesh mesh;
  for (const auto& [x, y, z] : std::vector<std::array<float, 3>>{{-1, g, 0},
                                                                 {1, g, 0},
                                                                 {-1, -g, 0},
                                                                 {1, -g, 0},
                                                                 {0, -1, g},
                                                                 {0, 1, g},
                                                                 {0, -1, -g},
                                                                 {0, 1, -g},
                                                                 {g, 0, -1},
                                                                 {g, 0, 1},
                                                                 {-g, 0, -1},
                                                                 {-g, 0, 1}})
    mesh.vertices.push_back(Vec3f(x, y, z).normalized());
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

void divide(BallMesh& mesh) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
  const auto middle = [&](std::size_t a, std::size_t b) {
    const auto [place, isNew] = middles.try_emplace(std::minmax(a, b), mesh.vertices.size());
    if (isNew) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
    return place->second;
  };
  for (const auto& [a, b, c] : std::exchange(mesh.triangles, {})) {
    const std::size_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.triangles.insert(mesh.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
}

}  // namespace

const BallMesh& BallMesh::unit() {
  static const BallMesh mesh = [] {
    BallMesh made = icosahedron();
    for (int k = 0; k < kDivisions; ++k) divide(made);
    return made;
  }();
  return mesh;
}

// One thread: the simulation has the others.
Probe::Probe(const Scene& scene)
    : scene_(scene),
      pool_(1),
      boundary_(wallsFor(scene.surfaces, static_cast<float>(scene.supportRadius()))) {
  if (boundary_.empty()) return;
  const GammaContext context = gammaContextOf(scene_, boundary_, pool_);
  entries_.push_back({"in use", gammaMethodOf(scene_, context), {}});
  reference_ = referenceGamma(context);
}

bool Probe::fits(const Scene& scene) const {
  return scene.supportRadius() == scene_.supportRadius() && scene.solver.kernel == scene_.solver.kernel &&
         scene.boundary.handling == scene_.boundary.handling &&
         scene.boundary.gammaMethod == scene_.boundary.gammaMethod &&
         scene.boundary.directions == scene_.boundary.directions &&
         scene.boundary.samples == scene_.boundary.samples;
}

bool Probe::makeNext() {
  const auto names = gammaMethodNames();
  if (boundary_.empty() || static_cast<std::size_t>(next_) >= names.size()) return false;
  Entry& entry = entries_.emplace_back();
  entry.name = names[static_cast<std::size_t>(next_)];
  try {
    entry.picked = makeGammaMethod(next_, gammaContextOf(scene_, boundary_, pool_));
  } catch (const std::exception& error) {
    entry.fault = error.what();
  }
  ++next_;
  return true;
}

WallAnswers Probe::ask(const Vec3f& at, double time) {
  if (boundary_.moves() && time != time_) {
    boundary_.moveTo(time, time);
    for (Entry& entry : entries_)
      if (entry.picked.method) entry.picked.method->wallsMoved();
    reference_.method->wallsMoved();
  }
  time_ = time;
  WallAnswers answers;
  answers.at = at;
  answers.time = time;
  if (boundary_.empty()) return answers;
  const Float4 point(at);
  const auto gammaOf = [&](const GammaMethod& method) {
    GammaSample sample;
    method.evaluate({&point, 1}, {&sample, 1});
    return static_cast<double>(sample.gamma);
  };
  answers.reference = gammaOf(*reference_.method);
  for (const Entry& entry : entries_) {
    MethodGamma& method = answers.methods.emplace_back();
    method.name = entry.name;
    method.fault = entry.fault;
    if (entry.picked.method) method.gamma = gammaOf(*entry.picked.method);
  }
  const auto support = static_cast<float>(scene_.supportRadius());
  for (const Vec3f& direction : BallMesh::unit().vertices)
    answers.distances.push_back(boundary_.distance(at + support * direction));
  return answers;
}

bool ProbeSession::poll(InspectModel& model, const Scene& scene, const Settings& now) {
  bool news = false;
  if (asking_.valid()) {
    if (asking_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    Outcome outcome = asking_.get();
    if (!std::exchange(dropped_, false)) {
      probe_ = std::move(outcome.probe);
      // Another particle may have been picked meanwhile.
      if (model.id == outcome.answers.id) model.walls = std::move(outcome.answers);
      news = true;
    }
  }
  if (!model.picked) return news;
  Scene asked = scene;
  asked.solver = now.solver;
  asked.boundary = now.boundary;
  const auto clock = std::chrono::steady_clock::now();
  if (isUpToDate(model, asked) || clock - asked_ < kBetweenQuestions) return news;
  asked_ = clock;
  asking_ = std::async(std::launch::async, [probe = probe_, scene = std::move(asked), id = model.picked->id,
                                            at = model.picked->position, time = model.time]() mutable {
    Outcome outcome;
    try {
      if (probe == nullptr || !probe->fits(scene)) probe = std::make_shared<Probe>(scene);
      const bool more = probe->makeNext();
      outcome.answers = probe->ask(at, time);
      outcome.answers.complete = !more;
      outcome.answers.id = id;
      outcome.probe = std::move(probe);
    } catch (const std::exception& error) {
      outcome.answers.id = id;
      outcome.answers.at = at;
      outcome.answers.time = time;
      outcome.answers.fault = error.what();
      outcome.answers.complete = true;
    }
    return outcome;
  });
  return news;
}

bool ProbeSession::isUpToDate(const InspectModel& model, const Scene& asked) const {
  if (!model.walls || model.walls->at != model.picked->position || model.walls->time != model.time)
    return false;
  return !model.walls->fault.empty() || (model.walls->complete && probe_ != nullptr && probe_->fits(asked));
}

void ProbeSession::forget(InspectModel& model) {
  model = {};
  probe_.reset();
  dropped_ = asking_.valid();
}

void ProbeSession::wait() const {
  if (asking_.valid()) asking_.wait();
}

}  // namespace migiwa
