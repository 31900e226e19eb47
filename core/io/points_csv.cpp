#include "core/io/points_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string>
#include <string_view>

#include "core/base/fields.h"
#include "core/base/messages.h"

namespace migiwa {

namespace {

constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
/// A file of the wrong kind has a fault in every line: the first ones say it.
constexpr std::size_t kMostFaults = 20;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\"");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> result;
  while (true) {
    const auto comma = line.find(',');
    result.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return result;
    line.remove_prefix(comma + 1);
  }
}

std::string quoted(std::string_view text) {
  return text.empty() ? std::string("nothing") : "'" + std::string(text.substr(0, 40)) + "'";
}

}  // namespace

std::vector<Vec3d> readPoints(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string(), "expected a file of points, found none that can be read");
  std::string line;
  std::getline(in, line);
  const auto header = cells(line);
  std::array<std::size_t, 3> columns{};
  std::vector<Fault> faults;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto found = std::find(header.begin(), header.end(), kNames[axis]);
    columns[axis] = static_cast<std::size_t>(found - header.begin());
    if (found == header.end()) {
      faults.push_back({file.string() + ":1", "expected a header with the columns x,y,z, found no column " +
                                                  std::string(kNames[axis]) + " in " +
                                                  quoted(trimmed(line))});
    }
  }
  if (!faults.empty()) throw InputError(std::move(faults));

  std::vector<Vec3d> points;
  for (long number = 2; std::getline(in, line) && faults.size() < kMostFaults; ++number) {
    if (trimmed(line).empty()) continue;
    const auto row = cells(line);
    Vec3d point = Vec3d::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string_view text = columns[axis] < row.size() ? row[columns[axis]] : std::string_view{};
      double& value = point[static_cast<Eigen::Index>(axis)];
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
          !kCoordinateRange.contains(value)) {
        faults.push_back({file.string() + ":" + std::to_string(number),
                          "expected a number (m) " + kCoordinateRange.text() + " in column " +
                              std::string(kNames[axis]) + ", found " + quoted(text)});
      }
    }
    points.push_back(point);
  }
  if (!faults.empty()) throw InputError(std::move(faults));
  return points;
}

}  // namespace migiwa
