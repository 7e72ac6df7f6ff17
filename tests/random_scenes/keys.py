"""Whether chance speaks of every key that the simulation knows."""

import json

from scenes import make_scene
from tool import call

# Keys that no scene of chance needs, each with its reason.
ELSEWHERE = {
    "camera": "pictures", "look": "pictures", "size of clip": "pictures", "color": "pictures", "name": "words",
    "root": "files", "mesh_hash": "written by the tool",
    "count": "written once, tests/sim/scene_file/test_repeat.cpp", "spacing": "as count", "mirror": "as count",
    "include": "files",
    "mesh_object": "tests/sim/mesh", "mesh_group": "tests/sim/mesh", "mesh_up": "tests/sim/mesh",
    "mesh_merge": "tests/sim/mesh", "mesh_holes": "tests/sim/mesh", "mesh_shell": "tests/sim/mesh",
    "mesh_frames": "tests/sim/mesh", "animation": "tests/sim/mesh", "mesh_fps": "tests/sim/mesh",
    "mesh_start": "tests/sim/mesh", "mesh_loop": "tests/sim/mesh", "sewing": "tests/sim/mesh",
}


def keys_of_schema(schema, found):
    for name, inner in schema.get("properties", {}).items():
        if name in ELSEWHERE:
            continue
        found.add(name)
        keys_of_schema(inner, found)
    for part in ("items", "additionalProperties"):
        if isinstance(schema.get(part), dict):
            keys_of_schema(schema[part], found)
    for part in ("anyOf", "oneOf", "allOf"):
        for inner in schema.get(part, []):
            keys_of_schema(inner, found)


def keys_of_scene(value, found):
    if isinstance(value, dict):
        found.update(value)
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            keys_of_scene(item, found)


def unspoken_keys(seeds=range(1, 600)):
    known, spoken = set(), set()
    keys_of_schema(json.loads(call(["schema", "scene"]).text), known)
    for seed in seeds:
        keys_of_scene(make_scene(seed)[0], spoken)
    return sorted(known - spoken)
