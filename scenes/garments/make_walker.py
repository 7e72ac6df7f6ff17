#!/usr/bin/env python3
"""Makes the walker of walk.toml and what it wears: python3 scenes/garments/make_walker.py [--spacing METRES] [-o DIR]

  walker.glb        a figure with a skeleton of 14 joints, a skin, a morph target that breathes, and an animation "walk":
                    it stands while it is dressed, lowers its arms and walks five steps along +z
  walk_tshirt.obj, walk_skirt.obj   the garments of make_garment.py, coarser, the T-shirt's panels farther apart so that
                    the skirt is between them

Lengths are metres, y is up. `--pins` prints the keyframes by which the skirt's waist goes along with the hips."""

import argparse
import json
import math
import os
import struct

import make_garment

# When it begins to lower its arms, to walk, and how. A foot is lifted while the other one stands.
LOWERED, WALK, STEP_TIME, STEPS, STEP_LENGTH, LIFT, SINK = 1.0, 1.7, 0.5, 5, 0.36, 0.07, 0.035
END = WALK + STEPS * STEP_TIME + 0.5
HIP, KNEE, ANKLE = (0.10, 0.74), (0.105, 0.395), (0.105, 0.05)  # x and y of the left ones
SHOULDER, ELBOW, HAND = (0.13, 1.335), (0.325, 1.25), (0.52, 1.165)

# name, parent, place in the world
JOINTS = [("hips", None, (0, 0.9, 0)), ("spine", "hips", (0, 1.06, 0)), ("chest", "spine", (0, 1.2, 0)),
          ("neck", "chest", (0, 1.42, 0))]
for side, name in ((1, "left"), (-1, "right")):
    at = lambda p: (side * p[0], p[1], 0)
    JOINTS += [(name + "_arm", "chest", at(SHOULDER)), (name + "_forearm", name + "_arm", at(ELBOW)),
               (name + "_thigh", "hips", at(HIP)), (name + "_shin", name + "_thigh", at(KNEE)),
               (name + "_foot", name + "_shin", at(ANKLE))]
NUMBER = {name: k for k, (name, _, _) in enumerate(JOINTS)}


def capsules():
    """Limbs: name of the limb, (a, b - a, |b - a|^-2, radius at a, growth to b, depth), as make_garment.py has them."""
    ends = [("trunk", (0, 0.72, 0), (0, 1.02, 0), 0.165, 0.135, 0.72), ("trunk", (0, 1.02, 0), (0, 1.27, 0), 0.135, 0.155, 0.72),
            ("trunk", (0, 1.30, 0), (0, 1.52, 0), 0.06, 0.055, 1), ("trunk", (0, 1.62, 0), (0, 1.66, 0), 0.09, 0.095, 1)]
    for side, name in ((1, "left"), (-1, "right")):
        at = lambda p, z=0.0: (side * p[0], p[1], z)
        ends += [(name + "_arm", at(SHOULDER), at(HAND), 0.062, 0.042, 1), (name + "_leg", at(HIP), at(KNEE), 0.085, 0.058, 1),
                 (name + "_leg", at(KNEE), at(ANKLE), 0.058, 0.042, 1),
                 (name + "_leg", at(ANKLE), at((0.105, 0.04), 0.14), 0.045, 0.035, 1)]
    return [(limb, (*a, *(y - x for x, y in zip(a, b)), 1 / math.dist(a, b) ** 2, ra, rb - ra, depth))
            for limb, a, b, ra, rb, depth in ends]


CAPSULES = capsules()


def distance_to(capsule, p):
    ax, ay, az, dx, dy, dz, inverse, radius, growth, depth = capsule
    x, y, z = p[0] - ax, p[1] - ay, p[2] / depth - az
    t = min(max((x * dx + y * dy + z * dz) * inverse, 0.0), 1.0)
    return math.sqrt((x - t * dx) ** 2 + (y - t * dy) ** 2 + (z - t * dz) ** 2) - radius - t * growth


def body_distance(p):
    """Capsules grown together, but for the legs, which would stick to one another: those are only joined to the trunk."""
    sums = {0: 0.0, 1: 0.0, -1: 0.0}
    for limb, capsule in CAPSULES:
        grown = math.exp(-60.0 * distance_to(capsule, p))
        sums[(1 if limb.startswith("left") else -1) if limb.endswith("leg") else 0] += grown
    return -math.log(sums[0] + max(sums[1], sums[-1])) / 60.0


