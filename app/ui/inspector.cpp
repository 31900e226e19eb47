// The particle that is looked into: over the picture its neighbours and its support ball, of which the part
// behind walls is shaded (Figures 1 and 2 of [FM], live); beside it a card with its values.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "app/session/probe.h"
#include "app/ui/ui.h"
#include "app/ui/widgets.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

constexpr ImU32 kFluidBack = IM_COL32(71, 184, 172, 26), kFluidFront = IM_COL32(71, 184, 172, 38),
                kMissingBack = IM_COL32(233, 84, 50, 90), kMissingFront = IM_COL32(233, 84, 50, 120),
                kCut = IM_COL32(150, 30, 10, 255), kRim = IM_COL32(20, 90, 90, 200),
                kBond = IM_COL32(24, 34, 46, 150), kNeighbour = IM_COL32(24, 34, 46, 220),
                kPicked = IM_COL32(255, 214, 64, 255), kHovered = IM_COL32(255, 255, 255, 255);
constexpr float kCardWidth = 20;  // over the height of the text

/// World to pixels.
class Sight {
 public:
  Sight(const Projection& projection, const Rect& area) : projection_(projection), area_(area) {
    const Mat4f inverse = projection.view.inverse();
    eye_ = inverse.block<3, 1>(0, 3);
    const Vec3f right = inverse.block<3, 1>(0, 0);
    right_ = right;
  }

  const Vec3f& eye() const { return eye_; }
  std::optional<ImVec2> at(const Vec3f& p) const {
    const auto pixel = pixelOf(p, projection_, area_);
    return pixel ? std::optional(ImVec2{(*pixel)[0], (*pixel)[1]}) : std::nullopt;
  }
  /// Of a sphere about p in the picture (pixels).
  float radius(const Vec3f& p, float radius) const {
    const std::optional<ImVec2> centre = at(p), side = at(p + radius * right_);
    return centre && side ? std::hypot(side->x - centre->x, side->y - centre->y) : 0;
  }

 private:
  Projection projection_;
  Rect area_;
  Vec3f eye_, right_;
};

/// A corner of the ball's surface: where, and how far from the walls (m).
struct Corner {
  Vec3f at;
  float distance;
};

Corner between(const Corner& a, const Corner& b) {
  const float share = a.distance / (a.distance - b.distance);
  return {a.at + share * (b.at - a.at), 0};
}

void fill(ImDrawList* draw, const Sight& sight, const std::vector<Corner>& corners, ImU32 color) {
  std::array<ImVec2, 4> points;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::optional<ImVec2> point = sight.at(corners[k].at);
    if (!point) return;
    points[k] = *point;
  }
  for (std::size_t k = 2; k < corners.size(); ++k)
    draw->AddTriangleFilled(points[0], points[k - 1], points[k], color);
}

/// One triangle of the ball: what is in the fluid, what is behind a wall, and the line between them.
void drawPiece(ImDrawList* draw, const Sight& sight, const std::array<Corner, 3>& corners, bool front) {
  std::vector<Corner> fluid, missing, cut;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner &here = corners[k], &next = corners[(k + 1) % 3];
    (here.distance > 0 ? fluid : missing).push_back(here);
    if ((here.distance > 0) == (next.distance > 0)) continue;
    const Corner edge = between(here, next);
    fluid.push_back(edge);
    missing.push_back(edge);
    cut.push_back(edge);
  }
  if (fluid.size() > 2) fill(draw, sight, fluid, front ? kFluidFront : kFluidBack);
  if (missing.size() > 2) fill(draw, sight, missing, front ? kMissingFront : kMissingBack);
  if (cut.size() != 2) return;
  const std::optional<ImVec2> from = sight.at(cut[0].at), to = sight.at(cut[1].at);
  if (from && to) draw->AddLine(*from, *to, kCut, 1.6F);
}

void drawBall(ImDrawList* draw, const Sight& sight, const Vec3f& centre, float support,
              const std::vector<float>& distances) {
  const BallMesh& ball = BallMesh::unit();
  const bool known = distances.size() == ball.vertices.size();
  const auto corner = [&](std::size_t k) -> Corner {
    return {centre + support * ball.vertices[k], known ? distances[k] : support};
  };
  // Edges that are smoothed would show all triangles.
  const ImDrawListFlags flags = draw->Flags;
  draw->Flags &= ~ImDrawListFlags_AntiAliasedFill;
  for (const bool front : {false, true}) {
    for (const auto& [a, b, c] : ball.triangles) {
      const std::array<Corner, 3> corners{corner(a), corner(b), corner(c)};
      const Vec3f outwards = ball.vertices[a] + ball.vertices[b] + ball.vertices[c];
      if ((outwards.dot(sight.eye() - corners[0].at) > 0) == front) drawPiece(draw, sight, corners, front);
    }
  }
  draw->Flags = flags;
  if (const std::optional<ImVec2> middle = sight.at(centre))
    draw->AddCircle(*middle, sight.radius(centre, support), kRim, 96, 1.2F);
}

void ring(ImDrawList* draw, const Sight& sight, const Vec3f& at, float radius, ImU32 color, float width) {
  if (const std::optional<ImVec2> middle = sight.at(at))
    draw->AddCircle(*middle, std::max(sight.radius(at, radius), 2.0F), color, 32, width);
}

