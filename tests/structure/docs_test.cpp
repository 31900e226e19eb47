// What holds of the documents: links lead somewhere, pictures are shown and can be made again, commands and
// source files that a text names are there, and every abbreviation has its one definition. The rules work on
// texts in memory, so that they are tested on documents that break them.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace migiwa::structure {
namespace docs_test {

namespace fs = std::filesystem;

struct Text {
  std::string path;  ///< relative to the repository, with forward slashes
  std::string text;
};

/// One readable line for each fault.
using Faults = std::vector<std::string>;
/// Whether a path, relative to the repository, is a file or a folder in it.
using Exists = std::function<bool(const std::string&)>;

constexpr std::size_t kMostLinesOfReadme = 180;

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string at(const Text& document, std::size_t line) {
  return document.path + ":" + std::to_string(line + 1);
}

/// A line in which code between backticks is blank.
std::string withoutCode(std::string line) {
  bool code = false;
  for (char& c : line) {
    const bool tick = c == '`';
    if (code || tick) c = ' ';
    if (tick) code = !code;
  }
  return line;
}

/// The lines of a document in which no Markdown is read: those of fenced blocks are empty, and code within a
/// line is blank. Indented blocks stay: their commands look like no link.
std::vector<std::string> proseOf(const std::string& text) {
  std::vector<std::string> lines = linesOf(text);
  bool fenced = false;
  for (std::string& line : lines) {
    const std::size_t first = line.find_first_not_of(' ');
    const bool fence = first != std::string::npos && line.compare(first, 3, "```") == 0;
    if (fence) fenced = !fenced;
    if (fence || fenced) {
      line.clear();
      continue;
    }
    line = withoutCode(line);
  }
  return lines;
}

/// The name by which GitHub links to a heading: lower case, without punctuation, hyphens for spaces. Letters
/// beyond ASCII stay; dashes and quotation marks (U+2000 to U+203F) go.
std::string slugOf(const std::string& heading) {
  static const std::regex link(R"(\[([^\]]*)\]\([^)]*\))");
  const std::string plain = std::regex_replace(heading, link, "$1");
  std::string slug;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const auto c = static_cast<unsigned char>(plain[i]);
    if (c == 0xE2 && i + 2 < plain.size() && static_cast<unsigned char>(plain[i + 1]) == 0x80) {
      i += 2;
    } else if (c == ' ') {
      slug += '-';
    } else if (c >= 0x80 || std::isalnum(c) != 0 || c == '-' || c == '_') {
      slug += c < 0x80 ? static_cast<char>(std::tolower(c)) : plain[i];
    }
  }
  return slug;
}

std::set<std::string> anchorsOf(const std::string& text) {
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  bool fenced = false;
  for (const std::string& line : linesOf(text)) {
    if (line.starts_with("```")) fenced = !fenced;
    const std::size_t level = line.find_first_not_of('#');
    if (fenced || level == 0 || level > 6 || level == std::string::npos || line[level] != ' ') continue;
    std::string heading = line.substr(level + 1);
    heading.erase(heading.find_last_not_of(" #") + 1);
    const std::string slug = slugOf(heading);
    const int before = seen[slug]++;
    anchors.insert(before == 0 ? slug : slug + "-" + std::to_string(before));
  }
  return anchors;
}

struct Link {
  std::size_t line;
  std::string target;  ///< as it is written, without an anchor
  std::string anchor;  ///< without #
  bool picture;
};

std::string decoded(const std::string& target) {
  std::string text;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target[i] == '%' && i + 2 < target.size()) {
      text += static_cast<char>(std::stoi(target.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      text += target[i];
    }
  }
  return text;
}

