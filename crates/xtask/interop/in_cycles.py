"""Draws copies of models in Cycles for `renders_agree.py`: in the light of a lamp at the camera, and their base color.

Usage: in_cycles.py JOBS.json. Needs the Python package `bpy`. Writes the pictures as arrays of linear light with alpha, and the
cameras that they were made with.
"""

import json
import math
import pathlib
import sys

import bpy
import numpy
from mathutils import Matrix, Vector

# As in `camera.rs`: degrees from the lower to the upper edge, and the shares of a picture that a model fills.
FOV = 19.5
FILLED = (0.84, 0.74)


def camera(points, yaw, pitch):
    """The camera that `sabi render` places before points, as `Camera::frame` does, in the model's own units."""
    low, high = points.min(axis=0), points.max(axis=0)
    side, middle = (high - low).max(), (low + high) / 2
    (sin_yaw, cos_yaw), (sin_pitch, cos_pitch) = ((numpy.sin(a), numpy.cos(a)) for a in numpy.radians([yaw, pitch]))
    right = numpy.array([cos_yaw, 0, -sin_yaw])
    up = numpy.array([-sin_yaw * sin_pitch, cos_pitch, -cos_yaw * sin_pitch])
    back = numpy.array([sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch])
    at = (points - middle) / side @ numpy.stack([right, up, back]).T
    slope = numpy.array(FILLED) * numpy.tan(numpy.radians(FOV / 2))
    nearer = slope * at[:, 2:]
    most, least = (at[:, :2] + nearer).max(axis=0), (nearer - at[:, :2]).max(axis=0)
    depth = (at[:, 2].min() + at[:, 2].max()) / 2
    distance = ((most + least) / 2 / slope).max() - depth
    aside, above = (most - least) / 2
    target = (right * aside + up * above + back * depth) * side + middle
    eye = target + back * distance * side
    axes = {"right": right, "up": up, "back": back, "eye": eye, "target": target}
    return {key: axis.tolist() for key, axis in axes.items()} | {"fov": FOV, "distance": distance * side}


def place_of(vector):
    """A vector of glTF, +Y up, in Blender, +Z up."""
    x, y, z = vector
    return Vector((x, -z, y))


def seen_points(objects):
    """Places of all vertices, +Y up."""
    graph = bpy.context.evaluated_depsgraph_get()
    found = []
    for thing in objects:
        mesh = thing.evaluated_get(graph).to_mesh()
        at = numpy.empty(3 * len(mesh.vertices))
        mesh.vertices.foreach_get("co", at)
        world = numpy.array(thing.matrix_world)
        found.append(at.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3])
    x, y, z = numpy.concatenate(found).T
    return numpy.stack([x, z, -y], axis=1)


def set_stage(job, options):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=job["copy"])
    scene = bpy.context.scene
    objects = [thing for thing in scene.objects if thing.type == "MESH"]
    for thing in objects:
        # Neither F3D nor the light of `sabi render` bounces.
        thing.visible_shadow = thing.visible_diffuse = thing.visible_glossy = thing.visible_transmission = False
    view = camera(seen_points(objects), options["yaw"], options["pitch"])
    eye = bpy.data.objects.new("eye", bpy.data.cameras.new("eye"))
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "SUN"))
    axes = [place_of(view[name]) for name in ("right", "up", "back", "eye")]
    for thing in (eye, lamp):
        scene.collection.objects.link(thing)
        thing.matrix_world = Matrix([[axis[row] for axis in axes] for row in range(3)] + [[0, 0, 0, 1]])
    lamp.data.energy, lamp.data.angle = options["light"], 0.0
    eye.data.sensor_fit, eye.data.angle_y = "VERTICAL", math.radians(FOV)
    eye.data.clip_start, eye.data.clip_end = view["distance"] / 100, view["distance"] * 10
    scene.camera = eye
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.max_bounces, scene.cycles.samples = 0, 32
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0.0
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.film_transparent = True
    scene.render.resolution_x = scene.render.resolution_y = options["size"]
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGBA"
    return view


def show_base_color():
    """Makes each material shine in its base color."""
    for material in bpy.data.materials:
        tree = material.node_tree
        surfaces = [node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"] if tree else []
        for surface in surfaces:
            color, shine = surface.inputs["Base Color"], tree.nodes.new("ShaderNodeEmission")
            shine.inputs["Color"].default_value = color.default_value
            for link in color.links:
                tree.links.new(link.from_socket, shine.inputs["Color"])
            for output in (node for node in tree.nodes if node.type == "OUTPUT_MATERIAL"):
                tree.links.new(shine.outputs["Emission"], output.inputs["Surface"])


def draw(path):
    scene = bpy.context.scene
    scene.render.filepath = str(path.with_suffix(".exr"))
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    image.colorspace_settings.name, image.alpha_mode = "Non-Color", "PREMUL"
    width, height = image.size
    values = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(values)
    numpy.save(path, values.reshape(height, width, 4)[::-1])


def main():
    options = json.loads(pathlib.Path(sys.argv[1]).read_text())
    for job in options["jobs"]:
        folder = pathlib.Path(job["folder"])
        view = set_stage(job, options)
        (folder / "camera.json").write_text(json.dumps(view))
        draw(folder / "cycles.npy")
        show_base_color()
        draw(folder / "cycles_base.npy")


if __name__ == "__main__":
    main()
