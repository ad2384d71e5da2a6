#!/usr/bin/env python3
"""Holds the light of `sabi render` against the path tracer Cycles, which comes as the Python package `bpy`.

    python3 -m venv bpy && bpy/bin/pip install bpy
    bpy/bin/python docs/cycles/compare.py --sabi target/release/sabi

Draws models of one plain material with both, in the same environments and from the same place, and prints for each how far
apart they are over the pixels that the model covers whole. The models are convex: no light of the environment is kept from them.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

import bpy
import numpy as np
from mathutils import Matrix

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "crates", "xtask", "interop"))

from in_cycles import FOV, camera, place_of, seen_points

# Name, sRGB color, roughness, metallic.
MATERIALS = [
    ("chalk", "#e7e7e7", 1.0, 0.0),
    ("plastic", "#e7e7e7", 0.4, 0.0),
    ("metal 0.6", "#f3f3f3", 0.6, 1.0),
    ("metal 0.3", "#f3f3f3", 0.3, 1.0),
    ("metal 0.1", "#f3f3f3", 0.1, 1.0),
]


def linear(code):
    """A color component of a file, 0 to 1, as light."""
    return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4


def pixels(path):
    """Linear RGBA of an EXR file, row by row from below."""
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    image.alpha_mode = "PREMUL"
    width, height = image.size
    values = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(height, width, 4).astype(np.float64)


def by_sabi(options, model, environment, material, folder):
    _, color, roughness, metallic = material
    values = {"color": color, "roughness": roughness, "metallic": metallic}
    graph = {
        "format": "sabi",
        "version": 1,
        "name": "plain",
        "nodes": {
            "plain": {"kind": "source/material", "params": values},
            "out": {"kind": "output/material", "inputs": {"material": "plain"}},
        },
    }
    file = os.path.join(folder, "plain.sabi")
    with open(file, "w", encoding="utf-8") as out:
        json.dump(graph, out)
    picture = os.path.join(folder, "sabi.exr")
    size = f"{options.size}x{options.size}"
    command = [options.sabi, "render", file, "--mesh", model, "--environment", environment, "--camera", "front"]
    command += ["--size", size, "--texels", "64", "--samples", "32", "--transparent", "--no-lights", "--no-ground"]
    command += ["-q", "-o", picture]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return pixels(picture)


def set_stage(options, model, environment):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=model)
    scene = bpy.context.scene
    objects = [thing for thing in scene.objects if thing.type == "MESH"]
    view = camera(seen_points(objects), yaw=0, pitch=0)
    eye = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    scene.collection.objects.link(eye)
    axes = [place_of(view[name]) for name in ("right", "up", "back", "eye")]
    eye.matrix_world = Matrix([[axis[row] for axis in axes] for row in range(3)] + [[0, 0, 0, 1]])
    eye.data.sensor_fit = "VERTICAL"
    eye.data.angle_y = math.radians(FOV)
    eye.data.clip_start = 0.001
    scene.camera = eye
    light(scene, environment)
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.max_bounces = 0
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0.0
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.film_transparent = True
    scene.render.resolution_x = scene.render.resolution_y = options.size
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGBA"
    return objects


def light(scene, environment):
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    picture = nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(environment)
    turn = nodes.new("ShaderNodeMapping")
    # The middle of the picture is +X in Blender; here it is glTF's +Z, which is Blender's -Y.
    turn.inputs["Rotation"].default_value = (0.0, 0.0, math.pi / 2)
    towards = nodes.new("ShaderNodeTexCoord")
    links.new(towards.outputs["Generated"], turn.inputs["Vector"])
    links.new(turn.outputs["Vector"], picture.inputs["Vector"])
    links.new(picture.outputs["Color"], nodes["Background"].inputs["Color"])


def by_cycles(options, objects, material, folder):
    """The light, and another picture of it with other noise."""
    name, color, roughness, metallic = material
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    values = made.node_tree.nodes["Principled BSDF"].inputs
    rgb = [linear(int(color[at : at + 2], 16) / 255) for at in (1, 3, 5)]
    values["Base Color"].default_value = (*rgb, 1.0)
    values["Roughness"].default_value = roughness
    values["Metallic"].default_value = metallic
    values["IOR"].default_value = 1.5
    for thing in objects:
        thing.data.materials.clear()
        thing.data.materials.append(made)
    halves = []
    for seed in (0, 1):
        picture = os.path.join(folder, f"cycles_{seed}.exr")
        scene = bpy.context.scene
        scene.render.filepath = picture
        scene.cycles.seed, scene.cycles.samples = seed, max(options.samples // 2, 1)
        bpy.ops.render.render(write_still=True)
        halves.append(pixels(picture))
    return halves


def told(sabi, halves):
    """Differences over what both cover whole, relative to the mean light, and how much of them is noise of Cycles."""
    cycles = (halves[0] + halves[1]) / 2
    covered = (sabi[..., 3] > 0.999) & (cycles[..., 3] > 0.999)
    a, b = sabi[covered][:, :3], cycles[covered][:, :3]
    mean = b.mean()
    error = np.abs(a - b).mean(axis=1) / mean
    signed = (a.mean() - mean) / mean
    rows, columns = np.nonzero(covered)
    radius = np.hypot(rows - rows.mean(), columns - columns.mean())
    edge = radius > 0.9 * radius.max()
    noise = (np.abs(halves[0] - halves[1])[covered][:, :3] / 2).mean() / mean
    shares = (error.mean(), noise, signed, np.percentile(error, 99), error[~edge].mean(), error[edge].mean())
    words = "mean {:5.2f} (noise {:5.2f})  signed {:+6.2f}  99th {:6.2f}  inside {:5.2f}  edge {:5.2f} %"
    return words.format(*(100 * share for share in shares))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sabi", default="target/release/sabi", help="the program")
    parser.add_argument("--size", type=int, default=192, help="pixels along a side")
    parser.add_argument("--samples", type=int, default=512, help="samples of Cycles for a pixel")
    parser.add_argument("--keep", help="a folder to keep both pictures of each case in, as NumPy arrays")
    options = parser.parse_args()
    asset = lambda kind, name: os.path.join(ROOT, "assets", kind, name)
    for model in ("sphere", "cube"):
        for environment in ("overcast", "studio", "low_sun"):
            mesh, panorama = asset("meshes", model + ".glb"), asset("environments", environment + ".hdr")
            objects = set_stage(options, mesh, panorama)
            for material in MATERIALS:
                with tempfile.TemporaryDirectory() as folder:
                    pair = by_sabi(options, mesh, panorama, material, folder), by_cycles(options, objects, material, folder)
                print(f"{model:7} {environment:9} {material[0]:10} {told(*pair)}", flush=True)
                if options.keep:
                    name = f"{model}_{environment}_{material[0].replace(' ', '_')}"
                    np.save(os.path.join(options.keep, name), np.stack([pair[0], *pair[1]]))


if __name__ == "__main__":
    sys.exit(main())
