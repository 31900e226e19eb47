// Which JSON keys a struct has. The struct has one list of its fields, a
// template over the visitor; reading a scene, writing it with all defaults, its schema and its documentation
// are visitors of that list. Writing has the struct as const. Nothing here knows JSON: the readers live in
// core/scene.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <vector>

#include <Eigen/Core>

#include "core/base/hash.h"
#include "core/base/math.h"

namespace migiwa {

/// Interval of allowed values. An open end excludes the bound itself.
struct Range {
  static constexpr double kSmallestLength = 1e-9;

  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool openMin = false;
  bool openMax = false;

  static constexpr Range closed(double a, double b) { return {a, b, false, false}; }
  static constexpr Range halfOpen(double a, double b) { return {a, b, false, true}; }
  static constexpr Range positive(double most) { return {0, most, true, false}; }
  /// Of a length that something has (m): what is smaller is no length to a float's squares and cubes.
  static constexpr Range length(double most) { return {kSmallestLength, most, false, false}; }
  bool contains(double v) const { return (openMin ? v > min : v >= min) && (openMax ? v < max : v <= max); }
  std::string text() const;
};

/// Coordinates, speeds and accelerations beyond this are refused: float keeps no digit that means anything
/// there.
inline constexpr double kLargestCoordinate = 1e7;
inline constexpr Range kCoordinateRange{-kLargestCoordinate, kLargestCoordinate};

enum class Presence { optional, required };

struct FieldDoc {
  std::string_view unit;         ///< SI unit, "1" for a ratio, empty for text
  std::string_view description;  ///< one sentence
  Presence presence = Presence::optional;
};

/// A file that a scene names.
struct FileName {
  std::string written;         ///< as in the scene; empty: none
  std::filesystem::path path;  ///< relative to the working folder
  FileIdentity identity{};     ///< what was in the file when the scene was read

  bool empty() const { return written.empty(); }
};

/// What a visitor may do with the values that it is shown.
enum class Access { change, look };

/// Visits one JSON object's fields in order. One list of kinds of fields, for two kinds of visitors: a
/// FieldVisitor overwrites the values or shows them to be changed, a FieldWriter only looks at them, and
/// visits what is const.
template <Access kAccess>
class BasicFieldVisitor {
 public:
  static constexpr bool kChanges = kAccess == Access::change;
  template <class T>
  using Value = std::conditional_t<kChanges, T, const T>;
  using Fields = std::function<void(BasicFieldVisitor&)>;
  using Element = std::function<void(BasicFieldVisitor&, std::size_t)>;
  using Variant = std::function<void(BasicFieldVisitor&, int)>;

