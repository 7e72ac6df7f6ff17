#!/usr/bin/env python3
"""Makes the meshes of the scenes in this folder: python3 scenes/garments/make_garment.py [--spacing METRES] [-o DIR]

  tshirt.obj   a front and a back panel of quads, flat, before and behind the body; l lines are the seams that sew
               sleeves, sides and shoulders; groups "front", "back", "front_top" and "back_top" (where shoulders are sewn),
                 "neck", "hem", "cuffs"
  skirt.obj    a closed ring of quads with a flare; groups "waist", "hem"
  body.obj     a closed triangle mesh: torso, neck and arms grown together
  arm.obj, arm.pc2   a forearm that bends at the elbow: a mesh that deforms, 31 samples

The default spacing gives a T-shirt of more than 20,000 vertices. Lengths are metres, y is up."""

import argparse
import math
import os
import struct

SLEEVE_DROP = 0.42  # metres down per metre out, of shoulder and sleeve


def tshirt(spacing):
    width, length, reach, sleeve, neck = 0.52, 0.66, 0.44, 0.21, 0.115
    half, columns, rows = round(width / 2 / spacing), round(reach / spacing), round(length / spacing)
    deep = round(sleeve / spacing)
    vertices, uvs, faces, lines = [], [], [], []
    groups = {"front": [], "back": [], "front_top": [], "back_top": [], "neck": [], "hem": [], "cuffs": []}
    number = {}
    for panel, z in (("front", 0.19), ("back", -0.19)):
        for j in range(rows + 1):
            for i in range(-columns, columns + 1):
                if abs(i) > half and j > deep:
                    continue
                x, y = i * spacing, j * spacing
                number[panel, i, j] = len(vertices) + 1
                # The shoulder slopes from the neck on, and the sleeve with it: columns are sheared, not stretched.
                drop = SLEEVE_DROP * max(0.0, abs(x) - neck)
                vertices.append((x, 1.47 - y - drop, z))
                uvs.append((x + 0.5, 1 - y))
                groups[panel].append(len(vertices))
        for j in range(rows):
            for i in range(-columns, columns):
                corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
                if all((panel, *c) in number for c in corners):
                    a, b, c, d = (number[(panel, *c)] for c in corners)
                    faces.append((a, b, c, d) if panel == "front" else (a, d, c, b))
    top = round(neck / spacing)
    sewn = [(i, 0) for i in range(-columns, columns + 1) if abs(i) >= top]
    for side in (-1, 1):
        sewn += [(side * i, deep) for i in range(half, columns + 1)]
        sewn += [(side * half, j) for j in range(deep + 1, rows + 1)]
    for i, j in sewn:
        lines.append((number["front", i, j], number["back", i, j]))
    for panel in ("front", "back"):
        groups[panel + "_top"] += [number[panel, i, 0] for i in range(-columns, columns + 1) if abs(i) >= top]
        groups["neck"] += [number[panel, i, 0] for i in range(1 - top, top)]
        groups["hem"] += [number[panel, i, rows] for i in range(-half, half + 1)]
        groups["cuffs"] += [number[panel, s * columns, j] for s in (-1, 1) for j in range(deep + 1)]
    return vertices, uvs, faces, lines, groups


def skirt(spacing):
    """A ring from the waist down, its columns spread evenly; circumference grows with the way down."""
    waist, flare, length, top = 0.96, 1.25, 0.5, 1.0
    columns, rows = round(waist * 1.2 / spacing), round(length / spacing)
    vertices, uvs, faces = [], [], []
    for j in range(rows + 1):
        down = length * j / rows
        radius = (waist + flare * down) / (2 * math.pi)
        fall = down * math.sqrt(max(1 - (flare / (2 * math.pi)) ** 2, 0.1))
        for i in range(columns + 1):
            angle = 2 * math.pi * i / columns
            if i < columns:
                vertices.append((radius * math.sin(angle), top - fall, radius * math.cos(angle)))
            uvs.append((waist * 1.2 * i / columns, 1 - down))
    at = lambda i, j: j * columns + i % columns + 1
    uv = lambda i, j: j * (columns + 1) + i + 1
    for j in range(rows):
        for i in range(columns):
            ring = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            faces.append(tuple((at(*c), uv(*c)) for c in ring))
    groups = {"waist": [at(i, 0) for i in range(columns)], "hem": [at(i, rows) for i in range(columns)]}
    return vertices, uvs, faces, [], groups


