"""Cloths by chance: grids of every shape, tubes and meshes, of anything, held by anything."""

import math

from meshes import disc, sheet_with_a_hole, strip

PRESETS = ["cotton", "silk", "denim", "wool", "jersey", "rubber"]
CORNERS = ["u0v0", "u1v0", "u0v1", "u1v1"]


def material(dice, extreme):
    if dice.chance(0.4):
        m = {"preset": dice.pick(PRESETS)}
        if dice.chance(0.2):
            m["bend"] = dice.spread(1e-7, 1e-3)
        return m
    stiff = dice.spread(1, 1e8) if extreme else dice.spread(10, 2e4)
    m = {"stretch": [stiff, dice.rounded(stiff * dice.spread(0.1, 10))] if dice.chance(0.3) else stiff}
    if dice.chance(0.7):
        m["shear"] = 0 if dice.chance(0.15) else dice.rounded(stiff * dice.spread(1e-3, 1))
    if dice.chance(0.6):
        m["bend"] = 0 if dice.chance(0.1) else dice.spread(1e-9, 10 if extreme else 1e-3)
    if dice.chance(0.5):
        m["stretch_damping"] = 0 if dice.chance(0.2) else dice.spread(1e-6, 1e3 if extreme else 0.1)
    if dice.chance(0.3):
        m["shear_damping"] = 0 if dice.chance(0.2) else dice.spread(1e-6, 1e2 if extreme else 0.01)
    if dice.chance(0.2):
        m["buckling_strain"] = dice.spread(1e-3, 0.5)
    if extreme and dice.chance(0.1):
        m["stretch"] = 0
    return m


def particles(dice, most):
    """Every shape of grid: one particle, threads, ribbons, squares, long and wide ones."""
    kind = dice.weighed({"one": 1, "thread": 2, "ribbon": 3, "small": 8, "any": 8, "large": 2})
    if kind == "one":
        return [1, 1]
    if kind == "thread":
        n = dice.whole(2, 40)
        return [1, n] if dice.chance(0.5) else [n, 1]
    if kind == "ribbon":
        n, m = dice.whole(2, 60), dice.whole(2, 3)
        return [m, n] if dice.chance(0.5) else [n, m]
    if kind == "small":
        return [dice.whole(2, 9), dice.whole(2, 9)]
    nu = dice.whole(5, 24) if kind == "any" else dice.whole(30, 48)
    nv = dice.whole(5, 24) if kind == "any" else dice.whole(30, 48)
    while nu * nv > most:
        nu, nv = (nu + 1) // 2, (nv + 1) // 2
    return [nu, nv]


