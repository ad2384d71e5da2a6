"""Checks the job template of a plan, and runs it as a farm would; `pip install openjd-cli` first.

    python3 crates/xtask/interop/openjd_run.py --sabi target/debug/sabi [--openjd openjd] [--items 12]
"""

import argparse
import json
import subprocess
import tempfile

from batch_place import Place


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--sabi", required=True)
    parser.add_argument("--openjd", default="openjd")
    parser.add_argument("--items", type=int, default=12)
    options = parser.parse_args()
    for fails in (False, True):
        with tempfile.TemporaryDirectory() as folder:
            place = Place(folder, options.sabi, options.items - fails, fails, size=64)
            template = place.sabi("plan", "matrix.toml", "--format", "openjd", check=True).stdout
            (place.folder / "job.yaml").write_text(template)

            def openjd(*arguments):
                return subprocess.run(
                    [options.openjd, *arguments], cwd=place.folder, env=place.environment(), capture_output=True, text=True
                )

            checked = openjd("check", "job.yaml", "--output", "json")
            assert json.loads(checked.stdout)["status"] == "success", checked.stdout + checked.stderr
            run = openjd("run", "job.yaml", "-p", f"Sabi={place.program}", "-p", "Adapter=cpu")
            said = run.stdout + run.stderr
            _, summary, _ = place.summary("--dry-run")
            finished = place.with_status(summary, "finished")
            if fails:
                assert run.returncode == 1, said
                assert f"item {options.items - 1} of {options.items}: out/bad/0" in said, said
                assert finished == list(range(options.items - 1)), summary
            else:
                assert run.returncode == 0, said
                assert finished == list(range(options.items)), summary
            progress = [line for line in said.splitlines() if "openjd_progress:" in line]
            assert progress, said
            print(f"{len(finished)} of {options.items} items are finished, with {len(progress)} lines of progress, exit {run.returncode}")


if __name__ == "__main__":
    main()
