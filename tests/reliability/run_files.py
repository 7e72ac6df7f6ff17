"""What the reliability tests know of a run's folder: which bytes must agree, and what makes each file whole."""

import csv
import json
import pathlib
import struct
import zlib

TIMING_COLUMNS = "ms_"


def fnv(data):
    """64-bit FNV-1a, the checksum at the end of a frame record."""
    value = 14695981039346656037
    for byte in data:
        value = ((value ^ byte) * 1099511628211) & 0xFFFFFFFFFFFFFFFF
    return value


def whole_png(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "no PNG"
    at, last = 8, b""
    while at < len(data):
        (size,), last = struct.unpack(">I", data[at : at + 4]), data[at + 4 : at + 8]
        (crc,) = struct.unpack(">I", data[at + 8 + size : at + 12 + size])
        assert crc == zlib.crc32(data[at + 4 : at + 8 + size]), f"damaged {last}"
        at += 12 + size
    assert last == b"IEND" and at == len(data), "cut off"


def boxes(data):
    at = 0
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        assert 8 <= size <= len(data) - at, "cut off"
        yield kind, data[at + 8 : at + size]
        at += size


def video_frames(file):
    """Frames that an mp4's sample table lists; its index (moov) is there only where the trailer was written."""
    data = file.read_bytes()
    for kind in (b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsz"):
        inside = [content for name, content in boxes(data) if name == kind]
        assert inside, f"{file} has no {kind.decode()}"
        data = inside[0]
    return struct.unpack(">I", data[8:12])[0]


def check_whole(folder):
    """Every file in the folder that carries a final name is complete."""
    for file in sorted(pathlib.Path(folder).rglob("*")):
        if file.is_dir() or file.name.startswith("."):
            continue
        data = file.read_bytes()
        assert data, f"{file} is empty"
        try:
            if file.suffix == ".png":
                whole_png(data)
            elif file.suffix == ".state":
                assert struct.unpack("<Q", data[-8:])[0] == fnv(data[:-8]), "checksum"
            elif file.suffix == ".json":
                json.loads(data)
            elif file.suffix == ".mp4":
                assert video_frames(file) > 0, "no frames"
            elif file.suffix in (".csv", ".toml", ".html"):
                assert data.endswith(b"\n"), "cut off"
        except Exception as error:
            raise AssertionError(f"{file} is not whole: {error}") from error


def leftovers(folder):
    return [str(file) for file in pathlib.Path(folder).rglob(".*.part")]


def stats_without_times(file):
    with open(file, newline="") as lines:
        rows = list(csv.reader(lines))
    keep = [k for k, name in enumerate(rows[0]) if not name.startswith(TIMING_COLUMNS)]
    assert len(keep) < len(rows[0]), "stats.csv has no timing column: the test looks for the wrong name"
    return [[row[k] for k in keep] for row in rows]


def content(folder, videos=True):
    """All that must not depend on how often a run was stopped."""
    folder = pathlib.Path(folder)
    out = {}
    for part in ("cache", "frames"):
        for file in sorted((folder / part).iterdir()):
            if not file.name.startswith("."):
                out[f"{part}/{file.name}"] = file.read_bytes()
    out["stats.csv"] = stats_without_times(folder / "stats.csv")
    out["scene.toml"] = (folder / "scene.toml").read_bytes()
    if videos:
        for file in sorted(folder.glob("*.mp4")):
            out[file.name] = file.read_bytes()
    return out


def check_same(expected, found, what):
    missing = sorted(set(expected) - set(found))
    extra = sorted(set(found) - set(expected))
    different = sorted(name for name in set(expected) & set(found) if expected[name] != found[name])
    assert not (missing or extra or different), (
        f"{what}: missing {missing[:5]}, too many {extra[:5]}, different {different[:5]}"
    )