def start_shape(dice, cloth):
    """How a sheet lies at the start; it reaches no farther than when it is flat."""
    nu, nv = cloth["particles"]
    start = {"shape": dice.pick(["pleated", "folded", "rolled", "over-bar"])}
    across = dice.pick(["u", "v"])
    length = cloth["size"][0 if across == "u" else 1]
    start["from"] = across + dice.pick(["0", "1"])
    if start["shape"] == "pleated":
        start["pleats"] = dice.whole(1, max(1, (nu if across == "u" else nv) // 4))
        start["width"] = dice.rounded(length * dice.number(0.5, 0.95))
    elif start["shape"] == "folded":
        start["folds"] = dice.whole(1, 3)
        start["gap"] = dice.rounded(length * dice.number(0.01, 0.05))
    elif start["shape"] == "rolled":
        start["radius"] = dice.rounded(length * dice.number(0.05, 0.15))
        start["gap"] = dice.rounded(length * dice.number(0.01, 0.05))
        start["flat"] = dice.rounded(length * dice.number(0, 0.5))
    else:
        start["radius"] = dice.rounded(length * dice.number(0.02, 0.1))
        start["share"] = dice.number(0.2, 0.8)
    return start


def motion(dice, duration, size):
    """Keyframes from rest, as pins want them: the first displaces nothing."""
    keys = [{"time": dice.rounded(dice.number(0, 0.3) * duration)}]
    for _ in range(dice.whole(1, 2)):
        key = {"time": dice.rounded(keys[-1]["time"] + dice.number(0.2, 0.6) * duration)}
        if dice.chance(0.8):
            key["position"] = dice.vector(size)
        if dice.chance(0.4):
            key["rotation"] = dice.vector(90)
        keys.append(key)
    return keys


def box(dice):
    u, v = dice.number(0, 0.6), dice.number(0, 0.6)
    return [u, v, dice.rounded(u + dice.number(0.2, 0.4)), dice.rounded(v + dice.number(0.2, 0.4))]


def grid_pin(dice, cloth):
    nu, nv = cloth["particles"]
    tube = cloth.get("wrap") == "tube"
    kinds = {"particles": 2, "edge": 3, "disc": 2}
    if not tube:
        kinds["corner"] = 4
    if min(nu, nv) >= 6:
        kinds["box"] = 2
    kind = dice.weighed(kinds)
    if kind == "corner":
        names = [name for name in CORNERS if dice.chance(0.4)]
        return {"corner": names or dice.pick(CORNERS)}
    if kind == "edge":
        return {"edge": dice.pick(["v0", "v1"] if tube else ["u0", "u1", "v0", "v1"])}
    if kind == "box":
        return {"box": box(dice)}
    if kind == "disc":
        # Around a particle, so that it catches one.
        i, j = dice.whole(0, nu - 1), dice.whole(0, nv - 1)
        u, v = i / (nu if tube else max(nu - 1, 1)), j / max(nv - 1, 1)
        return {"disc": {"center": [u, v], "radius": dice.spread(0.01, 0.2)}}
    i, j = dice.whole(0, nu - 1), dice.whole(0, nv - 1)
    return {"particles": [i, dice.whole(i, nu - 1), j, dice.whole(j, nv - 1)]}


def pins(dice, cloth, duration, group):
    """`group`: of a mesh's vertices; None: a grid."""
    found = []
    for _ in range(dice.weighed({0: 4, 1: 5, 2: 2, 3: 1})):
        if group is None:
            pin = grid_pin(dice, cloth)
        elif dice.chance(0.7):
            pin = {"group": group}
        else:
            low = [c - 1000 for c in cloth["center"]]
            pin = {"within": low + [cloth["center"][0], low[1] + 2000, low[2] + 2000]}
        if dice.chance(0.35):
            pin["motion"] = motion(dice, duration, 0.2)
            if dice.chance(0.3):
                pin["interpolation"] = dice.pick(["smooth", "linear", "ease", "hold"])
        elif isinstance(pin.get("edge"), str) and dice.chance(0.4):
            pin["gather"], pin["gather_time"] = dice.spread(0.05, 0.5), dice.rounded(duration * dice.number(0.3, 1))
        elif dice.chance(0.15):
            pin["slide"] = dice.pick([[1, 0, 0], [0, 1, 0], [0.5, 0, 1]])
        if isinstance(pin.get("edge"), str) and dice.chance(0.3):
            pin["count"] = dice.whole(1, max(1, min(cloth.get("particles", [2, 2]))))
        if dice.chance(0.3):
            pin["release"] = dice.rounded(duration * dice.number(0, 1.2))
        found.append(pin)
    return found


def mesh_cloth(dice, name, files):
    """A mesh of its own file; returns (cloth, group, low, reach, particles)."""
    size = dice.spread(0.1, 1)
    kind = dice.pick([disc, sheet_with_a_hole, strip])
    text, group, count, reach = kind(dice, size)
    files[name] = text
    cloth = {"mesh": name}
    if dice.chance(0.2):
        cloth["mesh_scale"] = 0.5
        reach = reach / 2
    return cloth, group, reach, count


def grid_cloth(dice, most):
    cloth = {"particles": particles(dice, most)}
    size = [dice.spread(0.05, 1.5), dice.spread(0.05, 1.5)]
    nu, nv = cloth["particles"]
    if nu >= 3 and nv >= 2 and dice.chance(0.2):
        cloth["wrap"] = "tube"
    elif nu > 1 and nv > 1 and dice.chance(0.6):
        # Most cells are nearly square.
        size[1] = dice.rounded(size[0] * (nv - 1) / (nu - 1) * dice.number(0.8, 1.25))
    cloth["size"] = [min(max(s, 0.01), 5.0) for s in size]
    if min(nu, nv) >= 4 and "wrap" not in cloth and dice.chance(0.15):
        cloth["start"] = start_shape(dice, cloth)
    elif dice.chance(0.15):
        cloth["placed_scale"] = [dice.number(0.7, 1.15), dice.number(0.9, 1.1)]
    scale = cloth.get("placed_scale", [1, 1])
    if cloth.get("wrap") == "tube":
        reach = math.hypot(cloth["size"][0] * scale[0] / (2 * math.pi), cloth["size"][1] * scale[1] / 2)
    else:
        reach = math.hypot(cloth["size"][0] * scale[0], cloth["size"][1] * scale[1]) / 2
    return cloth, reach


def make_cloth(dice, number, duration, most, height, extreme, files):
    """A cloth above `height` [m]; returns (cloth, its highest point, particles)."""
    if dice.chance(0.15):
        cloth, group, reach, count = mesh_cloth(dice, f"cloth_{number}.obj", files)
    else:
        cloth, reach = grid_cloth(dice, most)
        group, count = None, cloth["particles"][0] * cloth["particles"][1]
    flat = dice.chance(0.6)
    thick = reach
    if flat and group is None and cloth.get("wrap") != "tube" and "start" not in cloth:
        thick = 0.0
        if dice.chance(0.15):
            cloth["facing"] = dice.pick(["up", "down", "front", "back", "left", "right"])
            thick = 0.0 if cloth["facing"] in ("up", "down") else reach
    cloth["jitter"] = dice.rounded(dice.spread(1e-5, 1e-2)) if dice.chance(0.3) else 0.0
    if dice.chance(0.1) and group is None:
        cloth["wrinkles"] = {"height": dice.spread(1e-3, 0.02), "size": dice.spread(0.05, 0.3), "seed": dice.whole(0, 99)}
    low = height + cloth["jitter"] + cloth.get("wrinkles", {"height": 0})["height"] + (0.006 if dice.chance(0.7) else dice.number(0, 0.2))
    cloth["center"] = [dice.number(-0.1, 0.1), dice.rounded(low + thick + 1e-4), dice.number(-0.1, 0.1)]
    if not flat:
        cloth["rotation"] = dice.vector(180)
    elif dice.chance(0.3) and group is None:
        cloth["rotation"] = [0, dice.number(-180, 180), 0]
    if cloth["jitter"] == 0:
        del cloth["jitter"]
    elif dice.chance(0.5):
        cloth["seed"] = dice.whole(0, 4294967295)
    if dice.chance(0.3):
        cloth["velocity"] = dice.vector(dice.spread(0.1, 30 if extreme else 5))
    if dice.chance(0.5):
        cloth["density"] = dice.spread(1e-4, 1e3) if extreme and dice.chance(0.3) else dice.spread(0.03, 2)
    cloth["material"] = material(dice, extreme)
    if dice.chance(0.2):
        cloth["bend_model"] = dice.pick(["curvature", "buckling"])
    if dice.chance(0.25):
        region = {"box": box(dice)} if group is None else {"group": group}
        if dice.chance(0.7):
            region["material"] = material(dice, extreme)
        if dice.chance(0.5) or "material" not in region:
            region["density"] = dice.spread(0.03, 5)
        cloth["region"] = [region]
    held = pins(dice, cloth, duration, group)
    if held:
        cloth["pin"] = held
    if dice.chance(0.1):
        cloth["name"] = f"cloth number {number}"
    return cloth, cloth["center"][1] + thick + 0.01, count
