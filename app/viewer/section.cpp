// The section in the picture: its field in colours, with lines of equal values, and what is under the mouse.
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "app/viewer/viewer.h"
#include "core/base/messages.h"

namespace migiwa {
namespace {

/// Lines of equal values over the range, about so many.
constexpr int kLevels = 12;
constexpr double kLineCells = 0.3;  ///< half the width of such a line
constexpr Rgb8 kLineColor{20, 28, 40};

/// How much of a line is at a cell, in [0, 1]: by the way to the nearest level over how fast the field
/// changes.
double lineAt(const SectionRaster& raster, int column, int row, const std::vector<double>& levels) {
  const double here = static_cast<double>(raster.value(column, row));
  const double gradient = raster.steepness(column, row);
  if (levels.size() < 2 || gradient * kFlattestLines <= levels[1] - levels[0]) return 0;
  const auto above = std::lower_bound(levels.begin(), levels.end(), here);
  double away = std::numeric_limits<double>::infinity();
  if (above != levels.end()) away = *above - here;
  if (above != levels.begin()) away = std::min(away, here - *(above - 1));
  return std::clamp(kLineCells + 0.5 - away / gradient, 0.0, 1.0);
}

std::shared_ptr<const Sheet> sheetOf(const SectionRaster& raster, const std::array<double, 2>& range,
                                     const ColorMap& colors, bool lines) {
  const SectionPlane& plane = raster.plane;
  auto sheet = std::make_shared<Sheet>();
  sheet->corner = plane.corner;
  sheet->across = plane.cell * plane.columns * plane.across;
  sheet->up = plane.cell * plane.rows * plane.up;
  sheet->picture = Image(plane.columns, plane.rows);
  const std::vector<double> levels = roundTicks(range[0], range[1], kLevels).values;
  std::size_t k = 0;
  for (int row = 0; row < plane.rows; ++row) {
    for (int column = 0; column < plane.columns; ++column, ++k) {
      if (std::isnan(raster.values[k])) continue;
      const double share = (static_cast<double>(raster.values[k]) - range[0]) / (range[1] - range[0]);
      const auto entry =
          static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * (kColorMapSize - 1)));
      const double line = lines ? 0.8 * lineAt(raster, column, row, levels) : 0;
      std::uint8_t* const pixel = sheet->picture.pixel(column, plane.rows - 1 - row);
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(std::lround(
            std::lerp(static_cast<double>(colors[entry][c]), static_cast<double>(kLineColor[c]), line)));
      pixel[3] = 255;
    }
  }
  return sheet;
}

/// What has the section under it, of all that is drawn at a pixel, within so much (m).
bool isOnPlane(const SectionPlane& plane, const Vec3d& p, double within) {
  return std::abs(plane.normal().dot(p - plane.corner)) < within;
}

}  // namespace

ColorFieldInfo Viewer::sectionInfo() const {
  const SectionView& of = options_.section->of;
  ColorFieldInfo info = sectionFieldInfo(of.field, referenceSpeed_, scene_.solver.restDensity);
  if (isInterpolated(of.field) && of.divisor != SectionDivisor::sum) {
    info.low = std::min(info.low, 0.0);
    info.label += of.divisor == SectionDivisor::gamma ? ", over γ" : ", not divided";
  }
  if (view_.section.fit && options_.section->raster) {
    if (const auto range = options_.section->raster->range()) {
      info.low = static_cast<double>((*range)[0]);
      // Of a constant the colours are those about it.
      info.high = std::max(static_cast<double>((*range)[1]), info.low + 1e-6 * (1 + std::abs(info.low)));
    }
  }
  return info;
}

/// Takes over the newest raster, moves the plane with the wheel, and finds what the mouse points at.
void Viewer::moveSection(const InputState& input, const Rect& area) {
  if (options_.section == nullptr) return;
  SectionModel& model = *options_.section;
  SectionView& view = view_.section;
  const bool free = contains(area, input) && !ui_.wantsMouse();
  if (free && input.wheel != 0 && wheelMovesSection(input))
    view.at += 0.5 * scene_.particleSpacing * static_cast<double>(input.wheel);
  model.pointed.reset();
  if (!view.shown || !model.raster) {
    sheet_.reset();
    sheetRaster_.reset();
    return;
  }
  const ColorFieldInfo info = sectionInfo();
  const std::array<double, 2> range{info.low, info.high};
  if (model.raster != sheetRaster_ || range != sheetRange_ || view.lines != sheetLines_) {
    sheet_ = sheetOf(*model.raster, range, options_.colors, view.lines);
    sheetRaster_ = model.raster, sheetRange_ = range, sheetLines_ = view.lines;
  }
  if (!free || !mouseUsed_) return;
  const auto point = pointAt(static_cast<int>(input.mouseX), static_cast<int>(input.mouseY), area);
  // Depths are those of a float.
  const double within = 1e-3 * (view_.camera.eye - view_.camera.target).norm();
  if (point && isOnPlane(model.raster->plane, *point, within)) model.pointed = point;
}

/// The cut that lets the section be seen: half a spacing behind it, so that no particle that it cuts through
/// comes out of it.
std::optional<CutPlane> Viewer::sectionCut() const {
  const SectionView& view = view_.section;
  if (options_.section == nullptr || !view.shown || !view.cut) return std::nullopt;
  CutPlane cut{view.direction(), view.at};
  if (cut.normal.dot(view_.camera.eye) < cut.at) cut = {-cut.normal, -cut.at};
  cut.at -= 0.5 * scene_.particleSpacing;
  return cut;
}

}  // namespace migiwa