def smooth(value, low, high):
    t = min(max((value - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def weights_of(p):
    """Up to four joints that move a point, by their numbers."""
    near = {}
    for limb, capsule in CAPSULES:
        near[limb] = min(near.get(limb, 9.0), distance_to(capsule, p))
    least = min(near.values())
    share = {limb: math.exp(-70.0 * (d - least)) for limb, d in near.items()}
    for side, other in (("left", "right"), ("right", "left")):  # a leg has no say beyond the middle
        if side == ("right" if p[0] > 0 else "left"):
            share[side + "_leg"] *= smooth(abs(p[0]), 0.03, 0.0)
    out = {}

    def add(joint, weight):
        out[joint] = out.get(joint, 0.0) + weight

    for limb, weight in share.items():
        if limb == "trunk":
            spine, chest, neck = smooth(p[1], 1.0, 1.12), smooth(p[1], 1.13, 1.27), smooth(p[1], 1.36, 1.46)
            add("hips", weight * (1 - spine))
            add("spine", weight * spine * (1 - chest))
            add("chest", weight * chest * (1 - neck))
            add("neck", weight * chest * neck)
        elif limb.endswith("arm"):
            name = limb[:-4]
            along = (abs(p[0]) - SHOULDER[0]) / (HAND[0] - SHOULDER[0])
            arm, forearm = smooth(along, -0.12, 0.16), smooth(along, 0.4, 0.6)
            add("chest", weight * (1 - arm))
            add(name + "_arm", weight * arm * (1 - forearm))
            add(name + "_forearm", weight * arm * forearm)
        else:
            name = limb[:-4]
            thigh, shin, foot = smooth(p[1], 0.84, 0.64), smooth(p[1], 0.45, 0.34), smooth(p[1], 0.09, 0.04)
            add("hips", weight * (1 - thigh))
            add(name + "_thigh", weight * thigh * (1 - shin))
            add(name + "_shin", weight * thigh * shin * (1 - foot))
            add(name + "_foot", weight * thigh * shin * foot)
    best = sorted((i for i in out.items() if i[1] > 1e-4), key=lambda item: (-item[1], NUMBER[item[0]]))[:4]
    total = sum(w for _, w in best)
    return [(NUMBER[name], w / total) for name, w in best]


def steps():
    """(start, foot) of each step; the feet stand side by side before the first and after the last."""
    return [(WALK + k * STEP_TIME, k % 2) for k in range(STEPS)]


def foot_at(foot, t):
    """Where an ankle is along z, and how high it is lifted."""
    z = lift = 0.0
    for k, (start, mover) in enumerate(steps()):
        if mover != foot:
            continue
        # Half a step at the beginning and at the end.
        length = STEP_LENGTH if k in (0, STEPS - 1) else 2 * STEP_LENGTH
        share = smooth(t, start, start + STEP_TIME)
        z += length * share
        lift += LIFT * math.sin(math.pi * share)
    return z, lift


def hip_keys():
    """(time, place) of the hips, from where they stand: between the feet, lower at each change of them. Between keys they
    go as the scene's own keyframes do."""
    keys = [(LOWERED, 0.0, 0.0)]
    for start, _ in steps():
        keys.append((start, sum(foot_at(f, start)[0] for f in (0, 1)) / 2, -SINK))
        middle = start + STEP_TIME / 2
        keys.append((middle, sum(foot_at(f, middle)[0] for f in (0, 1)) / 2, -SINK + 0.012))
    last = WALK + STEPS * STEP_TIME
    keys.append((last, sum(foot_at(f, last)[0] for f in (0, 1)) / 2, -SINK))
    keys.append((END, keys[-1][1], 0.0))
    return [(t, (0.0, y, z)) for t, z, y in keys]


def slopes(keys):
    """Those of monotone cubics (Fritsch and Carlson): what keyframes of a scene are joined by, and so the waist."""
    out = [[0.0] * 3 for _ in keys]
    for k in range(1, len(keys) - 1):
        before, after = keys[k][0] - keys[k - 1][0], keys[k + 1][0] - keys[k][0]
        for c in range(3):
            left = (keys[k][1][c] - keys[k - 1][1][c]) / before
            right = (keys[k + 1][1][c] - keys[k][1][c]) / after
            if left * right > 0:
                w1, w2 = 2 * after + before, after + 2 * before
                out[k][c] = (w1 + w2) / (w1 / left + w2 / right)
    return out


def hips_at(keys, tangents, t):
    if t <= keys[0][0]:
        return keys[0][1]
    for k in range(len(keys) - 1):
        if t < keys[k + 1][0]:
            span = keys[k + 1][0] - keys[k][0]
            s = (t - keys[k][0]) / span
            h01, h10, h11 = s * s * (3 - 2 * s), s * (1 - s) ** 2, s * s * (s - 1)
            return tuple((1 - h01) * keys[k][1][c] + h01 * keys[k + 1][1][c]
                         + span * (h10 * tangents[k][c] + h11 * tangents[k + 1][c]) for c in range(3))
    return keys[-1][1]


def about_x(angle):
    return (math.sin(angle / 2), 0.0, 0.0, math.cos(angle / 2))


def about_z(angle):
    return (0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2))


def product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def pose_at(t, keys, tangents):
    """Rotations of the joints that move, by name."""
    hips = hips_at(keys, tangents, t)
    out = {}
    thigh_length, shin_length = math.dist(HIP, KNEE), math.dist(KNEE, ANKLE)
    for foot, name in ((0, "left"), (1, "right")):
        z, lift = foot_at(foot, t)
        down = HIP[1] + hips[1] - ANKLE[1] - lift
        ahead = z - hips[2]
        reach = min(math.hypot(down, ahead), thigh_length + shin_length)
        # The law of cosines; a turn about x by a positive angle takes what hangs down backwards.
        inner = lambda a, b, c: math.acos(min(max((a * a + b * b - c * c) / (2 * a * b), -1.0), 1.0))
        thigh = math.atan2(ahead, down) + inner(thigh_length, reach, shin_length)
        knee = math.pi - inner(thigh_length, shin_length, reach)
        out[name + "_thigh"] = about_x(-thigh)
        out[name + "_shin"] = about_x(knee)
        out[name + "_foot"] = about_x(thigh - knee)
    lowered = smooth(t, LOWERED, WALK)
    ahead = (foot_at(1, t)[0] - foot_at(0, t)[0]) / STEP_LENGTH  # of the right foot, before the left
    for side, name in ((1, "left"), (-1, "right")):
        swing = side * 0.32 * ahead * lowered
        out[name + "_arm"] = product(about_x(-swing), about_z(-side * math.radians(46) * lowered))
        out[name + "_forearm"] = product(about_z(-side * 0.12 * lowered), about_x(-0.25 * lowered))
    out["spine"] = (0.0, math.sin(0.03 * ahead), 0.0, math.cos(0.03 * ahead))
    return out


class Binary:
    """The binary part of a GLB, and the accessors into it."""

    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def add(self, rows, code, component, kind, **more):
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        flat = [x for row in rows for x in row] if width > 1 else list(rows)
        data = struct.pack("<%d%s" % (len(flat), code), *flat)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        if more.get("use"):
            self.views[-1]["target"] = more["use"]
        self.bytes += data + b"\0" * (-len(data) % 4)
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(flat) // width, "type": kind}
        if more.get("bounds"):
            columns = [[struct.unpack("<f", struct.pack("<f", x))[0] for x in flat[c::width]] for c in range(width)]
            accessor["min"], accessor["max"] = [min(c) for c in columns], [max(c) for c in columns]
        self.accessors.append(accessor)
        return len(self.accessors) - 1


FLOAT, SHORT, INT = 5126, 5123, 5125
VERTICES, INDICES = 34962, 34963


def walker(spacing):
    vertices, quads = make_garment.surface_net(body_distance, (-0.64, -0.04, -0.22), (0.64, 1.84, 0.26), spacing)
    triangles = [corner for q in quads for corner in (q[0] - 1, q[1] - 1, q[2] - 1, q[0] - 1, q[2] - 1, q[3] - 1)]
    influences = [weights_of(p) for p in vertices]
    padded = [list(zip(*(i + [(0, 0.0)] * (4 - len(i))))) for i in influences]
    breath = [(0, 0, 0.008 * smooth(p[1], 1.08, 1.2) * smooth(p[1], 1.33, 1.24) * smooth(p[2], 0.02, 0.09)
               * smooth(abs(p[0]), 0.16, 0.1)) for p in vertices]
    binary = Binary()
    primitive = {"attributes": {"POSITION": binary.add(vertices, "f", FLOAT, "VEC3", bounds=True, use=VERTICES),
                                "JOINTS_0": binary.add([p[0] for p in padded], "H", SHORT, "VEC4", use=VERTICES),
                                "WEIGHTS_0": binary.add([p[1] for p in padded], "f", FLOAT, "VEC4", use=VERTICES)},
                 "indices": binary.add(triangles, "I", INT, "SCALAR", use=INDICES), "material": 0,
                 "targets": [{"POSITION": binary.add(breath, "f", FLOAT, "VEC3", bounds=True, use=VERTICES)}]}
    binds = []
    nodes = []
    for k, (name, parent, place) in enumerate(JOINTS):
        above = JOINTS[NUMBER[parent]][2] if parent else (0, 0, 0)
        nodes.append({"name": name, "translation": [a - b for a, b in zip(place, above)]})
        children = [NUMBER[n] for n, p, _ in JOINTS if p == name]
        if children:
            nodes[-1]["children"] = children
        binds.append([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -place[0], -place[1], -place[2], 1])
    nodes.append({"name": "walker", "mesh": 0, "skin": 0})
    skin = {"joints": list(range(len(JOINTS))), "inverseBindMatrices": binary.add(binds, "f", FLOAT, "MAT4"), "skeleton": 0}
    animation = {"name": "walk", "samplers": [], "channels": []}

    def channel(node, path, times, values, kind, interpolation="LINEAR"):
        animation["samplers"].append({"input": binary.add(times, "f", FLOAT, "SCALAR", bounds=True),
                                      "output": binary.add(values, "f", FLOAT, kind), "interpolation": interpolation})
        animation["channels"].append({"sampler": len(animation["samplers"]) - 1, "target": {"node": node, "path": path}})

    keys = hip_keys()
    tangents = slopes(keys)
    home = JOINTS[0][2]
    places = []
    for (_, place), slope in zip(keys, tangents):
        places += [slope, [a + b for a, b in zip(home, place)], slope]
    channel(0, "translation", [t for t, _ in keys], places, "VEC3", "CUBICSPLINE")
    times = [LOWERED + k / 30 for k in range(round((END - LOWERED) * 30) + 1)]
    poses = [pose_at(t, keys, tangents) for t in times]
    for name in poses[0]:
        channel(NUMBER[name], "rotation", times, [pose[name] for pose in poses], "VEC4")
    breaths = [k / 10 for k in range(round(END * 10) + 1)]
    channel(len(JOINTS), "weights", breaths, [0.5 - 0.5 * math.cos(2 * math.pi * t / 2.4) for t in breaths], "SCALAR")
    document = {
        "asset": {"version": "2.0", "generator": "make_walker.py"}, "scene": 0,
        "scenes": [{"nodes": [0, len(JOINTS)]}], "nodes": nodes, "skins": [skin],
        "meshes": [{"name": "body", "primitives": [primitive], "weights": [0]}],
        "materials": [{"name": "skin", "pbrMetallicRoughness": {"baseColorFactor": [0.58, 0.38, 0.26, 1],
                                                                "metallicFactor": 0, "roughnessFactor": 0.8}}],
        "animations": [animation], "accessors": binary.accessors, "bufferViews": binary.views,
        "buffers": [{"byteLength": len(binary.bytes)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    whole = 12 + 8 + len(text) + 8 + len(binary.bytes)
    return (struct.pack("<4sIIII", b"glTF", 2, whole, len(text), 0x4E4F534A) + text
            + struct.pack("<II", len(binary.bytes), 0x004E4942) + binary.bytes), len(vertices)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spacing", type=float, default=0.011, help="between vertices of the cloth [m]")
    parser.add_argument("--body-spacing", type=float, default=0.017, help="between vertices of the body [m]")
    parser.add_argument("--pins", action="store_true", help="only print the keyframes of the hips")
    parser.add_argument("-o", default=os.path.dirname(os.path.abspath(__file__)), help="folder")
    options = parser.parse_args()
    if options.pins:
        for t, place in hip_keys():
            print("    { time = %.9g, position = [%.9g, %.9g, %.9g] }," % (t, *place))
        return
    os.makedirs(options.o, exist_ok=True)
    path = lambda name: os.path.join(options.o, name)
    vertices, uvs, faces, lines, groups = make_garment.tshirt(options.spacing, 0.21)
    make_garment.write_obj(path("walk_tshirt.obj"), vertices, faces, uvs, lines, groups)
    vertices, uvs, faces, lines, groups = make_garment.skirt(options.spacing)
    make_garment.write_obj(path("walk_skirt.obj"), vertices, faces, uvs, lines, groups)
    glb, count = walker(options.body_spacing)
    with open(path("walker.glb") + ".part", "wb") as file:
        file.write(glb)
    os.replace(path("walker.glb") + ".part", path("walker.glb"))
    print("%s: %d vertices, %d joints" % (path("walker.glb"), count, len(JOINTS)))


if __name__ == "__main__":
    main()
