#include "tests/structure/source_rules.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

namespace migiwa::structure {

namespace {

/// A part of the program: a folder with everything under it, or a single file; the longest name that fits
/// counts.
struct Room {
  std::string_view name;
  int rank;
};

// A room may include rooms of a lower or the same rank.
constexpr Room kRooms[] = {
    {"core/base", 0},
    {"core/sph", 1},
    {"core/slim", 1},
    {"core/walls", 2},
    {"core/gamma", 3},
    {"core/surface", 4},
    {"core/solver", 4},
    {"core/effects", 5},
    {"core/scene", 6},
    {"core/simulation", 7},
    {"core/io", 8},
    {"core/study", 9},
    {"include", 10},
    {"app/platform", 10},
    {"app/session", 10},
    {"app/raytrace", 10},
    {"app/render", 11},
    {"app/ui", 12},
    {"app/viewer", 13},
    {"app/commands", 14},
    {"app/command_line.h", 15},
    {"app/command_line.cpp", 15},
    {"app/main.cpp", 16},
    {"cmake", 17},
    {"python", 17},
    {"examples", 17},
    {"tests", 17},
};

/// Files under `from` may not include what begins with one of `targets`, unless it begins with one of
/// `except`.
struct Border {
  std::string_view from;
  std::vector<std::string_view> targets;
  std::vector<std::string_view> except;
  std::string_view reason;
};

const Border kBorders[] = {
    {"app/render/",
     {"core/"},
     {"core/base/", "core/scene/scene.h", "core/simulation/frame_view.h", "core/walls/surface.h"},
     "the renderer sees a scene's view and a frame view, never the solver"},
    {"app/platform/", {"core/"}, {"core/base/"}, "a context knows nothing of fluids"},
    {"app/ui/",
     {"core/solver/"},
     {"core/solver/parameters.h"},
     "panels change parameters, never the solver's state"},
};

/// Includes that begin with `header` may appear only under `places`; in at most `files` files of a place if
/// that is not 0.
struct Place {
  std::string_view prefix;
  std::size_t files = 0;
};
struct Library {
  std::string_view header;
  std::vector<Place> places;
  std::string_view reason;
};

const Library kLibraries[] = {
    {"nlohmann/",
     {{"core/scene/"}, {"core/io/"}, {"core/slim/", 1}, {"core/study/"}, {"app/commands/"}, {"tests/"}},
     "JSON is read and written at the rim"},
    {"CLI/", {{"app/command_line.cpp"}}, "one file reads the command line"},
    {"assimp/",
     {{"core/slim/", 1}, {"tests/io/", 1}},
     "one file reads meshes, and one test reads what we wrote"},
    {"glad/",
     {{"app/render/"}, {"app/platform/"}, {"app/ui/", 1}, {"tests/render/"}},
     "OpenGL stays in the renderer"},
    {"embree", {{"app/raytrace/", 1}}, "one file traces rays through triangles"},
    {"GL/", {}, "OpenGL comes from the generated loader"},
    {"GLFW/", {{"app/platform/", 1}}, "GLFW has one context file"},
    {"EGL/", {{"app/platform/", 1}}, "EGL has one context file"},
    {"imgui", {{"app/ui/"}, {"tests/render/"}}, "panels live in app/ui"},
    {"pybind11/", {{"python/"}}, "Python is bound in a room of its own"},
    {"stb", {{"app/render/"}, {"tests/render/"}}, "pictures are read and written in the renderer"},
    {"random",
     {{"app/"}, {"tests/"}},
     "the standard's distributions differ between libraries; the physics has its own"},
    {"chrono",
     {{"core/base/parallel.h"}, {"core/simulation/"}, {"app/"}, {"python/"}, {"tests/"}},
     "no clock in the physics"},
};

constexpr std::size_t kMostLines = 500, kLeastMedianLines = 120, kLeastReaders = 2;

bool beginsWithOneOf(std::string_view text, const std::vector<std::string_view>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return text.starts_with(prefix); });
}

struct Include {
  std::string name;
  bool quoted;
  std::size_t line;
};

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool isCode(const SourceFile& file) {
  return file.path.ends_with(".h") || file.path.ends_with(".cpp");
}

