// Reads the fields of one JSON object, and of the objects in it, into the structs that visit them. Every
// fault is collected; a faulty value leaves the default in place. Keys that nobody asked for are faults.
#pragma once

#include <set>

#include "core/base/fields.h"
#include "core/scene/fault_list.h"
#include "core/scene/json_document.h"

namespace migiwa {

class JsonReader final : public FieldVisitor {
 public:
  /// Reads `object` (which must be one), found at `pointer`, through `fields`, then looks for unknown keys.
  static void read(const Json& object, const std::string& pointer, FaultList& faults, const Fields& fields);

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
  void fault(std::string_view key, std::string_view message) override;
  void warning(std::string_view key, std::string_view message) override;
  bool sound(std::initializer_list<std::string_view> keys) const override;

 private:
  JsonReader(const Json& object, const std::string& pointer, FaultList& faults);

  /// The value of a key, or null when it is absent: then a fault that says `expected`, if the key is
  /// required.
  const Json* find(std::string_view key, const FieldDoc& doc, const std::string& expected);
  void wrong(std::string_view key, const std::string& expected, const std::string& found);
  bool numbers(std::string_view key, const FieldDoc& doc, std::size_t size, double* values);
  void reportUnknownKeys();

  const Json& object_;
  const std::string& pointer_;
  FaultList& faults_;
  std::vector<std::string_view> known_;
  std::set<std::string, std::less<>> faulty_;
  bool openEnded_ = false;  ///< the deciding key of a variant is wrong: nobody knows which keys belong here
};

}  // namespace migiwa
