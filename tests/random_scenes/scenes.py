"""A valid scene by chance, over every key that the simulation knows."""

from cloths import make_cloth
from dice import Dice
from surroundings import air, ride, self_collision, solid, solver

RATES = {10: (10, 1), 24: (24, 1), 25: (25, 1), 30: (30, 1), 60: (60, 1), "24000/1001": (24000, 1001),
         "30000/1001": (30000, 1001)}


def make_scene(seed):
    """Returns (scene, {name: text} of the mesh files that it names)."""
    dice = Dice(seed)
    files = {}
    extreme = dice.chance(0.2)
    rate = dice.pick(list(RATES))
    frames, seconds = RATES[rate]
    last = dice.whole(2, 8)
    duration = Dice.rounded(last * seconds / frames)
    scene = {"clip": {"duration": duration, "fps": rate}}
    if dice.chance(0.25):
        scene["gravity"] = [0, 0, 0] if dice.chance(0.5) else dice.vector(15)
    cloths, height, count = [], 0.5, 0
    for number in range(dice.weighed({1: 7, 2: 2, 3: 1})):
        cloth, height, more = make_cloth(dice, number, duration, 2000, height, extreme, files)
        cloths.append(cloth)
        count += more
    scene["cloth"] = cloths
    # Particles times steps: mostly little, at times much.
    work = dice.spread(1e3, 4e4)
    parts = max(1, min(dice.whole(1, 24), int(work / (count * last))))
    scene["solver"], explicit = solver(dice, RATES[rate], cloths, parts)
    if explicit * count * parts * last > 2e6:
        scene["solver"]["integrator"] = "adaptive-imex"
        del scene["solver"]["substeps"]
    if scene["solver"]["integrator"] == "newton" and count > 400:
        scene["solver"]["integrator"] = "implicit"  # thirty solves a step take minutes
    solids = [solid(dice, number, duration, 0.5, files) for number in range(dice.weighed({0: 3, 1: 5, 2: 2, 3: 1}))]
    if solids:
        if dice.chance(0.2):
            ride(dice, cloths, solids)
        scene["solid"] = solids
    if dice.chance(0.08):
        scene["clip"]["settle"] = Dice.rounded(duration * dice.number(0.1, 0.5))
    if dice.chance(0.3):
        scene["wind"] = air(dice, duration)
    if dice.chance(0.3):
        scene["self_collision"] = self_collision(dice)
    return scene, files
