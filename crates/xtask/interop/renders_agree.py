"""Draws copies of models in Cycles and F3D, and holds the pictures against those of `sabi render`.

Usage: renders_agree.py SABI FOLDER [CASES.json], with the program and a folder to work in. Needs the Python packages `bpy` and
`f3d`. CASES.json lists cases in place of the own ones: `[{"name": …, "model": …, "graph": …, "options": […]}]`.

The three have different formulas for light from all around and for what is occluded, so a single distant light shines from the
camera: no place that is seen is in the shadow, and occlusion maps, which glTF has for light from all around, do not count. F3D
darkens every light by them, so it gets the copy without. Compared is the mean of the differences, as a share of the mean light, over
what both cover whole and show darker than white, where F3D's pictures end. Two by two pixels count as one, since a glint that is
smaller than a pixel falls into another one elsewhere. The base color alone is compared in the same way.
"""

import json
import pathlib
import struct
import subprocess
import sys

import numpy

import maps

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
SIZE = 256
MOST = 0.08
# The usual direction of the camera, and so that of the light.
YAW, PITCH = 35, 20
LIGHT = 1.5

GLASS = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.3}}
CLOTH = {
    "KHR_materials_sheen": {"sheenColorFactor": [0.9, 0.5, 0.6], "sheenRoughnessFactor": 0.4},
    "KHR_materials_specular": {"specularFactor": 0.2, "specularColorFactor": [1, 0.5, 0.5]},
}
COAT = {"KHR_materials_clearcoat": {"clearcoatFactor": 1}, "KHR_materials_iridescence": {"iridescenceFactor": 1}}
# Name, model, graph, and the look that the model gets first, which no picture may show.
OWN = [
    ("metal", "figure.glb", "bronze-statue.sabi", {}),
    ("paint on wood", "crate.glb", "army-paint.sabi", {}),
    ("vertex colors", "wall.glb", "concrete.sabi", {}),
    ("glass", "barrel.glb", "machine-paint.sabi", GLASS),
    ("cloth", "chair.glb", "leather.sabi", CLOTH),
    ("unlit", "table.glb", "worn-oak.sabi", {"KHR_materials_unlit": {}}),
    ("coat", "column.glb", "porcelain.sabi", COAT),
]


def own_cases(folder):
    """The cases of the project's models, as files of their own."""
    for name, model, graph, look in OWN:
        document, binary = read_glb(ROOT / "assets/meshes" / model)
        for material in document["materials"]:
            material["extensions"] = look
        document["extensionsUsed"] = sorted(look)
        path = folder / f"{name}.glb"
        write_glb(path, {key: value for key, value in document.items() if value != []}, binary)
        yield {"name": name, "model": str(path), "graph": str(ROOT / "graphs/examples" / graph), "options": []}


def read_glb(path):
    """JSON and binary chunk of a GLB file; the JSON of a text file, and its first buffer."""
    data = path.read_bytes()
    if data[:4] != b"glTF":
        document = json.loads(data)
        return document, (path.parent / document["buffers"][0]["uri"]).read_bytes()
    (length,) = struct.unpack("<I", data[12:16])
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def write_glb(path, document, binary):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def without_occlusion(copy):
    """The copy beside itself without occlusion maps, for F3D."""
    data = copy.read_bytes()
    path = copy.with_name("no_occlusion" + copy.suffix)
    document, binary = read_glb(copy)
    for material in document.get("materials", []):
        material.pop("occlusionTexture", None)
    if data[:4] == b"glTF":
        write_glb(path, document, binary)
    else:
        path.write_text(json.dumps(document))
    return path


def by_sabi(sabi, case, folder):
    """Bakes a copy and draws the picture and its base color; hands back the path of the copy."""
    options = [case["graph"], "--mesh", case["model"], "--adapter", "cpu", "-q", *case["options"]]
    bake = ["bake", *options, "--size", "512", "--preset", "gltf", "--model", "--force", "--again", "-o", folder / "copy"]
    told(sabi, bake)
    render = ["render", *options, "--size", f"{SIZE}x{SIZE}", "--texels", "512", "--transparent"]
    told(sabi, [*render, "--view", "base_color", "-o", folder / "base.png"])
    light = ["--environment-strength", "0", "--light", f"{YAW},{PITCH},{LIGHT}", "--no-ground"]
    told(sabi, [*render, *light, "-o", folder / "lit.exr"])
    return next(path for path in sorted((folder / "copy").iterdir()) if path.suffix in (".glb", ".gltf"))


def told(program, arguments):
    subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def srgb(codes):
    """Light of sRGB codes from 0 to 1."""
    return numpy.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)


def halved(picture):
    return picture.reshape(SIZE // 2, 2, SIZE // 2, 2, 4).mean(axis=(1, 3))


def difference(ours, theirs, white):
    """Mean difference as a share of the mean light, the difference of the means, and how far the outlines agree."""
    ours, theirs = halved(ours), halved(theirs)
    both = (ours[..., 3] > 0.999) & (theirs[..., 3] > 0.999)
    both &= (ours[..., :3].max(axis=-1) < white) & (theirs[..., :3].max(axis=-1) < white)
    a, b = ours[both][:, :3], theirs[both][:, :3]
    inside = [picture[..., 3] > 0.5 for picture in (ours, theirs)]
    outline = (inside[0] & inside[1]).sum() / (inside[0] | inside[1]).sum()
    return float(numpy.abs(a - b).mean() / b.mean()), float(a.mean() / b.mean() - 1), float(outline)


def compared(folder):
    """Differences of a case by picture."""
    lit = maps.read(folder / "lit.exr").astype(numpy.float64)
    base = maps.read(folder / "base.png") / 255
    base = numpy.concatenate([srgb(base[..., :3]), base[..., 3:]], axis=-1)
    pairs = {
        "Cycles": (lit, "cycles.npy", 1.0),
        "F3D": (lit, "f3d.npy", 1.0),
        "base color": (base, "cycles_base.npy", numpy.inf),
    }
    return {name: difference(ours, numpy.load(folder / theirs), white) for name, (ours, theirs, white) in pairs.items()}


def main():
    sabi, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    cases = json.loads(pathlib.Path(sys.argv[3]).read_text()) if len(sys.argv) > 3 else list(own_cases(folder))
    jobs = []
    for case in cases:
        place = folder / case["name"]
        place.mkdir(exist_ok=True)
        copy = by_sabi(sabi, case, place)
        jobs.append({"copy": str(copy), "open": str(without_occlusion(copy)), "folder": str(place)})
    job_file = folder / "jobs.json"
    job_file.write_text(json.dumps({"jobs": jobs, "size": SIZE, "light": LIGHT, "yaw": YAW, "pitch": PITCH}))
    for script in ("in_cycles.py", "in_f3d.py"):
        told(sys.executable, [HERE / script, job_file])
    far = 0
    for case in cases:
        found = compared(folder / case["name"])
        is_far = any(share > MOST for share, _, _ in found.values())
        far += is_far
        words = ", ".join(f"{name} {share:.1%} ({mean:+.1%})" for name, (share, mean, _) in found.items())
        outlines = min(outline for _, _, outline in found.values())
        print(f"{case['name']:24} {words}, outline {outlines:.3f}{'  too far' if is_far else ''}", flush=True)
    print(f"{len(cases)} copies in Cycles and F3D: {f'{far} too far' if far else 'all within'} {MOST:.0%} of `sabi render`.")
    return 1 if far or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
