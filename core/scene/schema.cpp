// Writes what structs visit as a JSON Schema (draft 2020-12): the same list of fields that the reader goes
// through, so the two cannot disagree about keys, ranges and names. What only code can check (min beyond max)
// is not in it.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "core/base/fields.h"
#include "core/scene/json.h"
#include "core/scene/scene_file.h"

namespace migiwa {

/// A number without a needless ".0".
Json plainNumber(double value);

class SchemaWriter final : public FieldVisitor {
 public:
  /// Schemas of lists, by name; a list's schema is a reference to one of them.
  using Definitions = std::map<std::string, Json>;

  /// The schema of the object. `partial`: of what is merged over another object, where no key is required and
  /// null takes one out; the entries of its lists are whole objects all the same.
  static Json write(const Fields& fields, Definitions& definitions, bool partial);

  void number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) override;
  void integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) override;
  void boolean(std::string_view key, bool& value, const FieldDoc& doc) override;
  void text(std::string_view key, std::string& value, const FieldDoc& doc) override;
  void vector(std::string_view key, Vec3d& value, const FieldDoc& doc) override;
  void triples(std::string_view key, std::vector<std::array<double, 3>>& values,
               const FieldDoc& doc) override;
  void pair(std::string_view key, std::array<double, 2>& value, const FieldDoc& doc, bool* present) override;
  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override;
  void object(std::string_view key, const FieldDoc& doc, const Fields& fields, bool* present) override;
  void list(std::string_view key, std::size_t size, const FieldDoc& doc,
            const std::function<void(FieldVisitor&, std::size_t)>& element) override;
  void variant(std::string_view key, int& index, std::span<const std::string_view> names, const FieldDoc& doc,
               const std::function<void(FieldVisitor&, int)>& fields) override;
  void fault(std::string_view, std::string_view) override {}
  /// Nothing has been read: there is nothing to check across keys.
  bool valid(std::initializer_list<std::string_view>) const override { return false; }

 private:
  SchemaWriter(std::string pointer, Definitions& definitions, bool partial)
      : pointer_(std::move(pointer)), definitions_(definitions), partial_(partial) {}

  /// `value`: the default, null for none.
  void put(std::string_view key, Json schema, const FieldDoc& doc, Json value = nullptr);
  /// Without a word on keys that it does not name.
  Json open() const;
  Json closed() const;

  std::string pointer_;
  Definitions& definitions_;
  bool partial_;
  Json properties_ = Json::object();
  Json required_ = Json::array();
  Json conditions_ = Json::array();  ///< what follows from the deciding key of a variant
};

// Writes what structs visit as a reference for people: Markdown tables with each key's kind, range, unit,
// default and meaning. The same list of fields that the reader goes through.

class ReferenceWriter final : public FieldVisitor {
 public:
  /// A table for each object of the outermost one, and for each variant of what its lists hold.
  static std::string write(const Fields& fields);

  void number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) override;
  void integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) override;
  void boolean(std::string_view key, bool& value, const FieldDoc& doc) override;
  void text(std::string_view key, std::string& value, const FieldDoc& doc) override;
  void file(std::string_view key, FileName& value, const FieldDoc& doc) override;
  void vector(std::string_view key, Vec3d& value, const FieldDoc& doc) override;
  void triples(std::string_view key, std::vector<std::array<double, 3>>& values,
               const FieldDoc& doc) override;
  void pair(std::string_view key, std::array<double, 2>& value, const FieldDoc& doc, bool* present) override;
  void choice(std::string_view key, int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override;
  void object(std::string_view key, const FieldDoc& doc, const Fields& fields, bool* present) override;
  void list(std::string_view key, std::size_t size, const FieldDoc& doc,
            const std::function<void(FieldVisitor&, std::size_t)>& element) override;
  void variant(std::string_view key, int& index, std::span<const std::string_view> names, const FieldDoc& doc,
               const std::function<void(FieldVisitor&, int)>& fields) override;
  void fault(std::string_view, std::string_view) override {}
  bool valid(std::initializer_list<std::string_view>) const override { return false; }

 private:
  /// The rows of one table, and the tables that come after it.
  struct Table {
    std::string title;        ///< a JSON pointer
    std::string description;  ///< one sentence
    std::string rows;
  };

  ReferenceWriter(std::vector<Table>& tables, std::size_t table, std::string prefix)
      : tables_(tables), table_(table), prefix_(std::move(prefix)) {}

  void row(std::string_view key, const std::string& kind, const FieldDoc& doc, const std::string& value);
  std::size_t newTable(std::string title, std::string_view description);
  /// Whether this writer is at the outermost object, whose objects have tables of their own.
  bool outermost() const { return table_ == 0 && prefix_.empty(); }

  std::vector<Table>& tables_;
  std::size_t table_;
  std::string prefix_;  ///< of the keys in the table, for objects within the table's
};

