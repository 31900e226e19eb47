#include <algorithm>
#include <optional>

#include "core/base/files.h"
#include "core/scene/json.h"

namespace migiwa {

namespace {

namespace fs = std::filesystem;

/// One file of the chain.
struct Link {
  fs::path file;
  Json root;
};

[[noreturn]] void refuse(FaultList& faults, const Origin& origin, std::string message) {
  faults.addAt(origin, std::move(message));
  throw InputError(faults.faults());
}

Json readRoot(std::string_view text, const fs::path& file, FaultList& faults) {
  JsonDocument document = parseJson(text);
  if (document.broken) {
    std::vector<Fault> all = faults.faults();
    const DocumentFault& fault = document.faults.front();
    all.push_back({file.string() + ":" + fault.pointer, fault.message});
    throw InputError(std::move(all));
  }
  for (DocumentFault& fault : document.faults)
    faults.addAt({file.string(), fault.pointer}, std::move(fault.message));
  if (!document.root.is_object())
    refuse(faults, {file.string(), ""}, "expected an object, found " + describeJson(document.root));
  return std::move(document.root);
}

/// The file that a link includes, if any. The key is taken out.
std::optional<fs::path> takeInclude(Link& link, FaultList& faults) {
  const auto found = link.root.find(kIncludeKey);
  if (found == link.root.end()) return std::nullopt;
  if (!found->is_string() || found->get_ref<const std::string&>().empty())
    refuse(faults, {link.file.string(), childPointer("", kIncludeKey)},
           "expected the name of a scene file, found " + describeJson(*found));
  fs::path next = (link.file.parent_path() / found->get<std::string>()).lexically_normal();
  link.root.erase(found);
  return next;
}

bool sameFile(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored);
}

/// "a.json includes b.json, which includes a.json".
std::string cycleText(const std::vector<Link>& chain, std::size_t begin) {
  std::string text = chain[begin].file.string() + " includes ";
  for (std::size_t k = begin + 1; k < chain.size(); ++k) text += chain[k].file.string() + ", which includes ";
  return text + chain[begin].file.string();
}

/// Notes where each value comes from when `over` is merged over `base`.
void noteOrigins(const Json& base, const Json& over, const std::string& pointer, const std::string& file,
                 FaultList& faults) {
  for (const auto& item : over.items()) {
    const std::string place = childPointer(pointer, item.key());
    const auto under = base.find(item.key());
    if (item.value().is_object() && under != base.end() && under->is_object()) {
      noteOrigins(*under, item.value(), place, file, faults);
    } else {
      faults.addOrigin(place, {file, place});
    }
  }
}

/// Whether there is a value at a pointer. The library throws where it cannot read an index.
bool has(const Json& root, const Json::json_pointer& pointer) {
  try {
    return root.contains(pointer);
  } catch (const Json::exception&) {
    return false;
  }
}

/// Sets the value at a pointer, which may have to be made: see applyOverrides(). `origin`: where it was
/// written.
void setValue(Json& root, const Json::json_pointer& pointer, Json value, const Origin& origin,
              FaultList& faults) {
  Json::json_pointer there = pointer;
  std::vector<std::string> missing;  // the innermost first
  for (; !has(root, there); there.pop_back()) missing.push_back(there.back());
  Json& place = root[there];
  const std::string shown = there.empty() ? "/" : there.to_string();
  if (missing.empty()) {
    Json& parent = root[there.parent_pointer()];
    faults.addOrigin(there.to_string(), origin);
    if (value.is_null() && parent.is_object()) {
      parent.erase(there.back());
    } else {
      place = std::move(value);
    }
  } else if (place.is_array() && missing.size() == 1 && missing.back() == "-") {
    faults.addOrigin((there / place.size()).to_string(), origin);
    place.push_back(std::move(value));
  } else if (place.is_array()) {
    faults.addAt(origin, "expected the index of one of " + std::to_string(place.size()) + " entries at " +
                             shown + ", found " + quotedText(missing.back()));
  } else if (!place.is_object()) {
    faults.addAt(origin, "expected an object or an array at " + shown + ", found " + describeJson(place));
  } else {
    Json* inner = &place;
    for (; missing.size() > 1; missing.pop_back()) {
      there /= missing.back();
      inner = &((*inner)[missing.back()] = Json::object());
      const std::string made = there.to_string();
      faults.addOrigin(made,
                       origin.file.empty() ? Origin{"", made} : Origin{origin.file, origin.pointer, true});
    }
    faults.addOrigin(pointer.to_string(), origin);
    if (!value.is_null()) (*inner)[missing.back()] = std::move(value);
  }
}

/// Puts in what "set" names.
void applySet(const Json& set, const std::string& file, Json& root, FaultList& faults) {
  const std::string place = childPointer("", kSetKey);
  if (!set.is_object()) {
    faults.addAt({file, place}, "expected an object of JSON pointers and values, found " + describeJson(set));
    return;
  }
  for (const auto& item : set.items()) {
    const Origin origin{file, childPointer(place, item.key())};
    const std::optional<Json::json_pointer> pointer = parsePointer(item.key());
    if (!pointer) {
      faults.addAt(origin,
                   "expected a JSON pointer such as \"/fluid/0/max\", found " + quotedText(item.key()));
    } else if (const std::string key = tokensOf(*pointer).front(); key == kIncludeKey || key == kSetKey) {
      faults.addAt(origin, "expected a key of the scene, found one that is only read in a file itself");
    } else {
      setValue(root, *pointer, item.value(), origin, faults);
    }
  }
}

/// The chain from the outermost file to the one that includes nothing. When this throws, `chain` ends with
/// the file that cannot be had.
void readChain(std::string_view text, const fs::path& name, std::vector<Link>& chain, FaultList& faults) {
  chain.push_back({name, {}});
  chain.back().root = readRoot(text, name, faults);
  while (const std::optional<fs::path> next = takeInclude(chain.back(), faults)) {
    const Origin origin{chain.back().file.string(), childPointer("", kIncludeKey)};
    for (std::size_t k = 0; k < chain.size(); ++k)
      if (sameFile(chain[k].file, *next))
        refuse(faults, origin,
               "expected a scene that does not include itself, found a cycle: " + cycleText(chain, k));
    chain.push_back({*next, {}});
    std::string included;
    try {
      included = readTextFile(*next, "a scene file");
    } catch (const InputError& error) {
      refuse(faults, origin, error.faults().front().message + " (" + next->string() + ")");
    }
    chain.back().root = readRoot(included, *next, faults);
  }
}

}  // namespace

