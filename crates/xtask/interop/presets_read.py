"""Bakes a graph with each preset and reads the maps with decoders of its own: packing, inversion, flips, depths, color chunks.

Usage: presets_read.py SABI FOLDER, with the program and a new folder to work in.
"""

import json
import pathlib
import subprocess
import sys

import numpy

import maps

GRAPH = {
    "format": "sabi",
    "version": 1,
    "name": "all channels",
    "nodes": {
        "c": {"kind": "noise/simplex", "params": {"size": 0.3, "octaves": 6}},
        "d": {"kind": "noise/simplex", "params": {"size": 0.1, "octaves": 6}},
        "g": {
            "kind": "color/gradient",
            "inputs": {"source": "c"},
            "params": {"stops": [[0, "#2a1a10"], [0.5, "#6b8a2f"], [1, "#b8aaf5"]]},
        },
        "m": {
            "kind": "material/combine",
            "inputs": {
                "base_color": "g",
                "roughness": "c",
                "metallic": "d",
                "occlusion": "d",
                "alpha": "c",
                "emission": "g",
            },
        },
        "l": {"kind": "effect/layer", "inputs": {"base": "m", "mask": "d"}, "params": {"height": 0.02, "opacity": 0.5}},
        "out": {"kind": "output/material", "inputs": {"material": "l"}},
    },
}

CHANNELS = ["base_color", "opacity", "roughness", "metallic", "occlusion", "height", "normal", "emission"]

# Maps of the model itself, with the number of their components.
MESH_MAPS = {"world_normal": 3, "position": 3, "bent_normal": 3, "thickness": 1, "curvature": 1}

EXACT = 'version = 1\nname = "exact"\nabout = "Every channel as it is."\nnormal_y = "+"\nnames = "exact_$map"\n' + "".join(
    f'[[map]]\nname = "{name}"\n{"rgb" if name in ("base_color", "normal", "emission") else "gray"} = "{name}"\n'
    f'format = "exr32"\nwhen = "always"\n'
    for name in CHANNELS
) + "".join(
    f'[[map]]\nname = "{name}"\n{"rgb" if count == 3 else "gray"} = "mesh({name})"\nformat = "exr32"\nwhen = "always"\n'
    for name, count in MESH_MAPS.items()
)


def color(name):
    """Three components through the sRGB curve."""
    return [("srgb", name, index) for index in range(3)]


def plain(name, op="plain"):
    return [(op, name, 0)]


def normal(y="+"):
    return [("normal", "normal", 0), ("down" if y == "-" else "normal", "normal", 1), ("normal", "normal", 2)]


def signed(name, count=3):
    return [("signed", name, index) for index in range(count)]


ORM = plain("occlusion") + plain("roughness") + plain("metallic")
MASK = plain("metallic") + plain("occlusion") + [("constant", 0.5, 0)] + plain("roughness", "inverse")
HEIGHT = plain("height", "range")
RGBA = color("base_color") + plain("opacity")

# Files of each preset: bits, whether there is an sRGB chunk, and the content of each component.
PRESETS = {
    "gltf": {
        "{}_BaseColor.png": (8, True, RGBA),
        "{}_OcclusionRoughnessMetallic.png": (8, False, ORM),
        "{}_Normal.png": (8, False, normal()),
        "{}_Emissive.png": (8, True, color("emission")),
    },
    "unreal": {
        "T_{}_BC.png": (8, True, RGBA),
        "T_{}_ORM.png": (8, False, ORM),
        "T_{}_N.png": (8, False, normal("-")),
        "T_{}_H.png": (16, False, HEIGHT),
        "T_{}_E.png": (8, True, color("emission")),
    },
    "unity": {
        "{}_BaseMap.png": (8, True, RGBA),
        "{}_MaskMap.png": (8, False, MASK),
        "{}_Normal.png": (8, False, normal()),
        "{}_Height.png": (16, False, HEIGHT),
        "{}_Emission.png": (8, True, color("emission")),
    },
    "godot": {
        "{}_albedo.png": (8, True, RGBA),
        "{}_orm.png": (8, False, ORM),
        "{}_normal.png": (8, False, normal()),
        "{}_height.exr": (None, False, plain("height", "float")),
        "{}_emission.png": (8, True, color("emission")),
    },
    "blender": {
        "{}_BaseColor.png": (8, True, color("base_color")),
        "{}_Alpha.png": (8, False, plain("opacity")),
        "{}_Roughness.png": (8, False, plain("roughness")),
        "{}_Metallic.png": (8, False, plain("metallic")),
        "{}_AO.png": (8, False, plain("occlusion")),
        "{}_Normal.png": (16, False, normal()),
        "{}_Height.exr": (None, False, plain("height", "float")),
    },
    "materialx": {
        "{}_BaseColor.png": (8, True, color("base_color")),
        "{}_OcclusionRoughnessMetallic.png": (8, False, ORM),
        "{}_Normal.png": (16, False, normal()),
    },
    "usd": {
        "{}_BaseColor.png": (8, True, RGBA),
        "{}_OcclusionRoughnessMetallic.png": (8, False, ORM),
        "{}_Normal.png": (8, False, normal()),
    },
    "raw": {
        "{}_base_color.png": (8, True, color("base_color")),
        "{}_roughness.png": (8, False, plain("roughness")),
        "{}_height.png": (16, False, HEIGHT),
        "{}_height.exr": (None, False, plain("height", "float")),
        "{}_normal.png": (16, False, normal()),
    },
    "mesh": {
        "{}_world_normal.png": (16, False, signed("world_normal")),
        "{}_position.png": (16, False, [("plain", "position", index) for index in range(3)]),
        "{}_bent_normal.png": (16, False, signed("bent_normal")),
        "{}_thickness.png": (8, False, plain("thickness")),
        "{}_curvature.png": (16, False, signed("curvature", 1)),
    },
}