namespace {

void addRange(const Range& range, Json& schema) {
  if (std::isfinite(range.min))
    schema[range.openMin ? "exclusiveMinimum" : "minimum"] = plainNumber(range.min);
  if (std::isfinite(range.max))
    schema[range.openMax ? "exclusiveMaximum" : "maximum"] = plainNumber(range.max);
}

/// An array of so many numbers.
Json numbersSchema(std::size_t size, const Range& range) {
  Json entry{{"type", "number"}};
  addRange(range, entry);
  return {{"type", "array"}, {"items", std::move(entry)}, {"minItems", size}, {"maxItems", size}};
}

Json plainNumbers(std::span<const double> values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(plainNumber(value));
  return array;
}

Json namesSchema(std::span<const std::string_view> names) {
  Json array = Json::array();
  for (const std::string_view name : names) array.push_back(std::string(name));
  return {{"enum", std::move(array)}};
}

/// "/boundary/surfaces" as a name for $defs.
std::string definitionName(std::string pointer) {
  pointer.erase(0, 1);
  std::replace(pointer.begin(), pointer.end(), '/', '_');
  return pointer;
}

}  // namespace

Json plainNumber(double value) {
  if (std::floor(value) == value && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

Json SchemaWriter::write(const Fields& fields, Definitions& definitions, bool partial) {
  SchemaWriter writer("", definitions, partial);
  fields(writer);
  return writer.closed();
}

void SchemaWriter::put(std::string_view key, Json schema, const FieldDoc& doc, Json value) {
  std::string description(doc.description);
  if (!doc.unit.empty() && doc.unit != "1") description += " Unit: " + std::string(doc.unit) + ".";
  schema["description"] = std::move(description);
  if (partial_) {
    if (schema.contains("type")) schema["type"] = Json::array({schema["type"], "null"});
    if (schema.contains("enum")) schema["enum"].push_back(nullptr);
  } else if (doc.presence == Presence::required) {
    required_.push_back(std::string(key));
  } else if (!value.is_null()) {
    schema["default"] = std::move(value);
  }
  properties_[std::string(key)] = std::move(schema);
}

void SchemaWriter::number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) {
  Json schema{{"type", "number"}};
  addRange(range, schema);
  put(key, std::move(schema), doc, plainNumber(value));
}

void SchemaWriter::integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) {
  Json schema{{"type", "integer"}};
  addRange(range, schema);
  put(key, std::move(schema), doc, value);
}

void SchemaWriter::boolean(std::string_view key, bool& value, const FieldDoc& doc) {
  put(key, {{"type", "boolean"}}, doc, value);
}

void SchemaWriter::text(std::string_view key, std::string& value, const FieldDoc& doc) {
  put(key, {{"type", "string"}}, doc, value.empty() ? Json() : Json(value));
}

void SchemaWriter::vector(std::string_view key, Vec3d& value, const FieldDoc& doc) {
  put(key, numbersSchema(3, kCoordinateRange), doc, plainNumbers({value.data(), 3}));
}

void SchemaWriter::triples(std::string_view key, std::vector<std::array<double, 3>>&, const FieldDoc& doc) {
  put(key, {{"type", "array"}, {"items", numbersSchema(3, {})}}, doc);
}

void SchemaWriter::pair(std::string_view key, std::array<double, 2>& value, const FieldDoc& doc,
                        bool* present) {
  put(key, numbersSchema(2, kCoordinateRange), doc, present == nullptr ? plainNumbers(value) : Json());
}

void SchemaWriter::choice(std::string_view key, int& index, std::span<const std::string_view> names,
                          const FieldDoc& doc) {
  put(key, namesSchema(names), doc,
      index < 0 ? Json() : Json(std::string(names[static_cast<std::size_t>(index)])));
}

void SchemaWriter::object(std::string_view key, const FieldDoc& doc, const Fields& fields, bool*) {
  SchemaWriter inner(childPointer(pointer_, key), definitions_, partial_);
  fields(inner);
  put(key, inner.closed(), doc);
}

