#include "core/scene/json_writer.h"

namespace migiwa {

Json JsonWriter::write(const Fields& fields, const FileEntry& fileEntry) {
  JsonWriter writer;
  writer.fileEntry_ = fileEntry;
  fields(writer);
  return std::move(writer.object_);
}

void JsonWriter::put(std::string_view key, Json value) {
  object_[std::string(key)] = std::move(value);
}

void JsonWriter::number(std::string_view key, const double& value, const Range&, const FieldDoc&) {
  put(key, value);
}

void JsonWriter::integer(std::string_view key, const int& value, const Range&, const FieldDoc&) {
  put(key, value);
}

void JsonWriter::boolean(std::string_view key, const bool& value, const FieldDoc&) {
  put(key, value);
}

void JsonWriter::text(std::string_view key, const std::string& value, const FieldDoc&) {
  if (!value.empty()) put(key, value);
}

void JsonWriter::file(std::string_view key, const FileName& value, const FieldDoc&) {
  if (!value.empty()) put(key, fileEntry_ ? fileEntry_(value) : Json(value.written));
}

void JsonWriter::vector(std::string_view key, const Vec3d& value, const FieldDoc&) {
  put(key, Json::array({value.x(), value.y(), value.z()}));
}

void JsonWriter::triples(std::string_view key, const std::vector<std::array<double, 3>>& values,
                         const FieldDoc&) {
  Json rows = Json::array();
  for (const std::array<double, 3>& row : values) rows.push_back(Json::array({row[0], row[1], row[2]}));
  put(key, std::move(rows));
}

void JsonWriter::pair(std::string_view key, const std::array<double, 2>& value, const FieldDoc&,
                      const bool* present) {
  if (present == nullptr || *present) put(key, value);
}

void JsonWriter::choice(std::string_view key, const int& index, std::span<const std::string_view> names,
                        const FieldDoc&) {
  put(key, std::string(names[static_cast<std::size_t>(index)]));
}

void JsonWriter::object(std::string_view key, const FieldDoc&, const Fields& fields, const bool* present) {
  if (present == nullptr || *present) put(key, write(fields, fileEntry_));
}

void JsonWriter::list(std::string_view key, std::size_t size, const FieldDoc&, const Element& element) {
  Json entries = Json::array();
  for (std::size_t k = 0; k < size; ++k)
    entries.push_back(write([&](FieldWriter& fields) { element(fields, k); }, fileEntry_));
  put(key, std::move(entries));
}

void JsonWriter::variant(std::string_view key, const int& index, std::span<const std::string_view> names,
                         const FieldDoc& doc, const Variant& fields) {
  choice(key, index, names, doc);
  fields(*this, index);
}

}  // namespace migiwa
