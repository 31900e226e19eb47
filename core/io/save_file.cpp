#include "core/io/save_file.h"

#include <array>
#include <cstring>
#include <fstream>
#include <set>

#include "core/base/files.h"
#include "core/base/hash.h"
#include "core/base/messages.h"
#include "core/scene/json.h"
#include "core/scene/scene_file.h"
#include "core/simulation/state.h"

namespace migiwa {

namespace fs = std::filesystem;

namespace {

constexpr std::array<char, 8> kMagic{'m', 'i', 'g', 'i', 'w', 'a', 's', 'v'};
/// Raised whenever the layout of the file changes; names of values and arrays tell for themselves.
constexpr std::uint32_t kVersion = 1;
/// Tells a machine with another order of bytes.
constexpr std::uint32_t kOrder = 0x01020304;

struct Head {
  std::array<char, 8> magic;
  std::uint32_t version, order;
  std::uint64_t headerBytes, arrayBytes;
  std::uint64_t checksum;  ///< of all that follows
};
static_assert(std::is_trivially_copyable_v<Head> && sizeof(Head) == 40);

std::uint64_t checksumOf(std::string_view header, std::string_view arrays) {
  return checksum(checksum(kEmptyChecksum, header.data(), header.size()), arrays.data(), arrays.size());
}

class StateWriter final : public StateVisitor {
 public:
  bool reading() const override { return false; }
  void number(std::string_view name, double& value) override { put(name, value); }
  void integer(std::string_view name, std::int64_t& value) override { put(name, value); }
  void text(std::string_view name, std::string& value) override { put(name, value); }

  Json values = Json::object(), list = Json::array();
  std::string arrays;

 protected:
  void store(std::string_view name, std::size_t elementBytes, std::span<const std::byte> bytes) override {
    list.push_back({{"name", name}, {"element_bytes", elementBytes}, {"count", bytes.size() / elementBytes}});
    arrays.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  std::span<const std::byte> load(std::string_view, std::size_t) override { return {}; }

 private:
  template <class Value>
  void put(std::string_view name, const Value& value) {
    values[Json::json_pointer(std::string(name))] = value;
  }
};

class StateReader final : public StateVisitor {
 public:
  /// `arrays` is borrowed. Throws StateError when the list does not make them up.
  StateReader(const Json& header, std::string_view arrays) : values_(header.at("values").flatten()) {
    for (const auto& [name, value] : values_.items()) unread_.insert(name);
    std::size_t at = 0;
    for (const Json& entry : header.at("arrays")) {
      const Array array{entry.at("name").get<std::string>(), entry.at("element_bytes").get<std::size_t>(),
                        entry.at("count").get<std::size_t>(), at};
      if (array.elementBytes == 0 || array.count > (arrays.size() - at) / array.elementBytes)
        throw StateError("arrays as the header lists them, found too little for \"" + array.name + "\"");
      at += array.elementBytes * array.count;
      unread_.insert(array.name);
      arrays_.push_back(array);
    }
    if (at != arrays.size()) throw StateError("arrays as the header lists them, found more");
    bytes_ = std::as_bytes(std::span(arrays));
  }

  bool reading() const override { return true; }
  void number(std::string_view name, double& value) override { value = get(name).get<double>(); }
  void integer(std::string_view name, std::int64_t& value) override {
    value = get(name).get<std::int64_t>();
    if (value < -1)
      throw StateError("no negative number in \"" + std::string(name) + "\", found " + std::to_string(value));
  }
  void text(std::string_view name, std::string& value) override { value = get(name).get<std::string>(); }

  /// Throws StateError for values that no part has read.
  void requireAllRead() const {
    if (!unread_.empty())
      throw StateError("only what this version of migiwa simulates, found \"" + *unread_.begin() + "\"");
  }

 protected:
  void store(std::string_view, std::size_t, std::span<const std::byte>) override {}
  std::span<const std::byte> load(std::string_view name, std::size_t elementBytes) override {
    for (const Array& array : arrays_) {
      if (array.name != name) continue;
      if (array.elementBytes != elementBytes)
        throw StateError("elements of " + std::to_string(elementBytes) + " bytes in \"" + array.name +
                         "\", found " + std::to_string(array.elementBytes));
      unread_.erase(array.name);
      return bytes_.subspan(array.offset, array.elementBytes * array.count);
    }
    throw StateError("\"" + std::string(name) + "\", found none; another version of migiwa wrote it");
  }

 private:
  struct Array {
    std::string name;
    std::size_t elementBytes, count, offset;
  };

  const Json& get(std::string_view name) {
    const std::string key(name);
    if (!values_.contains(key))
      throw StateError("\"" + key + "\", found none; another version of migiwa wrote it");
    unread_.erase(key);
    return values_[key];
  }