void SchemaWriter::list(std::string_view key, std::size_t size, const FieldDoc& doc,
                        const std::function<void(FieldVisitor&, std::size_t)>& element) {
  const std::string pointer = childPointer(pointer_, key);
  const std::string name = definitionName(pointer);
  if (!definitions_.contains(name)) {
    SchemaWriter entry(pointer, definitions_, false);
    element(entry, size);
    definitions_[name] = entry.closed();
  }
  put(key, {{"type", "array"}, {"items", {{"$ref", "#/$defs/" + name}}}}, doc);
}

void SchemaWriter::variant(std::string_view key, int& index, std::span<const std::string_view> names,
                           const FieldDoc& doc, const std::function<void(FieldVisitor&, int)>& fields) {
  choice(key, index, names, doc);
  for (std::size_t k = 0; k < names.size(); ++k) {
    SchemaWriter inner(pointer_ + "/" + std::string(names[k]), definitions_, partial_);
    fields(inner, static_cast<int>(k));
    const std::string decider(key);
    conditions_.push_back({{"if",
                            {{"properties", {{decider, {{"const", std::string(names[k])}}}}},
                             {"required", Json::array({decider})}}},
                           {"then", inner.open()}});
  }
}

Json SchemaWriter::open() const {
  Json schema{{"properties", properties_}};
  if (!required_.empty()) schema["required"] = required_;
  if (!conditions_.empty()) schema["allOf"] = conditions_;
  return schema;
}

Json SchemaWriter::closed() const {
  Json schema{{"type", "object"}};
  schema.update(open());
  // Keys that only a condition knows are known to the one that looks at what is left unevaluated.
  schema[conditions_.empty() ? "additionalProperties" : "unevaluatedProperties"] = false;
  return schema;
}

namespace {

std::string code(std::string_view text) {
  return "`" + std::string(text) + "`";
}

std::string numberText(double value) {
  return plainNumber(value).dump();
}

std::string numbersText(std::span<const double> values) {
  std::string text = "[";
  for (std::size_t k = 0; k < values.size(); ++k) text += (k > 0 ? ", " : "") + numberText(values[k]);
  return text + "]";
}

/// In a table's cell.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

std::string ranged(const std::string& kind, const Range& range) {
  return range.min == range.max ? range.text() : kind + " " + range.text();
}

}  // namespace

std::string ReferenceWriter::write(const Fields& fields) {
  std::vector<Table> tables{{"", "", ""}};
  ReferenceWriter writer(tables, 0, "");
  fields(writer);
  std::string text;
  for (const Table& table : tables) {
    if (!table.title.empty()) text += "\n### " + table.title + "\n\n";
    if (!table.description.empty()) text += table.description + "\n\n";
    if (!table.rows.empty())
      text += "| key | value | unit | default | meaning |\n|---|---|---|---|---|\n" + table.rows;
  }
  return text;
}

void ReferenceWriter::row(std::string_view key, const std::string& kind, const FieldDoc& doc,
                          const std::string& value) {
  const std::string shown = doc.presence == Presence::required ? "required" : value;
  tables_[table_].rows += "| " + code(prefix_ + std::string(key)) + " | " + escaped(kind) + " | " +
                          escaped(doc.unit) + " | " + escaped(shown) + " | " + escaped(doc.description) +
                          " |\n";
}

std::size_t ReferenceWriter::newTable(std::string title, std::string_view description) {
  tables_.push_back({std::move(title), std::string(description), ""});
  return tables_.size() - 1;
}

void ReferenceWriter::number(std::string_view key, double& value, const Range& range, const FieldDoc& doc) {
  row(key, ranged("number", range), doc, numberText(value));
}

void ReferenceWriter::integer(std::string_view key, int& value, const Range& range, const FieldDoc& doc) {
  row(key, ranged("whole number", range), doc, std::to_string(value));
}

void ReferenceWriter::boolean(std::string_view key, bool& value, const FieldDoc& doc) {
  row(key, "true or false", doc, value ? "true" : "false");
}

void ReferenceWriter::text(std::string_view key, std::string& value, const FieldDoc& doc) {
  row(key, "text", doc, value);
}

void ReferenceWriter::file(std::string_view key, FileName& value, const FieldDoc& doc) {
  row(key, "file name", doc, value.written);
}

void ReferenceWriter::vector(std::string_view key, Vec3d& value, const FieldDoc& doc) {
  row(key, "3 numbers", doc, numbersText({value.data(), 3}));
}

void ReferenceWriter::triples(std::string_view key, std::vector<std::array<double, 3>>&,
                              const FieldDoc& doc) {
  row(key, "list of 3 numbers each", doc, "");
}