void drawPicked(ImDrawList* draw, const Sight& sight, const InspectModel& model, const FrameInfo& frame) {
  const PickedParticle& picked = *model.picked;
  const float radius = 0.5F * frame.spacing;
  const bool current = model.walls && model.walls->at == picked.position && model.walls->time == frame.time;
  drawBall(draw, sight, picked.position, frame.supportRadius,
           current ? model.walls->distances : std::vector<float>());
  const std::optional<ImVec2> middle = sight.at(picked.position);
  for (const Vec3f& neighbour : picked.around) {
    if (const std::optional<ImVec2> to = sight.at(neighbour); middle && to)
      draw->AddLine(*middle, *to, kBond, 1.2F);
    ring(draw, sight, neighbour, 0.35F * radius, kNeighbour, 1.2F);
  }
  ring(draw, sight, picked.position, radius, kPicked, 2.5F);
}

std::string threeNumbers(const Vec3d& v) {
  return formatNumber("%.3f  ", v.x()) + formatNumber("%.3f  ", v.y()) + formatNumber("%.3f", v.z());
}

void row(const char* label, const std::string& value) {
  rowLabel(label);
  ImGui::TextUnformatted(value.c_str());
}

/// Gamma of each method, and how far from the reference it is.
void methodRows(const WallAnswers& walls) {
  if (!walls.fault.empty()) return ImGui::TextWrapped("%s", walls.fault.c_str());
  if (walls.methods.empty()) return faintText("No walls: γ is 1 everywhere");
  row("reference", formatNumber("%.5f", walls.reference));
  for (const MethodGamma& method : walls.methods) {
    if (!method.gamma) {
      rowLabel(method.name.c_str());
      faintText("not at these walls");
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", method.fault.c_str());
      continue;
    }
    row(method.name.c_str(),
        formatNumber("%.5f", *method.gamma) + formatNumber("   %+.5f", *method.gamma - walls.reference));
  }
  if (!walls.complete) faintText("more methods are being made ...");
}

}  // namespace

void inspectorOverlay(const InspectModel& model, const FrameInfo& frame, const Projection& projection,
                      const Rect& area) {
  const Sight sight(projection, area);
  ImDrawList* draw = ImGui::GetBackgroundDrawList();
  draw->PushClipRect({static_cast<float>(area.x), static_cast<float>(area.y)},
                     {static_cast<float>(area.x + area.width), static_cast<float>(area.y + area.height)});
  if (model.picked) drawPicked(draw, sight, model, frame);
  if (model.hovered) ring(draw, sight, model.hovered->position, 0.5F * frame.spacing, kHovered, 2);
  draw->PopClipRect();
  if (!model.hovered) return;
  const PickedParticle& hovered = *model.hovered;
  ImGui::BeginTooltip();
  ImGui::Text("particle %u   ρ/ρ₀ %.3f   γ %.3f", hovered.id, static_cast<double>(hovered.density),
              static_cast<double>(hovered.gamma));
  ImGui::EndTooltip();
}

void inspectorCard(InspectModel& model, const FrameInfo& frame, const Vec3d& origin, const Rect& area) {
  if (!model.id) return;
  const float text = ImGui::GetFontSize(), margin = std::round(0.6F * text);
  ImGui::SetNextWindowPos(
      {static_cast<float>(area.x + area.width) - margin, static_cast<float>(area.y) + margin},
      ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowSize({std::round(kCardWidth * text), 0});
  ImGui::SetNextWindowBgAlpha(0.92F);
  ImGui::Begin("Particle", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::AlignTextToFramePadding();
  ImGui::Text("Particle %u", *model.id);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 4 * text);
  if (ImGui::Button("Close", {4 * text, 0})) model.id.reset();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Escape closes it, too");
  if (model.picked) {
    const PickedParticle& picked = *model.picked;
    const Vec3d velocity = picked.velocity.cast<double>();
    row("x, y, z (m)", threeNumbers(picked.position.cast<double>() + origin));
    row("velocity (m/s)", threeNumbers(velocity));
    row("speed (m/s)", formatNumber("%.4f", velocity.norm()));
    row("density ρ/ρ₀", formatNumber("%.5f", static_cast<double>(picked.density)));
    row("multiplier λh²", formatNumber("%.6g", static_cast<double>(picked.lambda)));
    row("γ of the step", formatNumber("%.5f", static_cast<double>(picked.gamma)));
    if (picked.pressure) row("pressure (Pa)", formatNumber("%.5g", static_cast<double>(*picked.pressure)));
    row("neighbours",
        std::to_string(picked.neighbours) + " in the step, " + std::to_string(picked.around.size()) + " now");
    ImGui::Separator();
    faintText("γ where it is now, by method, and its error");
    if (model.walls)
      methodRows(*model.walls);
    else
      faintText("being worked out ...");
    if (model.walls && frame.time != model.walls->time)
      faintText(formatNumber("as at %.3f s", model.walls->time));
  } else {
    faintText("No longer in the scene");
  }
  ImGui::End();
}

}  // namespace migiwa
