"""What must hold of every scene, whatever it is."""

import copy
import math

from distance import Placed
from toml import toml_text
from tool import DONE, SCENE_ERROR, STOPPED, Run, remove

# Energy may rise by this share of what a run has to spend, beside what swings and what contact lifts onto the skin:
# where steps change, so does how stiff an arc is near flat, and what it holds. What is looked for comes from nowhere
# and is many times as much.
ENERGY_SHARE = 0.01
# Schemes of which every force is taken at the step's end: they have no swing.
IMPLICIT = ("implicit", "newton", "bdf2")
# Positions are read in single precision.
ROUNDING = 1e-6
# s of CPU beyond which a scene is not run a second time: they show more in other scenes.
LONG = 4


class Finding(Exception):
    """A property that does not hold: its name, and what was seen."""

    def __init__(self, name, text):
        super().__init__(text)
        self.name = name


def write_scene(folder, scene, files):
    remove(folder)
    folder.mkdir(parents=True)
    for name, text in files.items():
        (folder / name).write_text(text)
    file = folder / "scene.toml"
    file.write_text(toml_text(scene))
    return file


def moves(thing):
    return any(any(key.get("position", [])) or any(key.get("rotation", [])) for key in thing.get("motion", []))


def puts_energy_in(scene):
    wind = scene.get("wind", {})
    moving = any({"fall", "parent"} & set(body) for body in scene.get("solid", []))
    drawn = any({"gather", "to", "rod"} & set(pin) for cloth in scene["cloth"] for pin in cloth.get("pin", []))
    return (moving or drawn or "self_collision" in scene or wind.get("keyframes") or any(wind.get("velocity", [])) or
            any(moves(body) for body in scene.get("solid", [])) or
            any(moves(pin) for cloth in scene["cloth"] for pin in cloth.get("pin", [])))


def with_idle_effects(scene):
    """The same scene with what cannot act: a solid too far away to be met, air of no density, a pin's motion
    that goes nowhere."""
    idle = copy.deepcopy(scene)
    far = {"shape": "sphere", "radius": 0.1, "center": [5000, 5000, 5000],
           "motion": [{"time": 0}, {"time": 1, "position": [1, 0, 0]}]}
    idle.setdefault("solid", []).append(far)
    idle.setdefault("wind", {"density": 0, "velocity": [3, 0, 0]})
    for cloth in idle["cloth"]:
        for pin in cloth.get("pin", []):
            if not {"gather", "to", "rod", "slide"} & set(pin):
                pin.setdefault("motion", [{"time": 0}, {"time": 0.1}])
    return idle


def judge_ended(run):
    if run.ended.code not in (DONE, SCENE_ERROR, STOPPED):
        raise Finding("ends", f"{run.ended.how()}: {run.ended.text.strip()[-300:]}")
    if run.ended.code != DONE and not run.ended.text.strip():
        raise Finding("ends", f"{run.ended.how()} without a word")


def judge_finite(steps):
    """A position or velocity that is no number shows in these sums."""
    for row in steps:
        bad = [name for name, value in row.items() if not math.isfinite(value)]
        if bad:
            raise Finding("finite", f"{bad[0]} at step {row['step']:.0f} is no number")


def judge_energy(scene, steps):
    if puts_energy_in(scene) or len(steps) < 2:
        return
    g = math.dist(scene.get("gravity", [0, -9.81, 0]), (0, 0, 0))
    weight = sum(density_bound(cloth) * area_of(cloth) for cloth in scene["cloth"]) * g
    size = max(max(cloth.get("size", [1.0])) for cloth in scene["cloth"])
    skin = max([body.get("offset", 0.004) for body in scene.get("solid", [])], default=0)
    springs = sum(0.5 * stiffness_bound(cloth) * area_of(cloth)
                  for cloth in scene["cloth"]) * max(0.0, steps[0]["max_strain"]) ** 2
    scale = steps[0]["kinetic"] + springs + weight * (size + skin)
    lowest, swing = math.inf, swings(scene, steps)
    for k, row in enumerate(steps):
        energy = row["kinetic"] + row["potential"]
        if energy - swing[k] - lowest > ENERGY_SHARE * scale + weight * skin + 1e-12:
            raise Finding("energy", f"{energy - lowest:.3g} J from nowhere by step {row['step']:.0f}, "
                                    f"where {scale:.3g} J is all there is")
        lowest = min(lowest, energy + swing[k])


def swings(scene, steps):
    """J for each step: forward-backward Euler keeps an energy that is h/2 v·f off the measured one, half of what
    passes into the springs within a step."""
    if scene["solver"]["integrator"] in IMPLICIT and scene["solver"].get("bend") != "explicit":
        return [0.0] * len(steps)
    passed = [abs(b["potential"] - a["potential"]) for a, b in zip(steps, steps[1:])]
    return [0.5 * max(passed[max(k - 1, 0):k + 1]) for k in range(len(steps))]


def density_bound(cloth):
    return max([cloth.get("density", 0.5)] + [region.get("density", 0.5) for region in cloth.get("region", [])])


def area_of(cloth):
    """m²; a mesh is about a metre wide, at most."""
    return cloth["size"][0] * cloth["size"][1] if "size" in cloth else 1.0


def stiffness_bound(cloth):
    """N/m, of stretch along both directions; presets stay below the first."""
    materials = [cloth["material"]] + [r["material"] for r in cloth.get("region", []) if "material" in r]
    of = [m.get("stretch", 1e4 if "preset" in m else 50) for m in materials]
    return 2 * max(max(k) if isinstance(k, list) else k for k in of)


