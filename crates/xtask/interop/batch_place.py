"""A folder with a model, a graph and a plan of small items, and the program run in it."""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[3]

GRAPH = """{
  "format": "sabi",
  "version": 1,
  "name": "clouds",
  "nodes": {
    "base": { "kind": "source/material", "params": { "color": "#3c5a6e" } },
    "clouds": { "kind": "noise/simplex" },
    "out": { "kind": "output/material", "inputs": { "material": "rust" } },
    "rust": { "kind": "effect/layer", "inputs": { "base": "base", "mask": "clouds" },
      "params": { "color": "#6b3a1e", "height": 0.01 } }
  }
}
"""


class Place:
    """A project whose plan has `count` items that bake, and then one that fails if `fails` is true."""

    def __init__(self, folder, program, count, fails, size=32):
        self.folder = pathlib.Path(folder)
        self.program = str(pathlib.Path(program).resolve())
        (self.folder / "meshes").mkdir()
        shutil.copy(ROOT / "assets/meshes/cube.glb", self.folder / "meshes")
        (self.folder / "clouds.sabi").write_text(GRAPH)
        seeds = list(range(count))
        matrix = f'version = 1\nout = "out/$name/$seed"\n[defaults]\nmodels = "meshes/*.glb"\ngraphs = "*.sabi"\nsizes = {size}\n'
        matrix += f'[[bake]]\nname = "good"\nseed = {seeds}\n'
        if fails:
            # Only the bake itself reads the materials of the model.
            matrix += '[[bake]]\nname = "bad"\nseed = 0\nmaterial = "gone"\n'
        (self.folder / "matrix.toml").write_text(matrix)
        self.sabi("plan", "matrix.toml", check=True)
        lines = (self.folder / "plan.jsonl").read_text().splitlines()
        self.items = [json.loads(line) for line in lines]
        assert len(self.items) == count + fails, len(self.items)

    def environment(self):
        """Away from the user's own settings and caches."""
        own = {"SABI_CACHE_DIR": str(self.folder / ".cache"), "SABI_NODES": str(self.folder / ".nodes")}
        return os.environ | own

    def arguments(self, *more):
        return [self.program, "run", "plan.jsonl", "--adapter", "cpu", *more]

    def sabi(self, *arguments, **options):
        return subprocess.run(
            [self.program, *arguments], cwd=self.folder, env=self.environment(), capture_output=True, text=True, **options
        )

    def summary(self, *more):
        """The exit code and the summary of a run."""
        done = subprocess.run(
            self.arguments("--json", *more), cwd=self.folder, env=self.environment(), capture_output=True, text=True
        )
        return done.returncode, json.loads(done.stdout), done.stderr

    def with_status(self, summary, status):
        return [item["item"] for item in summary["items"] if item["status"] == status]

    def maps(self):
        """Hashes of all maps, by path from the folder of the plan. Reports have times."""
        files = (path for path in (self.folder / "out").rglob("*") if path.is_file() and path.suffix in (".png", ".exr"))
        digest = lambda path: hashlib.sha256(path.read_bytes()).hexdigest()
        return {str(path.relative_to(self.folder)): digest(path) for path in files}

    def left_over(self):
        """Temporary files that no process uses any more."""
        return sorted(str(path.relative_to(self.folder)) for path in (self.folder / "out").rglob(".sabi-*"))

    def verify(self, items):
        """What `sabi verify` finds in the folders of items."""
        folders = [self.items[item]["out"] for item in items]
        done = self.sabi("verify", "--json", *folders)
        return [finding for verified in json.loads(done.stdout) for finding in verified["findings"]]
