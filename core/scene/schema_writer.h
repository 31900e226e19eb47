// Writes what structs visit as a JSON Schema (draft 2020-12): the same list of fields that the reader goes
// through, so the two cannot disagree about keys, ranges and names. What only code can check (min beyond max)
// is not in it.
#pragma once

#include <map>

#include "core/base/fields.h"
#include "core/scene/json_document.h"

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
  bool sound(std::initializer_list<std::string_view>) const override { return false; }

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

}  // namespace migiwa