def held_particles(cloth):
    """Particles of a grid that a pin holds at any time; None: all of them may be."""
    if "particles" not in cloth:
        return None if "pin" in cloth else set()
    nu, nv = cloth["particles"]
    tube = cloth.get("wrap") == "tube"
    sizes = cloth["size"]
    uv = [((i / nu) if tube else i / max(nu - 1, 1), j / max(nv - 1, 1)) for j in range(nv) for i in range(nu)]
    held = set()
    for pin in cloth.get("pin", []):
        for p, (u, v) in enumerate(uv):
            i, j = p % nu, p // nu
            if "corner" in pin:
                names = pin["corner"] if isinstance(pin["corner"], list) else [pin["corner"]]
                caught = any((i == (nu - 1) * int(name[1])) and (j == (nv - 1) * int(name[3])) for name in names)
            elif "edge" in pin:
                names = pin["edge"] if isinstance(pin["edge"], list) else [pin["edge"]]
                caught = any((i == (nu - 1) * int(name[1])) if name[0] == "u" else (j == (nv - 1) * int(name[1]))
                             for name in names)
            elif "particles" in pin:
                a, b, c, d = pin["particles"]
                caught = a <= i <= b and c <= j <= d
            elif "box" in pin:
                a, b, c, d = pin["box"]
                caught = a - 1e-6 <= u <= c + 1e-6 and b - 1e-6 <= v <= d + 1e-6
            else:
                centre, radius = pin["disc"]["center"], pin["disc"]["radius"]
                across = abs(u - centre[0])
                across = min(across, 1 - across) if tube else across
                caught = math.hypot(across * sizes[0], (v - centre[1]) * sizes[1]) <= radius * 1.001 + 1e-6
            if caught:
                held.add(p)
    return held


def judge_outside(scene, run):
    bodies = scene.get("solid", [])
    if not bodies:
        return
    frames = run.frames(len(scene["cloth"]))
    rate = scene["clip"]["fps"]
    num, den = (map(int, rate.split("/")) if isinstance(rate, str) else (rate, 1))
    for c, cloth in enumerate(scene["cloth"]):
        held = held_particles(cloth)
        if held is None:
            continue
        for frame, positions in enumerate(frames[c]):
            placed = [Placed(body, frame * den / num) for body in bodies]
            for p, x in enumerate(positions):
                if p in held:
                    continue
                for k, body in enumerate(placed):
                    depth = -body.distance(x)
                    if depth > ROUNDING * max(1.0, max(map(abs, x))):
                        raise Finding("outside", f"particle {p} of cloth {c} is {depth:.3g} m inside solid {k} "
                                                 f"({bodies[k]['shape']}) in frame {frame}")


def judge_told(run, steps):
    """What went wrong without a stop is said, in run.json as on the terminal."""
    words = run.json.get("warnings", [])

    def require(said, seen):
        if not any(said in word for word in words):
            raise Finding("told", f"{seen} and not a word of it")

    if run.ended.code != DONE:
        return
    most = max((row["max_strain"] for row in steps), default=0)
    if most > 0.25:
        require("longer than at rest", f"a strain of {most:.3g}")
    if any(row.get("crossings", 0) or row.get("in_solids", 0) for row in steps):
        require("passes through", "edges through faces")
    if not all(row["converged"] for row in steps):
        require("did not reach the tolerance", "steps that did not converge")


def judge_crossings(scene, steps):
    """Contact between surfaces lets nothing through that did not begin there."""
    if scene.get("self_collision", {"method": "particles"}).get("method") == "particles":
        return
    counts = [row["crossings"] for row in steps if "crossings" in row]
    jumps = any(pin.get("interpolation") == "hold" for cloth in scene["cloth"] for pin in cloth.get("pin", []))
    if counts and counts[0] == 0 and not jumps and max(counts) > 0:
        raise Finding("crossings", f"{max(counts):.0f} edges pass through faces though surfaces touch")


def judge(seed, scene, files, folder):
    """Judges a scene in a folder of its own; returns how it ended. Raises Finding."""
    file = write_scene(folder, scene, files)
    one = Run(file, folder / "one", 1)
    judge_ended(one)
    if one.ended.code == SCENE_ERROR:
        return one
    steps = one.steps()
    judge_finite(steps)
    judge_outside(scene, one)
    judge_crossings(scene, steps)
    judge_energy(scene, steps)
    judge_told(one, steps)
    if one.ended.seconds > LONG:
        return one
    judge_same(seed, scene, files, folder, one)
    if one.ended.code == DONE and seed % 4 == 0:
        judge_resumed(file, folder, one)
    return one


def judge_same(seed, scene, files, folder, one):
    """The same bits for two or five threads, where things are added that cannot act."""
    threads = (2, 5)[seed % 2]

    def differs(said):
        file = write_scene(folder / "other", said, files)
        return Run(file, folder / "other" / str(threads), threads).result() != one.result()

    if not differs(with_idle_effects(scene)):
        return
    if differs(scene):
        raise Finding("same bits", f"1 and {threads} threads differ")
    raise Finding("idle", "a far solid, air of no density or a pin that goes nowhere changes bits")


def judge_resumed(file, folder, one):
    states = sorted((folder / "one/cache").glob("*.state"))
    for state in states[len(states) // 2:]:
        state.unlink()
    if Run(file, folder / "one", 1, "--resume").result() != one.result():
        raise Finding("resumed", "a run gone on with ends with other bits")