  Json values_;
  std::vector<Array> arrays_;
  std::span<const std::byte> bytes_;
  std::set<std::string> unread_;
};

/// All of a file, or InputError.
std::string readAll(const fs::path& file) {
  const std::string place = file.string();
  std::error_code code;
  const fs::file_status status = fs::status(file, code);
  if (!fs::exists(status)) throw InputError(place, "expected a save, found no such file");
  if (fs::is_directory(status)) throw InputError(place, "expected a save, found a folder");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(place, "expected a save, found one that cannot be opened");
  // What is no save is not read to its end: it may be a device that has none.
  std::string content(sizeof(Head), '\0');
  in.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(in.gcount()));
  if (content.size() < sizeof(Head) || std::memcmp(content.data(), kMagic.data(), kMagic.size()) != 0)
    return content;
  if (fs::is_regular_file(status)) content.reserve(fs::file_size(file, code));
  std::vector<char> piece(std::size_t{1} << 16);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0)
    content.append(piece.data(), static_cast<std::size_t>(in.gcount()));
  if (in.bad()) throw InputError(place, "expected a save, found one that cannot be read");
  return content;
}

struct SavedParts {
  std::string_view header, arrays;
};

/// Throws InputError unless the content is that of a save, whole and as it was written.
SavedParts partsOf(std::string_view content, const std::string& place) {
  Head head{};
  if (!content.starts_with(std::string_view(kMagic.data(), kMagic.size())))
    throw InputError(place, "expected a save that migiwa simulate --save wrote, found something else");
  if (content.size() < sizeof head)
    throw InputError(
        place, "expected a whole save, found the first " + std::to_string(content.size()) + " bytes of one");
  std::memcpy(&head, content.data(), sizeof head);
  if (head.order != kOrder)
    throw InputError(place, "expected a save of a machine with the same order of bytes, found another");
  if (head.version != kVersion)
    throw InputError(place, "expected a save of version " + std::to_string(kVersion) + ", found version " +
                                std::to_string(head.version) + "; another version of migiwa wrote it");
  const std::string_view rest = content.substr(sizeof head);
  if (head.headerBytes > rest.size() || head.arrayBytes != rest.size() - head.headerBytes) {
    throw InputError(place,
                     "expected " + std::to_string(sizeof head + head.headerBytes + head.arrayBytes) +
                         " bytes, found " + std::to_string(content.size()) +
                         (head.headerBytes + head.arrayBytes > rest.size() ? "; the end is missing"
                                                                           : "; something was added to it"));
  }
  const SavedParts parts{rest.substr(0, head.headerBytes), rest.substr(head.headerBytes)};
  if (checksumOf(parts.header, parts.arrays) != head.checksum)
    throw InputError(place, "expected a save as it was written, found one that was damaged or changed");
  return parts;
}

/// What positions in the arrays are relative to. A save without this entry has those of the scene.
Json originEntry(const Scene& scene) {
  return Json::array({scene.origin.x(), scene.origin.y(), scene.origin.z()});
}

void requireSameScene(const Json& header, const Simulation& simulation, const std::string& place) {
  std::vector<Fault> faults;
  for (const DocumentFault& fault : identityFaults(sceneIdentity(simulation.scene()), header.at("scene")))
    faults.push_back({place + ":/scene" + fault.pointer, fault.message});
  if (const Json expected = originEntry(simulation.scene()), found = header.value("origin", originEntry({}));
      faults.empty() && found != expected)
    throw InputError(place + ":/origin", "expected positions relative to " + compactJson(expected) +
                                             ", found " + compactJson(found) +
                                             "; another version of migiwa wrote it");
  if (faults.empty()) return;
  faults.back().message += "; a save goes on only with the scene and the settings that it was made with";
  throw InputError(std::move(faults));
}

}  // namespace

void writeSave(const fs::path& file, Simulation& simulation, SettledSampler& sampler,
               const std::vector<Override>& overrides) {
  if (!simulation.goodState())
    throw InputError(file.string(),
                     "expected a run that can go on, found one that has lost particles or is not finite");
  StateWriter writer;
  simulation.visitState(writer);
  sampler.visit(writer);

  Json header = Json::object();
  header["scene_file"] = simulation.scene().file.string();
  header["overrides"] = Json::array();
  for (const Override& override : overrides)
    header["overrides"].push_back(override.pointer + "=" + override.value);
  header["time"] = simulation.time();
  header["frame"] = simulation.frame();
  header["particles"] = simulation.view().ids.size();
  header["state_hash"] = hexDigits(simulation.stateHash());
  header["scene"] = sceneIdentity(simulation.scene());
  if (!simulation.scene().origin.isZero(0)) header["origin"] = originEntry(simulation.scene());
  header["values"] = std::move(writer.values);
  header["arrays"] = std::move(writer.list);
  const std::string text = prettyJson(header);

  const Head head{
      kMagic, kVersion, kOrder, text.size(), writer.arrays.size(), checksumOf(text, writer.arrays)};
  std::array<char, sizeof head> headBytes;
  std::memcpy(headBytes.data(), &head, sizeof head);
  const std::array<std::string_view, 3> pieces{std::string_view(headBytes.data(), headBytes.size()), text,
                                               writer.arrays};
  writeFile(file, pieces, Outlasting::theMachine);
}

void readSave(const fs::path& file, Simulation& simulation, SettledSampler& sampler) {
  const std::string place = file.string();
  const std::string content = readAll(file);
  const SavedParts parts = partsOf(content, place);
  try {
    const Json header = readJson(parts.header);
    requireSameScene(header, simulation, place);
    StateReader reader(header, parts.arrays);
    simulation.visitState(reader);
    sampler.visit(reader);
    reader.requireAllRead();
    if (hexDigits(simulation.stateHash()) != header.at("state_hash").get<std::string>())
      throw StateError("the state hash that it was saved with, found another");
  } catch (const StateError& error) {
    throw InputError(place, std::string("expected ") + error.what());
  } catch (const Json::exception& error) {
    throw InputError(
        place, std::string("expected the header of a save, found something else (") + error.what() + ")");
  }
}

}  // namespace migiwa
