// The scene format for editors and for people: what structs visit, written as a JSON Schema (draft 2020-12)
// and, from that, as Markdown tables. The schema's list of fields is the one that the reader goes through, so
// the two cannot disagree about keys, ranges and names. What only code can check (min beyond max) is not in
// it.
#include <algorithm>
#include <cmath>
#include <map>

#include "core/scene/json.h"
#include "core/scene/scene_file.h"

namespace migiwa {

namespace {

// What a schema says to the reference alone, until publish() takes it out.
constexpr std::string_view kUnitNote = "unit";
constexpr std::string_view kKindNote = "kind";

/// A number without a needless ".0".
Json plainNumber(double value) {
  if (std::floor(value) == value && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

Json plainNumbers(std::span<const double> values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(plainNumber(value));
  return array;
}

/// Of numbers in a range, "number" or "integer".
Json numberSchema(std::string_view type, const Range& range) {
  Json schema{{"type", type}};
  if (std::isfinite(range.min))
    schema[range.openMin ? "exclusiveMinimum" : "minimum"] = plainNumber(range.min);
  if (std::isfinite(range.max))
    schema[range.openMax ? "exclusiveMaximum" : "maximum"] = plainNumber(range.max);
  return schema;
}

/// An array of so many numbers.
Json numbersSchema(std::size_t size, const Range& range) {
  return {
      {"type", "array"}, {"items", numberSchema("number", range)}, {"minItems", size}, {"maxItems", size}};
}

class SchemaWriter final : public FieldVisitor {
 public:
  /// Schemas of lists, by name; a list's schema is a reference to one of them.
  using Definitions = std::map<std::string, Json>;

  /// The schema of the object. `partial`: of what is merged over another object, where no key is required and
  /// null takes one out; the entries of its lists are whole objects all the same.
  static Json write(const Fields& fields, Definitions& definitions, bool partial) {
    SchemaWriter writer("", definitions, partial);
    fields(writer);
    return writer.closed();
  }

  void number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) override {
    put(key, numberSchema("number", range), doc, plainNumber(value));
  }
  void integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) override {
    put(key, numberSchema("integer", range), doc, value);
  }
  void boolean(std::string_view key, bool& value, const FieldDoc& doc) override {
    put(key, {{"type", "boolean"}}, doc, value);
  }
  void text(std::string_view key, std::string& value, const FieldDoc& doc) override {
    put(key, {{"type", "string"}}, doc, value.empty() ? Json() : Json(value));
  }
  void file(std::string_view key, FileName& value, const FieldDoc& doc) override {
    text(key, value.written, doc);
    properties_[key][kKindNote] = "file name";
  }
  void vector(std::string_view key, Vec3d& value, const FieldDoc& doc) override {
    put(key, numbersSchema(3, kCoordinateRange), doc, plainNumbers({value.data(), 3}));
  }
  void triples(std::string_view key, std::vector<std::array<double, 3>>&, const FieldDoc& doc) override {
    put(key, {{"type", "array"}, {"items", numbersSchema(3, {})}}, doc);
  }
  void pair(std::string_view key, std::array<double, 2>& value, const FieldDoc& doc, bool* present) override {
    put(key, numbersSchema(2, kCoordinateRange), doc, present == nullptr ? plainNumbers(value) : Json());
  }
  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override {
    put(key, {{"enum", Json(std::vector<std::string>(names.begin(), names.end()))}}, doc,
        index < 0 ? Json() : Json(names[static_cast<std::size_t>(index)]));
  }
  void object(std::string_view key, const FieldDoc& doc, const Fields& fields, bool*) override {
    SchemaWriter inner(childPointer(pointer_, key), definitions_, partial_);
    fields(inner);
    put(key, inner.closed(), doc);
  }
  void list(std::string_view key, std::size_t size, const FieldDoc& doc, const Element& element) override {
    const std::string pointer = childPointer(pointer_, key);
    std::string name = pointer.substr(1);
    std::replace(name.begin(), name.end(), '/', '_');
    if (!definitions_.contains(name)) {
      SchemaWriter entry(pointer, definitions_, false);
      element(entry, size);
      definitions_[name] = entry.closed();
    }
    put(key, {{"type", "array"}, {"items", {{"$ref", "#/$defs/" + name}}}}, doc);
  }
  void variant(std::string_view key, int& index, std::span<const std::string_view> names, const FieldDoc& doc,
               const Variant& fields) override {
    choice(key, index, names, doc);
    for (std::size_t k = 0; k < names.size(); ++k) {
      SchemaWriter inner(childPointer(pointer_, names[k]), definitions_, partial_);
      fields(inner, static_cast<int>(k));
      const std::string decider(key);
      conditions_.push_back(
          {{"if", {{"properties", {{decider, {{"const", names[k]}}}}}, {"required", Json::array({decider})}}},
           {"then", inner.open()}});
    }
  }
  /// Nothing has been read: there is nothing to check across keys.
  bool valid(std::initializer_list<std::string_view>) const override { return false; }

 private:
  SchemaWriter(std::string pointer, Definitions& definitions, bool partial)
      : pointer_(std::move(pointer)), definitions_(definitions), partial_(partial) {}

  /// `value`: the default, null for none.
  void put(std::string_view key, Json schema, const FieldDoc& doc, Json value = nullptr) {
    schema["description"] = doc.description;
    if (!doc.unit.empty()) schema[kUnitNote] = doc.unit;
    if (partial_) {
      if (schema.contains("type")) schema["type"] = Json::array({schema["type"], "null"});
      if (schema.contains("enum")) schema["enum"].push_back(nullptr);
    } else if (doc.presence == Presence::required) {
      required_.push_back(key);
    } else if (!value.is_null()) {
      schema["default"] = std::move(value);
    }
    properties_[key] = std::move(schema);
  }

  /// Without a word on keys that it does not name.
  Json open() const {
    Json schema{{"properties", properties_}};
    if (!required_.empty()) schema["required"] = required_;
    if (!conditions_.empty()) schema["allOf"] = conditions_;
    return schema;
  }

  Json closed() const {
    Json schema{{"type", "object"}};
    schema.update(open());
    // Keys that only a condition knows are known to the one that looks at what is left unevaluated.
    schema[conditions_.empty() ? "additionalProperties" : "unevaluatedProperties"] = false;
    return schema;
  }

  std::string pointer_;
  Definitions& definitions_;
  bool partial_;
  Json properties_ = Json::object();
  Json required_ = Json::array();
  Json conditions_ = Json::array();  ///< what follows from the deciding key of a variant
};

/// The whole document, with the notes for the reference.
Json annotatedSchema() {
  const auto fields = [](FieldVisitor& visitor) {
    Scene scene;
    describeScene(visitor, scene);
  };
  const Json include{{"type", "string"}, {"minLength", 1}, {"description", kIncludeDoc.description}};
  const Json set{{"type", "object"},
                 {"propertyNames", {{"pattern", "^(/([^~]|~[01])*)+$"}}},
                 {"description", kSetDoc.description}};
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Migiwa scene, format 1"},
              {"description", "Written by `./run schema` from the program's own list of keys."},
              {"type", "object"},
              {"if", {{"required", Json::array({kIncludeKey})}}},
              {"then", {{"$ref", "#/$defs/variant"}}},
              {"else", {{"$ref", "#/$defs/scene"}}}};
  SchemaWriter::Definitions lists;
  Json& definitions = schema["$defs"];
  definitions["scene"] = SchemaWriter::write(fields, lists, false);
  definitions["variant"] = SchemaWriter::write(fields, lists, true);
  for (const char* kind : {"scene", "variant"}) definitions[kind]["properties"][kSetKey] = set;
  definitions["variant"]["properties"][kIncludeKey] = include;
  for (auto& [name, list] : lists) definitions[name] = std::move(list);
  return schema;
}

/// Puts the units into the descriptions and takes the notes out. A property's name is never one of a note's.
void publish(Json& schema) {
  if (schema.is_object() && schema.contains("description") && schema["description"].is_string()) {
    const std::string unit = schema.value(std::string(kUnitNote), "1");
    if (unit != "1") schema["description"].get_ref<std::string&>() += " Unit: " + unit + ".";
    schema.erase(kUnitNote);
    schema.erase(kKindNote);
  }
  if (schema.is_structured())
    for (Json& inner : schema) publish(inner);
}

std::string code(std::string_view text) {
  return "`" + std::string(text) + "`";
}

/// Every key of a schema in Markdown tables with its kind, range, unit, default and meaning: a table for each
/// object of the outermost one, and for each variant of what its lists hold.
class Reference {
 public:
  explicit Reference(const Json& definitions) : definitions_(definitions) {}

