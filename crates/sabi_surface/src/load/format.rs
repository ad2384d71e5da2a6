//! Format of a model file, and advice for formats that are not read.

use super::error::ModelFault;
use super::{dae, ending, fbx, ply, stl};

/// Extensions of supported files, most common first.
pub const MODEL_ENDINGS: [&str; 8] = ["glb", "gltf", "vrm", "fbx", "obj", "dae", "ply", "stl"];

/// Number of bytes at the start of a file in which the root element of XML is searched.
const ROOT_WITHIN: usize = 4096;

/// Supported formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ModelFormat {
    Gltf,
    Obj,
    Fbx,
    Dae,
    Ply,
    Stl,
}

/// Returns the format: by the first bytes if they identify it, otherwise by the extension of the name, otherwise by what
/// the content looks like.
pub(super) fn format_of(name: &str, bytes: &[u8]) -> Result<ModelFormat, ModelFault> {
    if let Some(format) = marked(bytes) {
        return Ok(format);
    }
    if let Some(sentence) = refused_format(name).or_else(|| disguised(bytes)) {
        return Err(ModelFault::Format(sentence));
    }
    match ending(name).as_str() {
        "gltf" | "glb" | "vrm" => Ok(ModelFormat::Gltf),
        "obj" => Ok(ModelFormat::Obj),
        "fbx" => Ok(ModelFormat::Fbx),
        "dae" => Ok(ModelFormat::Dae),
        "ply" => Ok(ModelFormat::Ply),
        "stl" => Ok(ModelFormat::Stl),
        _ if bytes.trim_ascii_start().starts_with(b"{") => Ok(ModelFormat::Gltf),
        _ if stl::is_likely(bytes) => Ok(ModelFormat::Stl),
        _ => Err(ModelFault::Format(format!(
            "this is not a model that is read here: give a {} file",
            listed(&MODEL_ENDINGS.map(|ending| format!(".{ending}")), "or")
        ))),
    }
}

/// Returns the format of a file whose first bytes occur only in that format.
fn marked(bytes: &[u8]) -> Option<ModelFormat> {
    let starts_with = |marks: &[&[u8]]| marks.iter().any(|mark| bytes.starts_with(mark));
    let start = &bytes[..bytes.len().min(ROOT_WITHIN)];
    let is_xml = start.trim_ascii_start().starts_with(b"<");
    let has_root = || start.windows(dae::ROOT.len()).any(|window| window == dae::ROOT);
    match () {
        () if bytes.starts_with(b"glTF") => Some(ModelFormat::Gltf),
        () if starts_with(&fbx::MARKS) => Some(ModelFormat::Fbx),
        () if starts_with(&ply::MARKS) => Some(ModelFormat::Ply),
        () if is_xml && has_root() => Some(ModelFormat::Dae),
        () => None,
    }
}

/// Joins words: `a, b or c`.
fn listed(words: &[String], last: &str) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., end] => format!("{} {last} {end}", first.join(", ")),
    }
}

/// Returns a sentence for well-known formats that are not read.
pub(super) fn refused_format(name: &str) -> Option<String> {
    let ending = ending(name);
    Some(format!(".{ending} files are not read here: {}", way_from(&ending)?))
}

/// Returns advice on converting a format to a supported one.
fn way_from(ending: &str) -> Option<&'static str> {
    Some(match ending {
        "abc" | "usd" | "usda" | "usdc" | "usdz" => {
            "open it in Blender (File > Import) and export it with File > Export > glTF 2.0 (.glb)"
        }
        "blend" => "open it in Blender and export it with File > Export > glTF 2.0 (.glb)",
        "3ds" | "ac" | "ase" | "b3d" | "dxf" | "irrmesh" | "lwo" | "lws" | "md2" | "md3" | "md5mesh" | "ms3d"
        | "off" | "smd" | "wrl" | "x" | "x3d" => {
            "convert it with Assimp (`assimp export` with its name and that of a new .glb file), or export it from its own \
             program as glTF 2.0 (.glb), FBX, OBJ or Collada (.dae)"
        }
        "max" | "ma" | "mb" | "c4d" | "hip" | "hiplc" | "skp" | "ztl" | "spp" => {
            "export it from its own program as glTF 2.0 (.glb), FBX, OBJ or Collada (.dae)"
        }
        "step" | "stp" | "iges" | "igs" | "sldprt" | "3dm" | "ifc" => {
            "tessellate it in its CAD program and export it as glTF 2.0 (.glb), FBX, OBJ, STL or PLY"
        }
        "zip" | "7z" | "rar" | "gz" => "unpack it and give the model inside",
        _ => return None,
    })
}

/// First bytes of unsupported formats that often have a wrong extension, and the correct name.
const MARKS: [(&[u8], &str); 5] = [
    (b"PXR-USDC", "usdc"),
    (b"#usda", "usda"),
    (b"BLENDER", "blend"),
    (b"PK\x03\x04", "zip"),
    (b"\x1f\x8b", "gz"),
];

/// Returns a sentence for a file whose content contradicts its extension.
fn disguised(bytes: &[u8]) -> Option<String> {
    if bytes.starts_with(b"version https://git-lfs") {
        return Some(
            "this is a Git LFS pointer instead of the model itself; run `git lfs pull` where it came from".into(),
        );
    }
    if is_web_page(bytes) {
        return Some(
            "this is a web page instead of the model itself; download the file, not the page that shows or offers it"
                .into(),
        );
    }
    let (_, ending) = MARKS.iter().find(|(mark, _)| bytes.starts_with(mark))?;
    Some(format!(
        "this is a .{ending} file under another name: {}",
        way_from(ending)?
    ))
}

/// Returns true for HTML, which is stored where a link led to a page.
fn is_web_page(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let starts = [&b"<!doctype html"[..], b"<html"];
    starts.iter().any(|start| {
        let begin = text.get(..start.len());
        begin.is_some_and(|begin| begin.eq_ignore_ascii_case(start))
    })
}
