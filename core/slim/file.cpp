#include "core/slim/file.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "core/base/messages.h"

namespace migiwa {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "migiwa-slim";
constexpr int kVersion = 2;
constexpr std::size_t kMostNodes = 50'000'000;
constexpr const char* kLayout[] = {"centre", "radius", "normal", "tangent", "coefficients", "error"};
static_assert(std::endian::native == std::endian::little, "nodes are written as they lie in memory");

std::size_t floatsPerNode(int degree) {
  return 3 + 1 + 3 + 3 + static_cast<std::size_t>(slimTerms(degree)) + 1;
}

[[noreturn]] void fail(const std::string& name, const std::string& pointer, const std::string& message) {
  throw InputError(name + ":" + pointer, message);
}

std::string shown(const Json& value) {
  std::string text =
      value.is_discarded() ? "nothing" : value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 40) text = text.substr(0, 40) + "...";
  return text;
}

/// The value of a key, which must be there.
const Json& at(const Json& object, std::string_view pointer, const char* key, std::string_view name,
               std::string_view expected) {
  const auto found = object.find(key);
  if (found == object.end())
    fail(std::string(name), std::string(pointer) + "/" + key,
         "expected " + std::string(expected) + ", found nothing");
  return *found;
}

std::size_t wholeNumber(const Json& object, const std::string& pointer, const char* key,
                        const std::string& name, std::size_t least, std::size_t most) {
  const std::string expected =
      "a whole number in [" + std::to_string(least) + ", " + std::to_string(most) + "]";
  const Json& value = at(object, pointer, key, name, expected);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() < least || value.get<std::uint64_t>() > most)
    fail(name, pointer + "/" + key, "expected " + expected + ", found " + shown(value));
  return static_cast<std::size_t>(value.get<std::uint64_t>());
}

SlimStatistics readStatistics(const Json& root, const std::string& name) {
  SlimStatistics statistics;
  const Json& object = at(root, "", "statistics", name, "an object");
  if (!object.is_object()) fail(name, "/statistics", "expected an object, found " + shown(object));
  for (const char* key : {"largest", "mean"}) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number() || !(found->get<double>() >= 0))
      fail(name, std::string("/statistics/") + key,
           "expected a number that is not negative, found " +
               (found == object.end() ? "nothing" : shown(*found)));
    (std::strcmp(key, "mean") == 0 ? statistics.mean : statistics.largest) = found->get<double>();
  }
  if (const auto source = object.find("source"); source != object.end() && source->is_string())
    statistics.source = source->get<std::string>();
  if (const auto points = object.find("points"); points != object.end() && points->is_number_unsigned())
    statistics.points = points->get<std::size_t>();
  return statistics;
}

SlimNode readNode(const float* values, int degree) {
  SlimNode node;
  node.centre = {values[0], values[1], values[2]};
  node.radius = values[3];
  node.normal = {values[4], values[5], values[6]};
  node.tangent = {values[7], values[8], values[9]};
  const auto terms = static_cast<std::size_t>(slimTerms(degree));
  for (std::size_t k = 0; k < terms; ++k) node.coefficients[k] = values[10 + k];
  node.error = values[10 + terms];
  return node;
}

/// What is wrong with a node, or nothing.
std::string faultOf(const SlimNode& node) {
  bool finite = node.centre.allFinite() && node.normal.allFinite() && node.tangent.allFinite();
  finite = finite && std::isfinite(node.error) && std::isfinite(node.radius);
  for (const float c : node.coefficients) finite = finite && std::isfinite(c);
  if (!finite) return "expected finite numbers, found one that is not";
  if (node.centre.cwiseAbs().maxCoeff() > 1e7F)
    return "expected a centre within 1e7 of the origin, found one beyond";
  if (!(node.radius > 0)) return "expected a positive radius, found " + std::to_string(node.radius);
  if (std::abs(node.normal.norm() - 1) > 1e-3F || std::abs(node.tangent.norm() - 1) > 1e-3F ||
      std::abs(node.normal.dot(node.tangent)) > 1e-3F)
    return "expected a unit normal and a unit tangent across it, found others";
  return {};
}

