"""Folders that are gone on with: complete, damaged, of another scene or look, shorter."""

import shutil
import struct

from run_files import check_same, content, video_frames
from tool_runs import FRAMES, OUTPUT, SCENE, USAGE, finish, job, run, start


def test_a_changed_scene_is_refused_with_what_changed(reference, folder):
    out = folder / "changed"
    shutil.copytree(reference.folder, out)
    text = run(job(out, "--resume", "--set", "cloth.density=0.3"), USAGE)
    assert "density = 0.2" in text and "density = 0.3" in text, text
    text = run(job(out, "--resume", "--set", "gravity=[0,-1.6,0]"), USAGE)
    assert "gravity" in text and "nothing" not in text, text
    text = run(job(out), USAGE)
    assert "--resume" in text and "--force" in text, text
    reference.check(out, "refused runs")


def test_a_complete_run_resumed_stays_as_it_is(reference, folder):
    out = folder / "complete"
    shutil.copytree(reference.folder, out)
    before = {file: file.stat().st_mtime_ns for part in ("cache", "frames") for file in (out / part).glob("*.*")}
    run(job(out, "--resume"))
    reference.check(out, "resumed when complete")
    after = {file: file.stat().st_mtime_ns for file in before}
    assert before == after, "frames and states that were there were written again"


def test_damaged_states_are_simulated_again(reference, folder):
    out = folder / "damaged"
    shutil.copytree(reference.folder, out)
    damaged = bytearray((out / "cache/frame_0006.state").read_bytes())
    damaged[len(damaged) // 2] ^= 1
    (out / "cache/frame_0006.state").write_bytes(damaged)
    (out / "cache/frame_0009.state").write_bytes(b"")
    (out / "frames/textured_0003.png").write_bytes((out / "frames/textured_0003.png").read_bytes()[:-20])
    (out / "stats.csv").write_text("nonsense\n")
    run(job(out, "--resume"))
    reference.check(out, "after damage")


def test_broken_caches_are_named_where_only_they_tell(reference, folder):
    def broken(name, break_it, mends=True):
        out = folder / name
        shutil.copytree(reference.folder, out)
        break_it(out)
        for command in (["render", out, "--device", "software"], ["inspect", out, "--frame", "7", "--device", "software"]):
            text = finish(start(command), OUTPUT)
            assert "frame_0006.state" in text or "frame_0007.state" in text, text
            assert "--resume` makes it again" in text or not mends, text
        # What can't be drawn any more has been drawn.
        assert video_frames(out / "textured.mp4") == FRAMES
        shutil.rmtree(out)

    def replace(data, number=None):
        def break_it(out):
            for k in (6, 7) if number is None else (number,):
                file = out / f"cache/frame_{k:04d}.state"
                file.write_bytes(data(file.read_bytes()))
        return break_it

    broken("empty", replace(lambda data: b""))
    broken("cut", replace(lambda data: data[: len(data) // 2]))
    broken("flipped", replace(lambda data: data[:200] + bytes([data[200] ^ 4]) + data[201:]))
    broken("nonsense", replace(lambda data: b"nonsense" * 1000))
    broken("longer", replace(lambda data: data + b"more"))
    broken("foreign", replace(lambda data: data[:8] + struct.pack("<Q", 1) + data[16:]), mends=False)

    def folder_in_its_place(out):
        for k in (6, 7):
            (out / f"cache/frame_{k:04d}.state").unlink()
            (out / f"cache/frame_{k:04d}.state").mkdir()

    broken("a_folder", folder_in_its_place, mends=False)


def test_pictures_of_another_look_are_not_taken_for_this_one(reference, folder):
    look = ["--set", 'look.background="#203040"', "--size", "80x64"]
    fresh, out = folder / "fresh_look", folder / "other_look"
    run(job(fresh, *look))
    shutil.copytree(reference.folder, out)
    run(job(out, "--resume", *look))
    check_same(content(fresh), content(out), "a resumed run with another look")


def test_a_longer_clip_goes_on_from_a_shorter_one(reference, folder):
    out = folder / "longer"
    run(job(out, "--set", "clip.duration=0.2"))
    run(job(out, "--resume"))
    reference.check(out, "made longer")


def test_a_scene_whose_texture_is_no_picture_replaces_nothing(reference, folder):
    scene, out = folder / "tiny.toml", folder / "kept"
    shutil.copytree(reference.folder, out)
    shutil.copy(SCENE, scene)
    with open(scene, "a", encoding="utf-8") as text:
        text.write('[[look.cloth]]\ntexture = "cut.png"\n')
    # A whole picture's head, and of its content nothing.
    (folder / "cut.png").write_bytes((reference.folder / "frames/textured_0003.png").read_bytes()[:60])
    for command in (["check", scene], job(out, "--force", scene=scene)):
        text = finish(start(command), OUTPUT)
        assert "cut.png" in text and "too early" in text, text
    reference.check(out, "after a run that never began")
