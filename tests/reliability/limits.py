"""What a machine or its owner does not give: memory, threads, large files. Each is named, with what to do."""

import os
import resource

from run_files import check_whole, leftovers
from tool_runs import DONE, NO_ENCODER, OUTPUT, finish, job, run, start


def limited(kind, value, arguments, expected, uid=None):
    def set_limit():
        resource.setrlimit(kind, (value, value))
        if uid is not None:
            os.setgid(uid)
            os.setuid(uid)

    text = finish(start(arguments, preexec_fn=set_limit), expected)
    return [line for line in text.splitlines() if line.strip()]


def test_too_little_memory_for_mesa_is_told_in_a_line(reference, folder):
    if os.environ.get("UNRAVEL_FRAMES") == "0":
        print("    not with a sanitizer, which takes terabytes of address space", flush=True)
        return
    for megabytes in (300, 600, 1000):
        lines = limited(resource.RLIMIT_AS, megabytes * 1024 * 1000, job(folder / "out"), NO_ENCODER)
        assert len(lines) == 1 and "ulimit -v leaves" in lines[0] and "ulimit -v unlimited" in lines[0], lines
        assert not (folder / "out").exists()
        lines = limited(resource.RLIMIT_AS, megabytes * 1024 * 1000, ["doctor"], NO_ENCODER)
        assert any("ulimit -v leaves" in line for line in lines), lines
    run(job(folder / "out"))  # without the limit, that a run fits


def test_files_that_may_not_grow_are_named(reference, folder):
    for kilobytes in (4, 10):
        out = folder / f"out_{kilobytes}"
        lines = limited(resource.RLIMIT_FSIZE, kilobytes * 1024, job(out), OUTPUT)
        errors = [line for line in lines if line.startswith("unravel:")]
        assert len(errors) == 1 and f"ulimit -f allows files of {kilobytes} kB" in errors[0], lines
        check_whole(out)
        assert not leftovers(out), leftovers(out)
        run(job(out, "--resume"))
        reference.check(out, "gone on with where files may grow")


def test_too_few_threads_are_told_in_a_line(reference, folder):
    nobody = 65534 if os.geteuid() == 0 else None  # root is above this limit
    os.chmod(folder.parent, 0o711)
    os.chmod(folder, 0o777)
    for threads in (3, 12):
        lines = limited(resource.RLIMIT_NPROC, threads, job(folder / f"out_{threads}"), OUTPUT, nobody)
        errors = [line for line in lines if line.startswith("unravel:")]
        assert len(errors) == 1 and "threads ran out: ulimit -u" in errors[0], lines