Json layout() {
  Json parts = Json::array();
  for (const char* part : kLayout) parts.push_back(part);
  return parts;
}

std::string encodeNodes(const std::vector<SlimNode>& nodes, int degree) {
  std::vector<float> values;
  values.reserve(nodes.size() * floatsPerNode(degree));
  for (const SlimNode& node : nodes) {
    for (const Vec3f* v : {&node.centre, &node.normal, &node.tangent}) {
      values.insert(values.end(), v->data(), v->data() + 3);
      if (v == &node.centre) values.push_back(node.radius);
    }
    values.insert(values.end(), node.coefficients.begin(), node.coefficients.begin() + slimTerms(degree));
    values.push_back(node.error);
  }
  return base64(std::as_bytes(std::span(values)));
}

/// The bytes of a key, which must be so many.
std::vector<std::byte> readBytes(const Json& object, const std::string& pointer, const char* key,
                                 const std::string& name, std::size_t count, std::size_t each) {
  const Json& encoded = at(object, pointer, key, name, "a text in base64");
  const std::string place = pointer + "/" + key;
  std::vector<std::byte> bytes;
  if (!encoded.is_string() || !decodeBase64(encoded.get_ref<const std::string&>(), bytes))
    fail(name, place, "expected a text in base64, found something else");
  if (bytes.size() != count * each)
    fail(name, place,
         "expected " + std::to_string(count * each) + " bytes for " + std::to_string(count) +
             " nodes, found " + std::to_string(bytes.size()));
  return bytes;
}

std::vector<SlimNode> readNodes(const Json& object, const std::string& pointer, int degree,
                                const std::string& name) {
  const std::size_t count = wholeNumber(object, pointer, "nodes", name, 1, kMostNodes);
  const std::size_t width = floatsPerNode(degree);
  const std::vector<std::byte> bytes = readBytes(object, pointer, "data", name, count, width * sizeof(float));
  std::vector<float> values(count * width);
  std::memcpy(values.data(), bytes.data(), bytes.size());
  std::vector<SlimNode> nodes;
  nodes.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    nodes.push_back(readNode(&values[k * width], degree));
    if (const std::string fault = faultOf(nodes.back()); !fault.empty())
      fail(name, pointer + "/data: node " + std::to_string(k), fault);
  }
  return nodes;
}

SlimHierarchy readHierarchy(const Json& object, const SlimData& data, const std::string& name) {
  SlimHierarchy hierarchy;
  hierarchy.merged = readNodes(object, "/hierarchy", data.degree, name);
  const std::size_t count = hierarchy.merged.size(), leaves = data.nodes.size();
  const std::vector<std::byte> bytes =
      readBytes(object, "/hierarchy", "children", name, count, sizeof(hierarchy.children[0]));
  hierarchy.children.resize(count);
  std::memcpy(hierarchy.children.data(), bytes.data(), bytes.size());
  std::vector<bool> taken(leaves + count, false);
  for (std::size_t k = 0; k < count; ++k) {
    const std::string place = "/hierarchy/children: node " + std::to_string(k);
    for (const std::uint32_t child : hierarchy.children[k]) {
      if (child >= leaves + k)
        fail(name, place, "expected children before their parent, found number " + std::to_string(child));
      if (taken[child])
        fail(name, place, "expected one parent a node, found a second one of " + std::to_string(child));
      taken[child] = true;
      const SlimNode& node = child < leaves ? data.nodes[child] : hierarchy.merged[child - leaves];
      if (hierarchy.merged[k].error < node.error)
        fail(name, place, "expected an error at least as large as the children's, found a smaller one");
    }
  }
  return hierarchy;
}

}  // namespace

