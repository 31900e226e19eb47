// What a SLIM wall is made of, as scenes name it: a file that migiwa slim wrote, or a mesh, point cloud or
// formula to fit. Fits are kept for the next scene that asks for the same.
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/base/file_identity.h"
#include "core/slim/bowl.h"
#include "core/slim/slim_fitting.h"
#include "core/slim/slim_mesh.h"

namespace migiwa {

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

}  // namespace migiwa