std::vector<Include> includesOf(const SourceFile& file) {
  static const std::regex pattern(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  std::vector<Include> includes;
  if (!isCode(file)) return includes;
  const std::vector<std::string> lines = linesOf(file.text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::smatch match;
    if (std::regex_search(lines[i], match, pattern)) includes.push_back({match[2], match[1] == "\"", i + 1});
  }
  return includes;
}

std::string at(const SourceFile& file, std::size_t line) {
  return file.path + ":" + std::to_string(line);
}

const Room* roomOf(std::string_view path) {
  const Room* found = nullptr;
  for (const Room& room : kRooms) {
    const bool inside = path == room.name || path.starts_with(std::string(room.name) + "/");
    if (inside && (!found || room.name.size() > found->name.size())) found = &room;
  }
  return found;
}

/// Follows `edges` (from, to, and an include that makes it) depth first, and reports the first way back it
/// meets.
class CycleFinder {
 public:
  using Edges = std::map<std::string_view, std::map<std::string_view, std::string>>;
  explicit CycleFinder(const Edges& edges) : edges_(edges) {}

  std::optional<std::string> find() {
    for (const auto& [room, targets] : edges_)
      if (auto cycle = visit(room)) return cycle;
    return std::nullopt;
  }

 private:
  std::optional<std::string> visit(std::string_view room) {
    if (done_.contains(room)) return std::nullopt;
    if (const auto start = std::find(path_.begin(), path_.end(), room); start != path_.end()) {
      std::string text = "parts include each other in a circle:";
      for (auto step = start; step != path_.end(); ++step) {
        const std::string_view next = step + 1 == path_.end() ? room : *(step + 1);
        text += "\n  " + edges_.at(*step).at(next);
      }
      return text;
    }
    path_.push_back(room);
    if (const auto targets = edges_.find(room); targets != edges_.end())
      for (const auto& [target, example] : targets->second)
        if (auto cycle = visit(target)) return cycle;
    path_.pop_back();
    done_.insert(room);
    return std::nullopt;
  }

  const Edges& edges_;
  std::vector<std::string_view> path_;
  std::set<std::string_view> done_;
};

}  // namespace

Violations checkLayers(const std::vector<SourceFile>& files) {
  Violations violations;
  CycleFinder::Edges edges;
  for (const SourceFile& file : files) {
    if (!isCode(file)) continue;
    const Room* from = roomOf(file.path);
    if (!from) {
      violations.push_back(file.path +
                           ": lies in no known part of the program (tests/structure/source_rules.cpp)");
      continue;
    }
    for (const Include& include : includesOf(file)) {
      const Room* to = include.quoted ? roomOf(include.name) : nullptr;
      if (!to || to == from) continue;
      const std::string edge = at(file, include.line) + " includes " + include.name;
      if (to->rank > from->rank)
        violations.push_back(edge + ": " + std::string(from->name) + " lies below " + std::string(to->name));
      else
        edges[from->name].emplace(to->name, edge);
    }
  }
  if (auto cycle = CycleFinder(edges).find()) violations.push_back(*cycle);
  return violations;
}

Violations checkBorders(const std::vector<SourceFile>& files) {
  Violations violations;
  std::map<std::pair<const Library*, const Place*>, std::vector<std::string>> users;
  for (const SourceFile& file : files) {
    for (const Include& include : includesOf(file)) {
      const std::string edge = at(file, include.line) + " includes " + include.name + ": ";
      for (const Border& border : kBorders) {
        if (file.path.starts_with(border.from) && beginsWithOneOf(include.name, border.targets) &&
            !beginsWithOneOf(include.name, border.except))
          violations.push_back(edge + std::string(border.reason));
      }
      for (const Library& library : kLibraries) {
        if (include.quoted || !include.name.starts_with(library.header)) continue;
        const auto place = std::find_if(library.places.begin(), library.places.end(),
                                        [&](const Place& p) { return file.path.starts_with(p.prefix); });
        if (place == library.places.end()) {
          violations.push_back(edge + std::string(library.reason));
        } else if (place->files > 0) {
          std::vector<std::string>& known = users[{&library, &*place}];
          if (std::find(known.begin(), known.end(), file.path) == known.end()) known.push_back(file.path);
        }
      }
    }
  }
  for (const auto& [key, paths] : users) {
    if (paths.size() <= key.second->files) continue;
    std::string text = std::string(key.first->header) + " is included by more than " +
                       std::to_string(key.second->files) + " file: ";
    for (const std::string& path : paths) text += path + " ";
    violations.push_back(text + "- " + std::string(key.first->reason));
  }
  return violations;
}

Violations checkIncludeStyle(const std::vector<SourceFile>& files) {
  Violations violations;
  std::set<std::string> known;
  for (const SourceFile& file : files) known.insert(file.path);
  for (const SourceFile& file : files) {
    for (const Include& include : includesOf(file)) {
      const bool ours = beginsWithOneOf(include.name, {"core/", "app/", "python/", "tests/"});
      if (include.quoted && !ours)
        violations.push_back(at(file, include.line) + ": \"" + include.name +
                             "\" is not named from the repository's root");
      else if (include.quoted && !known.contains(include.name))
        violations.push_back(at(file, include.line) + ": there is no file " + include.name);
      else if (!include.quoted && ours)
        violations.push_back(at(file, include.line) + ": <" + include.name +
                             "> is ours and belongs in quotes");
    }
  }
  return violations;
}