def capsule_distance(p, a, b, ra, rb):
    d = [b[k] - a[k] for k in range(3)]
    q = [p[k] - a[k] for k in range(3)]
    t = max(0.0, min(1.0, sum(d[k] * q[k] for k in range(3)) / sum(x * x for x in d)))
    return math.sqrt(sum((q[k] - t * d[k]) ** 2 for k in range(3))) - (ra + t * (rb - ra))


def body_distance(p):
    """Capsules grown together: exponential smooth minimum."""
    x, y, z = p
    flat = (x, y, z / 0.72)  # a torso is wider than deep
    parts = [capsule_distance(flat, (0, 0.72, 0), (0, 1.02, 0), 0.165, 0.135),
             capsule_distance(flat, (0, 1.02, 0), (0, 1.27, 0), 0.135, 0.155),
             capsule_distance(p, (0, 1.30, 0), (0, 1.52, 0), 0.06, 0.055),
             capsule_distance(p, (0, 1.62, 0), (0, 1.66, 0), 0.09, 0.095)]
    for side in (-1, 1):
        parts.append(capsule_distance(p, (side * 0.13, 1.335, 0), (side * 0.52, 1.165, 0), 0.062, 0.042))
        parts.append(capsule_distance(p, (side * 0.10, 0.72, 0), (side * 0.12, 0.3, 0), 0.085, 0.055))
    k = 60.0
    return -math.log(sum(math.exp(-k * d) for d in parts)) / k


def marching_tetrahedra(distance, low, high, spacing):
    """A closed surface of distance = 0; six tetrahedra a cube, all cut the same way, so that neighbours agree."""
    counts = [round((h - l) / spacing) for l, h in zip(low, high)]
    points = [[l + spacing * i for i in range(n + 1)] for l, n in zip(low, counts)]
    value = {}

    def at(i, j, k):
        if (i, j, k) not in value:
            value[i, j, k] = distance((points[0][i], points[1][j], points[2][k])) or 1e-9
        return value[i, j, k]

    vertices, numbers, faces = [], {}, []

    def crossing(a, b):
        key = (a, b) if a < b else (b, a)
        if key not in numbers:
            a, b = key
            t = min(max(at(*a) / (at(*a) - at(*b)), 0.05), 0.95)
            pa, pb = ([points[d][c[d]] for d in range(3)] for c in key)
            vertices.append(tuple(x + t * (y - x) for x, y in zip(pa, pb)))
            numbers[key] = len(vertices)
        return numbers[key]

    tetrahedra = ((0, 5, 1, 6), (0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6))
    corners = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
    for i in range(counts[0]):
        for j in range(counts[1]):
            for k in range(counts[2]):
                cube = [(i + a, j + b, k + c) for a, b, c in corners]
                values = [at(*c) for c in cube]
                if min(values) > 0 or max(values) < 0:
                    continue
                for tetrahedron in tetrahedra:
                    inside = [cube[t] for t in tetrahedron if values[t] < 0]
                    outside = [cube[t] for t in tetrahedron if values[t] >= 0]
                    if not inside or not outside:
                        continue
                    if len(inside) == 2:
                        (a, b), (c, d) = inside, outside
                        ring = [crossing(a, c), crossing(a, d), crossing(b, d), crossing(b, c)]
                        cut = [(ring[0], ring[1], ring[2]), (ring[0], ring[2], ring[3])]
                    elif len(inside) == 1:
                        cut = [tuple(crossing(inside[0], o) for o in outside)]
                    else:
                        cut = [tuple(crossing(o, outside[0]) for o in inside)]
                    # Outward is from inside to outside.
                    away = [sum(o[d] for o in outside) / len(outside) - sum(c[d] for c in inside) / len(inside)
                            for d in range(3)]
                    for face in cut:
                        p, q, r = (vertices[v - 1] for v in face)
                        u, w = [q[d] - p[d] for d in range(3)], [r[d] - p[d] for d in range(3)]
                        n = (u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
                        faces.append(face if sum(n[d] * away[d] for d in range(3)) > 0 else face[::-1])
    return vertices, faces


def arm(columns=24, rows=40):
    """A closed tube along x from the shoulder; its bend at the elbow is that of a smooth hinge."""
    length, radius, elbow = 0.56, 0.045, 0.28
    flat = []
    for j in range(rows + 1):
        x = length * j / rows
        for i in range(columns):
            angle = 2 * math.pi * i / columns
            flat.append((x, radius * math.cos(angle), radius * math.sin(angle)))
    flat += [(-0.03, 0, 0), (length + 0.03, 0, 0)]
    at = lambda i, j: j * columns + i % columns + 1
    faces = [(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)) for j in range(rows) for i in range(columns)]
    faces = [f[::-1] for f in faces]
    start, end = len(flat) - 1, len(flat)
    faces += [(start, at(i, 0), at(i + 1, 0))[::-1] for i in range(columns)]
    faces += [(end, at(i + 1, rows), at(i, rows))[::-1] for i in range(columns)]

    def bent(degrees):
        out = []
        for x, y, z in flat:
            # The angle goes up evenly over a stretch of the arm: an arc of circle there, straight after.
            stretch = 0.16
            s = min(max((x - elbow) / stretch + 0.5, 0.0), 1.0)
            whole = math.radians(degrees)
            turn = whole * s
            start_x = elbow - stretch / 2
            if whole < 1e-9:
                out.append((x, y, z))
                continue
            bow = stretch / whole
            along = start_x + bow * math.sin(turn) if x > start_x else x
            up = bow * (1 - math.cos(turn)) if x > start_x else 0.0
            beyond = max(x - start_x - stretch, 0.0)
            along += beyond * math.cos(whole)
            up += beyond * math.sin(whole)
            out.append((along - y * math.sin(turn), up + y * math.cos(turn), z))
        return out

    samples = [bent(85 * (1 - math.cos(math.pi * k / 30)) / 2) for k in range(31)]
    return flat, faces, samples


