"""Random scenes, and what must hold of each of them.

    tests/random --seeds 1-200             these seeds; the same seed is the same scene everywhere
    tests/random --seeds 1-99999 --minutes 30
    tests/random --shrink 1234             as small a scene as still shows what seed 1234 shows
    tests/random --scene 1234              prints the scene of a seed

A scene of which something does not hold is kept in output/random/SEED/ with the tool's files. Scenes that have
once shown something are in tests/random_scenes/found/, each with what it was; all of them are judged first. One that
begins with `# open: seed N: property` is known and not mended yet: it is told, and fails nothing.
"""

import argparse
import collections
import pathlib
import sys
import tempfile
import time
import tomllib

import tool
from judge import Finding, judge, write_scene
from keys import unspoken_keys
from scenes import make_scene
from shrink import shrink
from toml import toml_text

HERE = pathlib.Path(__file__).resolve().parent


def seeds_of(text):
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def judged(seed, scene, files, folder):
    """(how it ended, None) or (None, finding)."""
    try:
        return judge(seed, scene, files, folder), None
    except Finding as finding:
        return None, finding


def spelt_out(scene):
    """A scene that somebody wrote, as scenes of chance are: lists where there may be several, and what is judged by."""
    for table, key in ((scene, "cloth"), (scene, "solid")):
        if isinstance(table.get(key), dict):
            table[key] = [table[key]]
    scene.setdefault("clip", {}).setdefault("fps", 30)
    scene.setdefault("solver", {}).setdefault("integrator", "adaptive-imex")
    for cloth in scene["cloth"]:
        cloth.setdefault("material", {})
        if "mesh" not in cloth:
            cloth.setdefault("particles", [51, 51])
            cloth.setdefault("size", [1.0, 1.0])
        if isinstance(cloth.get("pin"), dict):
            cloth["pin"] = [cloth["pin"]]
    return scene


def found_scenes():
    for file in sorted((HERE / "found").glob("*.toml")):
        text = file.read_text()
        yield file, text, spelt_out(tomllib.loads(text)), {mesh.name: mesh.read_text() for mesh in (HERE / "found").glob("*.obj")}


def open_findings():
    """{(seed, property)} of what is known and not mended: files that begin with `# open: seed N: property`."""
    found = set()
    for _, text, _, _ in found_scenes():
        if text.startswith("# open: seed "):
            seed, name = text.splitlines()[0].removeprefix("# open: seed ").split(": ")[:2]
            found.add((int(seed), name))
    return found


def judge_found(folder):
    failed = 0
    for file, text, scene, files in found_scenes():
        _, finding = judged(0, scene, files, folder / "found")
        is_open = text.startswith("# open")
        if finding and not is_open:
            failed += 1
            print(f"found/{file.name} shows again: {finding.name}: {finding}", flush=True)
        elif is_open:
            print(f"found/{file.name} {'is still open' if finding else 'shows nothing any more'}", flush=True)
    return failed


def judge_seeds(seeds, minutes, folder, keep):
    ends, findings, known = collections.Counter(), [], open_findings()
    until = time.monotonic() + 60 * minutes
    done = 0
    for seed in seeds:
        if time.monotonic() > until:
            break
        scene, files = make_scene(seed)
        run, finding = judged(seed, scene, files, folder / "scene")
        done += 1
        if finding is None:
            ends[run.ended.code] += 1
            continue
        if (seed, finding.name) in known:
            print(f"seed {seed}: {finding.name}, as is known", flush=True)
            continue
        findings.append(seed)
        write_scene(keep / str(seed), scene, files)
        print(f"seed {seed}: {finding.name}: {finding}", flush=True)
    print(f"{done} scenes: {ends[tool.DONE]} done, {ends[tool.STOPPED]} stopped and {ends[tool.SCENE_ERROR]} refused with "
          f"the cause named, {len(findings)} findings; {tool.cpu_seconds():.0f} s of CPU", flush=True)
    return findings


def shrunk(seed, folder):
    scene, files = make_scene(seed)
    _, finding = judged(0, scene, files, folder / "scene")
    if finding is None:
        return f"# seed {seed} shows nothing\n"

    def shows(candidate):
        _, other = judged(0, candidate, files, folder / "scene")
        return other is not None and other.name == finding.name

    small = shrink(scene, shows)
    _, finding = judged(0, small, files, folder / "scene")
    return f"# seed {seed}: {finding.name}: {finding}\n{toml_text(small)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-200"), metavar="A-B")
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--tool", default=HERE.parent.parent / "build/release/unravel", metavar="FILE")
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("output/random"), metavar="FOLDER")
    parser.add_argument("--shrink", type=int, metavar="SEED")
    parser.add_argument("--scene", type=int, metavar="SEED")
    options = parser.parse_args()
    tool.TOOL = str(pathlib.Path(options.tool).resolve())
    if options.scene is not None:
        print(toml_text(make_scene(options.scene)[0]), end="")
        return 0
    with tempfile.TemporaryDirectory(prefix="unravel-random-") as temporary:
        folder = pathlib.Path(temporary)
        if options.shrink is not None:
            print(shrunk(options.shrink, folder), end="")
            return 0
        failed = judge_found(folder)
        if unspoken := unspoken_keys():
            failed += 1
            print(f"no scene of chance has the keys {', '.join(unspoken)}: add them to tests/random_scenes", flush=True)
        return 1 if judge_seeds(options.seeds, options.minutes, folder, options.keep) or failed else 0


if __name__ == "__main__":
    sys.exit(main())
