"""Command lines as a hand can mistype them or a program can get them wrong."""

from tool_runs import (DONE, HERE, NO_ENCODER, OUTPUT, PATIENCE, SCENE, SCENE_ERROR, USAGE, start)


# What a hand can mistype or a program can get wrong: the command line, its exit code, a part of the message.
COMMAND_LINES = [
    ([], USAGE, "subcommand"),
    (["bogus"], USAGE, "subcommand"),
    (["run"], USAGE, "SCENE"),
    (["run", "no_such.toml"], OUTPUT, "no_such.toml can't be read: No such file"),
    (["run", "."], OUTPUT, "Is a directory"),
    (["run", "/dev/null"], SCENE_ERROR, "cloth"),
    (["run", "/dev/zero"], SCENE_ERROR, "/dev/zero"),
    (["run", "/proc/self/mem"], OUTPUT, "can't be read"),
    (["check", "{scene}", "--set"], USAGE, "--set"),
    (["check", "{scene}", "--set", "x"], SCENE_ERROR, "x"),
    (["check", "{scene}", "--set", "cloth.densty=1"], SCENE_ERROR, "density"),
    (["check", "{scene}", "--set", "cloth.density=nan"], SCENE_ERROR, "density"),
    (["check", "{scene}", "--set", "cloth.density=1e999"], SCENE_ERROR, "density"),
    (["check", "{scene}", "--set", "gravity=[0,-inf,0]"], SCENE_ERROR, "gravity"),
    (["check", "{scene}", "--set", "cloth.particles=[99999999,99999999]"], SCENE_ERROR, "particles"),
    (["check", "{scene}", "--set", "clip.duration=1e30"], SCENE_ERROR, "duration"),
    (["run", "{scene}", "--threads", "0"], USAGE, "--threads"),
    (["run", "{scene}", "--threads", "99999999999999999999"], USAGE, "--threads"),
    (["run", "{scene}", "--frames", "9-2"], USAGE, "--frames"),
    (["run", "{scene}", "--frames", "0-99999999999999999999"], USAGE, "--frames"),
    (["run", "{scene}", "--size", "big"], USAGE, "--size"),
    (["run", "{scene}", "--size", "1x1"], USAGE, "1 × 1"),
    (["run", "{scene}", "--size", "65x64"], USAGE, "even"),
    (["run", "{scene}", "--video", "avi"], USAGE, "avi"),
    (["run", "{scene}", "--video", "mp4", "--transparent"], USAGE, ".mkv"),
    (["run", "{scene}", "--codec", "nosuch"], NO_ENCODER, "nosuch"),
    (["run", "{scene}", "--samples", "-1"], USAGE, "--samples"),
    (["run", "{scene}", "--device", "moon"], USAGE, "moon"),
    (["run", "{scene}", "--device", "99"], NO_ENCODER, "99"),
    (["run", "{scene}", "--style", "neon"], USAGE, "--style"),
    (["run", "{scene}", "--camera", "nobody"], USAGE, "--camera"),
    (["run", "{scene}", "--crf", "99"], USAGE, "--crf"),
    (["run", "{scene}", "--no-such-option"], USAGE, "--no-such-option"),
    (["run", "{scene}", "--resume", "--force"], None, ""),
    (["render", "no_such_run"], USAGE, "no_such_run"),
    (["render", "{here}"], USAGE, "holds no run"),
    (["inspect", "{run}", "--frame", "0"], USAGE, "--frame"),
    (["inspect", "{run}", "--frame", "99999"], USAGE, "99999"),
    (["inspect", "{run}", "--frame", "3", "--particle", "99999999"], USAGE, "--particle"),
    (["inspect", "{run}", "--frame", "3", "--step", "77"], USAGE, "--step"),
    (["stability", "no_such_case"], USAGE, "cases.toml"),
    (["stability", "--scenes", "no_such_folder"], OUTPUT, "no_such_folder"),
    (["accuracy", "{scene}", "--budget", "-1"], USAGE, "--budget"),
    (["schema", "nothing"], USAGE, "nothing"),
]


def test_broken_command_lines_end_in_a_message_and_their_exit_code(reference, folder):
    names = {"{scene}": str(SCENE), "{run}": str(reference.folder), "{here}": str(folder)}
    for line, code, says in COMMAND_LINES:
        process = start([names.get(word, word) for word in line], cwd=folder if "stability" not in line else HERE.parents[1])
        out, err = process.communicate(timeout=PATIENCE)
        text = (out + err).decode()
        if code is None:
            assert process.returncode in (DONE, USAGE), f"{line}: exit {process.returncode}\n{text}"
            continue
        assert process.returncode == code, f"{line}: exit {process.returncode}, not {code}\n{text}"
        assert says in text, f"{line}: nothing about '{says}'\n{text}"
    reference.check(reference.folder, "a run that broken command lines named")
