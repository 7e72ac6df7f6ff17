"""Folders that are gone on with: complete, damaged, of another scene or look, shorter."""

import json
import shutil
import signal
import struct
import subprocess

from run_files import check_same, content, video_frames
from tool_runs import (DONE, FRAMES, OUTPUT, PATIENCE, SCENE, SCENE_ERROR, USAGE, finish, job, run, start, stopped_by,
                       wait_for_frames)


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


def test_what_is_not_complete_is_gone_on_with_or_makes_room_unasked(reference, folder):
    out = folder / "out"
    process = start(job(out))
    wait_for_frames(process, out, 4)
    process.kill()
    process.communicate()
    begun = (out / "cache/frame_0001.state").stat().st_mtime_ns
    run(job(out))  # the same scene: from where it stopped
    assert (out / "cache/frame_0001.state").stat().st_mtime_ns == begun
    reference.check(out, "gone on with unasked")
    run(job(out), USAGE)  # complete: not touched
    reference.check(out, "a complete run asked for again")
    other = folder / "other"
    process = start(job(other))
    wait_for_frames(process, other, 4)
    process.kill()
    process.communicate()
    begun = (other / "cache/frame_0001.state").stat().st_mtime_ns
    run(job(other, "--set", "cloth.density=0.3"))  # another scene: anew
    assert (other / "cache/frame_0001.state").stat().st_mtime_ns != begun
    draft = folder / "draft"
    for density in ("0.2", "0.3"):
        run(job(draft, "--draft", "--set", f"cloth.density={density}"))


def test_a_scene_from_standard_input_a_still_and_a_preview(reference, folder):
    text = SCENE.read_bytes()
    piped = start(["run", "-", "-o", folder / "piped", "--device", "software", "--threads", "2"],
                  stdin=subprocess.PIPE)
    out, err = piped.communicate(text, timeout=PATIENCE)
    assert piped.returncode == DONE, (out + err).decode()
    for name in ("cache/frame_0014.state", "frames/textured_0014.png"):
        assert (folder / "piped" / name).read_bytes() == (reference.folder / name).read_bytes(), name
    broken = start(["check", "-"], stdin=subprocess.PIPE)
    out, err = broken.communicate(b"[cloth]\nsiz = 3\n", timeout=PATIENCE)
    assert broken.returncode == SCENE_ERROR and b"stdin:2:1: error: unknown key 'siz'" in err, err
    run(job(folder / "still", "--still", "5", "--style", "textured"))
    assert [p.name for p in (folder / "still/frames").glob("*.png")] == ["textured_0005.png"]
    assert (folder / "still/frames/textured_0005.png").read_bytes() == \
        (reference.folder / "frames/textured_0005.png").read_bytes()
    assert not (folder / "still/textured.mp4").exists()
    assert not (folder / "still/cache/frame_0006.state").exists()
    run(job(folder / "still", "--still", "6", "--set", "cloth.density=0.3"))  # another one, as often as you like

    # A page of runs: each scene's clip, numbers and text, and what is missing is named.
    page = folder / "gallery.html"
    assert "unravel run" in run(["gallery", SCENE, "--runs", folder, "-o", page], USAGE)
    shutil.copytree(reference.folder, folder / "tiny")
    run(["gallery", SCENE, "--runs", folder, "-o", page])
    shown = page.read_text()
    assert shown.count("data:video/mp4;base64,") == 2 and "Small and quick, but with everything" in shown
    assert "corner = &quot;u0v0&quot;" in shown

    picture = folder / "preview.png"
    told = json.loads(run(["preview", SCENE, "-o", picture, "--device", "software", "--json", "--pictures", "4"]))
    assert told["frames"] == [0, 5, 9, 14] and told["particles"] == 121 and picture.stat().st_size > 1000, told
    scene = folder / "watched.toml"
    scene.write_bytes(text)
    watching = start(["preview", scene, "-o", picture, "--device", "software", "--watch", "--json", "--still", "3"])
    first = json.loads(watching.stdout.readline())
    before = picture.read_bytes()
    scene.write_bytes(text.replace(b"radius = 0.15", b"radius = [1]"))  # a slip: told, and watched on
    assert b"watched.toml:18:10: error" in watching.stderr.readline()
    scene.write_bytes(text.replace(b"radius = 0.15", b"radius = 0.1"))
    second = json.loads(watching.stdout.readline())
    assert first["frames"] == second["frames"] == [3]
    assert picture.read_bytes() != before
    watching.terminate()
    finish(watching, stopped_by(signal.SIGTERM))


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