  virtual ~BasicFieldVisitor() = default;
  virtual void number(std::string_view key, Value<double>& value, const Range& range,
                      const FieldDoc& doc) = 0;
  virtual void integer(std::string_view key, Value<int>& value, const Range& range, const FieldDoc& doc) = 0;
  virtual void boolean(std::string_view key, Value<bool>& value, const FieldDoc& doc) = 0;
  virtual void text(std::string_view key, Value<std::string>& value, const FieldDoc& doc) = 0;
  /// A file name; relative ones are relative to what is being read.
  virtual void file(std::string_view key, Value<FileName>& value, const FieldDoc& doc) {
    text(key, value.written, doc);
  }
  virtual void vector(std::string_view key, Value<Vec3d>& value, const FieldDoc& doc) = 0;
  /// A position: relative to origin() here, in the file's own coordinates where it is written.
  virtual void place(std::string_view key, Value<Vec3d>& value, const FieldDoc& doc) {
    vector(key, value, doc);
  }
  /// The same for the coordinate of a position along one axis: 0 x, 1 y, 2 z.
  virtual void coordinate(std::string_view key, Value<double>& value, int axis, const FieldDoc& doc) {
    static_cast<void>(axis);
    number(key, value, kCoordinateRange, doc);
  }
  /// What positions are relative to, in the file's own coordinates (m).
  virtual Vec3d origin() const { return Vec3d::Zero(); }
  /// Two numbers, such as the ends of a colour range. `present`, if given, says whether the key is there.
  virtual void pair(std::string_view key, Value<std::array<double, 2>>& value, const FieldDoc& doc,
                    Value<bool>* present = nullptr) = 0;
  /// Any number of number triples, such as the terms of a polynomial.
  virtual void triples(std::string_view key, Value<std::vector<std::array<double, 3>>>& values,
                       const FieldDoc& doc) = 0;
  /// One of `names`; `index` is its place in the list.
  virtual void choice(std::string_view key, Value<int>& index, std::span<const std::string_view> names,
                      const FieldDoc& doc) = 0;
  /// A nested object. `present`, if given, says whether the key is there; an absent object's fields are not
  /// visited.
  virtual void object(std::string_view key, const FieldDoc& doc, const Fields& fields,
                      Value<bool>* present = nullptr) = 0;
  /// An array of objects: a reader calls `element` for each entry it finds, a writer `size` times.
  virtual void list(std::string_view key, std::size_t size, const FieldDoc& doc, const Element& element) = 0;
  /// The key that decides which further fields the object has (such as "shape"). `index` < 0 when it is not
  /// known yet or wrong; `fields` is called with a valid index only.
  virtual void variant(std::string_view key, Value<int>& index, std::span<const std::string_view> names,
                       const FieldDoc& doc, const Variant& fields) = 0;
  /// Reports what only the struct itself can see, such as min beyond max, at the key or, for an empty key, at
  /// the object itself. Left out where the key is faulty already. Ignored by all but readers.
  virtual void fault(std::string_view key, std::string_view message) {
    static_cast<void>(key);
    static_cast<void>(message);
  }
  /// Reports what is valid and probably not meant, or was repaired. Ignored by all but readers.
  virtual void warning(std::string_view key, std::string_view message) {
    static_cast<void>(key);
    static_cast<void>(message);
  }
  /// Whether these keys hold what was written: false after a fault in one of them. A check across several
  /// keys asks first, so that it never complains about a default that took the place of a faulty value.
  virtual bool valid(std::initializer_list<std::string_view> keys) const {
    static_cast<void>(keys);
    return true;
  }

  /// Whether the object that is read has the key, or what a JSON pointer leads to: for defaults that depend
  /// on what else is written. False for all but readers.
  virtual bool given(std::string_view key) const {
    static_cast<void>(key);
    return false;
  }

