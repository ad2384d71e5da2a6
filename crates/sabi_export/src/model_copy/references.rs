//! References to textures and images. Unknown extensions may contain references, so everything that looks like one is
//! treated as one: an unused image does no harm, a missing one does.

use std::collections::BTreeSet;

use serde_json::Value as Json;

/// Lists whose entries are targets of references, or that refer to bytes only.
const NOT_SEARCHED: [&str; 6] = ["accessors", "buffers", "bufferViews", "images", "samplers", "textures"];

/// Returns the textures that anything but a texture list refers to: numbers under `index` or a key with `texture` in it.
pub(super) fn textures(document: &Json) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for (key, value) in document.as_object().into_iter().flatten() {
        if !NOT_SEARCHED.contains(&key.as_str()) {
            search(
                value,
                &|key| key == "index" || mentions(key, "texture"),
                false,
                &mut found,
            );
        }
    }
    found
}

/// Pictures that the given textures, or extensions, point at.
pub(super) fn images(document: &Json, textures: &BTreeSet<usize>) -> BTreeSet<usize> {
    let is_reference = |key: &str| key == "source" || mentions(key, "image");
    let mut found = BTreeSet::new();
    for index in textures {
        search(&document["textures"][*index], &is_reference, false, &mut found);
    }
    for (key, value) in document.as_object().into_iter().flatten() {
        if !NOT_SEARCHED.contains(&key.as_str()) {
            search(value, &is_reference, false, &mut found);
        }
    }
    found
}

/// Buffer views that anything but the given pictures points at.
pub(super) fn views(document: &Json, without_images: &BTreeSet<usize>) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for (key, value) in document.as_object().into_iter().flatten() {
        let is_reference = |key: &str| mentions(key, "bufferview");
        if key == "images" {
            for (index, image) in value.as_array().into_iter().flatten().enumerate() {
                if !without_images.contains(&index) {
                    search(image, &is_reference, false, &mut found);
                }
            }
        } else if key != "bufferViews" {
            search(value, &is_reference, false, &mut found);
        }
    }
    found
}

fn mentions(key: &str, what: &str) -> bool {
    key.to_ascii_lowercase().contains(what)
}

/// Collects whole numbers below keys that refer.
fn search(value: &Json, is_reference: &dyn Fn(&str) -> bool, refers: bool, found: &mut BTreeSet<usize>) {
    match value {
        Json::Object(object) => {
            for (key, value) in object {
                let refers = is_reference(key);
                search(value, is_reference, refers, found);
            }
        }
        Json::Array(values) => values
            .iter()
            .for_each(|value| search(value, is_reference, refers, found)),
        Json::Number(number) if refers => found.extend(number.as_u64().and_then(|at| usize::try_from(at).ok())),
        _ => {}
    }
}
