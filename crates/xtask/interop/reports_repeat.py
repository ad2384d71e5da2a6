"""Bakes in many ways, and bakes from each report: all bytes must be the same.

    python3 crates/xtask/interop/reports_repeat.py SABI FOLDER

with the program and a new folder to work in. Prints a sentence for each difference, and ends with 1 if there is any.
"""

import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]

# Options of each bake: presets, sizes, seeds, settings, copies of models, all maps.
BAKES = [
    ["worn-oak.sabi", "table.glb", "--size", "256"],
    ["army-paint.sabi", "crate.glb", "--size", "128", "--preset", "unreal", "--preset", "unity", "--seed", "7"],
    ["concrete.sabi", "wall.glb", "--size", "128", "--all-maps", "--padding", "infinite"],
    ["porcelain.sabi", "figure.glb", "--size", "128", "--model", "--preset", "gltf", "--fit", "metres"],
    ["leather.sabi", "chair.glb", "--size", "128", "--channel", "base_color", "--channel", "normal", "--no-fuse"],
]


def main():
    sabi, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    faults = 0
    for number, (graph, model, *options) in enumerate(BAKES):
        report = folder / f"reports/{number}.json"
        report.parent.mkdir(exist_ok=True)
        inputs = [str(ROOT / "graphs/examples" / graph), "--mesh", str(ROOT / "assets/meshes" / model)]
        bake = [sabi, "bake", *inputs, *options, "--adapter", "cpu", "--no-cache", "-q"]
        run([*bake, "-o", str(folder / f"first-{number}"), "--report", str(report)])
        again = [sabi, "bake", "--from", str(report), "-o", str(folder / f"again-{number}"), "--no-cache", "-q"]
        done = subprocess.run(again, capture_output=True, text=True)
        clean = subprocess.run([sabi, "verify", str(folder / f"again-{number}")], capture_output=True, text=True)
        for name, result in [("bake --from", done), ("verify", clean)]:
            if result.returncode != 0:
                faults += 1
                print(f"{graph} on {model}: {name} ends with {result.returncode}: {result.stderr.strip()}")
    print(f"{len(BAKES)} reports: {'good' if faults == 0 else f'{faults} faults'}")
    return 1 if faults else 0


def run(command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    sys.exit(main())