Violations checkPortability(const std::vector<SourceFile>& files) {
  // What differs between libraries, their versions or processors in its last digit; names that nothing else
  // has.
  static const std::regex unequal(
      "\\bstd::(a?(sin|cos|tan)h?|atan2|exp[2m]?1?|log(2|10|1p)?|pow|cbrt|hypot|erfc?|[lt]gamma)f?\\b|"
      "\\bAngleAxis|\\bApproximateReciprocal|\\b(SumOf|Reduce)(Lanes|Sum)\\b");
  // These reach no particle: numbers for people, cameras and limits.
  static const std::vector<std::string_view> free{"core/base/math.", "core/base/messages.", "core/study/",
                                                  "core/scene/scene.cpp"};
  Violations violations;
  for (const SourceFile& file : files) {
    if (!file.path.starts_with("core/") || beginsWithOneOf(file.path, free)) continue;
    const std::vector<std::string> lines = linesOf(file.text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::smatch match;
      const std::string code = lines[i].substr(0, lines[i].find("//"));
      if (std::regex_search(code, match, unequal))
        violations.push_back(at(file, i + 1) + ": " + match.str() +
                             " is not the same on every machine; see core/base/math.h");
    }
  }
  return violations;
}

Violations checkChapters(const std::vector<SourceFile>& files) {
  std::map<std::string_view, std::vector<std::size_t>> lengths;
  std::map<std::string_view, std::set<std::string_view>> readers;
  std::set<std::string> known;
  for (const SourceFile& file : files) known.insert(file.path);
  const auto ours = [](const SourceFile& file) {
    return isCode(file) && beginsWithOneOf(file.path, {"core/", "app/"});
  };
  for (const SourceFile& file : files) {
    if (const Room* room = roomOf(file.path); room && ours(file))
      lengths[room->name].push_back(linesOf(file.text).size());
    for (const Include& include : includesOf(file)) {
      const auto header = known.find(include.name);
      const bool own =
          file.path.ends_with(".cpp") && include.name == file.path.substr(0, file.path.size() - 4) + ".h";
      if (header != known.end() && !own) readers[*header].insert(file.path);
    }
  }
  Violations violations;
  for (auto& [room, lines] : lengths) {
    if (lines.size() < 4) continue;
    std::sort(lines.begin(), lines.end());
    const std::size_t median = (lines[(lines.size() - 1) / 2] + lines[lines.size() / 2]) / 2;
    if (median < kLeastMedianLines)
      violations.push_back(std::string(room) + ": half of its files have " + std::to_string(median) +
                           " lines or fewer, expected " + std::to_string(kLeastMedianLines) + ": merge some");
  }
  for (const SourceFile& file : files)
    if (ours(file) && file.path.ends_with(".h") && readers[file.path].size() < kLeastReaders)
      violations.push_back(file.path + ": a header with fewer than two readers belongs into its reader");
  return violations;
}

/// What is wrong with the namespace of a test file, which others are compiled together with; or nothing.
std::string testNamespaceFault(const SourceFile& file, const std::vector<std::string>& lines) {
  if (!file.path.starts_with("tests/") || !file.path.ends_with("_test.cpp")) return {};
  const std::size_t name = file.path.rfind('/') + 1;
  const std::string stem = file.path.substr(name, file.path.size() - 4 - name);
  const auto has = [&](const std::string& line) {
    return std::find(lines.begin(), lines.end(), line) != lines.end();
  };
  if (has("namespace {")) return "names of a test file are not in an unnamed namespace";
  return has("namespace " + stem + " {") ? std::string() : "no namespace " + stem + " for the file's names";
}

Violations checkHabits(const std::vector<SourceFile>& files) {
  // Written so that this file does not hold the words itself.
  static const std::regex unfinished(
      "\\b(TO"
      "DO|FIX"
      "ME|XX"
      "X)\\b");
  Violations violations;
  for (const SourceFile& file : files) {
    const std::vector<std::string> lines = linesOf(file.text);
    if (lines.size() > kMostLines)
      violations.push_back(file.path + ": " + std::to_string(lines.size()) + " lines, more than " +
                           std::to_string(kMostLines));
    if (const std::string fault = testNamespaceFault(file, lines); !fault.empty())
      violations.push_back(file.path + ": " + fault);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (std::regex_search(lines[i], unfinished))
        violations.push_back(at(file, i + 1) + ": a note about unfinished work: " + lines[i]);
      if (file.path.starts_with("core/") && lines[i].find("const_cast") != std::string::npos)
        violations.push_back(at(file, i + 1) +
                             ": a const_cast: what is const is shared, and others may be reading it");
    }
    if (!file.path.ends_with(".h")) continue;
    if (lines.empty() || !lines[0].starts_with("//"))
      violations.push_back(file.path + ": a header opens with a comment that says what it is for");
    // What is compiled once for every instruction set has a guard of its own.
    if (file.path.ends_with("-inl.h")) continue;
    if (std::find(lines.begin(), lines.end(), "#pragma once") == lines.end())
      violations.push_back(file.path + ": no #pragma once");
  }
  return violations;
}

}  // namespace migiwa::structure
