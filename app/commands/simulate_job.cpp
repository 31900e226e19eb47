#include "app/commands/simulate_job.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/base/error.h"
#include "core/io/output_file.h"
#include "core/io/particle_export.h"
#include "core/scene/nearest_name.h"
#include "core/scene/run_limit.h"
#include "core/simulation/settings.h"

namespace migiwa {

namespace {

constexpr double kLongestRun = 1e6;  // (s), as long as a scene's duration can be

class JobReader {
 public:
  JobReader(const SimulateOptions& options, const CommonOptions& common)
      : options_(options), common_(common) {}

  SimulateJob read() {
    std::optional<Scene> scene;
    collect([&] {
      scene = readScene(options_.scene, common_.overrides);
      requireSteppable(scene->boundary, scene->file);
    });
    seconds("--until", options_.until, Range::closed(0, kLongestRun));
    if (scene && options_.until && Range::closed(0, kLongestRun).contains(*options_.until))
      collect([&] { requireReachable(*scene, *options_.until, "--until"); });
    writable("--report", options_.report);
    readExport(scene ? scene->stem() : "");
    seconds("--save-every", options_.saveEvery, Range::positive(kLongestRun));
    needs("--save-every", options_.saveEvery.has_value(), "--save FILE", !options_.save.empty());
    writable("--save", options_.save);
    if (!faults_.empty()) throw InputError(std::move(faults_));
    return {*std::move(scene), *format_, fields_};
  }

 private:
  template <class Body>
  void collect(const Body& body) {
    try {
      body();
    } catch (const InputError& error) {
      faults_.insert(faults_.end(), error.faults().begin(), error.faults().end());
    }
  }

  void seconds(const char* option, const std::optional<double>& value, const Range& range) {
    if (!value || range.contains(*value)) return;
    std::ostringstream message;
    message << "expected a number " << range.text() << " (unit: s), found " << *value;
    faults_.push_back({option, message.str()});
  }

  void needs(const char* option, bool given, const std::string& other, bool otherGiven) {
    if (given && !otherGiven) faults_.push_back({option, "expected " + other + " with it, found none"});
  }

  void writable(const char* option, const std::string& file) {
    if (!file.empty()) collect([&] { requireWritable(file, option); });
  }

  void readExport(const std::string& stem) {
    const std::string& folder = options_.exportFolder;
    readFormat();
    readFields();
    seconds("--every", options_.every, Range::positive(kLongestRun));
    needs("--every", options_.every.has_value(), "--export DIR", !folder.empty());
    needs("--format", !options_.format.empty(), "--export DIR", !folder.empty());
    needs("--fields", !options_.fields.empty(), "--export DIR", !folder.empty());
    if (folder.empty()) return;
    needs("--export", true, "--every S", options_.every.has_value());
    std::error_code ignored;
    if (std::filesystem::is_directory(folder, ignored) && format_) {
      writable("--export", (std::filesystem::path(folder) / exportListName(stem, *format_)).string());
    } else if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored)) {
      faults_.push_back({"--export", "expected a folder, found the file " + folder});
    }
  }

  void readFormat() {
    std::vector<std::string_view> names;
    for (const ParticleFormat& format : particleFormats()) {
      names.push_back(format.name);
      if (options_.format.empty() ? names.size() == 1 : format.name == options_.format) format_ = format;
    }
    if (!format_)
      faults_.push_back(
          {"--format", "expected one of " + quotedList(names) + ", found \"" + options_.format + "\""});
  }

  void readFields() {
    if (format_ && !format_->holdsFields) {
      if (!options_.fields.empty())
        faults_.push_back({"--fields", "expected none with --format " + std::string(format_->name) +
                                           ", which holds positions only; ply and vtk hold fields"});
      return;
    }
    if (options_.fields.empty()) {
      fields_ = {"velocity", "density", "id"};
      return;
    }
    std::vector<std::string_view> names;
    for (const ParticleFieldInfo& info : particleFields()) names.push_back(info.name);
    std::istringstream words(options_.fields + ",");
    for (std::string word; std::getline(words, word, ',');) {
      if (std::find(names.begin(), names.end(), word) == names.end()) {
        faults_.push_back({"--fields", "expected some of " + quotedList(names) + ", found \"" + word + "\""});
      } else if (std::find(fields_.begin(), fields_.end(), word) != fields_.end()) {
        faults_.push_back({"--fields", "expected each field once, found \"" + word + "\" again"});
      } else {
        fields_.push_back(word);
      }
    }
  }

  const SimulateOptions& options_;
  const CommonOptions& common_;
  std::vector<Fault> faults_;
  std::optional<ParticleFormat> format_;
  std::vector<std::string> fields_;
};

}  // namespace

SimulateJob checkedSimulateJob(const SimulateOptions& options, const CommonOptions& common) {
  return JobReader(options, common).read();
}

}  // namespace migiwa
