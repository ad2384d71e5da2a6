"""Bakes graphs with each preset and holds every picture against pngcheck and OpenImageIO.

Usage: pictures_valid.py SABI FOLDER, with the program and a new folder to work in. Needs the Python package `OpenImageIO`; PNG
files are also checked by `pngcheck`, where it is installed.

pngcheck may find nothing; OpenImageIO has to read each file without an error, see the same pixels as the decoders of `maps.py`,
the color space of PNG files that name one, and the usual names of the channels of OpenEXR files.
"""

import json
import pathlib
import shutil
import subprocess
import sys

import numpy
import OpenImageIO as oiio

import maps
import presets_read

ROOT = pathlib.Path(__file__).resolve().parents[3]
PRESETS = ["raw", "gltf", "unreal", "unity", "godot", "blender", "materialx", "usd", "mesh", "every.toml"]

# Formats and sizes that no preset of Sabi has.
EVERY = """version = 1
name = "every"
about = "Every format."
normal_y = "+"
names = "$material_$map"
"""
MAPS = [
    ("Color8", 'rgb = "base_color"\nsrgb = true', "png8"),
    ("Color16", 'rgb = "base_color"\nsrgb = true', "png16"),
    ("Clear8", 'rgb = "base_color"\na = "opacity"\nsrgb = true', "png8"),
    ("Clear16", 'rgb = "normal"\na = "opacity"', "png16"),
    ("Gray8", 'gray = "roughness"\ndither = true', "png8"),
    ("Gray16", 'gray = "height"', "png16"),
    ("Targa", 'rgb = "base_color"\nsrgb = true', "tga"),
    ("TargaClear", 'r = "occlusion"\ng = "1 - roughness"\nb = "metallic"\na = "opacity"', "tga"),
    ("TargaGray", 'gray = "metallic"', "tga"),
    ("Half", 'rgb = "emission"\nsize = "128x32"', "exr16"),
    ("HalfGray", 'gray = "height"', "exr16"),
    ("HalfClear", 'rgb = "base_color"\na = "opacity"', "exr16"),
    ("Float", 'rgb = "mesh(position)"', "exr32"),
    ("FloatGray", 'gray = "height"\nsize = "1/2"', "exr32"),
    ("FloatClear", 'rgb = "normal"\na = "opacity"', "exr32"),
]
EVERY += "".join(f'[[map]]\nname = "{name}"\n{parts}\nformat = "{format}"\nwhen = "always"\n' for name, parts, format in MAPS)

CHANNELS = {1: ["Y"], 3: ["R", "G", "B"], 4: ["R", "G", "B", "A"]}


def bake(sabi, graph, model, preset, output):
    command = [sabi, "bake", graph, "--mesh", ROOT / "assets/meshes" / model, "--size", "256", "--adapter", "cpu", "--force"]
    subprocess.run([*command, "--preset", preset, "-o", output, "-q"], check=True, stdout=subprocess.DEVNULL)


def told_by_pngcheck(path):
    """Faults of a PNG file, among them everything that pngcheck says about a file that is good."""
    told = subprocess.run(["pngcheck", "-q", path], capture_output=True, text=True)
    words = (told.stdout + told.stderr).strip()
    return [f"pngcheck: {words or told.returncode}"] if words or told.returncode else []


def told_by_openimageio(path):
    """Faults of a file, and its pixels."""
    config = oiio.ImageSpec()
    # Else colors are multiplied by alpha.
    config.attribute("oiio:UnassociatedAlpha", 1)
    picture = oiio.ImageInput.open(str(path), config)
    if picture is None:
        return [f"OpenImageIO: {oiio.geterror()}"], None
    spec = picture.spec()
    pixels = picture.read_image(oiio.UNKNOWN)
    if pixels is None or picture.geterror():
        return [f"OpenImageIO: {picture.geterror()}"], None
    picture.close()
    return list(faults_of(path, spec, pixels)), pixels


def faults_of(path, spec, pixels):
    """Sentences on a picture as OpenImageIO sees it."""
    own = maps.read(path)
    if pixels.shape != own.shape:
        yield f"OpenImageIO sees {pixels.shape}, not {own.shape}"
    elif not numpy.array_equal(pixels.astype(own.dtype), own, equal_nan=True):
        yield f"OpenImageIO sees {numpy.mean(pixels != own):.2%} of other pixels"
    names = list(spec.channelnames)
    if path.suffix == ".exr" and names != CHANNELS[len(names)]:
        yield f"OpenImageIO sees the channels {names}"
    if path.suffix == ".png" and "sRGB" in [kind for kind, _ in maps.png_chunks(path.read_bytes())]:
        space = spec.get_string_attribute("oiio:ColorSpace")
        if "srgb" not in space.lower():
            yield f"OpenImageIO takes it for {space!r}, not sRGB"


def main():
    sabi, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "channels.sabi").write_text(json.dumps(presets_read.GRAPH))
    (folder / "every.toml").write_text(EVERY)
    pngcheck = shutil.which("pngcheck")
    if not pngcheck:
        print("pngcheck is not installed, and PNG files are read by OpenImageIO alone.")
    kinds, faulty = {}, 0
    graphs = [(folder / "channels.sabi", "cube.glb"), (ROOT / "graphs/examples/army-paint.sabi", "crate.glb")]
    for graph, model in graphs:
        for preset in PRESETS:
            output = folder / f"{graph.stem}-{pathlib.Path(preset).stem}"
            bake(sabi, graph, model, folder / preset if preset.endswith(".toml") else preset, output)
            for path in sorted(path for path in output.iterdir() if path.suffix in (".png", ".exr", ".tga")):
                found, pixels = told_by_openimageio(path)
                if pngcheck and path.suffix == ".png":
                    found += told_by_pngcheck(path)
                kind = f"{path.suffix[1:]} {'-' if pixels is None else pixels.dtype}"
                kinds[kind] = kinds.get(kind, 0) + 1
                faulty += bool(found)
                for fault in found:
                    print(f"{output.name}/{path.name}: {fault}")
    told = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
    print(f"{sum(kinds.values())} pictures ({told}), {faulty} with faults.")
    return 1 if faulty or not kinds else 0


if __name__ == "__main__":
    sys.exit(main())
