#!/usr/bin/env python3
"""Holds MaterialX documents against the official library, which comes as the Python package `MaterialX`.

    python3 -m venv interop && interop/bin/pip install MaterialX
    interop/bin/python crates/xtask/interop/materialx_valid.py out/helmet.mtlx out/other

Takes documents, and folders, which are searched for documents. Each must be valid, name files that are there, and give shader
code for each of its materials. Prints a sentence for each fault, and ends with 1 if there is any, with 2 if there is nothing to
check.
"""

import glob
import os
import sys

import MaterialX as mx
from MaterialX import PyMaterialXGenGlsl, PyMaterialXGenShader


def documents(places):
    """The documents among paths and below folders."""
    for place in places:
        if os.path.isdir(place):
            for folder, _, names in sorted(os.walk(place)):
                yield from (os.path.join(folder, name) for name in sorted(names) if name.endswith(".mtlx"))
        else:
            yield place


def library():
    """The node definitions of the package."""
    found = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), found)
    return found


def missing_files(document, folder):
    """Sentences on files that the document names and that are not there."""
    for element in document.traverseTree():
        if element.isA(mx.Input) and element.getType() == "filename":
            name = element.getValueString()
            pattern = "[0-9][0-9][0-9][0-9]".join(glob.escape(part) for part in name.split("<UDIM>"))
            if not glob.glob(os.path.join(glob.escape(folder), pattern)):
                yield f"it names {name}, which is not there"


def ungenerated(document, definitions):
    """Sentences on materials that give no shader code."""
    generator = PyMaterialXGenGlsl.GlslShaderGenerator.create()
    context = PyMaterialXGenShader.GenContext(generator)
    context.registerSourceCodeSearchPath(mx.getDefaultDataSearchPath())
    colors = PyMaterialXGenShader.DefaultColorManagementSystem.create(generator.getTarget())
    colors.loadLibrary(definitions)
    generator.setColorManagementSystem(colors)
    materials = document.getMaterialNodes()
    if not materials:
        yield "it has no materials"
    for material in materials:
        shaders = mx.getShaderNodes(material)
        if not shaders:
            yield f"its material {material.getName()} has no shader"
        for shader in shaders:
            try:
                code = generator.generate(material.getName(), shader, context).getSourceCode("pixel")
            except Exception as error:  # The package raises errors of several kinds.
                yield f"its material {material.getName()} gives no shader code: {error}"
                continue
            if "void main" not in code:
                yield f"the shader code of its material {material.getName()} is empty"


def faults(path, definitions):
    """Sentences on a document."""
    document = mx.createDocument()
    try:
        mx.readFromXmlFile(document, path)
    except Exception as error:
        return [f"it cannot be read: {error}"]
    document.setDataLibrary(definitions)
    is_valid, message = document.validate()
    found = [] if is_valid else [f"it is not valid: {message.strip()}"]
    found += missing_files(document, os.path.dirname(path) or ".")
    return found + list(ungenerated(document, definitions))


def main(places):
    definitions = library()
    checked = faulty = 0
    for path in documents(places):
        checked += 1
        found = faults(path, definitions)
        faulty += bool(found)
        for fault in found:
            print(f"{path}: {fault}")
    if checked == 0:
        print("There is no MaterialX document to check; name files or folders.")
        return 2
    print(f"{checked} MaterialX documents checked with MaterialX {mx.getVersionString()}, {faulty} with faults.")
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