/// All links but those to other places of the web.
std::vector<Link> linksOf(const Text& document) {
  static const std::regex inlined(R"((!?)\[[^\]]*\]\(<?([^)\s>]+)>?(?:\s+"[^"]*")?\))");
  static const std::regex defined(R"(^()\[[^\]]+\]:\s+(\S+))"),
      tag(R"re(<(img|a)\s[^>]*(?:src|href)="([^"]+)")re");
  static const std::regex scheme(R"(^[a-z][a-z0-9+.-]*:)");
  std::vector<Link> links;
  const std::vector<std::string> lines = proseOf(document.text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const std::regex* pattern : {&inlined, &defined, &tag}) {
      for (std::sregex_iterator match(lines[i].begin(), lines[i].end(), *pattern), end; match != end;
           ++match) {
        const std::string whole = (*match)[2];
        if (std::regex_search(whole, scheme)) continue;
        const std::size_t hash = whole.find('#');
        const std::string mark = (*match)[1];
        links.push_back({i, decoded(whole.substr(0, hash)),
                         hash == std::string::npos ? "" : decoded(whole.substr(hash + 1)),
                         mark == "!" || mark == "img"});
      }
    }
  }
  return links;
}

/// A link's target relative to the repository.
std::string placeOf(const Text& document, const Link& link) {
  if (link.target.empty()) return document.path;
  const fs::path folder = fs::path(document.path).parent_path();
  std::string place = (folder / link.target).lexically_normal().generic_string();
  if (place.size() > 1 && place.ends_with('/')) place.pop_back();
  return place;
}

Faults deadLinks(const std::vector<Text>& documents, const Exists& exists) {
  std::map<std::string, std::set<std::string>> anchors;
  for (const Text& document : documents) anchors[document.path] = anchorsOf(document.text);
  Faults faults;
  for (const Text& document : documents) {
    for (const Link& link : linksOf(document)) {
      const std::string place = placeOf(document, link);
      const std::string kind = link.picture ? "picture" : "link";
      if (link.target.starts_with('/') || place.starts_with("..")) {
        faults.push_back(at(document, link.line) + ": the " + kind + " " + link.target +
                         " leads out of the repository");
      } else if (!exists(place)) {
        faults.push_back(at(document, link.line) + ": the " + kind + " " + link.target + " leads nowhere");
      } else if (const auto known = anchors.find(place);
                 !link.anchor.empty() && known != anchors.end() && !known->second.contains(link.anchor)) {
        faults.push_back(at(document, link.line) + ": " + place + " has no heading #" + link.anchor);
      }
    }
  }
  return faults;
}

/// Pictures, given by their paths, that no document links to.
Faults picturesNotShown(const std::vector<std::string>& pictures, const std::vector<Text>& documents) {
  std::set<std::string> shown;
  for (const Text& document : documents)
    for (const Link& link : linksOf(document)) shown.insert(placeOf(document, link));
  Faults faults;
  for (const std::string& picture : pictures)
    if (!shown.contains(picture)) faults.push_back(picture + ": no document shows it");
  return faults;
}

/// Pictures that no command of `run` makes: it names them as a file, where a variable stands for any part but
/// the first, or as what its functions single, compareSheet, film, rayTraced, windowPicture and scriptPicture
/// make.
Faults picturesNotMade(const std::vector<std::string>& pictures, const std::string& run) {
  static const std::regex named(R"(([A-Za-z0-9_]+(?:\$[a-z_]+[A-Za-z0-9_]*)*)\.png)"),
      variable(R"(\$[a-z_]+)");
  static const std::regex made(
      R"((?:single|compareSheet|film|rayTraced|windowPicture|scriptPicture) ([A-Za-z0-9_]+) )");
  std::vector<std::regex> names;
  for (std::sregex_iterator match(run.begin(), run.end(), named), end; match != end; ++match)
    names.emplace_back(std::regex_replace((*match)[1].str(), variable, "[a-z0-9_]+"));
  for (std::sregex_iterator match(run.begin(), run.end(), made), end; match != end; ++match)
    names.emplace_back((*match)[1].str());
  Faults faults;
  for (const std::string& picture : pictures) {
    const std::string stem = fs::path(picture).stem().string();
    if (std::none_of(names.begin(), names.end(),
                     [&](const std::regex& name) { return std::regex_match(stem, name); }))
      faults.push_back(picture + ": no command of ./run makes it");
  }
  return faults;
}

