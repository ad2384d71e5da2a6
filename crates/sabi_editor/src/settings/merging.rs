//! Settings that two windows have changed at the same time.

use serde_json::Value as Json;

/// Settings that are lists of items, of which each is added or removed by itself.
const LISTS: [&str; 4] = ["recent", "models", "favorites", "brush_colors"];
/// Settings that are maps, of which each entry is changed by itself.
const MAPS: [&str; 4] = ["keys", "readings", "export_places", "model_strips"];

/// Settings of this window, with what another window has changed in `theirs` since both were `before`.
pub(super) fn merged(before: &Json, ours: Json, theirs: serde_json::Map<String, Json>) -> Json {
    let mut all = theirs;
    let Json::Object(ours) = ours else {
        return Json::Object(all);
    };
    for (name, own) in ours {
        let known = before.get(&name);
        let value = match all.get(&name) {
            Some(_) if known == Some(&own) => continue,
            Some(Json::Array(theirs)) if LISTS.contains(&name.as_str()) => merged_list(known, own, theirs),
            Some(Json::Object(theirs)) if MAPS.contains(&name.as_str()) => merged_map(known, own, theirs),
            // Of two windows that have changed a choice, the later save counts.
            _ => own,
        };
        all.insert(name, value);
    }
    Json::Object(all)
}

/// Returns this window's list with the items that another window has added, and without the items that the other window
/// has removed.
fn merged_list(before: Option<&Json>, own: Json, theirs: &[Json]) -> Json {
    let Json::Array(mut own) = own else { return own };
    let before = before.and_then(Json::as_array).map_or(&[][..], Vec::as_slice);
    own.retain(|item| theirs.contains(item) || !before.contains(item));
    let added = theirs.iter().filter(|item| !before.contains(item));
    let added: Vec<Json> = added.filter(|item| !own.contains(item)).cloned().collect();
    own.extend(added);
    Json::Array(own)
}

/// Own map, with the entries that another window has changed and this one has not.
fn merged_map(before: Option<&Json>, own: Json, theirs: &serde_json::Map<String, Json>) -> Json {
    let Json::Object(own) = own else { return own };
    let known = |name: &str| before.and_then(|before| before.get(name));
    let is_changed = |name: &str| own.get(name) != known(name);
    let mut all = theirs.clone();
    all.retain(|name, _| !is_changed(name));
    let changed = own.iter().filter(|(name, _)| is_changed(name));
    all.extend(changed.map(|(name, value)| (name.clone(), value.clone())));
    Json::Object(all)
}
