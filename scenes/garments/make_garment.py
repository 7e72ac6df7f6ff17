#!/usr/bin/env python3
"""Makes the meshes of the scenes in this folder: python3 scenes/garments/make_garment.py [--spacing METRES] [-o DIR]

  tshirt.obj   a front and a back panel of quads, flat, before and behind the body; l lines are the seams that sew
               sleeves, sides and shoulders; groups "front", "back", "front_top" and "back_top" (where shoulders are sewn),
                 "neck", "hem", "cuffs"
  skirt.obj    a closed ring of quads with a flare; groups "waist", "hem"
  body.obj     a closed mesh of quads: torso, neck and arms grown together
  arm.obj, arm.pc2   a forearm that bends at the elbow: a mesh that deforms, 31 samples

The default spacing gives a T-shirt of more than 20,000 vertices. Lengths are metres, y is up."""

import argparse
import itertools
import math
import os
import struct


def tshirt(spacing, away=0.15):
    """Panels as they are cut, so far before and behind the middle. Shoulders follow the body, with room between; rows run from there to the armhole, and on
    to the hem. Sleeves are their outer columns."""
    width, reach, hem, neck = 0.50, 0.44, 0.80, 0.095
    half, columns = round(width / 2 / spacing), round(reach / spacing)
    armhole = lambda x: 0.21 - 0.04 * max(0.0, x - width / 2) / (reach - width / 2)  # half of a sleeve's circumference
    shoulder = {i: top_of_body(i * spacing) for i in range(columns + 1)}
    deep = round(armhole(0) / spacing)
    under = shoulder[half] - armhole(0)
    rows = deep + round((under - hem) / spacing)
    at_neck = round(neck / spacing)

    def height(panel, i, j):
        scoop = 0.05 if panel == "front" else 0.015
        top = shoulder[max(i, at_neck)] - scoop * math.cos(math.pi / 2 * min(i / at_neck, 1)) ** 2
        if i > half:
            return top - armhole(i * spacing) * j / deep
        return top + (under - top) * j / deep if j <= deep else under + (hem - under) * (j - deep) / (rows - deep)

    vertices, uvs, faces, lines = [], [], [], []
    groups = {"front": [], "back": [], "front_top": [], "back_top": [], "neck": [], "hem": [], "cuffs": []}
    number = {}
    for panel, z in (("front", away), ("back", -away)):
        for j in range(rows + 1):
            for i in range(-columns, columns + 1):
                if abs(i) > half and j > deep:
                    continue
                number[panel, i, j] = len(vertices) + 1
                vertices.append((i * spacing, height(panel, abs(i), j), z))
                uvs.append((i * spacing + 0.5, vertices[-1][1] - hem))
                groups[panel].append(len(vertices))
        for j in range(rows):
            for i in range(-columns, columns):
                corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
                if all((panel, *c) in number for c in corners):
                    a, b, c, d = (number[(panel, *c)] for c in corners)
                    faces.append((a, b, c, d) if panel == "front" else (a, d, c, b))
    sewn = [(i, 0) for i in range(-columns, columns + 1) if abs(i) >= at_neck]
    for side in (-1, 1):
        sewn += [(side * i, deep) for i in range(half, columns + 1)]
        sewn += [(side * half, j) for j in range(deep + 1, rows + 1)]
    for i, j in sewn:
        lines.append((number["front", i, j], number["back", i, j]))
    for panel in ("front", "back"):
        groups[panel + "_top"] += [number[panel, i, 0] for i in range(-columns, columns + 1) if abs(i) >= at_neck]
        groups["neck"] += [number[panel, i, 0] for i in range(1 - at_neck, at_neck)]
        groups["hem"] += [number[panel, i, rows] for i in range(-half, half + 1)]
        groups["cuffs"] += [number[panel, s * columns, j] for s in (-1, 1) for j in range(deep + 1)]
    return vertices, uvs, faces, lines, groups