/// The commands that `run` takes: what its last `case` lists.
std::set<std::string> commandsOf(const std::string& run) {
  static const std::regex choice(R"(^\s*([a-z]+(?: \| [a-z]+){3,})\)\s*$)"), word("[a-z]+");
  std::set<std::string> commands{"help"};
  for (const std::string& line : linesOf(run)) {
    std::smatch match;
    if (!std::regex_match(line, match, choice)) continue;
    const std::string list = match[1];
    for (std::sregex_iterator name(list.begin(), list.end(), word), end; name != end; ++name)
      commands.insert(name->str());
  }
  return commands;
}

/// Commands of `run` that documents name, in code or beside it, and that it does not have.
Faults unknownCommands(const std::vector<Text>& documents, const std::string& run) {
  static const std::regex call(R"(\./run ([a-z][a-z_-]*))");
  const std::set<std::string> known = commandsOf(run);
  Faults faults;
  for (const Text& document : documents) {
    const std::vector<std::string> lines = linesOf(document.text);
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::sregex_iterator match(lines[i].begin(), lines[i].end(), call), end; match != end; ++match)
        if (!known.contains((*match)[1]))
          faults.push_back(at(document, i) + ": ./run has no command " + (*match)[1].str());
  }
  return faults;
}

/// Files and folders of the sources and scenes that a document names, and that are not there. NAME stands for
/// any name; what runs write is not looked for.
Faults missingFiles(const std::vector<Text>& documents, const Exists& exists) {
  static const std::regex path(
      R"re((^|[^A-Za-z0-9_./$*{}-])((?:core|app|include|python|examples|tests|scenes|cmake|shaders)/[A-Za-z0-9_./-]*[A-Za-z0-9_])([*{]|\.\*)?)re");
  static const std::regex kept(R"((^|/)[A-Za-z0-9_-]+(\.(h|cpp|json|md|cmake|txt|sh|py|obj|png))?$)");
  Faults faults;
  for (const Text& document : documents) {
    const std::vector<std::string> lines = linesOf(document.text);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::sregex_iterator match(lines[i].begin(), lines[i].end(), path), end; match != end; ++match) {
        const std::string name = (*match)[2];
        // A link's target is relative to the document, and looked at as such.
        if ((*match)[1] == "(" || (*match)[3].length() > 0 || name.find("NAME") != std::string::npos)
          continue;
        if (std::regex_search(name, kept) && !exists(name))
          faults.push_back(at(document, i) + ": there is no " + name);
      }
    }
  }
  return faults;
}

/// Abbreviations such as [FM] in a line, where no link is.
std::vector<std::string> abbreviationsIn(const std::string& line) {
  static const std::regex pattern(R"((^|[^A-Za-z0-9_\])])\[([A-Z][A-Za-z]+[0-9]*)\](?![(\[:]))");
  std::vector<std::string> found;
  for (std::sregex_iterator match(line.begin(), line.end(), pattern), end; match != end; ++match)
    found.push_back((*match)[2]);
  return found;
}

/// Abbreviations in comments of the sources, and in the prose of the documents, that the bibliography does
/// not define in a row of its own, and those that it defines twice.
Faults undefinedAbbreviations(const std::vector<Text>& sources, const std::vector<Text>& documents,
                              const std::string& bibliography) {
  static const std::regex row(R"(^\| \[([A-Z][A-Za-z]+[0-9]*)\] \|)");
  Faults faults;
  std::set<std::string> defined;
  for (const std::string& line : linesOf(bibliography)) {
    std::smatch match;
    if (std::regex_search(line, match, row) && !defined.insert(match[1]).second)
      faults.push_back("[" + match[1].str() + "] is defined twice");
  }
  const auto look = [&](const Text& text, std::size_t line, const std::string& part) {
    for (const std::string& name : abbreviationsIn(part))
      if (!defined.contains(name))
        faults.push_back(at(text, line) + ": [" + name + "] is not defined in docs/method.md");
  };
  for (const Text& source : sources) {
    const std::vector<std::string> lines = linesOf(source.text);
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (const std::size_t comment = lines[i].find("//"); comment != std::string::npos)
        look(source, i, withoutCode(lines[i].substr(comment)));
  }
  for (const Text& document : documents) {
    const std::vector<std::string> lines = proseOf(document.text);
    for (std::size_t i = 0; i < lines.size(); ++i) look(document, i, lines[i]);
  }
  return faults;
}

// The repository itself.

