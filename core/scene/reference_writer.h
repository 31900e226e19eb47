// Writes what structs visit as a reference for people: Markdown tables with each key's kind, range, unit,
// default and meaning. The same list of fields that the reader goes through.
#pragma once

#include "core/base/fields.h"

namespace migiwa {

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
  bool sound(std::initializer_list<std::string_view>) const override { return false; }

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

}  // namespace migiwa
