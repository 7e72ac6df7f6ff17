"""Run by Blender: compares what it makes of a run's exports with the run's cache. Arguments after --: RUN_DIR."""

import glob
import os
import struct
import sys

import bpy
import numpy

# Debian 12's Blender reads glTF with a name that its NumPy no longer has.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

run = sys.argv[sys.argv.index("--") + 1]
tolerance = 2e-6  # metres: floats, and one sum of them in glTF


def cached(frame):
    """Positions of a state file (sim/run/frame_record.cpp): a list of doubles after 65 bytes."""
    with open(os.path.join(run, "cache", "frame_%04d.state" % frame), "rb") as file:
        data = file.read()
    (count,) = struct.unpack_from("<Q", data, 65)
    flat = struct.unpack_from("<%dd" % (3 * count), data, 73)
    return [flat[3 * k:3 * k + 3] for k in range(count)]


frames = len(glob.glob(os.path.join(run, "cache", "frame_*.state")))
states = [cached(k) for k in range(frames)]


def clear():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    for block in (bpy.data.meshes, bpy.data.actions, bpy.data.shape_keys):
        for item in list(block):
            try:
                block.remove(item)
            except Exception:
                pass


def compare(what, frame, expected, found):
    if len(found) < len(expected):
        print("bad %s: frame %d has %d vertices, not %d" % (what, frame, len(found), len(expected)))
        sys.exit(1)
    worst = max((max(abs(a - b) for a, b in zip(p, q)) for p, q in zip(expected, found)), default=0)
    if not worst < tolerance:
        print("bad %s: frame %d is off by %g m" % (what, frame, worst))
        sys.exit(1)


def evaluated(thing):
    bpy.context.view_layer.update()
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return [tuple(thing.matrix_world @ v.co) for v in mesh.vertices]


def meshes():
    return {o.name.split(".")[0]: o for o in bpy.context.scene.objects if o.type == "MESH"}


def import_obj(path):
    bpy.ops.wm.obj_import(filepath=path, forward_axis="Y", up_axis="Z")


# The OBJ's order of cloths is the cache's.
for k in range(frames):
    clear()
    import_obj(os.path.join(run, "export", "obj", "frame_%04d.obj" % k))
    found = [x for name in ("sheet", "tshirt") for x in evaluated(meshes()[name])]
    compare("obj", k, states[k], found)
print("ok obj: %d frames of %d vertices" % (frames, len(states[0])))

for k in range(frames):
    clear()
    bpy.ops.import_mesh.ply(filepath=os.path.join(run, "export", "ply", "frame_%04d.ply" % k))
    thing = next(o for o in bpy.context.scene.objects if o.type == "MESH")
    compare("ply", k, states[k], evaluated(thing))
    if not thing.data.color_attributes:
        print("bad ply: no colours")
        sys.exit(1)
print("ok ply")

for kind in ("PC2", "MDD"):
    clear()
    folder = os.path.join(run, "export", kind.lower())
    first = {"sheet": 0}
    for name in ("sheet", "tshirt"):
        import_obj(os.path.join(folder, name + ".obj"))
    things = meshes()
    for name in ("sheet", "tshirt"):
        cache = things[name].modifiers.new("cache", "MESH_CACHE")
        cache.cache_format = kind
        cache.filepath = os.path.abspath(os.path.join(folder, name + "." + kind.lower()))
        cache.frame_start = 0
    bpy.context.scene.render.fps = 25
    for k in range(frames):
        bpy.context.scene.frame_set(k)
        compare(kind, k, states[k], evaluated(things["sheet"]) + evaluated(things["tshirt"]))
    print("ok " + kind)

try:
    import numpy  # Blender's glTF importer needs it
except ImportError:
    print("ok glb not looked at: Blender's importer has no numpy (apt-get install python3-numpy)")
    print("ok all")
    sys.exit(0)

clear()
bpy.context.scene.render.fps = 25
bpy.ops.import_scene.gltf(filepath=glob.glob(os.path.join(run, "export", "glb", "*.glb"))[0], merge_vertices=False)
things = meshes()
for k in range(frames):
    bpy.context.scene.frame_set(k)
    start = 0
    for name, count in (("sheet", 63), ("tshirt", len(states[0]) - 63)):
        # glTF is y up, and Blender turns it; vertices that repeat a particle come after the particles.
        found = [(x, z, -y) for x, y, z in evaluated(things[name])]
        compare("glb", k, states[k][start:start + count], found[:count])
        start += count
    # The solid goes from (5, 0, 0) to (5, 1, 2).
    ball = things["ball"].matrix_world.translation
    expected = [(5, 0, 0)] if k == 0 else [(5, 1, 2)] if k == frames - 1 else []
    compare("ball of the glb", k, expected, [(ball.x, ball.z, -ball.y)])
print("ok glb")
print("ok all")