const fs::path& root() {
  static const fs::path path = MIGIWA_SOURCE_DIR;
  return path;
}

Text readText(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return {path.lexically_relative(root()).generic_string(), text.str()};
}

/// Files under a folder of the repository, hidden folders and what is built and written left out.
std::vector<Text> textsUnder(const fs::path& folder, const std::vector<std::string_view>& endings) {
  std::vector<fs::path> paths;
  for (fs::recursive_directory_iterator entry(folder), end; entry != end; ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory()) {
      const bool written = entry.depth() == 0 && folder == root() && (name == "build" || name == "out");
      if (written || name.starts_with('.')) entry.disable_recursion_pending();
    } else if (std::any_of(endings.begin(), endings.end(),
                           [&](std::string_view ending) { return name.ends_with(ending); })) {
      paths.push_back(entry->path());
    }
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Text> texts;
  std::transform(paths.begin(), paths.end(), std::back_inserter(texts), readText);
  return texts;
}

const std::vector<Text>& documents() {
  static const std::vector<Text> texts = textsUnder(root(), {".md"});
  return texts;
}

/// Those whose path begins so.
std::vector<Text> documentsOf(std::string_view begin) {
  std::vector<Text> texts;
  std::copy_if(documents().begin(), documents().end(), std::back_inserter(texts),
               [&](const Text& text) { return text.path.starts_with(begin); });
  return texts;
}

std::vector<std::string> screenshots() {
  std::vector<std::string> pictures;
  for (const fs::directory_entry& entry : fs::directory_iterator(root() / "screenshots"))
    pictures.push_back("screenshots/" + entry.path().filename().string());
  std::sort(pictures.begin(), pictures.end());
  return pictures;
}

bool inTree(const std::string& path) {
  return fs::exists(root() / path);
}

void expectNone(const Faults& faults) {
  for (const std::string& fault : faults) ADD_FAILURE() << fault;
}

TEST(Documents, AreAllThere) {
  for (const char* path :
       {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE", "docs/method.md", "docs/gamma.md",
        "docs/scene_format.md", "docs/effects.md", "docs/studies.md", "docs/export.md", "docs/report.md",
        "docs/performance.md", "docs/code.md", "docs/library.md", "docs/python.md"})
    EXPECT_TRUE(inTree(path)) << path;
  EXPECT_GT(screenshots().size(), 10U);
}
TEST(Documents, LinkToWhatIsThere) {
  expectNone(deadLinks(documents(), inTree));
}
TEST(Documents, ShowEveryScreenshot) {
  expectNone(picturesNotShown(screenshots(), documents()));
}
TEST(Documents, ShowWhatRunMakes) {
  expectNone(picturesNotMade(
      screenshots(), readText(root() / "run").text + readText(root() / "docs" / "screenshots.sh").text));
}
TEST(Documents, ShowPicturesThatAreSmall) {
  // As much as a repository is to carry of what ./run makes anew.
  constexpr std::uintmax_t kMost = 6'000'000, kMostOfOne = 2'000'000;
  std::uintmax_t all = 0;
  for (const std::string& picture : screenshots()) {
    const std::uintmax_t size = fs::file_size(root() / picture);
    EXPECT_LE(size, kMostOfOne) << picture;
    all += size;
  }
  EXPECT_LE(all, kMost);
}
TEST(Documents, NameCommandsOfRun) {
  expectNone(unknownCommands(documents(), readText(root() / "run").text));
}
TEST(Documents, NameFilesThatAreThere) {
  std::vector<Text> present = documents();
  std::erase_if(present,
                [](const Text& text) { return text.path == "CHANGELOG.md"; });  // it tells of the past
  expectNone(missingFiles(present, inTree));
}
TEST(Documents, DefineEveryAbbreviation) {
  std::vector<Text> sources = textsUnder(root() / "core", {".h", ".cpp"});
  for (Text& text : textsUnder(root() / "app", {".h", ".cpp"})) sources.push_back(std::move(text));
  EXPECT_GT(sources.size(), 50U);
  expectNone(undefinedAbbreviations(sources, documentsOf("docs/"), readText(root() / "docs/method.md").text));
}
TEST(Documents, ReadmeIsShort) {
  EXPECT_LE(linesOf(readText(root() / "README.md").text).size(), kMostLinesOfReadme);
}