  std::string write(const Json& object) {
    addRows(newTable("", ""), "", object);
    std::string text;
    for (const Table& table : tables_) {
      if (!table.pointer.empty()) text += "\n### " + table.title() + "\n\n";
      if (!table.description.empty()) text += table.description + "\n\n";
      if (!table.rows.empty())
        text += "| key | value | unit | default | meaning |\n|---|---|---|---|---|\n" + table.rows;
    }
    return text;
  }

 private:
  struct Table {
    std::string pointer;      ///< of the object whose keys the rows are; empty for the outermost
    std::string variant;      ///< the deciding key with its value, if that is what the rows follow from
    std::string description;  ///< one sentence
    std::string rows;

    std::string title() const { return code(pointer) + (variant.empty() ? "" : " with " + code(variant)); }
  };

  std::size_t newTable(std::string pointer, std::string description, std::string variant = "") {
    tables_.push_back({std::move(pointer), std::move(variant), std::move(description), ""});
    return tables_.size() - 1;
  }

  /// `prefix`: of the keys in the table, for objects within the table's.
  void addRows(std::size_t table, const std::string& prefix, const Json& object) {
    const Json required = object.value("required", Json::array());
    const Json properties = object.value("properties", Json::object());
    for (const auto& [key, schema] : properties.items()) {
      const bool isRequired = std::find(required.begin(), required.end(), key) != required.end();
      const std::string place = tables_[table].pointer + "/" + prefix + key;
      const bool ownTable = table == 0 && schema.contains("properties");
      const std::string kind = ownTable ? "object, see " + code(place) : kindOf(schema);
      for (const std::string& cell :
           {code(prefix + key), kind, schema.value(std::string(kUnitNote), ""),
            isRequired ? "required" : defaultOf(schema), schema["description"].get<std::string>()})
        tables_[table].rows.append("| ").append(escaped(cell)).append(" ");
      tables_[table].rows += "|\n";
      if (ownTable) {
        addRows(newTable(place, schema["description"]), "", schema);
      } else if (schema.contains("properties")) {
        addRows(table, prefix + key + "/", schema);
      } else if (schema.contains("items") && schema["items"].contains("$ref")) {
        addEntries(table, prefix + key + "/N", place + "/N", schema);
      }
      addVariants(table, key, object);
    }
  }

