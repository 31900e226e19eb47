// A script with which Blender renders a sequence of meshes.
#include <array>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "core/io/surface_files.h"

namespace migiwa {

namespace {

/// Blender 3.4 runs it without any library but its own. Words between @ are filled in.
constexpr std::string_view kScript =
    R"python(# Renders the meshes beside it as pictures beside them: blender -b -P THIS_FILE [-- --samples 32 --size 1280x720]
import array, bpy, json, mathutils, os, struct, sys

folder = os.path.dirname(os.path.abspath(__file__))
with open(os.path.join(folder, "@LIST@")) as text:
    files = json.load(text)["files"]

words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
option = dict(zip(words[0::2], words[1::2]))
samples = int(option.get("--samples", 32))
width, height = (int(n) for n in option.get("--size", "1280x720").split("x"))


def read_ply(name):
    """Positions, normals and triangles of a mesh that migiwa has written."""
    with open(os.path.join(folder, name), "rb") as file:
        data = file.read()
    end = data.index(b"end_header\n") + 11
    lines = data[:end].decode("ascii").split("\n")
    vertices, faces = (int(line.split()[2]) for line in lines if line.startswith("element "))
    kind = "d" if "property double x" in lines else "f"
    row = struct.Struct("<3%s6f" % kind)
    points, normals = [], []
    for values in row.iter_unpack(data[end:end + vertices * row.size]):
        points.extend(values[0:3])
        normals.append(values[3:6])
    triangles = array.array("i")
    for _, a, b, c, _ in struct.iter_unpack("<B3IB", data[end + vertices * row.size:]):
        triangles.extend((a, b, c))
    return points, normals, triangles


def turned(x, y, z):
    """The scene's up is y, Blender's z."""
    return (x, -z, y)


def mesh_of(name):
    points, normals, triangles = read_ply(name)
    mesh = bpy.data.meshes.new("water")
    count = len(triangles) // 3
    mesh.vertices.add(len(points) // 3)
    mesh.vertices.foreach_set("co", [c for k in range(0, len(points), 3) for c in turned(*points[k:k + 3])])
    mesh.loops.add(3 * count)
    mesh.loops.foreach_set("vertex_index", triangles)
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", range(0, 3 * count, 3))
    mesh.polygons.foreach_set("loop_total", [3] * count)
    mesh.polygons.foreach_set("use_smooth", [True] * count)
    mesh.update()
    if count > 0:
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = 0.9
    mesh.materials.append(water)
    return mesh


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene

water = bpy.data.materials.new("water")
water.use_nodes = True
nodes, links = water.node_tree.nodes, water.node_tree.links
nodes.clear()
output = nodes.new("ShaderNodeOutputMaterial")
glass = nodes.new("ShaderNodeBsdfGlass")
glass.inputs["IOR"].default_value = 1.333
glass.inputs["Roughness"].default_value = 0.0
links.new(glass.outputs["BSDF"], output.inputs["Surface"])
absorption = nodes.new("ShaderNodeVolumeAbsorption")
absorption.inputs["Color"].default_value = (0.35, 0.75, 0.9, 1)
absorption.inputs["Density"].default_value = 1.0 / @SIZE@
links.new(absorption.outputs["Volume"], output.inputs["Volume"])

ground = bpy.data.materials.new("ground")
ground.use_nodes = True
ground.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.42, 0.40, 0.38, 1)
bpy.ops.mesh.primitive_plane_add(size=60 * @SIZE@, location=turned(@GROUND@))
bpy.context.object.data.materials.append(ground)

world = bpy.data.worlds.new("sky")
scene.world = world
world.use_nodes = True
world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.45, 0.62, 0.9, 1)

sun = bpy.data.lights.new("sun", "SUN")
sun.energy, sun.angle = 3, 0.05
lamp = bpy.data.objects.new("sun", sun)
lamp.rotation_euler = (0.7, 0.2, 0.6)
scene.collection.objects.link(lamp)

eye, target = mathutils.Vector(turned(@EYE@)), mathutils.Vector(turned(@TARGET@))
lens = bpy.data.cameras.new("camera")
lens.sensor_fit, lens.angle = "VERTICAL", @FOV@
lens.clip_start, lens.clip_end = 0.001 * @SIZE@, 1000 * @SIZE@
camera = bpy.data.objects.new("camera", lens)
camera.location = eye
camera.rotation_euler = (target - eye).to_track_quat("-Z", "Y").to_euler()
scene.collection.objects.link(camera)
scene.camera = camera

scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = samples
scene.cycles.use_denoising = False
scene.cycles.max_bounces = 16
scene.cycles.transmission_bounces = 16
scene.render.resolution_x, scene.render.resolution_y = width, height
scene.render.image_settings.file_format = "PNG"

body = bpy.data.objects.new("water", bpy.data.meshes.new("empty"))
scene.collection.objects.link(body)
for number, entry in enumerate(files):
    old = body.data
    body.data = mesh_of(entry["file"])
    bpy.data.meshes.remove(old)
    scene.render.filepath = os.path.join(folder, os.path.splitext(entry["file"])[0] + ".png")
    bpy.ops.render.render(write_still=True)
    print("%d of %d: %s" % (number + 1, len(files), scene.render.filepath), flush=True)
)python";

std::string pythonTuple(const Vec3d& p) {
  std::ostringstream text;
  text << p.x() << ", " << p.y() << ", " << p.z();
  return text.str();
}

std::string pythonNumber(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

std::string blenderScript(const BlenderView& view) {
  const std::array<std::pair<std::string_view, std::string>, 6> words{{{"@LIST@", view.list},
                                                                       {"@SIZE@", pythonNumber(view.size)},
                                                                       {"@GROUND@", pythonTuple(view.ground)},
                                                                       {"@EYE@", pythonTuple(view.eye)},
                                                                       {"@TARGET@", pythonTuple(view.target)},
                                                                       {"@FOV@", pythonNumber(view.fov)}}};
  std::string script(kScript);
  for (const auto& [word, value] : words)
    for (std::size_t at = script.find(word); at != std::string::npos;
         at = script.find(word, at + value.size()))
      script.replace(at, word.size(), value);
  return script;
}

}  // namespace migiwa