void ReferenceWriter::pair(std::string_view key, std::array<double, 2>& value, const FieldDoc& doc,
                           bool* present) {
  row(key, "2 numbers", doc, present == nullptr ? numbersText(value) : "");
}

void ReferenceWriter::choice(std::string_view key, int& index, std::span<const std::string_view> names,
                             const FieldDoc& doc) {
  std::string kind;
  for (const std::string_view name : names) kind += (kind.empty() ? "" : ", ") + code(name);
  row(key, kind, doc, index < 0 ? "" : code(names[static_cast<std::size_t>(index)]));
}

void ReferenceWriter::object(std::string_view key, const FieldDoc& doc, const Fields& fields, bool*) {
  if (outermost()) {
    const std::string title = code("/" + std::string(key));
    const std::size_t table = newTable(title, doc.description);
    ReferenceWriter inner(tables_, table, "");
    fields(inner);
    const bool anyKeys = tables_.size() > table + 1 || !tables_[table].rows.empty();
    if (!anyKeys) tables_.pop_back();
    row(key, anyKeys ? "object, see " + title : "object", doc, "");
  } else {
    row(key, "object", doc, "");
    ReferenceWriter inner(tables_, table_, prefix_ + std::string(key) + "/");
    fields(inner);
  }
}

void ReferenceWriter::list(std::string_view key, std::size_t size, const FieldDoc& doc,
                           const std::function<void(FieldVisitor&, std::size_t)>& element) {
  row(key, "list of objects", doc, "");
  if (tables_[table_].title.find(" with ") != std::string::npos) {
    // Within an entry of another list already: a table of its own would be hard to find.
    ReferenceWriter inner(tables_, table_, prefix_ + std::string(key) + "/N/");
    return element(inner, size);
  }
  std::string pointer = tables_[table_].title.empty()
                            ? "/"
                            : tables_[table_].title.substr(1, tables_[table_].title.size() - 2) + "/";
  pointer += prefix_ + std::string(key) + "/N";
  ReferenceWriter inner(tables_, newTable(code(pointer), doc.description), "");
  element(inner, size);
}

void ReferenceWriter::variant(std::string_view key, int& index, std::span<const std::string_view> names,
                              const FieldDoc& doc, const std::function<void(FieldVisitor&, int)>& fields) {
  choice(key, index, names, doc);
  const std::string title = tables_[table_].title;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::size_t table = newTable(
        title + " with " + code("\"" + std::string(key) + "\": \"" + std::string(names[k]) + "\""), "");
    ReferenceWriter inner(tables_, table, "");
    fields(inner, static_cast<int>(k));
  }
}

namespace {

Json includeSchema() {
  return {{"type", "string"}, {"minLength", 1}, {"description", std::string(kIncludeDoc.description)}};
}

Json setSchema() {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", "^(/([^~]|~[01])*)+$"}}},
          {"description", std::string(kSetDoc.description)}};
}

}  // namespace

std::string sceneSchema() {
  const auto fields = [](FieldVisitor& visitor) {
    Scene scene;
    describeScene(visitor, scene);
  };
  SchemaWriter::Definitions lists;
  Json scene = SchemaWriter::write(fields, lists, false);
  Json variant = SchemaWriter::write(fields, lists, true);
  scene["properties"][std::string(kSetKey)] = setSchema();
  variant["properties"][std::string(kSetKey)] = setSchema();
  variant["properties"][std::string(kIncludeKey)] = includeSchema();

  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Migiwa scene, format 1"},
              {"description", "Written by `./run schema` from the program's own list of keys."},
              {"type", "object"},
              {"if", {{"required", Json::array({std::string(kIncludeKey)})}}},
              {"then", {{"$ref", "#/$defs/variant"}}},
              {"else", {{"$ref", "#/$defs/scene"}}}};
  Json& definitions = schema["$defs"];
  definitions["scene"] = std::move(scene);
  definitions["variant"] = std::move(variant);
  for (auto& [name, list] : lists) definitions[name] = std::move(list);
  return prettyJson(schema);
}

std::string sceneReference() {
  return ReferenceWriter::write([](FieldVisitor& visitor) {
    std::string none;
    visitor.text(kIncludeKey, none, kIncludeDoc);
    visitor.object(kSetKey, kSetDoc, [](FieldVisitor&) {});
    Scene scene;
    describeScene(visitor, scene);
  });
}

}  // namespace migiwa
