//! Updates the lists of extensions of a glTF file, so that they stay correct.

use std::collections::BTreeSet;

use serde_json::{Value as Json, json};

use super::edit::{push, remove};

/// Returns the names of all extensions used in the document.
pub(super) fn present(document: &Json) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    collect(document, &mut found);
    found
}

fn collect(value: &Json, found: &mut BTreeSet<String>) {
    match value {
        Json::Object(object) => {
            for (key, value) in object {
                if key == "extensions" {
                    found.extend(value.as_object().into_iter().flatten().map(|(name, _)| name.clone()));
                }
                collect(value, found);
            }
        }
        Json::Array(values) => values.iter().for_each(|value| collect(value, found)),
        _ => {}
    }
}

/// Removes names from the lists that were used `before` and no longer are, and adds new ones. Names that were never used
/// anywhere stay: some extensions consist only of a name.
pub(super) fn keep_lists_true(document: &mut Json, before: &BTreeSet<String>) {
    let now = present(document);
    for key in ["extensionsUsed", "extensionsRequired"] {
        let Some(Json::Array(names)) = document.get_mut(key) else {
            continue;
        };
        names.retain(|name| {
            // An entry that is no text is not the copy's to remove.
            name.as_str()
                .is_none_or(|name| !before.contains(name) || now.contains(name))
        });
        if names.is_empty() {
            remove(document, key);
        }
    }
    for name in now.difference(before) {
        let listed = document["extensionsUsed"].as_array();
        if !listed.is_some_and(|names| names.iter().any(|listed| listed == name.as_str())) {
            push(document, "extensionsUsed", json!(name));
        }
    }
}
