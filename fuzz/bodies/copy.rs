//! Any model that loads can be copied with new maps or is refused with a reason; the copy loads again with all triangles.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::Arc;

use sabi_export::{CopyOptions, CopySource, FinishedCopy, MapFile, MaterialMaps, ModelCopy, SetKey};
use sabi_surface::load::{LoadOptions, load};
use sabi_surface::model::Model;

use crate::parts::files;

/// Most triangles of a model that is copied.
const MOST_TRIANGLES: usize = 10_000;

pub fn survives(bytes: &[u8]) {
    let all = files(bytes, 2);
    let is_binary = all[0].starts_with(b"glTF");
    let name = if is_binary { "model.glb" } else { "model.gltf" };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    fs::write(&path, if is_binary { bytes } else { all[0] }).expect("a new file");
    if let (false, Some(beside)) = (is_binary, all.get(1)) {
        fs::write(folder.path().join("data.bin"), beside).expect("a new file");
    }
    let options = LoadOptions {
        memory_bytes: 64 << 20,
        ..LoadOptions::default()
    };
    let Ok(model) = load(&path, &options) else {
        return;
    };
    if model.mesh.triangles.len() > MOST_TRIANGLES {
        return;
    }
    for (keeps_look, embeds) in [(false, false), (true, true)] {
        let options = CopyOptions { keeps_look, embeds };
        match copied(&path, &model, options) {
            Ok(copy) => loads_again(&copy, &model),
            Err(reason) => assert!(!reason.is_empty(), "a refusal has a reason"),
        }
    }
}

/// The copy of a model with maps for all of its materials.
fn copied(path: &Path, model: &Model, options: CopyOptions) -> Result<FinishedCopy, String> {
    let sets = (0..model.materials.len() as u32).map(|material| SetKey {
        material,
        uv_tile: [0, 0],
        udim: None,
    });
    let maps: BTreeMap<SetKey, MaterialMaps> = sets.map(|key| (key, maps())).collect();
    let baked: BTreeSet<SetKey> = maps.keys().copied().collect();
    let source = CopySource {
        path,
        model,
        uv_set: 0,
        unwrapped_uv_set: None,
    };
    let copy = ModelCopy::open(source, &baked, options).map_err(|error| error.to_string())?;
    copy.finish(maps, &|_| false).map_err(|error| error.to_string())
}

fn maps() -> MaterialMaps {
    let map = |name: &str| {
        Some(MapFile {
            name: format!("{name}.png"),
            bytes: Arc::new(b"\x89PNG of no pixels".to_vec()),
            is_written: true,
        })
    };
    MaterialMaps {
        base_color: map("color"),
        packed: map("packed"),
        packed_surface: true,
        packed_occlusion: true,
        normal: map("normal"),
        ..MaterialMaps::default()
    }
}

fn loads_again(copy: &FinishedCopy, model: &Model) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for file in copy.beside.iter().chain([&copy.copy]) {
        let is_plain = Path::new(&file.name)
            .file_name()
            .is_some_and(|name| name == file.name.as_str());
        assert!(is_plain, "{:?} is no plain file name", file.name);
        fs::write(folder.path().join(&file.name), &file.bytes).expect("a new file");
    }
    let again = load(&folder.path().join(&copy.copy.name), &LoadOptions::default());
    let again = again.expect("a copy can be read");
    assert_eq!(again.mesh.triangles.len(), model.mesh.triangles.len());
}
