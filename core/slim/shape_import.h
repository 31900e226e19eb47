// Meshes and points from files, checked and repaired.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/messages.h"
#include "core/slim/points.h"

namespace migiwa {

// Meshes and oriented point clouds from files: OBJ, PLY, STL and what else assimp reads, and points as .xyz.

/// What a file holds, checked and repaired where that is safe: a mesh, or points with normals, which
/// are estimated where the file has none.
struct ImportedShape {
  TriangleMesh mesh;     ///< no triangles: the file holds points
  OrientedPoints cloud;  ///< no points: the file holds a mesh
  bool closed = true;    ///< encloses a solid
  /// Where more than two sheets meet at an edge, or a sheet has one side only: a wall is made of them, a SLIM
  /// surface is not.
  std::optional<Fault> branching;
  std::string rim;  ///< of an open mesh: how many edges end it, and where
  /// The mesh's vertices, or the points, in double where floats do not hold what the file says: far from the
  /// origin. Empty elsewhere.
  std::vector<Vec3d> exact;
  std::vector<std::string> notes;  ///< what was repaired, and what is probably not meant; one sentence each

  bool isMesh() const { return !mesh.triangles.empty(); }
  Bounds bounds() const;
};

/// Throws InputError, its place the file, when the file is missing, holds no surface, or one that cannot be
/// told inside from outside.
ImportedShape importShape(const std::filesystem::path& file);

/// The points that a SLIM surface of about so many nodes (0: not known) is fitted to. Throws InputError for
/// sheets of which more than two meet at an edge, or that have one side only.
OrientedPoints fitPoints(const ImportedShape& shape, int nodes);

// Makes points with normals as files hold them into points whose normals agree.

/// Drops points that are there twice, estimates normals where all are zero, turns those against most of their
/// neighbours, and all of them if they point inwards. Adds a sentence to `notes` for each kind of repair.
/// Returns whether the points seem to cover a closed surface, on which normals cancel. Throws InputError at
/// `place` for fewer than 50 points.
bool repairCloud(std::vector<OrientedPoint>& points, const std::string& place,
                 std::vector<std::string>& notes);

// Makes a mesh as files hold them into one that has an inside and an outside.

/// Such as `1 corner was` or `2 corners were`, for notes.
std::string counted(std::size_t count, const std::string& one, const std::string& many);

/// Makes one of corners at the same place, or within a millionth of the mesh's diagonal; leaves out triangles
/// that lose a corner by that, and corners of none. Adds a sentence to `notes` where anything was changed.
void weldMesh(TriangleMesh& mesh, std::vector<std::string>& notes);

struct RepairedMesh {
  bool closed = true;
  std::optional<Fault> branching{};  ///< of ImportedShape
  std::string rim{};                 ///< of ImportedShape
};

/// Welds corners, drops triangles that are degenerate, there twice or shared by two parts that touch, and
/// turns triangles so that the outermost closed parts face outwards; a
/// closed part within another keeps how it faces relative to that one: inwards is the wall of a hollow. Where
/// an odd number of sheets meet at an edge, those that end elsewhere, too, become parts that end there, with
/// vertices of their own. A surface with one side only is cut where it comes back to itself. Adds a sentence
/// to `notes` for each kind of repair, and for an open mesh. Throws InputError at `place` for no triangles.
RepairedMesh repairMesh(TriangleMesh& mesh, const std::string& place, std::vector<std::string>& notes);

// Normals for points that have none, or none that agree: planes through neighbours, whose sides are made to
// agree along the spanning tree that turns least (Hoppe, DeRose, Duchamp, McDonald and Stuetzle 1992, Surface
// reconstruction from unorganized points), and then to face outwards.

/// Gives every point the normal of the plane of best fit through its neighbours, out of the solid that the
/// points cover all around. There must be at least 50 points, no two at the same place. Throws InputError at
/// `place` where inside and outside cannot be told apart: on an open surface, or where two sheets are too
/// close for the points' distance. Sorts the points anew, the same way every time.
void estimateNormals(std::vector<OrientedPoint>& points, const std::string& place);

/// Turns normals so that they agree and face outwards. Returns how many were turned; none where they agree
/// already, and none where it cannot be decided.
std::size_t orientNormals(std::vector<OrientedPoint>& points);

// Text that says more digits than a float holds, as coordinates of maps do: it is moved to the origin before
// anything is read from it.

/// Where the middle of the shape lies that a file of this content and ending (lower case, no dot) holds, if
/// that is so far from the origin that floats do not hold the shape; then moves the coordinates of the
/// content there. Zero elsewhere, for files that hold floats only, and for those whose numbers are none.
Vec3d moveToOrigin(std::string& content, std::string_view ending);

/// The same for a file, which stays as it is; zero for one that cannot be read, too.
Vec3d middleIfFar(const std::filesystem::path& file);

// Points as text, a line each: x y z, or x y z nx ny nz.

struct XyzPoints {
  std::vector<Vec3d> positions;
  std::vector<Vec3f> normals;  ///< unit, or zero; none where the file has none
};

/// Takes comments from # on, how many points follow in the first line, and the columns' names, x, y and z
/// first, before the points. Returns what is wrong, as "expected ..., found ..."; empty where nothing is.
/// Adds a sentence to `notes` for what is left out.
std::string readXyz(std::string_view content, XyzPoints& points, std::vector<std::string>& notes);

// STL files that others write: keywords in capitals, and counts of triangles that are wrong.

/// Makes the content one that is read as what it is where that is certain, and adds a sentence to `notes`.
/// Returns what is wrong elsewhere, as "expected ..., found ..."; empty where nothing is.
std::string repairStl(std::string& content, std::vector<std::string>& notes);

// Whether a PLY file holds all that its header promises. assimp 5.2 never comes back from a header that does
// not end, makes up zeros for what is missing of the rest, and asks for memory for as many corners as a face
// says.

/// What is wrong with a PLY file of this content, as "expected ..., found ..."; empty where it seems whole.
std::string plyFault(std::string_view content);

// The header of a PLY file: which elements follow, and of which numbers each consists.

/// A number of a binary file; of text only the word matters.
struct PlyType {
  std::size_t bytes = 0;  ///< 0: none
  bool whole = false;     ///< an integer
  bool negative = false;  ///< may be below 0
};

/// One number of an element, or a list of them: how many, then so many.
struct PlyProperty {
  std::string name;
  PlyType type;
  PlyType listCount;  ///< of no bytes: a single number
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { ascii, littleEndian, bigEndian } format = Format::ascii;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;  ///< up to and with `end_header`
  std::string_view body;  ///< what follows
};

/// Reads the header of a file of this content, which has to outlive the result. Returns what is wrong with
/// it, as "expected ..., found ..."; empty where nothing is.
std::string readPlyHeader(std::string_view content, PlyHeader& header);

}  // namespace migiwa