def write_obj(path, vertices, faces, uvs=(), lines=(), groups=None):
    with open(path + ".part", "w") as file:
        file.write("# made by make_garment.py: metres, y up\n")
        file.writelines("v %.9g %.9g %.9g\n" % v for v in vertices)
        file.writelines("vt %.9g %.9g\n" % uv for uv in uvs)
        for face in faces:
            if isinstance(face[0], tuple):
                file.write("f " + " ".join("%d/%d" % c for c in face) + "\n")
            elif uvs:
                file.write("f " + " ".join("%d/%d" % (v, v) for v in face) + "\n")
            else:
                file.write("f " + " ".join(map(str, face)) + "\n")
        file.writelines("l %d %d\n" % line for line in lines)
        for name, members in (groups or {}).items():
            file.write("g %s\n" % name)
            for k in range(0, len(members), 20):
                file.write("p " + " ".join(map(str, members[k:k + 20])) + "\n")
    os.replace(path + ".part", path)
    print("%s: %d vertices, %d faces, %d stitches" % (path, len(vertices), len(faces), len(lines)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spacing", type=float, default=0.0062, help="between vertices of the cloth [m]")
    parser.add_argument("--body-spacing", type=float, default=0.02, help="between vertices of the body [m]")
    parser.add_argument("-o", default=os.path.dirname(os.path.abspath(__file__)), help="folder")
    options = parser.parse_args()
    os.makedirs(options.o, exist_ok=True)
    path = lambda name: os.path.join(options.o, name)
    vertices, uvs, faces, lines, groups = tshirt(options.spacing)
    write_obj(path("tshirt.obj"), vertices, faces, uvs, lines, groups)
    vertices, uvs, faces, lines, groups = skirt(options.spacing * 1.3)
    write_obj(path("skirt.obj"), vertices, faces, uvs, lines, groups)
    vertices, faces = marching_tetrahedra(body_distance, (-0.64, 0.16, -0.22), (0.64, 1.84, 0.22), options.body_spacing)
    write_obj(path("body.obj"), vertices, faces)
    vertices, faces, samples = arm()
    write_obj(path("arm.obj"), vertices, faces)
    with open(path("arm.pc2") + ".part", "wb") as file:
        file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(vertices), 0.0, 1.0, len(samples)))
        for sample in samples:
            file.write(b"".join(struct.pack("<3f", *p) for p in sample))
    os.replace(path("arm.pc2") + ".part", path("arm.pc2"))


if __name__ == "__main__":
    main()
