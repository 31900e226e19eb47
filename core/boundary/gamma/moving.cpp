// gamma where walls move: those that move as one keep their shape, so in their own frame gamma stays what it
// is, and what is costly to look at needs a grid only once. Where walls of several frames are in reach of a
// point their solids may overlap, and gamma is found anew from all of them.
#include <algorithm>
#include <limits>

#include "core/boundary/gamma/gamma_methods.h"

namespace migiwa {

namespace {

class MovingGamma final : public GammaMethod {
 public:
  MovingGamma(const GammaContext& context, std::unique_ptr<GammaMethod> (*make)(const GammaContext&))
      : boundary_(context.boundary),
        support_(context.supportRadius),
        whole_(makeAutoGammaWithoutGrid(context)) {
    std::vector<std::shared_ptr<const Surface>> still;
    for (const auto& surface : boundary_.surfaces())
      if (dynamic_cast<const MovingSurface*>(surface.get()) == nullptr) still.push_back(surface);
    if (!still.empty()) addFrame(context, nullptr, std::move(still), make);
    for (const auto& wall : boundary_.moving()) {
      const auto known = std::find_if(frames_.begin(), frames_.end(), [&](const Frame& frame) {
        return frame.mover != nullptr && frame.mover->group() == wall->group();
      });
      if (known != frames_.end()) continue;
      std::vector<std::shared_ptr<const Surface>> rest;
      for (const auto& other : boundary_.moving())
        if (other->group() == wall->group()) rest.push_back(other->rest());
      GammaContext alone = context;
      alone.region = {};
      addFrame(alone, wall.get(), std::move(rest), make);
    }
  }

  GammaChoice choice() const override {
    GammaChoice result{"", "walls that move, each in its own frame"};
    for (const Frame& frame : frames_) {
      const GammaChoice own = frame.method->choice();
      if (result.name.find(own.name) == std::string::npos)
        result.name += (result.name.empty() ? "" : ", ") + own.name;
      result.reason += "; " + std::string(frame.mover == nullptr ? "still: " : "moving: ") + own.reason;
    }
    result.reason += "; where several are in reach: " + whole_->choice().name;
    return result;
  }

  void wallsMoved() override { whole_->wallsMoved(); }

  void evaluate(std::span<const Float4> points, std::span<GammaSample> out) const override {
    // Gathered by frame, so that each method has a batch; the last is for points that see several.
    std::vector<std::vector<std::size_t>> picked(frames_.size() + 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3f p = points[i].xyz();
      std::size_t frame = frames_.size();
      int inReach = 0;
      float nearest = std::numeric_limits<float>::infinity();
      for (std::size_t k = 0; k < frames_.size(); ++k) {
        const float distance = frames_[k].boundary->distance(frames_[k].toRest(p));
        nearest = std::min(nearest, distance);
        if (distance >= support_) continue;
        frame = inReach++ == 0 ? k : frames_.size();
      }
      out[i] = GammaSample{};
      out[i].distance = nearest;
      if (inReach > 0) picked[frame].push_back(i);
    }
    std::vector<Float4> at;
    std::vector<GammaSample> samples;
    for (std::size_t k = 0; k < picked.size(); ++k) {
      if (picked[k].empty()) continue;
      const Frame* const frame = k < frames_.size() ? &frames_[k] : nullptr;
      at.clear();
      for (const std::size_t i : picked[k])
        at.emplace_back(frame != nullptr ? frame->toRest(points[i].xyz()) : points[i].xyz());
      samples.resize(at.size());
      (frame != nullptr ? frame->method : whole_)->evaluate(at, samples);
      const MovingSurface* const mover = frame != nullptr ? frame->mover : nullptr;
      for (std::size_t n = 0; n < at.size(); ++n) {
        GammaSample& sample = out[picked[k][n]];
        const float distance = sample.distance;
        sample = samples[n];
        sample.distance = distance;
        if (mover == nullptr) continue;
        sample.gradient = mover->directionToWorld(sample.gradient);
        sample.pairGradient = mover->directionToWorld(sample.pairGradient);
      }
    }
  }

 private:
  /// Walls that move as one, as they are described.
  struct Frame {
    const MovingSurface* mover;  ///< one of them; null: they stand still
    std::unique_ptr<const Boundary> boundary;
    std::unique_ptr<GammaMethod> method;

    Vec3f toRest(const Vec3f& p) const { return mover != nullptr ? mover->toRest(p) : p; }
  };

  void addFrame(const GammaContext& context, const MovingSurface* mover,
                std::vector<std::shared_ptr<const Surface>> surfaces,
                std::unique_ptr<GammaMethod> (*make)(const GammaContext&)) {
    auto boundary = std::make_unique<const Boundary>(Boundary::atRest(std::move(surfaces)));
    const GammaContext own{*boundary,       context.kernel, context.supportRadius, context.directions,
                           context.samples, context.region, context.pool,          context.place};
    std::unique_ptr<GammaMethod> method = make(own);
    frames_.push_back({mover, std::move(boundary), std::move(method)});
  }

  const Boundary& boundary_;
  float support_;
  std::unique_ptr<GammaMethod> whole_;
  std::vector<Frame> frames_;
};

}  // namespace

std::unique_ptr<GammaMethod> makeMovingGamma(const GammaContext& context,
                                             std::unique_ptr<GammaMethod> (*make)(const GammaContext&)) {
  return std::make_unique<MovingGamma>(context, make);
}

}  // namespace migiwa