  /// Tables of what follows from the values of a key.
  void addVariants(std::size_t table, const std::string& key, const Json& object) {
    for (const Json& condition : object.value("allOf", Json::array())) {
      const Json& deciders = condition["if"]["properties"];
      if (!deciders.contains(key)) continue;
      const std::string variant = compactJson(Json(key)) + ": " + compactJson(deciders[key]["const"]);
      addRows(newTable(tables_[table].pointer, "", variant), "", condition["then"]);
    }
  }

  /// The keys of what a list holds.
  void addEntries(std::size_t table, const std::string& prefix, const std::string& place, const Json& list) {
    const auto& reference = list["items"]["$ref"].get_ref<const std::string&>();
    const Json& entry = definitions_[reference.substr(reference.rfind('/') + 1)];
    // Within an entry of another list already, a table of its own would be hard to find.
    if (!tables_[table].variant.empty()) return addRows(table, prefix + "/", entry);
    addRows(newTable(place, list["description"]), "", entry);
  }

  static std::string kindOf(const Json& schema) {
    if (schema.contains(kKindNote)) return schema[kKindNote];
    if (schema.contains("enum")) {
      std::string names;
      for (const std::string name : schema["enum"]) names += (names.empty() ? "" : ", ") + code(name);
      return names;
    }
    const auto& type = schema["type"].get_ref<const std::string&>();
    if (type == "number") return ranged("number", schema);
    if (type == "integer") return ranged("whole number", schema);
    if (type == "boolean") return "true or false";
    if (type == "string") return "text";
    if (type == "object") return "object";
    if (schema["items"].contains("$ref")) return "list of objects";
    if (schema.contains("minItems")) return compactJson(schema["minItems"]) + " numbers";
    return "list of " + compactJson(schema["items"]["minItems"]) + " numbers each";
  }

  static std::string ranged(const std::string& kind, const Json& schema) {
    Range range;
    range.openMin = schema.contains("exclusiveMinimum");
    range.openMax = schema.contains("exclusiveMaximum");
    range.min = schema.value(range.openMin ? "exclusiveMinimum" : "minimum", range.min);
    range.max = schema.value(range.openMax ? "exclusiveMaximum" : "maximum", range.max);
    return range.min == range.max ? range.text() : kind + " " + range.text();
  }

  static std::string defaultOf(const Json& schema) {
    if (!schema.contains("default")) return "";
    const Json& value = schema["default"];
    if (value.is_array()) {
      std::string text;
      for (const Json& number : value) text += (text.empty() ? "" : ", ") + compactJson(number);
      return "[" + text + "]";
    }
    if (!value.is_string()) return compactJson(value);
    return schema.contains("enum") ? code(value.get<std::string>()) : value.get<std::string>();
  }

  /// In a table's cell.
  static std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
    return result;
  }

  const Json& definitions_;
  std::vector<Table> tables_;
};

}  // namespace

std::string sceneSchema() {
  Json schema = annotatedSchema();
  publish(schema);
  return prettyJson(schema);
}

std::string sceneReference() {
  const Json schema = annotatedSchema();
  Json scene = schema["$defs"]["scene"];
  // What is read before all others comes first.
  Json properties;
  for (const std::string_view key : {kIncludeKey, kSetKey})
    properties[key] = schema["$defs"]["variant"]["properties"][key];
  properties.update(scene["properties"]);
  scene["properties"] = std::move(properties);
  return Reference(schema["$defs"]).write(scene);
}

}  // namespace migiwa
