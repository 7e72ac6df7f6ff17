"""Makes a scene that shows something as small as it still shows it."""

import copy


def smaller(scene, path=()):
    """Scenes with one thing less, the larger steps first."""
    here = scene
    for step in path:
        here = here[step]
    keys = range(len(here)) if isinstance(here, list) else list(here)
    for key in keys:
        if (path, key) in (((), "clip"), ((), "cloth")) or (path == ("clip",)):
            continue
        if isinstance(here, list) and path == ("cloth",) and len(here) == 1:
            continue
        yield path, key
    for key in keys:
        if isinstance(here[key], (dict, list)) and here[key] and not is_plain(here[key]):
            yield from smaller(scene, path + (key,))


def is_plain(value):
    return isinstance(value, list) and not any(isinstance(item, (dict, list)) for item in value)


def without(scene, path, key):
    out = copy.deepcopy(scene)
    here = out
    for step in path:
        here = here[step]
    del here[key]
    for name in [name for name, value in out.items() if value in ([], {}) and name not in ("wind", "self_collision")]:
        del out[name]
    return out


def halved(scene):
    for c, cloth in enumerate(scene["cloth"]):
        for k in range(2):
            if "particles" in cloth and cloth["particles"][k] > 3:
                out = copy.deepcopy(scene)
                out["cloth"][c]["particles"][k] = (cloth["particles"][k] + 1) // 2
                yield out


def shrink(scene, shows, patience=150):
    """shows(scene): whether a scene shows the same. Tries at most `patience` scenes."""
    changed = True
    while changed and patience > 0:
        changed = False
        candidates = [without(scene, path, key) for path, key in smaller(scene)] + list(halved(scene))
        for candidate in candidates:
            patience -= 1
            if patience < 0:
                break
            if shows(candidate):
                scene, changed = candidate, True
                break
    return scene
