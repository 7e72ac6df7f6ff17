"""What cmake --install leaves works by itself.  test_install.py BUILD_FOLDER"""

import pathlib
import subprocess
import sys
import tempfile

build = sys.argv[1]


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    if done.returncode != 0:
        sys.exit(f"{words}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


with tempfile.TemporaryDirectory() as folder:
    prefix = pathlib.Path(folder) / "usr"
    run("cmake", "--install", build, "--prefix", prefix)
    tool = prefix / "bin" / "unravel"
    assert "no problem found" in run(tool, "check", prefix / "share/unravel/scenes/hang.toml")
    # It finds its own scenes, not those that it was built from.
    said = subprocess.run([tool, "stability", "no such case", "--no-pictures"], capture_output=True, text=True, cwd=folder)
    assert str(prefix / "share/unravel/scenes/hard/cases.toml") in said.stderr, said.stderr
    for where, what in [("share/man/man1/unravel.1", "man"), ("share/bash-completion/completions/unravel", "completion")]:
        assert (prefix / where).read_text() == run(tool, "describe", what), where
    # The shell's own answer to: unravel run --sh<Tab>, unravel rend<Tab>, unravel run --show s<Tab>.
    script = prefix / "share/bash-completion/completions/unravel"
    for words, answer in [(["run", "--sh"], "--show"), (["rend"], "render"), (["run", "--show", "sp"], "splitting")]:
        line = " ".join(f"'{word}'" for word in words)
        asked = f"source '{script}'; COMP_WORDS=(unravel {line}); COMP_CWORD={len(words)}; _unravel; echo ${{COMPREPLY[@]}}"
        got = run("bash", "-c", asked).split()
        assert answer in got, (words, got)
    assert (prefix / "share/doc/unravel/CHANGELOG.md").exists()
