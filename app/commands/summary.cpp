// `migiwa summary REPORT...`: reports side by side.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>

#include "app/commands/command.h"
#include "core/base/messages.h"

namespace migiwa {

namespace {

/// File stems, or the whole paths where two stems are the same.
std::vector<std::string> labelsFor(const std::vector<std::string>& files) {
  std::vector<std::string> labels;
  labels.reserve(files.size());
  for (const std::string& file : files) labels.push_back(std::filesystem::path(file).stem().string());
  auto sorted = labels;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? labels : files;
}

int summarise(const std::vector<std::string>& files) {
  std::vector<Fault> faults;
  std::vector<Report> reports;
  for (const std::string& file : files) {
    try {
      reports.push_back(readReport(file));
    } catch (const InputError& error) {
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw InputError(std::move(faults));
  std::cout << reportTable(reports, labelsFor(files));
  return kDone;
}

}  // namespace

Command summaryCommand() {
  return {"summary", "Compares reports of runs in a table.", [] {
            const auto files = std::make_shared<std::vector<std::string>>();
            return Declaration{{{.name = "reports",
                                 .target = files.get(),
                                 .value = "REPORT",
                                 .help = "Files that simulate --report has written.",
                                 .required = true}},
                               [files](const CommonOptions&) { return summarise(*files); }};
          }};
}

namespace {

struct Row {
  std::string measure;
  std::string unit;
  std::function<std::string(const Report&)> cell;
};

std::string number(const Measure& value, const char* format, double factor = 1) {
  if (!value) return "-";
  char text[64];
  std::snprintf(text, sizeof text, format, factor * *value);
  return text;
}

Measure ratio(const Measure& value, const Measure& over) {
  return value && over && *over != 0 ? Measure(*value / *over) : std::nullopt;
}

std::string walls(const Report& report) {
  if (report.gammaMethod.empty()) return report.handling.empty() ? "-" : report.handling;
  return report.handling + " (" + report.gammaMethod + ")";
}

std::vector<Row> rows() {
  return {
      {"correction at walls", "", walls},
      {"particles", "", [](const Report& r) { return number(r.particles, "%.0f"); }},
      {"simulated time", "s", [](const Report& r) { return number(r.simulatedSeconds, "%.3f"); }},
      {"settled height", "m", [](const Report& r) { return number(r.settled.height, "%.4f"); }},
      {"expected height", "m", [](const Report& r) { return number(r.settled.expectedHeight, "%.4f"); }},
      {"settled over expected height", "%",
       [](const Report& r) {
         return number(ratio(r.settled.height, r.settled.expectedHeight), "%.1f", 100);
       }},
      {"edge crowding", "", [](const Report& r) { return number(r.settled.edgeCrowding, "%.2f"); }},
      {"spacing near walls, 1st percentile", "",
       [](const Report& r) { return number(r.settled.nearWallSpacingP1, "%.3f"); }},
      {"spacing elsewhere, 1st percentile", "",
       [](const Report& r) { return number(r.settled.bulkSpacingP1, "%.3f"); }},
      {"rms speed", "m/s", [](const Report& r) { return number(r.settled.rmsSpeed, "%.4f"); }},
      {"density error, mean", "%", [](const Report& r) { return number(r.densityErrorMean, "%.2f", 100); }},
      {"density error, largest", "%", [](const Report& r) { return number(r.densityErrorMax, "%.1f", 100); }},
      {"iterations a step, mean", "", [](const Report& r) { return number(r.iterationsMean, "%.2f"); }},
      {"time a step, median", "ms", [](const Report& r) { return number(r.stepMedian, "%.2f"); }},
      {"wall time", "s", [](const Report& r) { return number(r.wallSeconds, "%.1f"); }},
      {"left the scene", "", [](const Report& r) { return number(r.leftParticles, "%.0f"); }},
      {"drained", "", [](const Report& r) { return number(r.drainedParticles, "%.0f"); }},
      {"lost particles", "", [](const Report& r) { return number(r.lostParticles, "%.0f"); }},
  };
}

}  // namespace

std::string reportTable(const std::vector<Report>& reports, const std::vector<std::string>& labels) {
  std::vector<std::vector<std::string>> lines;
  if (!labels.empty()) {
    lines.push_back({"", ""});
    lines.back().insert(lines.back().end(), labels.begin(), labels.end());
  }
  for (const Row& row : rows()) {
    lines.push_back({row.measure, row.unit});
    for (const Report& report : reports) lines.back().push_back(row.cell(report));
  }

  std::vector<std::size_t> widths(reports.size() + 2);
  for (const auto& line : lines)
    for (std::size_t k = 0; k < widths.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
  std::string text;
  for (const auto& line : lines) {
    // Words to the left, numbers to the right.
    for (std::size_t k = 0; k < widths.size(); ++k) {
      const std::string gap(widths[k] - line[k].size(), ' ');
      text += (k == 0 ? "" : "  ") + (k < 2 ? line[k] + gap : gap + line[k]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace migiwa
