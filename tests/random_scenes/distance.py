"""Where solids are and how far it is to them, from the scene alone: not by the code that is tested."""

import math


def rotation(degrees):
    """About x, then y, then z."""
    (sx, cx), (sy, cy), (sz, cz) = ((math.sin(a), math.cos(a)) for a in map(math.radians, degrees))
    return [[cy * cz, sx * sy * cz - cx * sz, cx * sy * cz + sx * sz],
            [cy * sz, sx * sy * sz + cx * cz, cx * sy * sz - sx * cz],
            [-sy, sx * cy, cx * cy]]


def times(matrix, v):
    return [sum(row[k] * v[k] for k in range(3)) for row in matrix]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def channels(key):
    return list(key.get("position", [0, 0, 0])) + list(key.get("rotation", [0, 0, 0]))


def slope(keys, k):
    """Fritsch and Carlson's harmonic mean, zero at the ends and where a channel turns round."""
    out = [0.0] * 6
    if k == 0 or k + 1 == len(keys):
        return out
    before, after = keys[k]["time"] - keys[k - 1]["time"], keys[k + 1]["time"] - keys[k]["time"]
    here, left, right = channels(keys[k]), channels(keys[k - 1]), channels(keys[k + 1])
    for c in range(6):
        a, b = (here[c] - left[c]) / before, (right[c] - here[c]) / after
        if a * b > 0:
            w1, w2 = 2 * after + before, after + 2 * before
            out[c] = (w1 + w2) / (w1 / a + w2 / b)
    return out


def sample(keys, t, how="smooth"):
    if t <= keys[0]["time"]:
        return channels(keys[0])
    if t >= keys[-1]["time"]:
        return channels(keys[-1])
    k = max(i for i, key in enumerate(keys) if key["time"] <= t)
    span = keys[k + 1]["time"] - keys[k]["time"]
    s = (t - keys[k]["time"]) / span
    h01, h10, h11 = s * s * (3 - 2 * s), s * (1 - s) ** 2, s * s * (s - 1)
    if how != "smooth":
        share = {"linear": s, "ease": h01, "hold": 0.0}[how]
        return [(1 - share) * a + share * b for a, b in zip(channels(keys[k]), channels(keys[k + 1]))]
    a, b, da, db = channels(keys[k]), channels(keys[k + 1]), slope(keys, k), slope(keys, k + 1)
    return [(1 - h01) * a[c] + h01 * b[c] + span * (h10 * da[c] + h11 * db[c]) for c in range(6)]


class Placed:
    """A solid of the scene where it is at time t."""

    def __init__(self, body, t):
        self.body = body
        self.centre = list(body.get("center", [0, 0, 0]))
        self.axes = rotation(body.get("rotation", [0, 0, 0]))
        if body.get("motion"):
            moved = sample(body["motion"], t, body.get("interpolation", "smooth"))
            turn = rotation(moved[3:])
            pivot = body.get("pivot", self.centre)
            arm = times(turn, [self.centre[k] - pivot[k] for k in range(3)])
            self.centre = [pivot[k] + moved[k] + arm[k] for k in range(3)]
            self.axes = product(turn, self.axes)

    def distance(self, x):
        """Negative inside [m]."""
        d = [x[k] - self.centre[k] for k in range(3)]
        p = [sum(self.axes[k][i] * d[k] for k in range(3)) for i in range(3)]
        body, shape = self.body, self.body["shape"]
        if "fall" in body or "parent" in body:
            return math.inf  # where these are is the tool's own reckoning
        if shape == "plane":
            return p[1]
        if shape == "sphere":
            return math.dist(p, (0, 0, 0)) - body.get("radius", 0.3)
        if shape == "box":
            size, round_ = body.get("size", [1, 1, 1]), body.get("round", 0)
            return rounded_box([abs(p[k]) - max(size[k] / 2 - round_, 0) for k in range(3)]) - round_
        radius, height = body.get("radius", 0.3), body.get("height", 1.0)
        if shape == "cylinder":
            round_ = body.get("round", 0)
            return rounded_box([math.hypot(p[0], p[2]) - max(radius - round_, 0),
                                abs(p[1]) - max(height / 2 - round_, 0)]) - round_
        if shape == "capsule":
            on_axis = min(max(p[1], -height / 2), height / 2)
            return math.dist(p, (0, on_axis, 0)) - radius
        return math.inf  # a mesh is its own matter


def rounded_box(beyond):
    if max(beyond) <= 0:
        return max(beyond)
    return math.sqrt(sum(max(b, 0) ** 2 for b in beyond))