def srgb(linear):
    linear = numpy.clip(linear, 0, 1)
    return numpy.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)


def expected(component, exact, most):
    """Codes of a component, not rounded; values of floats as they are."""
    op, name, index = component
    if op == "constant":
        return numpy.full(exact["opacity"].shape[:2], name * most)
    values = exact[name][..., index]
    if op == "float":
        return values
    if op == "srgb":
        return srgb(values) * most
    if op == "inverse":
        return (1 - numpy.clip(values, 0, 1)) * most
    if op == "signed":
        return (numpy.clip(values, -1, 1) * 0.5 + 0.5) * most
    if op == "range":
        low, high = values.min(), values.max()
        return (values - low) / (high - low) * most
    if op == "down":
        return (1 - values) * most
    if op == "normal":
        return values * most
    return numpy.clip(values, 0, 1) * most


def bake(sabi, folder, preset, output):
    command = [sabi, "bake", "graph.sabi", "--mesh", MODEL, "--size", "128", "--padding", "infinite", "--adapter", "cpu"]
    subprocess.run([*command, "--preset", preset, "-o", output, "--no-cache", "-q"], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def faults(path, wanted, exact):
    bits, has_chunk, components = wanted
    if not path.exists():
        return [f"{path.name} is missing"]
    samples = maps.read(path)
    found = []
    if samples.shape[-1] != len(components):
        return [f"{path.name} has {samples.shape[-1]} components, not {len(components)}"]
    most = 2**bits - 1 if bits else 1
    for index, component in enumerate(components):
        wanted = expected(component, exact, most)
        # A dithered code is one of the two beside the value. Half floats have 11 bits.
        allowed = 1.01 if bits else max(1e-3 * numpy.abs(wanted).max(), 1e-9)
        worst = numpy.abs(samples[..., index] - wanted).max()
        if worst > allowed:
            found.append(f"{path.name}: component {index} ({component[0]} of {component[1]}) is {worst:.3f} codes off")
    if path.suffix == ".png":
        kinds = [kind for kind, _ in maps.png_chunks(path.read_bytes())]
        depth = path.read_bytes()[24]
        if depth != bits:
            found.append(f"{path.name} has {depth} bits, not {bits}")
        if ("sRGB" in kinds) != has_chunk:
            found.append(f"{path.name} has {'no' if has_chunk else 'an'} sRGB chunk")
        others = set(kinds) - {"IHDR", "IDAT", "IEND", "sRGB"}
        if others:
            found.append(f"{path.name} has chunks that say more: {sorted(others)}")
    return found


def mirrored(folder):
    """Faults of the green of Unreal, which is the mirror of glTF's to the digit: a flat normal is 128 in both."""
    up, down = (maps.read(folder / path)[..., 1] for path in ("gltf/cube_Normal.png", "unreal/T_cube_N.png"))
    is_mirror = (up + down == 255) | ((up == 128) & (down == 128))
    return [] if is_mirror.all() else [f"unreal: {(~is_mirror).sum()} texels of green are no mirror of glTF's"]


def main():
    global MODEL
    sabi, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    MODEL = str(pathlib.Path(__file__).resolve().parents[3] / "assets/meshes/cube.glb")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "graph.sabi").write_text(json.dumps(GRAPH))
    (folder / "exact.toml").write_text(EXACT)
    bake(sabi, folder, "exact.toml", "exact")
    exact = {name: maps.read(folder / f"exact/exact_{name}.exr") for name in [*CHANNELS, *MESH_MAPS]}
    found = []
    for preset, files in PRESETS.items():
        bake(sabi, folder, preset, preset)
        for name, wanted in files.items():
            found += [f"{preset}: {fault}" for fault in faults(folder / preset / name.format("cube"), wanted, exact)]
    found += mirrored(folder)
    for fault in found:
        print(fault)
    print(f"{len(PRESETS)} presets, {sum(map(len, PRESETS.values()))} files: {'good' if not found else f'{len(found)} faults'}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
