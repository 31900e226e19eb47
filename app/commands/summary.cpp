// `migiwa summary REPORT...`: reports side by side.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "app/commands/command.h"
#include "app/commands/report_table.h"
#include "core/base/error.h"

namespace migiwa {

namespace {

/// File stems, or the whole paths where two stems are the same.
std::vector<std::string> labelsFor(const std::vector<std::string>& files) {
  std::vector<std::string> labels;
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
  return {"summary", "Compares reports of runs in a table.", [](CLI::App& parser) {
            const auto files = std::make_shared<std::vector<std::string>>();
            parser.add_option("reports", *files, "Files that simulate --report has written.")
                ->required()
                ->type_name("REPORT");
            return [files](const CommonOptions&) { return summarise(*files); };
          }};
}

}  // namespace migiwa
