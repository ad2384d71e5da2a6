"""Kills runs of a plan, many of them while files take their places, and holds what is left against a run that nobody killed.

    python3 crates/xtask/interop/plan_kills.py --sabi target/debug/sabi [--items 200] [--kills 20] [--seed 1]
"""

import argparse
import os
import pathlib
import random
import signal
import subprocess
import tempfile
import time

from batch_place import Place


def processes_of(place):
    """Processes of runs in this place, by id, with their command lines."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
                here = os.readlink(entry / "cwd") == str(place.folder)
            except OSError:
                continue
            if here and words[0].decode() == place.program:
                found[int(entry.name)] = words
    return found


def wait_for_temporaries(place, seconds):
    """Returns once a file is being written, or after a while."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if any((place.folder / "out").rglob(".sabi-*")):
            return


def kill_one_run(place, chance, how):
    run = subprocess.Popen(
        place.arguments("--jobs", "2"),
        cwd=place.folder,
        env=place.environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    time.sleep(chance.uniform(0.3, 8.0))
    # Half of the kills come while maps take their places.
    if chance.random() < 0.7:
        wait_for_temporaries(place, 3.0)
        time.sleep(chance.uniform(0.0, 0.01))
    if how == "group":
        os.killpg(run.pid, signal.SIGKILL)
    elif how == "run":
        os.kill(run.pid, signal.SIGKILL)
    else:
        items = [pid for pid, words in processes_of(place).items() if b"--alone" in words]
        for pid in items[:1]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(0.2)
        run.terminate()
    run.wait()
    end = time.monotonic() + 20
    while processes_of(place):
        assert time.monotonic() < end, f"processes outlive their run: {processes_of(place)}"
        time.sleep(0.02)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--sabi", required=True)
    parser.add_argument("--items", type=int, default=200)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as other:
        place = Place(folder, options.sabi, options.items - 1, fails=True)
        bad = len(place.items) - 1
        for kill in range(options.kills):
            kill_one_run(place, chance, ["group", "run", "item"][kill % 3])
        left_by_kills = place.left_over()
        _, before, _ = place.summary("--dry-run")
        finished = place.with_status(before, "finished")
        assert place.verify(finished) == [], "what is finished is whole"
        print(f"{options.kills} kills: {len(finished)} of {len(place.items)} items are finished, {len(left_by_kills)} files left over")
        code, last, stderr = place.summary("--jobs", "2")
        assert code == 1, (code, stderr)
        assert place.with_status(last, "failed") == [bad], last
        assert f"error: item {bad} of {len(place.items)}: out/bad/0: " in stderr, stderr
        assert place.with_status(last, "finished") == finished, "what was finished is left alone"
        expected = [item for item in range(bad) if item not in finished]
        assert place.with_status(last, "baked") == expected, "only what is missing is baked"
        code, again, _ = place.summary()
        assert code == 1 and place.with_status(again, "finished") == list(range(bad)), again
        assert place.left_over() == [], place.left_over()
        assert place.verify(range(bad)) == [], place.verify(range(bad))
        unharmed = Place(other, options.sabi, options.items - 1, fails=True)
        unharmed.summary("--jobs", "2")
        assert len(unharmed.maps()) > bad, "every item has maps"
        assert place.maps() == unharmed.maps(), "the maps are those of a run that nobody killed"
        print(f"the next run baked {len(expected)} items; {len(place.maps())} maps are as without kills")


if __name__ == "__main__":
    main()