  /// A choice held as an enum whose values count from 0 in the order of `names`.
  template <class Enum>
  requires std::is_enum_v<Enum>
  void choice(std::string_view key, Enum& value, std::span<const std::string_view> names,
              const FieldDoc& doc) {
    int index = static_cast<int>(value);
    choice(key, index, names, doc);
    if constexpr (kChanges) value = static_cast<Enum>(index);
  }
};

/// Of what is read, or shown to be changed.
using FieldVisitor = BasicFieldVisitor<Access::change>;
/// Of what is written out: nothing that it visits changes, so that others may read it meanwhile.
using FieldWriter = BasicFieldVisitor<Access::look>;

/// `Part` as a visitor may have it: for lists of fields that both kinds of visitors go through.
template <class Visitor, class Part>
using Visited = typename Visitor::template Value<Part>;

/// A `Base` whose fields one function of `Derived` lists for both kinds of visitors:
///   static void fields(auto& visitor, auto& self);
/// It is public; `self` is const where the visitor only looks.
template <class Derived, class Base>
class Described : public Base {
 public:
  void describe(FieldVisitor& visitor) override { Derived::fields(visitor, static_cast<Derived&>(*this)); }
  void describe(FieldWriter& visitor) const override {
    Derived::fields(visitor, static_cast<const Derived&>(*this));
  }
};

// The names of a registry's entries, for the scene keys that choose among them.

/// `kEntries` is an array, in static storage, of structs with a member `name`.
template <const auto& kEntries>
std::span<const std::string_view> registryNames() {
  static constexpr auto kNames = [] {
    std::array<std::string_view, kEntries.size()> names;
    for (std::size_t k = 0; k < names.size(); ++k) names[k] = kEntries[k].name;
    return names;
  }();
  return kNames;
}

// Lists of objects of various shapes, each named by its key "shape".

/// The place in `names` of the shape that `object` is, found by its type.
template <class T>
int shapeOf(const T& object, std::span<const std::string_view> names, std::unique_ptr<T> (*make)(int)) {
  for (int shape = 0; shape < static_cast<int>(names.size()); ++shape) {
    const std::unique_ptr<T> example = make(shape);
    const T& candidate = *example;
    if (typeid(candidate) == typeid(object)) return shape;
  }
  return -1;
}

inline constexpr std::string_view kShapeKey = "shape";
inline constexpr FieldDoc kShapeDoc{"", "What it is.", Presence::required};

/// The objects that `makeOne` makes, by the names of their shapes.
template <class T>
struct Shapes {
  std::span<const std::string_view> names;
  std::unique_ptr<T> (*makeOne)(int);
};

/// A list of objects whose "shape" says what they are: each is described by its shape, by `more` and, after
/// the keys that depend on the shape, by `common`. What is read is added to `objects`.
template <class T, class Visitor, class More, class Common>
void describeShapes(Visitor& visitor, std::string_view key, const FieldDoc& doc,
                    Visited<Visitor, std::vector<std::shared_ptr<const T>>>& objects, const Shapes<T>& shapes,
                    const More& more, const Common& common) {
  visitor.list(key, objects.size(), doc, [&](Visitor& element, std::size_t at) {
    std::shared_ptr<Visited<Visitor, T>> object;
    int shape = -1;
    if constexpr (!Visitor::kChanges) {
      object = objects[at];
      shape = shapeOf(*object, shapes.names, shapes.makeOne);
      if (shape < 0) return;  // not one that a scene can name
    }
    element.variant(kShapeKey, shape, shapes.names, kShapeDoc, [&](Visitor& fields, int picked) {
      if constexpr (Visitor::kChanges) object = shapes.makeOne(picked);
      object->describe(fields);
      more(fields, *object);
    });
    if (object == nullptr) return;
    common(element, *object);
    if constexpr (Visitor::kChanges) objects.push_back(std::move(object));
  });
}

/// An object whose "shape", one of an enum's names, says which fields it has: `fields` visits those.
template <class Visitor, class Shape, std::size_t kCount, class Fields>
void describeShaped(Visitor& visitor, Shape& shape, const std::array<std::string_view, kCount>& names,
                    const FieldDoc& doc, const Fields& fields) {
  int index = static_cast<int>(shape);
  visitor.variant(kShapeKey, index, names, doc, [&](Visitor& own, int picked) {
    if constexpr (Visitor::kChanges) shape = static_cast<Shape>(picked);
    fields(own);
  });
}

// A turn about an axis through something's centre, as scenes write it.

/// The right-handed turn by an angle (rad) about a unit axis, after Rodrigues.
Eigen::Matrix3d rotationAbout(const Vec3d& axis, double angle);

struct Rotation {
  Vec3d axis = Vec3d::UnitY();
  double degrees = 0;

  template <class Visitor>
  static void describe(Visitor& visitor, Visited<Visitor, Rotation>& self) {
    visitor.vector("axis", self.axis,
                   {"1", "Axis through the centre; any length but zero.", Presence::required});
    visitor.number("degrees", self.degrees, Range::closed(-360, 360),
                   {"degrees", "Angle of the turn, right-handed.", Presence::required});
    if constexpr (Visitor::kChanges) {
      if (self.axis.norm() >= 1e-12) return;
      visitor.fault("axis", "expected a vector that is not zero, found [0, 0, 0]");
      self.axis = Vec3d::UnitY();
    }
  }
  Eigen::Matrix3d matrix() const;
};

// Where a shape from a file stands in a scene: scaled, then turned about the file's origin, then moved.

struct Transform {
  double scale = 1;
  Rotation rotate;
  Vec3d translate = Vec3d::Zero();  ///< of the file's origin (m)

  bool operator==(const Transform& other) const;
  /// The object "transform" beside the name of the file. Left out, the shape is where the file has it.
  template <class Visitor>
  static void describe(Visitor& visitor, Visited<Visitor, Transform>& self) {
    if constexpr (Visitor::kChanges) self.translate = Vec3d::Zero() - visitor.origin();
    visitor.object("transform", {"", "Where the shape of the file stands in the scene."}, [&](auto& fields) {
      fields.number("scale", self.scale, Range::closed(1e-9, 1e6),
                    {"1", "Factor on all lengths of the file: metres per its unit."});
      fields.object("rotate",
                    {"", "Turns it about the origin; a file whose z axis is up needs [1, 0, 0] and -90."},
                    [&](auto& turn) { Rotation::describe(turn, self.rotate); });
      fields.place("translate", self.translate, {"m", "Moves it, at last."});
    });
  }
  Vec3f point(const Vec3f& p) const;
  Vec3f direction(const Vec3f& n) const;
};

}  // namespace migiwa