Json resolveIncludes(std::string_view text, const fs::path& name, FaultList& faults) {
  std::vector<Link> chain;
  readChain(text, name, chain, faults);
  Json root = Json::object();
  if (chain.size() > 1) faults.addOrigin("", {chain.back().file.string(), ""});
  for (auto link = chain.rbegin(); link != chain.rend(); ++link) {
    Json set = Json::object();
    if (const auto found = link->root.find(kSetKey); found != link->root.end()) {
      set = std::move(*found);
      link->root.erase(found);
    }
    if (link == chain.rbegin()) {
      root = std::move(link->root);
    } else {
      noteOrigins(root, link->root, "", link->file.string(), faults);
      root.merge_patch(link->root);
    }
    applySet(set, link->file.string(), root, faults);
  }
  return root;
}

std::vector<fs::path> filesOfScene(const fs::path& file) {
  std::vector<Link> chain;
  try {
    FaultList ignored(file.string());
    readChain(readTextFile(file, "a scene file"), file, chain, ignored);
  } catch (const InputError&) {
    // What is missing or broken is named all the same: whoever waits for it to be mended looks at it.
  }
  std::vector<fs::path> files{file};
  for (std::size_t k = 1; k < chain.size(); ++k) files.push_back(std::move(chain[k].file));
  return files;
}

namespace {

/// A JSON value, else a bare word. What begins like an object, an array or a quoted text has to be one:
/// nothing if not.
std::optional<Json> parseValue(const Override& override, FaultList& faults) {
  JsonDocument document = parseJson(override.value);
  const std::size_t first = override.value.find_first_not_of(" \t\r\n");
  const bool structured = first != std::string::npos &&
                          std::string_view("{[\"").find(override.value[first]) != std::string_view::npos;
  if (document.broken && !structured) return override.value;
  for (const DocumentFault& fault : document.faults) {
    if (document.broken) {
      faults.addAt({"", override.pointer}, fault.message + " (at " + fault.pointer + " of the value)");
    } else {
      faults.addAt({"", override.pointer + fault.pointer}, fault.message);
    }
  }
  if (document.broken) return std::nullopt;
  return std::move(document.root);
}

}  // namespace

Override Override::parse(std::string_view argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string_view::npos || !argument.starts_with('/'))
    throw InputError("--set", "expected /json/pointer=VALUE, found " + quotedText(argument));
  const std::string_view pointer = argument.substr(0, equals);
  if (!parsePointer(pointer))
    throw InputError("--set", "expected ~0 for ~ and ~1 for / in a pointer, found " + quotedText(pointer));
  return {std::string(pointer), std::string(argument.substr(equals + 1))};
}

void applyOverrides(const std::vector<Override>& overrides, Json& root, FaultList& faults) {
  for (const Override& override : overrides)
    if (std::optional<Json> value = parseValue(override, faults))
      setValue(root, Json::json_pointer(override.pointer), *std::move(value), {"", override.pointer}, faults);
}

}  // namespace migiwa
