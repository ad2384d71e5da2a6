//! Keys of JSON documents, and those that docs/report.md lists.

use std::collections::BTreeSet;

use serde::Serialize;
use serde_json::Value as Json;

const DOCUMENT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/report.md"));

/// Keys in the tables of a section, such as `mesh.overlap.materials[].texels`.
pub(crate) fn documented(section: &str) -> BTreeSet<String> {
    let title = format!("\n## {section}\n");
    let (_, after) = DOCUMENT.split_once(&title).expect("a section of that title");
    let section = after.split("\n## ").next().expect("the text up to the next section");
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
    rows.filter_map(|row| Some(row.split_once('`')?.0.to_owned())).collect()
}

/// Keys of a document and of all objects in it.
pub(crate) fn written(document: &impl Serialize) -> BTreeSet<String> {
    let mut keys = BTreeSet::new();
    collect("", &serde_json::to_value(document).expect("plain data"), &mut keys);
    keys
}

fn collect(path: &str, json: &Json, keys: &mut BTreeSet<String>) {
    match json {
        Json::Object(members) => {
            for (key, value) in members {
                let path = if path.is_empty() {
                    key.clone()
                } else {
                    format!("{path}.{key}")
                };
                collect(&path, value, keys);
                keys.insert(path);
            }
        }
        Json::Array(items) => items.iter().for_each(|item| collect(&format!("{path}[]"), item, keys)),
        _ => {}
    }
}
