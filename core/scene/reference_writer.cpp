#include "core/scene/reference_writer.h"

#include <sstream>

#include "core/scene/schema_writer.h"

namespace migiwa {

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

}  // namespace migiwa
