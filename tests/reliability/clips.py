"""Pictures and videos that are there already: what is asked for besides them, and what replaces them."""

import json
import shutil
import signal
import struct
import time

from run_files import check_same, check_whole, content, leftovers, video_frames
from tool_runs import DONE, FRAMES, PATIENCE, finish, job, run, start, stopped_by

SOFTWARE = ["--device", "software"]
LOOK = ["--set", 'look.background="#203040"']
VIEWS = ("textured", "components")


def pictures(folder, view):
    return sorted(folder.glob(f"frames/{view}_[0-9]*.png"))


def color_type(png):
    """2: RGB, 6: RGBA."""
    return png.read_bytes()[25]


def size(png):
    return struct.unpack(">II", png.read_bytes()[16:24])


def wait_until(process, holds):
    deadline = time.monotonic() + PATIENCE
    while process.poll() is None and time.monotonic() < deadline and not holds():
        time.sleep(0.002)


def wait_for(process, pattern, folder, count):
    wait_until(process, lambda: len(list(folder.glob(pattern))) >= count)


def test_parts_and_other_looks_go_to_folders_of_their_own(reference, folder):
    out = folder / "run"
    shutil.copytree(reference.folder, out)
    run(["render", out, *SOFTWARE, "--size", "80x60", "--frames", "2-3"])
    run(["render", out, *SOFTWARE, "--still", "4", "--transparent"])
    run(["render", out, *SOFTWARE, "--show", "strain"])
    reference.check(out, "after previews")
    part, still, strain = (out / "renders" / name for name in ("frames_2-3_80x60", "still_4_transparent", "strain"))
    for view in VIEWS:
        assert [size(p) for p in pictures(part, view)] == [(80, 60)] * 2
        assert video_frames(part / f"{view}.mp4") == 2
        assert [color_type(p) for p in pictures(still, view)] == [6]
        assert len(pictures(strain, view)) == FRAMES == video_frames(strain / f"{view}.mp4")
    assert not list(still.glob("*.mp4"))
    # Told where, it goes there.
    run(["render", out, *SOFTWARE, "--frames", "2-3", "-o", folder / "elsewhere"])
    assert len(pictures(folder / "elsewhere", "textured")) == 2
    check_whole(out)


def test_a_clip_drawn_anew_replaces_the_old_one_only_when_it_is_whole(reference, folder):
    fresh = folder / "fresh"
    run(job(fresh, *LOOK))
    old = {name: data for name, data in reference.content.items() if name.startswith("frames/") or name.endswith(".mp4")}
    for number in (signal.SIGTERM, signal.SIGKILL):
        out = folder / signal.Signals(number).name
        shutil.copytree(reference.folder, out)
        process = start(job(out, "--resume", *LOOK))
        # Well under way: pictures of the new look are there, or of the old one are not any more.
        wait_until(process, lambda: len(list(out.glob("next/frames/*_[0-9]*.png"))) >= 5 or
                   not all((out / name).exists() for name in old))
        process.send_signal(number)
        text, _ = process.communicate(timeout=PATIENCE)
        if process.returncode != DONE:
            assert process.returncode in (stopped_by(number), -number), process.returncode
            check_whole(out)
            now = {name: data for name, data in content(out).items() if name in old}
            check_same(old, now, f"stopped by {number} on the way to another look")
            assert number == signal.SIGKILL or b"stays as it was" in text, text
        run(job(out, "--resume", *LOOK))
        check_same(content(fresh), content(out), "another look at last")
        assert not (out / "next").exists() and not leftovers(out)


def test_a_render_stopped_on_the_way_takes_no_video_away(reference, folder):
    out = folder / "run"
    shutil.copytree(reference.folder, out)
    process = start(["render", out, *SOFTWARE])
    wait_for(process, ".components.mp4.*.part", out, 1)
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=PATIENCE)
    assert process.returncode in (DONE, stopped_by(signal.SIGTERM), -signal.SIGTERM), process.returncode
    check_whole(out)
    reference.check(out, "after a render that was stopped")


def test_an_interrupted_render_says_so(reference, folder):
    out = folder / "run"
    shutil.copytree(reference.folder, out)
    slow = ["--motion-blur", "8", "--supersample", "4"]
    place = out / "renders/motion_blur_8_supersample_4"
    process = start(["render", out, *SOFTWARE, *slow])
    wait_for(process, "frames/*_[0-9]*.png", place, 3)
    process.send_signal(signal.SIGTERM)
    text = finish(process, stopped_by(signal.SIGTERM))
    assert "interrupted: " in text and f"of {FRAMES} frames" in text, text
    page = (place / "report.html").read_text()
    assert '"summary":"interrupted' in page and f"stopped after" in page, "the page says something else"
    assert json.loads((out / "run.json").read_text())["status"] == "complete"
    reference.check(out, "after an interrupted render")


def test_a_shortened_clip_keeps_no_pictures_beyond_its_end(reference, folder):
    out = folder / "run"
    shutil.copytree(reference.folder, out)
    run(job(out, "--resume", "--set", "clip.duration=0.2"))
    for view in VIEWS:
        assert len(pictures(out, view)) == 6 == video_frames(out / f"{view}.mp4")
    run(job(out, "--resume"))
    reference.check(out, "made longer again")
