// What a control of the panels changes: in the words, units and ranges of the scene's keys, with what a
// change costs.
#include <array>
#include <map>
#include <string>

#include <imgui.h>

#include "app/ui/widgets.h"
#include "core/base/fields.h"
#include "core/scene/scene_file.h"

namespace migiwa {
namespace {

/// Of every key that a scene without objects has, by its JSON pointer.
class KeyTexts final : public FieldWriter {
 public:
  KeyTexts() { describeScene(*this, Scene()); }

  const std::string& of(std::string_view pointer) const {
    static const std::string none;
    const auto found = texts_.find(pointer);
    return found == texts_.end() ? none : found->second;
  }

  void number(std::string_view key, const double&, const Range& range, const FieldDoc& doc) override {
    add(key, doc, range.text());
  }
  void integer(std::string_view key, const int&, const Range& range, const FieldDoc& doc) override {
    add(key, doc, range.text());
  }
  void boolean(std::string_view key, const bool&, const FieldDoc& doc) override { add(key, doc); }
  void text(std::string_view key, const std::string&, const FieldDoc& doc) override { add(key, doc); }
  void vector(std::string_view key, const Vec3d&, const FieldDoc& doc) override { add(key, doc); }
  void pair(std::string_view key, const std::array<double, 2>&, const FieldDoc& doc, const bool*) override {
    add(key, doc);
  }
  void triples(std::string_view key, const std::vector<std::array<double, 3>>&,
               const FieldDoc& doc) override {
    add(key, doc);
  }
  void choice(std::string_view key, const int&, std::span<const std::string_view>,
              const FieldDoc& doc) override {
    add(key, doc);
  }
  void object(std::string_view key, const FieldDoc&, const Fields& fields, const bool* present) override {
    if (present != nullptr && !*present) return;
    const std::string outer = prefix_;
    prefix_ += "/" + std::string(key);
    fields(*this);
    prefix_ = outer;
  }
  void list(std::string_view, std::size_t, const FieldDoc&, const Element&) override {}
  void variant(std::string_view key, const int&, std::span<const std::string_view>, const FieldDoc& doc,
               const Variant&) override {
    add(key, doc);
  }

 private:
  void add(std::string_view key, const FieldDoc& doc, const std::string& range = {}) {
    std::string text(doc.description);
    const bool bare = doc.unit.empty() || doc.unit == "1";
    if (!range.empty()) text += "\nA number " + range + (bare ? "" : " " + std::string(doc.unit));
    texts_[prefix_ + "/" + std::string(key)] = std::move(text);
  }

  std::string prefix_;
  std::map<std::string, std::string, std::less<>> texts_;
};

struct KeyCost {
  std::string_view pointer, cost;
};
/// What the scene's keys do not say of themselves.
constexpr std::array<KeyCost, 9> kCosts{{
    {"/solver/min_iterations", "every step takes at least the time of so many iterations"},
    {"/solver/max_iterations", "a step takes up to the time of so many; fewer leave more density error"},
    {"/solver/tolerance", "a smaller one takes more iterations a step, up to the most there may be"},
    {"/solver/method", "see \"What if\", for another kind of step takes another time"},
    {"/solver/velocity_step", "positions takes two thirds of the time of a step"},
    {"/solver/position_step", "as many iterations as it then takes to come within the tolerance"},
    {"/solver/time_step", "half of it takes twice as many steps for a second, each with fewer iterations"},
    {"/boundary/handling", "that of γ or of particles at walls: \"Performance\" has it by stage"},
    {"/boundary/gamma/method", "nearly none for planes; for other walls \"What if\" compares them"},
}};

}  // namespace

void keyHint(std::string_view pointer) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  static const KeyTexts texts;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(26 * ImGui::GetFontSize());
  ImGui::TextUnformatted(texts.of(pointer).c_str());
  for (const KeyCost& known : kCosts)
    if (known.pointer == pointer) ImGui::TextUnformatted(("Cost: " + std::string(known.cost)).c_str());
  faintText(pointer);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace migiwa
