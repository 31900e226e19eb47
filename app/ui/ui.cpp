#include "app/ui/ui.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "app/session/ui_state.h"
#include "app/ui/widgets.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

constexpr float kFontPixels = 15;
/// Width of the panels over the height of their text.
constexpr float kPanelWidth = 21.4F;

struct KeyPair {
  ImGuiKey imgui;
  Key key;
};
constexpr std::array<KeyPair, 19> kKeys{{
    {ImGuiKey_Tab, Key::tab},
    {ImGuiKey_LeftArrow, Key::left},
    {ImGuiKey_RightArrow, Key::right},
    {ImGuiKey_UpArrow, Key::up},
    {ImGuiKey_DownArrow, Key::down},
    {ImGuiKey_Home, Key::home},
    {ImGuiKey_End, Key::end},
    {ImGuiKey_Insert, Key::insert},
    {ImGuiKey_Delete, Key::remove},
    {ImGuiKey_Backspace, Key::backspace},
    {ImGuiKey_Enter, Key::enter},
    {ImGuiKey_Escape, Key::escape},
    {ImGuiKey_Space, Key::space},
    {ImGuiKey_A, Key::a},
    {ImGuiKey_C, Key::c},
    {ImGuiKey_V, Key::v},
    {ImGuiKey_X, Key::x},
    {ImGuiKey_Y, Key::y},
    {ImGuiKey_Z, Key::z},
}};

#if IMGUI_VERSION_NUM >= 18900

/// Newer versions of Dear ImGui are told keys and buttons as events and no longer read the arrays of older
/// ones.
void prepareInput(ImGuiIO& io) {
  // Every frame has all of its input, as it has with arrays.
  io.ConfigInputTrickleEventQueue = false;
}

void feedButtons(ImGuiIO& io, const InputState& input) {
  if (input.mouseInside)
    io.AddMousePosEvent(input.mouseX, input.mouseY);
  else
    io.AddMousePosEvent(-FLT_MAX, -FLT_MAX);
  for (std::size_t i = 0; i < kMouseButtonCount; ++i)
    io.AddMouseButtonEvent(static_cast<int>(i), input.buttons[i]);
  io.AddMouseWheelEvent(0, input.wheel);
  io.AddKeyEvent(ImGuiMod_Ctrl, input.control);
  io.AddKeyEvent(ImGuiMod_Shift, input.shift);
  io.AddKeyEvent(ImGuiMod_Alt, input.alt);
  for (const KeyPair& pair : kKeys)
    io.AddKeyEvent(pair.imgui, input.keys[static_cast<std::size_t>(pair.key)]);
}

#else

void prepareInput(ImGuiIO& io) {
  for (const KeyPair& pair : kKeys) io.KeyMap[pair.imgui] = static_cast<int>(pair.key);
}

void feedButtons(ImGuiIO& io, const InputState& input) {
  io.MousePos = input.mouseInside ? ImVec2(input.mouseX, input.mouseY) : ImVec2(-FLT_MAX, -FLT_MAX);
  for (std::size_t i = 0; i < kMouseButtonCount; ++i) io.MouseDown[i] = input.buttons[i];
  io.MouseWheel = input.wheel;
  io.KeyCtrl = input.control;
  io.KeyShift = input.shift;
  io.KeyAlt = input.alt;
  for (std::size_t i = 0; i < kKeyCount; ++i) io.KeysDown[i] = input.keys[i];
}

#endif

void feed(ImGuiIO& io, const InputState& input) {
  io.DeltaTime = static_cast<float>(input.seconds);
  feedButtons(io, input);
  for (const unsigned c : input.characters) io.AddInputCharacter(c);
}

/// A heading that folds; open at first where the picture is high enough for what comes with it.
template <class Panel>
void section(const char* title, bool open, ImFont* bold, PanelModel& model, const Panel& panel) {
  ImGui::PushFont(bold);
  const bool shown = ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  ImGui::PopFont();
  if (!shown) return;
  // Widgets of two panels may have one name.
  ImGui::PushID(title);
  markPanel(title, true);
  panel(model);
  markPanel(title, false);
  ImGui::PopID();
}

}  // namespace

