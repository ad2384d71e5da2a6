//! Format of a model file, and advice for formats that are not read.

use super::ending;
use super::error::Fault;

/// The formats that are read.
pub(super) enum Format {
    Gltf,
    Obj,
}

/// Returns the format by the ending of the name, or by the first bytes where the ending is unknown or contradicts them.
pub(super) fn format_of(name: &str, bytes: &[u8]) -> Result<Format, Fault> {
    if let Some(sentence) = refused_format(name).or_else(|| disguised(bytes)) {
        return Err(Fault::Format(sentence));
    }
    match ending(name).as_str() {
        _ if bytes.starts_with(b"glTF") => Ok(Format::Gltf),
        "gltf" | "glb" | "vrm" => Ok(Format::Gltf),
        "obj" => Ok(Format::Obj),
        _ if bytes.trim_ascii_start().starts_with(b"{") => Ok(Format::Gltf),
        _ => Err(Fault::Format(
            "this is not a model that is read here: give a .glb, .gltf or .obj file".into(),
        )),
    }
}

/// Returns a sentence for well-known formats that are not read.
pub(super) fn refused_format(name: &str) -> Option<String> {
    let ending = ending(name);
    Some(format!(".{ending} files are not read here: {}", way_from(&ending)?))
}

/// Advice on converting a format to one that is read.
fn way_from(ending: &str) -> Option<&'static str> {
    Some(match ending {
        "fbx" | "ply" | "stl" | "abc" | "usd" | "usda" | "usdc" | "usdz" => {
            "open it in Blender (File > Import) and export it with File > Export > glTF 2.0 (.glb)"
        }
        "blend" => "open it in Blender and export it with File > Export > glTF 2.0 (.glb)",
        "dae" => {
            "convert it with Assimp (`assimp export model.dae model.glb`), or open it in Blender up to 4.5 (File > Import > \
             Collada) and export it with File > Export > glTF 2.0 (.glb)"
        }
        "3ds" | "ac" | "ase" | "b3d" | "dxf" | "irrmesh" | "lwo" | "lws" | "md2" | "md3" | "md5mesh" | "ms3d"
        | "off" | "smd" | "wrl" | "x" | "x3d" => {
            "convert it with Assimp (`assimp export` with its name and that of a new .glb file), or export it from its own \
             program as glTF 2.0 (.glb) or OBJ"
        }
        "max" | "ma" | "mb" | "c4d" | "hip" | "hiplc" | "skp" | "ztl" | "spp" => {
            "export it from its own program as glTF 2.0 (.glb) or OBJ"
        }
        "step" | "stp" | "iges" | "igs" | "sldprt" | "3dm" | "ifc" => {
            "tessellate it in its CAD program and export it as glTF 2.0 (.glb) or OBJ"
        }
        "zip" | "7z" | "rar" | "gz" => "unpack it and give the model inside",
        _ => return None,
    })
}

/// First bytes of formats that often have a wrong ending, and the right one.
const MARKS: [(&[u8], &str); 9] = [
    (b"Kaydara FBX Binary", "fbx"),
    (b"; FBX", "fbx"),
    (b"ply\n", "ply"),
    (b"ply\r\n", "ply"),
    (b"PXR-USDC", "usdc"),
    (b"#usda", "usda"),
    (b"BLENDER", "blend"),
    (b"PK\x03\x04", "zip"),
    (b"\x1f\x8b", "gz"),
];

/// Returns a sentence for a file whose content contradicts its ending.
fn disguised(bytes: &[u8]) -> Option<String> {
    if bytes.starts_with(b"version https://git-lfs") {
        return Some(
            "this is a Git LFS pointer instead of the model itself; run `git lfs pull` where it came from".into(),
        );
    }
    let (_, ending) = MARKS.iter().find(|(mark, _)| bytes.starts_with(mark))?;
    Some(format!(
        "this is a .{ending} file under another name: {}",
        way_from(ending)?
    ))
}
