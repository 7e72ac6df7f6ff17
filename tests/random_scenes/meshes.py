"""Small meshes by chance, as OBJ texts."""

import math


def obj(vertices, groups):
    lines = [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in vertices]
    for name, faces in groups:
        lines.append(f"g {name}")
        lines += ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    return "\n".join(lines) + "\n"


def reach_of(vertices):
    return max(math.sqrt(x * x + y * y + z * z) for x, y, z in vertices)


def disc(dice, size):
    """Rings of triangles about a middle, lying flat."""
    rings, spokes = dice.whole(1, 5), dice.whole(4, 12)
    vertices = [(0.0, 0.0, 0.0)]
    for ring in range(1, rings + 1):
        for spoke in range(spokes):
            angle = 2 * math.pi * (spoke + 0.3 * ring) / spokes
            r = 0.5 * size * ring / rings
            vertices.append((r * math.cos(angle), 0.0, r * math.sin(angle)))

    def at(ring, spoke):
        return 0 if ring == 0 else 1 + (ring - 1) * spokes + spoke % spokes

    inner = [(0, at(1, s + 1), at(1, s)) for s in range(spokes)]
    outer = []
    for ring in range(1, rings):
        for s in range(spokes):
            outer.append((at(ring, s), at(ring, s + 1), at(ring + 1, s + 1)))
            outer.append((at(ring, s), at(ring + 1, s + 1), at(ring + 1, s)))
    groups = [("middle", inner)] + ([("rim", outer)] if outer else [])
    return obj(vertices, groups), "middle", len(vertices), reach_of(vertices)


def strip(dice, size):
    """Triangles in a row, some long, some short."""
    cells = dice.whole(1, 12)
    vertices, x = [], 0.0
    for k in range(cells + 1):
        vertices += [(x, 0.0, 0.0), (x + 0.2 * size / cells, 0.0, 0.3 * size)]
        x += size / cells * (0.5 + (k % 3) / 2)
    faces = []
    for k in range(cells):
        a = 2 * k
        faces += [(a, a + 1, a + 3), (a, a + 3, a + 2)]
    return (obj(vertices, [("first", faces[:2])] + ([("rest", faces[2:])] if faces[2:] else [])), "first",
            len(vertices), reach_of(vertices))


def sheet_with_a_hole(dice, size):
    """Quads and triangles mixed, some of them missing."""
    n = dice.whole(3, 8)
    vertices = [(size * (i / n - 0.5), 0.0, size * (j / n - 0.5)) for j in range(n + 1) for i in range(n + 1)]
    held, faces = [], []
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            quad = (a, a + n + 1, a + n + 2, a + 1)
            into = held if j == 0 else faces
            if 0 < i < n - 1 and 0 < j < n - 1 and (i, j) == (n // 2, n // 2):
                continue
            if (i + j) % 3 == 0:
                into += [quad[:3], (quad[0], quad[2], quad[3])]
            else:
                into.append(quad)
    return obj(vertices, [("edge", held), ("body", faces)]), "edge", len(vertices), reach_of(vertices)


def tetrahedron(size):
    a = size / 2
    vertices = [(a, a, a), (a, -a, -a), (-a, a, -a), (-a, -a, a)]
    return obj(vertices, [("all", [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)])])


def cube(size):
    a = size / 2
    vertices = [(x, y, z) for x in (-a, a) for y in (-a, a) for z in (-a, a)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return obj(vertices, [("all", faces)])