def skirt(spacing):
    """A ring from the waist of the body down, its columns spread evenly; it widens on the way."""
    flare, length, top = 0.2, 0.5, 1.0  # metres out per metre of cloth
    waist = [waist_of_body(2 * math.pi * k / 720, top) for k in range(721)]
    along = [0.0]
    for p, q in zip(waist, waist[1:]):
        along.append(along[-1] + math.dist(p, q))
    columns, rows = round((along[-1] + math.pi * flare * length) / spacing), round(length / spacing)
    ring, k = [], 0  # where each column starts, and which way is out
    for i in range(columns):
        here = along[-1] * i / columns
        while along[k + 1] < here:
            k += 1
        angle = 2 * math.pi * (k + (here - along[k]) / (along[k + 1] - along[k])) / 720
        ring.append((waist_of_body(angle, top), math.sin(angle), math.cos(angle)))
    vertices, uvs, faces = [], [], []
    for j in range(rows + 1):
        down = length * j / rows
        out, fall = flare * down, down * math.sqrt(1 - flare**2)
        vertices += [(x + out * sine, y - fall, z + out * cosine) for (x, y, z), sine, cosine in ring]
        uvs += [(1.4 * i / columns, 1 - down) for i in range(columns + 1)]
    at = lambda i, j: j * columns + i % columns + 1
    uv = lambda i, j: j * (columns + 1) + i + 1
    for j in range(rows):
        for i in range(columns):
            corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            faces.append(tuple((at(*c), uv(*c)) for c in corners))
    groups = {"waist": [at(i, 0) for i in range(columns)], "hem": [at(i, rows) for i in range(columns)]}
    return vertices, uvs, faces, [], groups


def capsules():
    """(a, b - a, |b - a|^-2, radius at a, growth to b, depth): a torso is wider than deep."""
    ends = [((0, 0.72, 0), (0, 1.02, 0), 0.165, 0.135, 0.72), ((0, 1.02, 0), (0, 1.27, 0), 0.135, 0.155, 0.72),
            ((0, 1.30, 0), (0, 1.52, 0), 0.06, 0.055, 1), ((0, 1.62, 0), (0, 1.66, 0), 0.09, 0.095, 1)]
    for side in (-1, 1):
        ends.append(((side * 0.13, 1.335, 0), (side * 0.52, 1.165, 0), 0.062, 0.042, 1))
        ends.append(((side * 0.10, 0.72, 0), (side * 0.12, 0.3, 0), 0.085, 0.055, 1))
    return [(*a, *(y - x for x, y in zip(a, b)), 1 / math.dist(a, b) ** 2, ra, rb - ra, depth)
            for a, b, ra, rb, depth in ends]


CAPSULES = capsules()


def body_distance(p):
    """Capsules grown together: exponential smooth minimum."""
    px, py, pz = p
    k, total = 60.0, 0.0
    for ax, ay, az, dx, dy, dz, inverse, radius, growth, depth in CAPSULES:
        x, y, z = px - ax, py - ay, pz / depth - az
        t = min(max((x * dx + y * dy + z * dz) * inverse, 0.0), 1.0)
        x, y, z = x - t * dx, y - t * dy, z - t * dz
        total += math.exp(-k * (math.sqrt(x * x + y * y + z * z) - radius - t * growth))
    return -math.log(total) / k


def surface_at(point, direction, clearance):
    """The point on the ray, from outside in, that is so far from the body."""
    inside, outside = 0.0, 1.0
    for _ in range(40):
        middle = (inside + outside) / 2
        if body_distance([p + middle * d for p, d in zip(point, direction)]) > clearance:
            outside = middle
        else:
            inside = middle
    return tuple(p + outside * d for p, d in zip(point, direction))


def top_of_body(x):
    return surface_at((x, 1.2 if x < 0.2 else 1.3 - 0.436 * (x - 0.2), 0), (0, 0.4, 0), 0.008)[1]


def waist_of_body(angle, height):
    return surface_at((0, height, 0), (0.5 * math.sin(angle), 0, 0.5 * math.cos(angle)), 0.007)


