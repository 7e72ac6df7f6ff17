"""What cloth meets by chance: solids of every shape, still and moving, air, itself, and a solver."""

from cloths import motion
from meshes import cube, tetrahedron

INTEGRATORS = {"adaptive-imex": 5, "explicit": 3, "implicit": 3, "newton": 2, "imex": 2, "bdf2": 2,
               "adaptive-imex2": 2, "auto": 3}
PRECONDITIONERS = ["none", "diagonal", "block", "constrained-block", "ssor", "ic0", "auto", "stencil-block",
                   "multigrid", "aggregation"]


def friction(dice):
    if dice.chance(0.3):
        return 0
    if dice.chance(0.5):
        return dice.spread(0.01, 2)
    static = dice.spread(0.05, 1.5)
    return {"static": static, "kinetic": dice.rounded(static * dice.number(0.3, 1))}


def solid(dice, number, duration, top, files):
    """A solid whose highest point is `top` [m], below cloth; planes may be tilted."""
    shape = dice.weighed({"plane": 3, "sphere": 4, "box": 3, "cylinder": 2, "capsule": 2, "mesh": 1})
    body = {"shape": shape}
    if shape == "plane":
        body["center"] = [0, dice.rounded(top - 1e-4), 0]
        if dice.chance(0.4):
            # A tilted one stays below everything that lies within 3 m.
            angle = dice.number(-40, 40)
            body["rotation"] = [angle, 0, dice.rounded(angle * dice.number(-1, 1))]
            body["center"][1] = dice.rounded(top - abs(angle) / 10)
    else:
        body["center"] = [dice.number(-0.3, 0.3), 0, dice.number(-0.3, 0.3)]
        turned = dice.chance(0.4)
        if shape == "sphere":
            body["radius"] = reach = dice.spread(0.01, 0.5)
        elif shape == "box":
            body["size"] = [dice.spread(0.02, 0.6) for _ in range(3)]
            reach = body["size"][1] / 2
            if dice.chance(0.4):
                body["round"] = dice.rounded(min(body["size"]) * dice.number(0, 0.5))
            turned_reach = sum(s * s for s in body["size"]) ** 0.5 / 2
        elif shape == "mesh":
            name = f"solid_{number}.obj"
            size = dice.spread(0.1, 0.5)
            files[name] = dice.pick([cube, tetrahedron])(size)
            body["mesh"] = name
            reach, turned_reach = size / 2, size * 3 ** 0.5 / 2
        else:
            body["radius"], body["height"] = dice.spread(0.01, 0.3), dice.spread(0.02, 0.6)
            reach = body["height"] / 2 + (body["radius"] if shape == "capsule" else 0)
            turned_reach = body["height"] / 2 + body["radius"]
            if shape == "cylinder" and dice.chance(0.4):
                body["round"] = dice.rounded(min(body["radius"], body["height"] / 2) * dice.number(0, 1))
        if turned and shape != "sphere":
            body["rotation"] = dice.vector(180)
            reach = turned_reach
        body["center"][1] = dice.rounded(top - reach - 1e-4 * (1 + abs(top - reach)))
    if dice.chance(0.35):
        body["motion"] = motion(dice, duration, dice.spread(0.02, 0.5))
        if dice.chance(0.3):
            body["pivot"] = dice.vector(0.3)
        if dice.chance(0.3):
            body["interpolation"] = dice.pick(["smooth", "linear", "ease", "hold"])
    elif shape != "plane" and dice.chance(0.15):
        body["fall"] = {"time": dice.rounded(duration * dice.number(0, 0.5)), "velocity": [0, dice.number(0, 5), 0],
                        "floor": -1, "bounce": dice.number(0, 0.9), "give": dice.number(0, 0.1)}
    if shape != "mesh" and dice.chance(0.25):
        body["contact"] = dice.pick(["surface", "particles"])
    body["friction"] = friction(dice)
    if dice.chance(0.3):
        body["offset"] = dice.spread(1e-4, 0.006)
    return body


