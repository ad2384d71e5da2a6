#!/usr/bin/env python3
"""Holds USD documents against the official validators, which come with the Python package `usd-core`.

    python3 -m venv interop && interop/bin/pip install usd-core
    interop/bin/python crates/xtask/interop/usd_valid.py out/helmet.usda out/other

Takes `.usda` and `.usdz` files, and folders, which are searched for such. No validator may find anything, each material must
have a surface whose connections lead somewhere, and the files of a package must lie uncompressed at multiples of 64 bytes, its
document first. Prints a sentence for each fault, and ends with 1 if there is any, with 2 if there is nothing to check.
"""

import os
import sys
import zipfile

from pxr import Sdf, Usd, UsdShade, UsdValidation

ENDINGS = (".usda", ".usdz")


def documents(places):
    """The documents among paths and below folders."""
    for place in places:
        if os.path.isdir(place):
            for folder, _, names in sorted(os.walk(place)):
                yield from (os.path.join(folder, name) for name in sorted(names) if name.endswith(ENDINGS))
        else:
            yield place


def package_faults(path):
    """Sentences on the archive of a package."""
    with zipfile.ZipFile(path) as package, open(path, "rb") as file:
        entries = package.infolist()
        if not entries or not entries[0].filename.endswith(".usda"):
            yield "its first file is no .usda"
        damaged = package.testzip()
        if damaged:
            yield f"its file {damaged} is damaged"
        for entry in entries:
            if entry.compress_type != zipfile.ZIP_STORED:
                yield f"its file {entry.filename} is compressed"
            if not entry.filename.endswith((".usda", ".png")):
                yield f"its file {entry.filename} is neither a .usda nor a .png"
            file.seek(entry.header_offset + 26)
            name, extra = (int.from_bytes(file.read(2), "little") for _ in range(2))
            start = entry.header_offset + 30 + name + extra
            if start % 64:
                yield f"its file {entry.filename} begins at {start}, which is no multiple of 64"


def files(stage):
    """Attributes that name a file, with its path."""
    for prim in stage.Traverse():
        for attribute in prim.GetAttributes():
            value = attribute.Get()
            if isinstance(value, Sdf.AssetPath):
                yield attribute, value


def file_faults(stage):
    """Sentences on files that are not there; puts the first tile in place of `<UDIM>`, which the validators do not look up."""
    stage.SetEditTarget(stage.GetSessionLayer())
    for attribute, value in list(files(stage)):
        if UsdShade.UdimUtils.IsUdimIdentifier(value.path):
            tiles = UsdShade.UdimUtils.ResolveUdimTilePaths(value.path, stage.GetRootLayer())
            if tiles:
                attribute.Set(Sdf.AssetPath(tiles[0][0]))
            else:
                yield f"it names {value.path}, of which no tile is there"
        elif not value.resolvedPath:
            yield f"it names {value.path}, which is not there"


def material_faults(stage):
    """Sentences on the materials of a stage."""
    materials = [UsdShade.Material(prim) for prim in stage.Traverse() if prim.IsA(UsdShade.Material)]
    if not materials:
        yield "it has no materials"
    for material in materials:
        surface = material.ComputeSurfaceSource()[0]
        if not surface or surface.GetIdAttr().Get() != "UsdPreviewSurface":
            yield f"its material {material.GetPath()} has no UsdPreviewSurface"
        for prim in Usd.PrimRange(material.GetPrim()):
            for attribute in prim.GetAttributes():
                for source in attribute.GetConnections():
                    if not stage.GetAttributeAtPath(source):
                        yield f"{attribute.GetPath()} is connected to {source}, which does not exist"


def faults(path, validators):
    """Sentences on a document."""
    try:
        stage = Usd.Stage.Open(path)
    except Exception as error:  # The package raises errors of several kinds.
        return [f"it cannot be read: {error}"]
    found = [*file_faults(stage), *material_faults(stage)]
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    found += [f"{error.GetName()}: {error.GetMessage()}" for error in errors]
    return found + (list(package_faults(path)) if path.endswith(".usdz") else [])


def main(places):
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    checked = faulty = 0
    for path in documents(places):
        checked += 1
        found = faults(path, validators)
        faulty += bool(found)
        for fault in found:
            print(f"{path}: {fault}")
    if checked == 0:
        print("There is no USD document to check; name files or folders.")
        return 2
    version = ".".join(str(part) for part in Usd.GetVersion())
    print(f"{checked} USD documents checked by {len(validators)} validators of USD {version}, {faulty} with faults.")
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
