#include <algorithm>
#include <charconv>
#include <optional>

#include "core/base/files.h"
#include "core/scene/json.h"
#include "core/scene/scene_file.h"

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

Link readLink(std::string_view text, const fs::path& file, FaultList& faults) {
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
  return {file, std::move(document.root)};
}

std::string pointerOf(std::string_view key) {
  return childPointer("", key);
}

/// The file that a link includes, if any. The key is taken out.
std::optional<fs::path> takeInclude(Link& link, FaultList& faults) {
  const auto found = link.root.find(std::string(kIncludeKey));
  if (found == link.root.end()) return std::nullopt;
  if (!found->is_string() || found->get_ref<const std::string&>().empty())
    refuse(faults, {link.file.string(), pointerOf(kIncludeKey)},
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

/// JSON Merge Patch (RFC 7396) of objects, noting where each value comes from.
void mergeOver(Json& base, const Json& over, const std::string& pointer, const std::string& file,
               Origins& origins) {
  for (const auto& item : over.items()) {
    const std::string place = childPointer(pointer, item.key());
    const bool mergesInto = base.contains(item.key()) && base[item.key()].is_object();
    if (!item.value().is_object() || !mergesInto) origins.add(place, {file, place});
    if (item.value().is_null()) {
      base.erase(item.key());
    } else if (item.value().is_object()) {
      if (!mergesInto) base[item.key()] = Json::object();
      mergeOver(base[item.key()], item.value(), place, file, origins);
    } else {
      base[item.key()] = item.value();
    }
  }
}

/// Puts in what "set" names.
void applySet(const Json& set, const std::string& file, Json& root, FaultList& faults) {
  const std::string place = pointerOf(kSetKey);
  if (!set.is_object()) {
    faults.addAt({file, place}, "expected an object of JSON pointers and values, found " + describeJson(set));
    return;
  }
  for (const auto& item : set.items()) {
    const Origin origin{file, childPointer(place, item.key())};
    const auto tokens = pointerTokens(item.key());
    if (!tokens) {
      faults.addAt(origin,
                   "expected a JSON pointer such as \"/fluid/0/max\", found " + quotedText(item.key()));
    } else if (tokens->front() == kIncludeKey || tokens->front() == kSetKey) {
      faults.addAt(origin, "expected a key of the scene, found one that is only read in a file itself");
    } else {
      setValue(root, item.key(), item.value(), origin, faults);
    }
  }
}

/// The chain from the outermost file to the one that includes nothing.
std::vector<Link> readChain(std::string_view text, const fs::path& name, FaultList& faults) {
  std::vector<Link> chain;
  chain.push_back(readLink(text, name, faults));
  while (const std::optional<fs::path> next = takeInclude(chain.back(), faults)) {
    const Origin origin{chain.back().file.string(), pointerOf(kIncludeKey)};
    for (std::size_t k = 0; k < chain.size(); ++k)
      if (sameFile(chain[k].file, *next))
        refuse(faults, origin,
               "expected a scene that does not include itself, found a cycle: " + cycleText(chain, k));
    std::string included;
    try {
      included = readTextFile(*next, "a scene file");
    } catch (const InputError& error) {
      refuse(faults, origin, error.faults().front().message + " (" + next->string() + ")");
    }
    chain.push_back(readLink(included, *next, faults));
  }
  return chain;
}

}  // namespace

Json resolveIncludes(std::string_view text, const fs::path& name, FaultList& faults) {
  std::vector<Link> chain = readChain(text, name, faults);
  Json root = Json::object();
  if (chain.size() > 1) faults.origins().add("", {chain.back().file.string(), ""});
  for (auto link = chain.rbegin(); link != chain.rend(); ++link) {
    Json set = Json::object();
    if (const auto found = link->root.find(std::string(kSetKey)); found != link->root.end()) {
      set = std::move(*found);
      link->root.erase(found);
    }
    if (link == chain.rbegin()) {
      root = std::move(link->root);
    } else {
      mergeOver(root, link->root, "", link->file.string(), faults.origins());
    }
    applySet(set, link->file.string(), root, faults);
  }
  return root;
}

std::vector<fs::path> filesOfScene(const fs::path& file) {
  std::vector<fs::path> files{file};
  try {
    FaultList ignored(file.string());
    Link link{file, {}};
    for (;;) {
      link = readLink(readTextFile(files.back(), "a scene file"), files.back(), ignored);
      const std::optional<fs::path> next = takeInclude(link, ignored);
      const bool known = next && std::any_of(files.begin(), files.end(),
                                             [&](const fs::path& other) { return sameFile(other, *next); });
      if (!next || known) break;
      files.push_back(*next);
    }
  } catch (const InputError&) {
    // What is missing or broken is named all the same: whoever waits for it to be mended looks at it.
  }
  return files;
}

namespace {

std::optional<std::size_t> arrayIndex(const std::string& token) {
  std::size_t index = 0;
  const auto [end, code] = std::from_chars(token.data(), token.data() + token.size(), index);
  if (code != std::errc() || end != token.data() + token.size()) return std::nullopt;
  if (token.size() > 1 && token.front() == '0') return std::nullopt;
  return index;
}

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

std::optional<std::vector<std::string>> pointerTokens(std::string_view pointer) {
  if (!pointer.starts_with('/')) return std::nullopt;
  std::vector<std::string> result;
  for (std::size_t k = 0; k < pointer.size(); ++k) {
    if (pointer[k] == '/') {
      result.emplace_back();
    } else if (pointer[k] != '~') {
      result.back() += pointer[k];
    } else if (k + 1 < pointer.size() && (pointer[k + 1] == '0' || pointer[k + 1] == '1')) {
      result.back() += pointer[++k] == '0' ? '~' : '/';
    } else {
      return std::nullopt;
    }
  }
  return result;
}

Override Override::parse(std::string_view argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string_view::npos || !argument.starts_with('/'))
    throw InputError("--set", "expected /json/pointer=VALUE, found " + quotedText(argument));
  const std::string_view pointer = argument.substr(0, equals);
  if (!pointerTokens(pointer).has_value())
    throw InputError("--set", "expected ~0 for ~ and ~1 for / in a pointer, found " + quotedText(pointer));
  return {std::string(pointer), std::string(argument.substr(equals + 1))};
}

void setValue(Json& root, const std::string& pointer, Json value, const Origin& origin, FaultList& faults) {
  const std::vector<std::string> tokens = pointerTokens(pointer).value_or(std::vector<std::string>());
  Json* place = &root;
  std::string reached;
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    const std::string& token = tokens[k];
    const bool last = k + 1 == tokens.size();
    const std::string& shown = reached.empty() ? "/" : reached;
    if (place->is_object()) {
      if (last && value.is_null()) {
        place->erase(token);
        faults.origins().add(childPointer(reached, token), origin);
        return;
      }
      // A new member is an object until the next token or the value says otherwise.
      if (!place->contains(token)) {
        (*place)[token] = Json::object();
        const std::string made = childPointer(reached, token);
        faults.origins().add(
            made, origin.file.empty() ? Origin{"", made} : Origin{origin.file, origin.pointer, true});
      }
      place = &(*place)[token];
      reached = childPointer(reached, token);
    } else if (place->is_array()) {
      std::optional<std::size_t> index = arrayIndex(token);
      if (last && token == "-") {
        index = place->size();
        place->push_back(nullptr);
      }
      if (!index || *index >= place->size()) {
        faults.addAt(origin, "expected the index of one of " + std::to_string(place->size()) +
                                 " entries at " + shown + ", found " + quotedText(token));
        return;
      }
      place = &(*place)[*index];
      reached = childPointer(reached, *index);
    } else {
      faults.addAt(origin, "expected an object or an array at " + shown + ", found " + describeJson(*place));
      return;
    }
  }
  *place = std::move(value);
  faults.origins().add(reached, origin);
}

void applyOverrides(const std::vector<Override>& overrides, Json& root, FaultList& faults) {
  for (const Override& override : overrides)
    if (std::optional<Json> value = parseValue(override, faults))
      setValue(root, override.pointer, *std::move(value), {"", override.pointer}, faults);
}

}  // namespace migiwa
