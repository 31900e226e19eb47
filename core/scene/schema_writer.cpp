#include "core/scene/schema_writer.h"

#include <algorithm>
#include <cmath>

namespace migiwa {

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

}  // namespace migiwa