// The rules, on documents that keep them and that break them.

/// Exactly one fault for each of the given pieces of text, in that order.
void expect(const Faults& faults, const std::vector<std::string>& pieces) {
  ASSERT_EQ(faults.size(), pieces.size()) << testing::PrintToString(faults);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    EXPECT_NE(faults[i].find(pieces[i]), std::string::npos) << faults[i] << "\nhas no: " << pieces[i];
}

TEST(DocumentRules, LinksAndAnchorsAreFollowed) {
  const Exists exists = [](const std::string& path) {
    return path == "docs/a.md" || path == "README.md" || path == "docs/p.png";
  };
  const Text a{"docs/a.md", "# Methods of γ\n## Add `x`, y\n## Add `x`, y\n"};
  const auto with = [&](const std::string& text) { return deadLinks({a, {"README.md", text}}, exists); };
  expectNone(
      with("[a](docs/a.md#methods-of-γ) [b](docs/a.md#add-x-y) [c](docs/a.md#add-x-y-1) ![p](docs/p.png)"));
  expectNone(with("`[a](gone.md)`\n```\n[a](gone.md)\n# No heading\n```\n[w](https://example.org/#x)"));
  expect(with("\n[a](docs/b.md)"), {"README.md:2: the link docs/b.md leads nowhere"});
  expect(with("![a](docs/q.png)"), {"the picture docs/q.png leads nowhere"});
  expect(with("[a](docs/a.md#gone) [b](#no)"),
         {"docs/a.md has no heading #gone", "README.md has no heading #no"});
  expect(with("[a](../other/README.md)"), {"out of the repository"});
}

TEST(DocumentRules, PicturesAreShownAndMade) {
  const std::vector<std::string> pictures{"screenshots/a.png", "screenshots/b_c.png"};
  expect(picturesNotShown(pictures, {{"docs/d.md", "![a](../screenshots/a.png)"}}), {"screenshots/b_c.png"});
  expectNone(picturesNotMade(pictures, "single a scene 3\ncp x \"screenshots/b_$scene.png\"\n"));
  expect(picturesNotMade(pictures, "cp x screenshots/$name.png\n"), {"a.png", "b_c.png"});
}

TEST(DocumentRules, CommandsAndFilesAreKnown) {
  const std::string run =
      "case ${1:-help} in\n  setup | build | demo | test)\n    ;;\n  help | -h) usage ;;\n";
  expectNone(unknownCommands({{"a.md", "`./run test`, `./run` alone, ./run help"}}, run));
  expect(unknownCommands({{"a.md", "\n    ./run tset   # typed badly"}}, run),
         {"a.md:2: ./run has no command tset"});
  const Exists exists = [](const std::string& path) { return path == "core/a.h" || path == "core/b"; };
  expectNone(
      missingFiles({{"a.md", "`core/a.h` core/b, `core/NAME.cpp` core/c_*.h `build/core/x.h`"}}, exists));
  expect(missingFiles({{"a.md", "See `core/gone.h`."}}, exists), {"a.md:1: there is no core/gone.h"});
}

TEST(DocumentRules, AbbreviationsAreDefinedOnce) {
  const std::string bibliography = "| [FM] | one |\n| [OBA] | two |\n";
  expectNone(undefinedAbbreviations(
      {{"core/a.h", "// [FM] Eq. 5, q in [0, 1], [OBA], `view [SCENE]`\nint a[Index];  // a[Index]\n"}},
      {{"docs/a.md", "[FM] and [a](b.md), [MIT](LICENSE), `[X Y]` `[SCENE]`"}}, bibliography));
  expect(undefinedAbbreviations({{"core/a.h", "\n// ([MM] 2013)\n"}}, {{"docs/a.md", "[XX]"}}, bibliography),
         {"core/a.h:2: [MM] is not defined", "docs/a.md:1: [XX]"});
  expect(undefinedAbbreviations({}, {}, bibliography + "| [FM] | again |\n"), {"[FM] is defined twice"});
}

}  // namespace docs_test
}  // namespace migiwa::structure
