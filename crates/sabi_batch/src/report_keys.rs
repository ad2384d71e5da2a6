//! Test that docs/report.md names exactly the keys of a line of a plan.

#[path = "../../sabi_engine/src/report_keys/keys.rs"]
mod keys;

use std::collections::BTreeSet;
use std::path::Path;

use keys::{documented, written};
use sabi_engine::baking::BakeRequest;
use sabi_engine::baking::made_of::Recipe;
use sabi_engine::program::Build;

use crate::{BakeItem, ItemInput};

#[test]
fn a_line_of_a_plan_has_the_documented_keys() {
    let text = || "text".to_owned();
    let request = BakeRequest::plain(Path::new("rust.sabi"), Path::new("crate.glb"), 64);
    let item = BakeItem {
        item: 0,
        key: text(),
        out: text(),
        recipe: Recipe::of(&request, None),
        inputs: vec![ItemInput {
            name: text(),
            path: text(),
            blake3: text(),
        }],
        build: Build::current().clone(),
    };
    // The recipe is that of a report.
    let keys = written(&item).into_iter().filter(|key| !key.starts_with("recipe."));
    assert_eq!(keys.collect::<BTreeSet<_>>(), documented("Line of a plan"));
}
