//! Entries that an archive may have: files that a bake reads, and no files on which other programs act.

use std::path::Path;

use sabi_files::read_plain;
use sabi_surface::load::MODEL_ENDINGS;

use super::manifest;

/// Extensions of graphs, of node files and of strokes.
const OWN_ENDINGS: [&str; 3] = ["sabi", "wgsl", "strokes"];
/// Extensions of vertex data and of material libraries.
const DATA_ENDINGS: [&str; 6] = ["bin", "buf", "buffer", "dat", "glbin", "mtl"];
/// Extensions of pictures that are accepted by their name. For others, the content is examined.
const PICTURE_ENDINGS: [&str; 18] = [
    "avif", "basis", "bmp", "dds", "exr", "gif", "hdr", "jpeg", "jpg", "ktx", "ktx2", "pic", "png", "psd", "tga",
    "tif", "tiff", "webp",
];
/// Maximum size of a picture whose content is examined.
const MOST_PICTURE_BYTES: u64 = 1 << 30;
/// Folder of node files.
const NODES: &str = "nodes";

/// Returns true for the lower-case extension of a file of a model or of its pictures.
pub(super) fn is_usual_ending(ending: &str) -> bool {
    DATA_ENDINGS.contains(&ending) || PICTURE_ENDINGS.contains(&ending)
}

/// Checks the name of an entry. The error is a clause.
pub(super) fn check_name(name: &str) -> Result<(), String> {
    // Some disks ignore zero-width joiners in names, so that a name with them could mean `.git`.
    let is_joiner = |letter: char| matches!(letter, '\u{200c}' | '\u{200d}');
    if let Some(hidden) = name
        .split('/')
        .find(|part| part.trim_start_matches(is_joiner).starts_with('.'))
    {
        return Err(format!(
            "'{hidden}' begins with a dot, as settings of other programs do, which no bake reads"
        ));
    }
    let is_node = ending(name).as_deref() == Some("wgsl");
    if is_node && !(name.split('/').count() == 3 && name.split('/').next() == Some(NODES)) {
        return Err(format!("node files are in folders of {NODES}/ alone"));
    }
    Ok(())
}

/// Checks that a file is one of those that a bake reads: by the extension of its entry, or because it is a picture. The error is a clause.
pub(super) fn check_file(name: &str, path: &Path) -> Result<(), String> {
    if name == manifest::NAME || ending(name).is_some_and(|ending| is_known(&ending)) {
        return Ok(());
    }
    let is_picture = read_plain(path, MOST_PICTURE_BYTES).is_ok_and(|bytes| is_picture(name, &bytes));
    match is_picture {
        true => Ok(()),
        false => Err("it is no graph, node, model or picture, nor data of a model".to_owned()),
    }
}

/// Returns true if bytes begin like a picture of this name.
pub(super) fn is_picture(name: &str, bytes: &[u8]) -> bool {
    sabi_image::check_header(name, bytes).is_ok()
}

fn is_known(ending: &str) -> bool {
    OWN_ENDINGS.contains(&ending) || MODEL_ENDINGS.contains(&ending) || is_usual_ending(ending)
}

/// Returns the extension of the last part of a name in lower case.
fn ending(name: &str) -> Option<String> {
    let file = name.rsplit('/').next().unwrap_or(name);
    file.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_on_which_other_programs_act_are_refused() {
        for good in [
            "graph.sabi",
            "pack.json",
            "nodes/own/half.wgsl",
            "nodes/lib/wave.wgsl",
            "graph.paint/model.strokes",
            "files/2/a b.png",
            "model/crate.gltf",
        ] {
            assert_eq!(check_name(good), Ok(()), "{good}");
        }
        for bad in [
            ".git/config",
            "\u{200c}.git/config",
            ".envrc",
            "a/.vscode/settings.json",
            "a/.git",
            ".hidden.png",
            "half.wgsl",
            "nodes/half.wgsl",
            "other/own/half.wgsl",
            "nodes/a/b/half.WGSL",
        ] {
            assert!(check_name(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn files_of_other_kinds_are_accepted_only_if_they_are_pictures() {
        let folder = tempfile::tempdir().unwrap();
        let text = folder.path().join("text");
        std::fs::write(&text, b"[autorun]\nopen=x.exe\n").unwrap();
        let picture = folder.path().join("picture");
        let options = sabi_image::PngOptions {
            channels: 1,
            bits: 8,
            srgb_chunk: false,
        };
        let png = sabi_image::encode_png(1, 1, sabi_image::PngData::U8(&[255]), options);
        std::fs::write(&picture, png.unwrap()).unwrap();
        for name in [
            "autorun.inf",
            "sabi.toml",
            "run.sh",
            "a.desktop",
            "README",
            "x.png.exe",
            "package.json",
        ] {
            assert!(check_file(name, &text).is_err(), "{name}");
        }
        for name in ["scan.texture", "README", "a.b"] {
            assert_eq!(check_file(name, &picture), Ok(()), "{name}");
        }
        for name in ["a.PNG", "b.Sabi", "c.glb", "d.bin", "pack.json"] {
            assert_eq!(check_file(name, Path::new("never read")), Ok(()), "{name}");
        }
    }
}
