"""Memory over many frames."""

import json
import os
import subprocess
import time

from tool_runs import DONE, job, run, start, wait_for_frames


def resident(process):
    """Memory that a process holds [MiB], or None once it has ended."""
    try:
        for line in open(f"/proc/{process.pid}/status", encoding="ascii"):
            if line.startswith("VmRSS:"):
                return int(line.split()[1]) / 1024
    except OSError:
        pass
    return None


def test_memory_stays_flat(reference, folder):
    frames = int(os.environ.get("UNRAVEL_FRAMES", "600"))
    if frames == 0:
        print("    not looked at", flush=True)
        return
    out = folder / "long"
    process = start(job(out, "--quiet", "--set", f"clip.duration={frames / 25}", "--size", "96x72"),
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    held = []  # MiB at a quarter of the frames, half, three quarters, the last ones
    for share in (0.25, 0.5, 0.75, 0.97):
        wait_for_frames(process, out, int(share * frames))
        held.append(resident(process))
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == DONE
    assert None not in held, "it had ended before it was looked at"
    most = used.ru_maxrss / 1024
    print(f"    {frames} frames, MiB at a quarter, half, three quarters, the end: "
          + ", ".join(f"{m:.1f}" for m in held) + f"; at most {most:.1f}", flush=True)
    # What a frame leaves in memory is a hash and where its numbers lie on the disk. Reports of steps and previews
    # were once kept: 5 kB a frame and more.
    grown = held[-1] - held[1]
    assert grown < 0.5 + 0.001 * frames, f"{grown:.1f} MiB grown in the second half"
    # stats.csv and the page hold every frame, but are never held whole themselves.
    assert most - held[-1] < 4 + 0.004 * frames, f"{most - held[-1]:.1f} MiB for the page"


def test_check_foretells_memory(reference, folder):
    if os.environ.get("UNRAVEL_FRAMES") == "0":
        print("    not with a sanitizer, which takes memory of its own", flush=True)
        return
    cloth = "[cloth]\nparticles = [240, 240]\nmaterial = { %s }\n[[cloth.pin]]\nedge = \"v0\"\n"
    clip = "[clip]\nduration = 0.05\nfps = 40\nsize = [640, 480]\n"
    for name, material, more in (("soft", "stretch = 50", ""), ("cotton", 'preset = "cotton"', ""),
                                 ("met", 'preset = "cotton"', '[[solid]]\nshape = "sphere"\ncenter = [0, -0.31, 0]\n')):
        scene = folder / f"{name}.toml"
        scene.write_text(clip + cloth % material + more)
        foretold = json.loads(run(["check", scene, "--json"]))
        for command, key in (("simulate", "estimated_bytes"), ("run", "estimated_bytes_with_pictures")):
            process = start(job(folder / f"{name}_{command}", "--quiet", command=command, scene=scene),
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            assert process.returncode == DONE
            share = foretold[key] / (1024 * used.ru_maxrss)
            print(f"    {name}, {command}: {used.ru_maxrss / 1024:.0f} MiB, foretold {share:.2f} of it", flush=True)
            assert 1 / 1.5 < share < 1.5, share
