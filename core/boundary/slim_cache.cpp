#include "core/boundary/slim_cache.h"

#include <cstdio>
#include <fstream>
#include <sstream>

#include "core/base/disk_cache.h"
#include "core/base/error.h"
#include "core/slim/slim_file.h"

namespace migiwa {

namespace fs = std::filesystem;

namespace {

/// Raised whenever the file, or what a fit gives, changes.
constexpr int kVersion = 3;

/// FNV-1a.
std::uint64_t hashOf(std::string_view text) {
  std::uint64_t sum = 0xCBF29CE484222325U;
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  return sum;
}

std::optional<std::string> contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) return std::nullopt;
  return std::move(text).str();
}

void add(std::string& key, const char* name, std::initializer_list<double> values) {
  key += std::string(" ") + name;
  char digits[32];
  for (const double value : values) {
    std::snprintf(digits, sizeof digits, " %a", value);
    key += digits;
  }
}

std::string header(const std::string& key, std::string_view body) {
  char numbers[64];
  std::snprintf(numbers, sizeof numbers, "%zu %016llx", body.size(),
                static_cast<unsigned long long>(hashOf(body)));
  return "migiwa-slim-fit " + std::to_string(kVersion) + "\n" + key + "\n" + numbers + "\n";
}

}  // namespace

std::string slimFitKey(const SlimSource& source) {
  std::string key;
  if (source.kind == SlimSource::Kind::bowl) {
    const Bowl& bowl = source.bowl;
    add(key, "bowl",
        {bowl.center.x(), bowl.center.y(), bowl.center.z(), bowl.radius, bowl.thickness, bowl.height});
  } else {
    const FileIdentity content = source.content();
    if (content.bytes == 0) return {};
    // The reader goes by the name's ending.
    key = "file " + content.text() + " " + source.file.extension().string();
  }
  add(key, "fit", {static_cast<double>(source.degree), source.tolerance, static_cast<double>(source.nodes)});
  const Transform& place = source.transform;
  add(key, "transform",
      {place.scale, place.rotate.axis.x(), place.rotate.axis.y(), place.rotate.axis.z(), place.rotate.degrees,
       place.translate.x(), place.translate.y(), place.translate.z()});
  return key;
}

fs::path slimFitFile(const fs::path& folder, const std::string& key) {
  char name[32];
  std::snprintf(name, sizeof name, "slim_%016llx.fit", static_cast<unsigned long long>(hashOf(key)));
  return folder / name;
}

std::optional<SlimFit> readSlimFit(const fs::path& file, const std::string& key) {
  if (MadeAnew::active()) return std::nullopt;
  const std::optional<std::string> text = contentOf(file);
  if (!text) return std::nullopt;
  // Magic and version, key, size and checksum: three lines, the rest is the body.
  std::size_t end = 0;
  for (int line = 0; line < 3; ++line) {
    end = text->find('\n', end);
    if (end == std::string::npos) return std::nullopt;
    ++end;
  }
  std::string body = text->substr(end);
  if (text->substr(0, end) != header(key, body)) return std::nullopt;
  SlimFit fit;
  while (body.starts_with("note ")) {
    const std::size_t eol = body.find('\n');
    fit.notes.push_back(body.substr(5, eol - 5));
    body.erase(0, eol + 1);
  }
  try {
    fit.data = parseSlimFile(body, file.string());
  } catch (const InputError&) {
    return std::nullopt;
  }
  return fit;
}

bool writeSlimFit(const fs::path& file, const std::string& key, const SlimFit& fit) {
  std::string body;
  for (const std::string& note : fit.notes) body += "note " + note + "\n";
  body += slimFileText(fit.data);
  return writeCacheFile(file, [&](std::ostream& out) { out << header(key, body) << body; });
}

}  // namespace migiwa
