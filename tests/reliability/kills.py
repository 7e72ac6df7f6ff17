"""Kills at random moments: nothing is lost, and a run that goes on ends with the bytes of one that was never killed."""

import random
import shutil
import signal
import time

from run_files import check_whole
from tool_runs import DONE, PATIENCE, job, run, start, wait_for_frames


def kill_at_random(reference, folder, kills, seed):
    """Kills runs of tiny.toml, with videos and without in turn, so many times, and lets each go on until the next or
    its end; compares all of its bytes. Raises AssertionError."""
    dice = random.Random(seed)
    done = finished = 0
    while done < kills:
        out = folder / f"killed_{finished}"
        command = "run" if finished % 2 == 0 else "simulate"
        while done < kills:
            # A random number of frames on, then a random moment: spread over the run however loaded the machine is.
            there = len(list(out.glob("cache/frame_*.state")))
            process = start(job(out, *(["--resume"] if out.exists() else []), command=command))
            wait_for_frames(process, out, there + dice.randint(0, 4))
            time.sleep(dice.uniform(0, 0.1 * reference.seconds))
            process.kill()
            process.communicate(timeout=PATIENCE)
            ended = process.returncode != -signal.SIGKILL
            if out.exists():
                check_whole(out)
            if ended:
                assert process.returncode == DONE, process.returncode
                break
            done += 1
        run(job(out, *(["--resume"] if out.exists() else []), command=command))
        reference.check(out, f"after {done} kills", videos=command == "run")
        finished += 1
        shutil.rmtree(out)
    print(f"    {done} kills over {finished} runs, nothing lost", flush=True)
