"""Draws copies of models in F3D for `renders_agree.py`, in the light of a lamp at the camera that `in_cycles.py` left.

Usage: in_f3d.py JOBS.json. Needs the Python package `f3d` and a driver of OpenGL, such as Mesa's. Writes the pictures as arrays of
linear light with alpha.
"""

import json
import pathlib
import sys

import f3d
import numpy

# Pixels along the side of each that is drawn, which F3D does not smooth.
SAMPLES = 4
# Exponent of the light in F3D's codes.
GAMMA = 2.2


def draw(job, options):
    view = json.loads((pathlib.Path(job["folder"]) / "camera.json").read_text())
    engine = f3d.Engine.create_egl()
    size = options["size"]
    engine.window.size = (size * SAMPLES, size * SAMPLES)
    engine.options["render.grid.enable"] = engine.options["ui.axis"] = False
    engine.scene.add(job["open"])
    state = engine.window.camera.state
    state.position, state.focal_point, state.view_up = (tuple(view[name]) for name in ("eye", "target", "up"))
    state.view_angle = view["fov"]
    engine.window.camera.state = state
    towards = tuple(-part for part in view["back"])
    engine.scene.remove_all_lights()
    engine.scene.add_light(f3d.LightState(direction=towards, position=tuple(view["eye"]), intensity=options["light"]))
    picture = engine.window.render_to_image(True)
    codes = numpy.frombuffer(picture.content, numpy.uint8).reshape(picture.height, picture.width, 4)[::-1] / 255
    light = numpy.concatenate([codes[..., :3] ** GAMMA * codes[..., 3:], codes[..., 3:]], axis=-1)
    return light.reshape(size, SAMPLES, size, SAMPLES, 4).mean(axis=(1, 3))


def main():
    options = json.loads(pathlib.Path(sys.argv[1]).read_text())
    for job in options["jobs"]:
        numpy.save(pathlib.Path(job["folder"]) / "f3d.npy", draw(job, options))


if __name__ == "__main__":
    main()
