// The panel of an effect, made from what the effect says of its parameters. Effects are shared and never
// change: a moved slider puts a changed copy in the place of the old one.
#include "app/ui/panels.h"
#include "app/ui/widgets.h"

namespace migiwa {
namespace {

/// A row for each field that a slider, a checkbox or a list can show.
class FieldRows final : public FieldVisitor {
 public:
  bool changed = false;

  void number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) override {
    row(key);
    // Six digits below a wide range's end are as far as a logarithmic slider goes; it ends at zero.
    const bool wide = range.max > 10;
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat |
                                   (wide ? ImGuiSliderFlags_Logarithmic : 0);
    // An open end itself is not allowed.
    const double gap = 1e-3 * (range.max - range.min);
    const double low = range.min + (range.openMin ? gap : 0), high = range.max - (range.openMax ? gap : 0);
    const std::string unit = doc.unit == "1" ? "" : " " + std::string(doc.unit);
    if (ImGui::SliderScalar(id(key).c_str(), ImGuiDataType_Double, &value, &low, &high,
                            ((wide ? "%.6g" : "%.3g") + unit).c_str(), flags))
      changed = true;
    hint(doc);
  }
  void integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) override {
    row(key);
    if (ImGui::SliderInt(id(key).c_str(), &value, static_cast<int>(range.min), static_cast<int>(range.max),
                         "%d", ImGuiSliderFlags_AlwaysClamp))
      changed = true;
    hint(doc);
  }
  void boolean(std::string_view key, bool& value, const FieldDoc& doc) override {
    row(key);
    if (ImGui::Checkbox(id(key).c_str(), &value)) changed = true;
    hint(doc);
  }
  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override {
    row(key);
    if (migiwa::choice(id(key).c_str(), index, names)) changed = true;
    hint(doc);
  }

  // What no effect has among its parameters.
  void text(std::string_view, std::string&, const FieldDoc&) override {}
  void vector(std::string_view, Vec3d&, const FieldDoc&) override {}
  void pair(std::string_view, std::array<double, 2>&, const FieldDoc&, bool*) override {}
  void triples(std::string_view, std::vector<std::array<double, 3>>&, const FieldDoc&) override {}
  void object(std::string_view, const FieldDoc&, const Fields&, bool*) override {}
  void list(std::string_view, std::size_t, const FieldDoc&,
            const std::function<void(FieldVisitor&, std::size_t)>&) override {}
  void variant(std::string_view, int&, std::span<const std::string_view>, const FieldDoc&,
               const std::function<void(FieldVisitor&, int)>&) override {}
  void fault(std::string_view, std::string_view) override {}

 private:
  static std::string id(std::string_view key) { return "##" + std::string(key); }
  static void row(std::string_view key) { rowLabel(titleOf(key).c_str()); }
  static void hint(const FieldDoc& doc) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(doc.description).c_str());
  }
};

}  // namespace

void effectPanel(PanelModel& model, NamedEffect& effect) {
  ImGui::PushID(effect.name.c_str());
  FieldRows rows;
  std::unique_ptr<Effect> copy = effect.effect->clone();
  copy->describe(rows);
  if (rows.changed) {
    effect.effect = std::move(copy);
    model.wishes.settings = true;
  }
  ImGui::PopID();
}

}  // namespace migiwa
