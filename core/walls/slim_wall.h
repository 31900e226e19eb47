// Walls made of SLIM surfaces: fitted, or read from a file.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/base/hash.h"
#include "core/slim/fit.h"
#include "core/slim/mesh.h"
#include "core/walls/surface.h"

namespace migiwa {

// What a SLIM wall is made of, as scenes name it: a file that migiwa slim wrote, or a mesh, point cloud or
// formula to fit. Fits are kept for the next scene that asks for the same.

struct SlimSource {
  enum class Kind { slimFile, mesh, bowl };

  Kind kind = Kind::mesh;
  std::filesystem::path file;  ///< of slimFile and mesh
  /// What is in the file: nothing else is read. Null: what is there at the time.
  std::optional<FileIdentity> identity{};
  Bowl bowl;
  int degree = 2;        ///< of the fit
  double tolerance = 0;  ///< of the fit (m); 0 with nodes 0: a thousandth of the diagonal. Cuts a file's
                         ///< hierarchy; 0 with nodes 0: all of its nodes
  int nodes = 0;         ///< of the fit; of a file, at most
  Transform transform;

  bool operator==(const SlimSource& other) const;
  /// The identity of the file's content that counts.
  FileIdentity content() const;
};

/// A surface ready for use, with what is worth saying about it.
struct SlimWallData {
  std::unique_ptr<const SlimModel> model;
  std::vector<std::string> notes;  ///< of the import
  /// The least way through the solid (m).
  float thinnestPart = std::numeric_limits<float>::infinity();

  /// The surface for pictures, extracted when it is first asked for.
  const SlimMesh& drawnMesh() const;

 private:
  mutable std::once_flag extracted_;
  mutable SlimMesh mesh_;
};

/// Mean distance (m) of a model from the shape that it was fitted to, at points that the fit has not seen;
/// null for a file of ours, which no longer has its shape, and for a file that has changed since.
std::optional<double> slimFitError(const SlimSource& source, const SlimModel& model);

/// Reads, fits and prepares; throws InputError when the file does not allow it, or holds something else than
/// `source` says.
std::shared_ptr<const SlimWallData> prepareSlim(const SlimSource& source);

// A wall that is a SLIM surface ([FM] section 5): balls with a polynomial each. Read from a file of migiwa
// slim, or fitted to a mesh, a point cloud or the formula of a bowl when the scene is read.

class SlimSurface : public Surface {
 public:
  enum class Fluid { inside, outside };

  SlimSurface() = default;
  SlimSurface(std::shared_ptr<const SlimWallData> data, Fluid fluid)
      : data_(std::move(data)), fluid_(fluid) {}
  /// Fitted to a mesh or points, as a scene would name it. Throws InputError when the file does not allow it.
  SlimSurface(const FileName& mesh, const Transform& transform, Fluid fluid);

  const std::vector<std::string>& notes() const { return data_->notes; }

  void describe(FieldVisitor& visitor) override;
  void describe(FieldWriter& visitor) const override;
  bool costlyDistance() const override { return data_ && data_->model->closed(); }
  /// Not without a grid: nodes end, and are looked at closely only near the surface.
  bool steadyDistance() const override { return false; }
  float distance(const Vec3f& p, Vec3f& normal) const override;
  /// By the errors of the nodes at the nearest point.
  float statedError(const Vec3f& p) const override;
  std::optional<double> fitError() const override { return slimFitError(source_, *data_->model); }
  bool project(Vec3f& p, float margin) const override;
  void firstHits(const Vec3f& origin, const Directions& directions, std::span<float> hits) const override;
  /// Thin parts let rays out again, and a vessel may bend.
  bool reentrant() const override { return true; }
  void exits(const Vec3f& origin, const Directions& directions, std::span<float> exits) const override;
  float thinnestPart() const override;
  bool crosses(const Vec3f& from, const Vec3f& to, Vec3f& normal, float& entry) const override;
  /// One for each node whose centre is nearer than `reach`, with that as its foot point: [FM] Eq. 14.
  void pieces(const Vec3f& p, float reach, std::vector<WallPiece>& out) const override;
  Bounds bounds() const override;
  /// Nothing: the mesh shows it.
  void wireframe(const Bounds&, std::vector<LineSegment>&) const override {}
  WallMesh mesh() const override;
  void drawnNodes(std::vector<WallNode>& out) const override;

 protected:
  template <class Visitor>
  static void describeFluid(Visitor& visitor, Visited<Visitor, SlimSurface>& self) {
    visitor.choice("fluid", self.fluid_, kFluidNames,
                   {"", "The side of the wall that holds the fluid.", Presence::required});
  }
  /// Takes `file` for what the surface is made of.
  void setFile(SlimSource::Kind kind, const FileName& file);
  /// Prepares `source_`; faults are reported at `key`.
  void prepare(FieldVisitor& visitor, std::string_view key);

 private:
  static constexpr std::array<std::string_view, 2> kFluidNames{"inside", "outside"};

  template <class Visitor>
  static void fields(Visitor& visitor, Visited<Visitor, SlimSurface>& self, Visited<Visitor, bool>& bowl);
  template <class Visitor>
  static void describeBowl(Visitor& visitor, Visited<Visitor, Bowl>& bowl);
  template <class Visitor>
  static void describeFit(Visitor& visitor, Visited<Visitor, SlimSource>& source);
  bool holdsFluid() const { return fluid_ == Fluid::inside; }

  SlimSource source_;
  std::shared_ptr<const SlimWallData> data_;  ///< of source_; null until described without a fault
  Fluid fluid_ = Fluid::outside;
  FileName slimFile_, meshFile_;
};

// Fitted SLIM walls on disk, so that the second start of a scene need not fit them again. A file is taken
// only if it is whole and its key is, word for word, the one that is asked for; anything else counts as no
// file.

/// What a fit gave, and what the import of its mesh had to say.
struct SlimFit {
  SlimData data;
  std::vector<std::string> notes;
};

/// All that the fit depends on, the content of the file included; empty where that cannot be read.
std::string slimFitKey(const SlimSource& source);
/// The file for a key, in a folder (cacheFolder()).
std::filesystem::path slimFitFile(const std::filesystem::path& folder, const std::string& key);

std::optional<SlimFit> readSlimFit(const std::filesystem::path& file, const std::string& key);
/// Creates the folder too. Returns whether the file is now there, whole.
bool writeSlimFit(const std::filesystem::path& file, const std::string& key, const SlimFit& fit);

}  // namespace migiwa
