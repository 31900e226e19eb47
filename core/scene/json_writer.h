// Writes what structs visit into a JSON object: every key, with the value in force. An empty text is left
// out, it says nothing.
#pragma once

#include "core/base/fields.h"
#include "core/scene/json_document.h"

namespace migiwa {

class JsonWriter final : public FieldWriter {
 public:
  /// What stands for a file that a scene names.
  using FileEntry = std::function<Json(const FileName&)>;

  static Json write(const Fields& fields, const FileEntry& fileEntry = {});

  void number(std::string_view key, const double& value, const Range& range, const FieldDoc& doc) override;
  void integer(std::string_view key, const int& value, const Range& range, const FieldDoc& doc) override;
  void boolean(std::string_view key, const bool& value, const FieldDoc& doc) override;
  void text(std::string_view key, const std::string& value, const FieldDoc& doc) override;
  void file(std::string_view key, const FileName& value, const FieldDoc& doc) override;
  void vector(std::string_view key, const Vec3d& value, const FieldDoc& doc) override;
  void triples(std::string_view key, const std::vector<std::array<double, 3>>& values,
               const FieldDoc& doc) override;
  void pair(std::string_view key, const std::array<double, 2>& value, const FieldDoc& doc,
            const bool* present) override;
  void choice(std::string_view key, const int& index, std::span<const std::string_view> names,
              const FieldDoc& doc) override;
  void object(std::string_view key, const FieldDoc& doc, const Fields& fields, const bool* present) override;
  void list(std::string_view key, std::size_t size, const FieldDoc& doc, const Element& element) override;
  void variant(std::string_view key, const int& index, std::span<const std::string_view> names,
               const FieldDoc& doc, const Variant& fields) override;

 private:
  void put(std::string_view key, Json value);

  Json object_ = Json::object();
  FileEntry fileEntry_;
};

}  // namespace migiwa