struct Ui::State {
  ImGuiContext* context = ImGui::CreateContext();
  Fonts fonts;
  float pixels = kFontPixels;
  Theme theme = Theme::dark;
  Clipboard clipboard;
  std::string pasted;  ///< ImGui keeps a pointer to it

  State() { ImGui::SetCurrentContext(context); }
  ~State() { ImGui::DestroyContext(context); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

Ui::Ui(double scale, Clipboard clipboard) : state_(std::make_unique<State>()) {
  state_->pixels = std::floor(kFontPixels * static_cast<float>(scale) + 0.25F);
  state_->fonts = loadFonts(state_->pixels);
  applyTheme(state_->pixels, state_->theme);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  prepareInput(io);
  if (clipboard.set && clipboard.get) {
    state_->clipboard = std::move(clipboard);
    io.ClipboardUserData = state_.get();
    io.SetClipboardTextFn = [](void* state, const char* text) {
      static_cast<State*>(state)->clipboard.set(text);
    };
    io.GetClipboardTextFn = [](void* state) {
      auto& own = *static_cast<State*>(state);
      own.pasted = own.clipboard.get();
      return own.pasted.c_str();
    };
  }
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Ui::~Ui() {
  ImGui::SetCurrentContext(state_->context);
  ImGui_ImplOpenGL3_Shutdown();
}

Rect Ui::sceneArea(int width, int height, bool panels, std::size_t branches) const {
  if (!panels) return {0, 0, width, height};
  const int taken = std::min(static_cast<int>(kPanelWidth * state_->pixels), width / 2);
  const int line = branches > 0 ? std::min(timeLineHeight(branches, state_->pixels), height / 2) : 0;
  return {taken, 0, width - taken, height - line};
}

void Ui::timeLine(PanelModel& model, const Rect& area) const {
  const float top = static_cast<float>(area.y + area.height);
  timeLineStrip(model, {static_cast<float>(area.x), top},
                {static_cast<float>(area.width), ImGui::GetIO().DisplaySize.y - top});
}

void Ui::setTheme(Theme theme) {
  if (theme == state_->theme) return;
  ImGui::SetCurrentContext(state_->context);
  state_->theme = theme;
  applyTheme(state_->pixels, theme);
}

void Ui::begin(int width, int height, const InputState& input) {
  ImGui::SetCurrentContext(state_->context);
  ImGui_ImplOpenGL3_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  feed(io, input);
  ImGui::NewFrame();
  forgetRows();
}

void Ui::panels(PanelModel& model, int height) {
  const Rect scene = sceneArea(static_cast<int>(ImGui::GetIO().DisplaySize.x), height, true);
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({static_cast<float>(scene.x), static_cast<float>(height)});
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration & ~ImGuiWindowFlags_NoScrollbar;
  // Where the window is too narrow for them, panels are pushed aside and not cut off.
  const float wanted = std::floor(kPanelWidth * state_->pixels);
  const bool narrow = static_cast<float>(scene.x) < wanted;
  if (narrow)
    ImGui::SetNextWindowContentSize(
        {wanted - 2 * ImGui::GetStyle().WindowPadding.x - ImGui::GetStyle().ScrollbarSize, 0});
  ImGui::Begin("Panels", nullptr,
               kFixed | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   (narrow ? ImGuiWindowFlags_HorizontalScrollbar : 0));
  const float lines = static_cast<float>(height) / state_->pixels;
  ImFont* bold = state_->fonts.bold;
  if (model.editor != nullptr) section("Scene", true, bold, model, scenePanel);
  section("Simulation", true, bold, model, simulationPanel);
  section("Boundary", true, bold, model, boundaryPanel);
  section("Solver", lines > 26, bold, model, solverPanel);
  for (NamedEffect& effect : model.settings.effects) {
    section(titleOf(effect.name).c_str(), lines > 40, bold, model,
            [&](PanelModel& whole) { effectPanel(whole, effect); });
  }
  section("View", lines > 33, bold, model, viewPanel);
  if (model.section != nullptr) section("Section", lines > 52, bold, model, sectionPanel);
  if (model.selection != nullptr) section("Particles", lines > 72, bold, model, selectionPanel);
  section("Changes", lines > 56, bold, model, changesPanel);
  section("Energy", lines > 58, bold, model, energyPanel);
  if (!model.run.line.branches.empty()) section("Plots", lines > 88, bold, model, plotsPanel);
  if (!model.frame.gauges.empty()) section("Gauges", true, bold, model, gaugesPanel);
  section("Performance", lines > 46, bold, model, performancePanel);
  if (model.whatIf != nullptr) section("What if", lines > 60, bold, model, whatIfPanel);
  ImGui::End();
}

void Ui::inspector(InspectModel& model, const FrameInfo& frame, const Vec3d& origin,
                   const Projection& projection, const Rect& area) const {
  inspectorOverlay(model, frame, projection, area);
  inspectorCard(model, frame, origin, area);
}

void Ui::selection(const SelectionModel& model, const FrameView& frame, const Projection& projection,
                   const Rect& area) const {
  selectionOverlay(model, frame, projection, area);
}

void Ui::sectionPointer(const SectionModel& model, const ColorFieldInfo& info, const Vec3d& origin) const {
  migiwa::sectionPointer(model, info, origin);
}

void Ui::sceneEditor(SceneEditor& editor, const Rect& area) const {
  sceneEditorWindow(editor, area, state_->fonts);
}

void Ui::gallery(GalleryModel& gallery, const Rect& area) const {
  galleryWindow(gallery, area, state_->fonts);
}

void Ui::command(CommandModel& model, const Rect& area) const {
  commandWindow(model, area, state_->fonts);
}

void Ui::bindings(bool& open, const Rect& area) const {
  bindingsWindow(open, area);
}

void Ui::caption(const Caption& caption, const Rect& area) const {
  drawCaption(caption, area, state_->fonts);
}

void Ui::legend(const ColorFieldInfo& field, const std::array<double, 2>& range, const ColorMap& colors,
                const Rect& area) const {
  drawLegend(field, range, colors, area, state_->fonts);
}

int Ui::legendHeight() const {
  return migiwa::legendHeight(state_->fonts);
}

void Ui::end(bool draw) {
  ImGui::Render();
  if (draw) ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Ui::busy() const {
  return ImGui::IsAnyItemActive();
}

bool Ui::wantsMouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}

bool Ui::wantsKeyboard() const {
  return ImGui::GetIO().WantCaptureKeyboard;
}

namespace {

ImFont* load(const char* name, float pixels) {
  // ImGui keeps a pointer to the ranges until the atlas is built.
  static constexpr ImWchar kRanges[] = {0x20,   0xFF,    // Latin
                                        0x370,  0x3FF,   // Greek
                                        0x2010, 0x2027,  // dashes, ellipsis
                                        0x2070, 0x209F,  // superscripts and subscripts
                                        0x2200, 0x22FF,  // mathematical signs
                                        0};
  const std::filesystem::path file = std::filesystem::path("/usr/share/fonts/truetype/dejavu") / name;
  if (!std::filesystem::exists(file)) {
    throw MissingError("no font at " + file.string() + "; on Debian: apt-get install fonts-dejavu-core");
  }
  ImFontConfig config;
  config.OversampleH = 2;
  config.PixelSnapH = true;
  return ImGui::GetIO().Fonts->AddFontFromFileTTF(file.c_str(), pixels, &config, kRanges);
}

struct ThemeColor {
  ImGuiCol which;
  ImVec4 dark, light;
};
const ThemeColor kThemeColors[]{
    {ImGuiCol_Text, {0.90F, 0.92F, 0.94F, 1}, {0.10F, 0.13F, 0.17F, 1}},
    {ImGuiCol_TextDisabled, {0.52F, 0.57F, 0.63F, 1}, {0.36F, 0.41F, 0.47F, 1}},
    {ImGuiCol_WindowBg, {0.115F, 0.135F, 0.165F, 1}, {0.945F, 0.952F, 0.960F, 1}},
    {ImGuiCol_PopupBg, {0.090F, 0.108F, 0.135F, 0.98F}, {0.985F, 0.988F, 0.992F, 0.98F}},
    {ImGuiCol_Border, {1, 1, 1, 0.10F}, {0, 0, 0, 0.18F}},
    {ImGuiCol_FrameBg, {0.200F, 0.230F, 0.275F, 1}, {0.855F, 0.875F, 0.895F, 1}},
    {ImGuiCol_FrameBgHovered, {0.245F, 0.285F, 0.340F, 1}, {0.800F, 0.830F, 0.860F, 1}},
    {ImGuiCol_FrameBgActive, {0.275F, 0.325F, 0.390F, 1}, {0.745F, 0.785F, 0.825F, 1}},
    {ImGuiCol_ScrollbarBg, {0, 0, 0, 0.20F}, {0, 0, 0, 0.06F}},
    {ImGuiCol_ScrollbarGrab, {1, 1, 1, 0.18F}, {0, 0, 0, 0.22F}},
    {ImGuiCol_ScrollbarGrabHovered, {1, 1, 1, 0.28F}, {0, 0, 0, 0.32F}},
    {ImGuiCol_ScrollbarGrabActive, {1, 1, 1, 0.38F}, {0, 0, 0, 0.42F}},
    {ImGuiCol_CheckMark, {0.33F, 0.82F, 0.76F, 1}, {0.02F, 0.47F, 0.43F, 1}},
    {ImGuiCol_SliderGrab, {0.25F, 0.62F, 0.60F, 0.65F}, {0.20F, 0.62F, 0.59F, 0.65F}},
    {ImGuiCol_SliderGrabActive, {0.33F, 0.78F, 0.74F, 0.75F}, {0.10F, 0.52F, 0.49F, 0.75F}},
    {ImGuiCol_Button, {0.165F, 0.375F, 0.400F, 1}, {0.690F, 0.850F, 0.845F, 1}},
    {ImGuiCol_ButtonHovered, {0.200F, 0.465F, 0.490F, 1}, {0.600F, 0.795F, 0.790F, 1}},
    {ImGuiCol_ButtonActive, {0.235F, 0.560F, 0.580F, 1}, {0.510F, 0.735F, 0.730F, 1}},
    {ImGuiCol_Header, {0.155F, 0.185F, 0.225F, 1}, {0.835F, 0.862F, 0.890F, 1}},
    {ImGuiCol_HeaderHovered, {0.205F, 0.245F, 0.300F, 1}, {0.775F, 0.815F, 0.855F, 1}},
    {ImGuiCol_HeaderActive, {0.235F, 0.285F, 0.350F, 1}, {0.720F, 0.770F, 0.820F, 1}},
    {ImGuiCol_Separator, {1, 1, 1, 0.10F}, {0, 0, 0, 0.15F}},
    {ImGuiCol_NavHighlight, {0.33F, 0.82F, 0.76F, 1}, {0.02F, 0.47F, 0.43F, 1}},
    {ImGuiCol_PlotLinesHovered, {1, 0.561F, 0.451F, 1}, {0.70F, 0.19F, 0.06F, 1}},
    {ImGuiCol_PlotLines, {0.278F, 0.722F, 0.675F, 1}, {0, 0.47F, 0.43F, 1}},
    {ImGuiCol_PlotHistogram, {0.914F, 0.769F, 0.416F, 1}, {0.60F, 0.38F, 0, 1}},
    {ImGuiCol_TableRowBgAlt, {0.067F, 0.086F, 0.114F, 1}, {1, 1, 1, 1}},
    {ImGuiCol_TableBorderLight, {1, 1, 1, 0.11F}, {0, 0, 0, 0.12F}},
};

}  // namespace

Fonts loadFonts(float pixels) {
  return {load("DejaVuSans.ttf", pixels), load("DejaVuSans-Bold.ttf", pixels),
          load("DejaVuSansMono.ttf", pixels)};
}

void applyTheme(float pixels, Theme theme) {
  const auto part = [pixels](float share) { return std::round(share * pixels); };
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  style.WindowPadding = {part(0.75F), part(0.5F)};
  style.FramePadding = {part(0.4F), part(0.16F)};
  style.ItemSpacing = {part(0.4F), part(0.27F)};
  style.ItemInnerSpacing = {part(0.35F), part(0.25F)};
  style.ScrollbarSize = part(0.7F);
  style.GrabMinSize = part(0.6F);
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.PopupRounding = 4;
  style.ScrollbarRounding = 4;
  style.AntiAliasedLinesUseTex = false;

  for (const ThemeColor& color : kThemeColors)
    style.Colors[color.which] = theme == Theme::dark ? color.dark : color.light;
}

}  // namespace migiwa