def surface_net(distance, low, high, spacing):
    """A closed surface of distance = 0, of quads: a vertex in each cell that it passes through, drawn onto it by
    Newton's method; a quad across each edge whose ends lie on two sides (Gibson 1998)."""
    counts = [round((h - l) / spacing) for l, h in zip(low, high)]
    block = 4
    steepest = 1.5  # of the distance, which is a little more than one where space is scaled
    value = {}

    def at(node):
        if node not in value:
            value[node] = distance([l + spacing * k for l, k in zip(low, node)]) or 1e-9
        return value[node]

    near = []  # cells of the blocks that the surface may pass through
    for start in itertools.product(*(range(0, n, block) for n in counts)):
        centre = [l + spacing * (k + block / 2) for l, k in zip(low, start)]
        if abs(distance(centre)) < steepest * spacing * block * math.sqrt(3) / 2:
            near += itertools.product(*(range(k, min(k + block, n)) for k, n in zip(start, counts)))

    corners = list(itertools.product((0, 1), repeat=3))
    edges = [(a, b) for a in corners for b in corners if sum(b) - sum(a) == 1 and sum(x != y for x, y in zip(a, b)) == 1]
    vertices, number = [], {}
    for cell in near:
        values = {c: at(tuple(k + d for k, d in zip(cell, c))) for c in corners}
        crossings = []
        for a, b in edges:
            if (values[a] < 0) != (values[b] < 0):
                t = values[a] / (values[a] - values[b])
                crossings.append([a[k] + t * (b[k] - a[k]) for k in range(3)])
        if crossings:
            p = [l + spacing * (k + sum(c[d] for c in crossings) / len(crossings))
                 for d, (l, k) in enumerate(zip(low, cell))]
            vertices.append(onto(distance, p, spacing))
            number[cell] = len(vertices)
    faces = []
    for cell in number:
        for axis in range(3):
            end = tuple(k + (d == axis) for d, k in enumerate(cell))
            if (at(cell) < 0) == (at(end) < 0):
                continue
            u, v = (axis + 1) % 3, (axis + 2) % 3
            around = [tuple(k - (d == u) * i - (d == v) * j for d, k in enumerate(cell))
                      for i, j in ((1, 1), (0, 1), (0, 0), (1, 0))]
            quad = tuple(number[c] for c in around)
            faces.append(quad if at(cell) < 0 else quad[::-1])
    return vertices, faces


def onto(distance, p, spacing):
    for _ in range(3):
        d, h = distance(p), 1e-4 * spacing
        slope = [(distance([x + h * (k == j) for j, x in enumerate(p)]) - d) / h for k in range(3)]
        square = sum(g * g for g in slope)
        p = [x - d * g / square for x, g in zip(p, slope)]
    return tuple(p)


def arm(columns=24, rows=40):
    """A closed tube along x from the shoulder, round at its ends; its bend at the elbow is that of a smooth hinge."""
    length, radius, elbow, cap = 0.56, 0.045, 0.28, 6
    quarter = [math.pi / 2 * k / cap for k in range(1, cap)]
    profile = [(-radius * math.cos(a), radius * math.sin(a)) for a in quarter]
    profile += [(length * j / rows, radius) for j in range(rows + 1)]
    profile += [(length + radius * math.sin(a), radius * math.cos(a)) for a in quarter]
    flat = []
    for x, r in profile:
        for i in range(columns):
            angle = 2 * math.pi * i / columns
            flat.append((x, r * math.cos(angle), r * math.sin(angle)))
    flat += [(-radius, 0, 0), (length + radius, 0, 0)]
    at = lambda i, j: j * columns + i % columns + 1
    last = len(profile) - 1
    faces = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(last) for i in range(columns)]
    start, end = len(flat) - 1, len(flat)
    faces += [(start, at(i + 1, 0), at(i, 0)) for i in range(columns)]
    faces += [(end, at(i, last), at(i + 1, last)) for i in range(columns)]

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
    parser.add_argument("--spacing", type=float, default=0.0058, help="between vertices of the cloth [m]")
    parser.add_argument("--body-spacing", type=float, default=0.015, help="between vertices of the body [m]")
    parser.add_argument("-o", default=os.path.dirname(os.path.abspath(__file__)), help="folder")
    options = parser.parse_args()
    os.makedirs(options.o, exist_ok=True)
    path = lambda name: os.path.join(options.o, name)
    vertices, uvs, faces, lines, groups = tshirt(options.spacing)
    write_obj(path("tshirt.obj"), vertices, faces, uvs, lines, groups)
    vertices, uvs, faces, lines, groups = skirt(options.spacing * 0.92)
    write_obj(path("skirt.obj"), vertices, faces, uvs, lines, groups)
    vertices, faces = surface_net(body_distance, (-0.64, 0.16, -0.22), (0.64, 1.84, 0.22), options.body_spacing)
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