std::string slimFileText(const SlimData& data) {
  Json statistics = Json::object();
  statistics["source"] = data.statistics.source;
  statistics["largest"] = data.statistics.largest;
  statistics["mean"] = data.statistics.mean;
  statistics["points"] = data.statistics.points;
  Json root = Json::object();
  root["format"] = kFormat;
  root["version"] = kVersion;
  root["degree"] = data.degree;
  root["closed"] = data.closed;
  root["nodes"] = data.nodes.size();
  root["statistics"] = std::move(statistics);
  root["layout"] = layout();
  root["data"] = encodeNodes(data.nodes, data.degree);
  if (!data.hierarchy.merged.empty()) {
    Json hierarchy = Json::object();
    hierarchy["nodes"] = data.hierarchy.merged.size();
    hierarchy["data"] = encodeNodes(data.hierarchy.merged, data.degree);
    hierarchy["children"] = base64(std::as_bytes(std::span(data.hierarchy.children)));
    root["hierarchy"] = std::move(hierarchy);
  }
  return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

SlimData parseSlimFile(const std::string& text, const std::string& name) {
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::parse_error& error) {
    fail(name, "byte " + std::to_string(error.byte),
         "expected a file of a SLIM surface (JSON), found one that ends or breaks here");
  } catch (const Json::out_of_range&) {
    fail(name, "/", "expected numbers below 1.8e308, found one beyond");
  }
  if (!root.is_object() || root.find("format") == root.end() || root["format"] != kFormat)
    fail(name, "/format",
         std::string("expected \"") + kFormat +
             "\", the mark of a SLIM surface that migiwa slim has written, found " +
             (root.is_object() && root.find("format") != root.end() ? shown(root["format"]) : "nothing"));
  const auto version = static_cast<int>(wholeNumber(root, "", "version", name, 0, 1'000'000));
  if (version < 1 || version > kVersion)
    fail(name, "/version",
         "expected 1 or 2, the versions that this program reads, found " + std::to_string(version));

  SlimData data;
  data.degree = static_cast<int>(wholeNumber(root, "", "degree", name, 1, kLargestSlimDegree));
  const Json& closed = at(root, "", "closed", name, "true or false");
  if (!closed.is_boolean()) fail(name, "/closed", "expected true or false, found " + shown(closed));
  data.closed = closed.get<bool>();
  data.statistics = readStatistics(root, name);
  const Json expected = layout();
  if (at(root, "", "layout", name, shown(expected)) != expected)
    fail(name, "/layout", "expected " + expected.dump() + ", found " + shown(root["layout"]));
  data.nodes = readNodes(root, "", data.degree, name);
  if (const auto hierarchy = root.find("hierarchy"); hierarchy != root.end()) {
    if (!hierarchy->is_object()) fail(name, "/hierarchy", "expected an object, found " + shown(*hierarchy));
    data.hierarchy = readHierarchy(*hierarchy, data, name);
  }
  return data;
}

SlimData readSlimFile(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::exists(file, code))
    throw InputError(file.string(),
                     "expected a file of a SLIM surface, found no such file; migiwa slim writes them");
  if (std::filesystem::is_directory(file, code))
    throw InputError(file.string(), "expected a file of a SLIM surface, found a folder");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in)
    throw InputError(file.string(), "expected a file of a SLIM surface, found one that cannot be read");
  return parseSlimFile(text.str(), file.string());
}

namespace {
constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
}

std::string base64(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i)
      group = group << 8 | (k + i < bytes.size() ? std::to_integer<std::uint32_t>(bytes[k + i]) : 0);
    for (std::size_t i = 0; i < 4; ++i)
      text.push_back(k + i > bytes.size() ? '=' : kDigits[group >> (18 - 6 * i) & 63]);
  }
  return text;
}

bool decodeBase64(std::string_view text, std::vector<std::byte>& bytes) {
  static const std::array<std::int8_t, 256> kValues = [] {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    for (std::size_t k = 0; k < kDigits.size(); ++k)
      values[static_cast<unsigned char>(kDigits[k])] = static_cast<std::int8_t>(k);
    return values;
  }();
  bytes.clear();
  if (text.size() % 4 != 0) return false;
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t k = 0; k < text.size(); k += 4) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int8_t value =
          k + i >= text.size() - padding ? std::int8_t{0} : kValues[static_cast<unsigned char>(text[k + i])];
      if (value < 0) return false;
      group = group << 6 | static_cast<std::uint32_t>(value);
    }
    for (std::size_t i = 0; i < 3; ++i) bytes.push_back(static_cast<std::byte>(group >> (16 - 8 * i) & 255));
  }
  bytes.resize(bytes.size() - padding);
  return true;
}

}  // namespace migiwa