def ride(dice, cloths, solids):
    """Lets some things ride on solids, which get names for that."""
    for k, body in enumerate(solids):
        body["name"] = f"body {k}"
    for cloth in cloths:
        for pin in cloth.get("pin", []):
            if {"motion", "gather", "slide"} & set(pin) or not dice.chance(0.3):
                continue
            body = dice.pick(solids)
            pin["rod" if body["shape"] in ("cylinder", "capsule") and dice.chance(0.4) else "to"] = body["name"]
    if len(solids) > 1 and dice.chance(0.5) and solids[1]["shape"] != "plane" and "fall" not in solids[1]:
        solids[1]["parent"] = solids[0]["name"]


def air(dice, duration):
    wind = {}
    if dice.chance(0.3):
        wind["keyframes"] = [{"time": 0, "velocity": dice.vector(10)},
                             {"time": dice.rounded(duration * 0.7), "velocity": dice.vector(10)}]
    elif dice.chance(0.7):
        wind["velocity"] = dice.vector(dice.spread(0.1, 30))
    if dice.chance(0.3) and wind:
        wind["gust"] = {"strength": dice.number(0, 1), "period": dice.spread(0.05, 2), "seed": dice.whole(0, 99)}
    if dice.chance(0.4):
        wind["density"] = 0 if dice.chance(0.2) else dice.spread(0.1, 20)
    if dice.chance(0.4):
        wind["drag"] = dice.spread(0.01, 5)
    if dice.chance(0.4):
        wind["lift"] = dice.spread(0.01, 2)
    return wind


def self_collision(dice):
    contact = {}
    if dice.chance(0.5):
        if dice.chance(0.4):
            contact["friction"] = friction(dice)
    else:
        contact["method"] = "particles"
    if dice.chance(0.4):
        contact["thickness"] = dice.spread(1e-3, 0.05)
    if dice.chance(0.3):
        contact["stiffness"] = dice.spread(1, 1e4)
    if dice.chance(0.3):
        contact["damping"] = dice.spread(1e-5, 1)
    return contact


def explicit_parts(cloth, step):
    """About how many parts of a step the cloth's stiffest spring wants."""
    material = cloth["material"]
    stretch = material.get("stretch", 4e3 if "preset" in material else 50)
    stretch = max(stretch) if isinstance(stretch, list) else stretch
    damping = material.get("stretch_damping", 1e-2)
    density = cloth.get("density", 0.1)
    if "particles" in cloth:
        cell = min(s / max(n, 2) for s, n in zip(cloth["size"], cloth["particles"]))
    else:
        cell = 0.01
    mass = max(density * cell * cell, 1e-12)
    return 1 + step * ((8 * stretch / mass) ** 0.5 + 8 * damping / mass)


def solver(dice, rate, cloths, parts_of_frame):
    """`rate`: (frames, seconds) of the clip's frames per second."""
    frames, seconds = rate
    s = {"step": f"{seconds}/{frames * parts_of_frame}"}
    step = seconds / (frames * parts_of_frame)
    kind = dice.weighed(INTEGRATORS)
    parts = max(explicit_parts(cloth, step) for cloth in cloths)
    if kind in ("explicit", "auto") and parts > 300:
        kind = "adaptive-imex"
    s["integrator"] = kind
    if kind == "explicit":
        s["substeps"] = 0 if dice.chance(0.7) else dice.whole(1, 40)
    if dice.chance(0.3):
        s["threshold"] = 0 if dice.chance(0.2) else dice.spread(0.01, 1)
    if dice.chance(0.5):
        s["preconditioner"] = dice.pick(PRECONDITIONERS)
    if dice.chance(0.3):
        s["tolerance"] = dice.spread(1e-9, 0.1)
    if dice.chance(0.1):
        s["max_iterations"] = dice.whole(5, 3000)
    if dice.chance(0.2):
        s["decompose"] = False
    if dice.chance(0.2):
        s["bend"] = dice.pick(["scheme", "explicit"])
    if dice.chance(0.3):
        s["activation"] = dice.pick(["start", "predicted", "resolve", "ahead"])
    if dice.chance(0.2):
        s["activation_band"] = dice.number(0, 0.3)
    if dice.chance(0.25):
        adaptive = {"smallest": dice.rounded(step / 2 ** dice.whole(1, 5) * 0.999)}
        if dice.chance(0.5):
            adaptive["max_strain"] = dice.spread(0.01, 1)
        if dice.chance(0.3):
            adaptive["tolerance"] = dice.spread(1e-5, 1e-2)
        s["adaptive"] = adaptive
    return s, parts if kind == "explicit" else 1
