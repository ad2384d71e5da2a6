//! The page about all groups of the effect library.

use std::fmt::Write;

use serde_json::Value;

use super::CATEGORIES;
use super::group::LibraryGroup;

/// The page about all groups.
pub(super) fn page(groups: &[LibraryGroup]) -> String {
    let mut page = String::from(
        "# The effect library\n\nWritten by `cargo xtask library` from `graphs/library`. Each group is drawn on three models with the \
         same parameters, and in its variants on the first of them; all but base materials lie over one. Every group has the \
         parameters Seed (other patterns), Scale (multiplies its lengths) and Fit (whether lengths are shares of the piece, shares of \
         the model, or metres) besides its own. How to make your own: [a smart material step by step](own-material.md). \
         How long they take: [times](times.md).\n",
    );
    for (category, title) in CATEGORIES {
        let _ = write!(page, "\n## {title}\n"); // Writing to a string does not fail.
        for group in groups.iter().filter(|group| group.category == category) {
            let (stem, name) = (&group.stem, group.text("name"));
            let _ = write!(
                page,
                "\n### {name}\n\n{}\n\n![{name} on three models]({stem}.png)\n\n",
                group.text("about")
            );
            let _ = writeln!(page, "| Parameter | Effect |\n|---|---|");
            for (label, about) in knobs(&group.document) {
                let _ = writeln!(page, "| {label} | {about} |");
            }
            let variants: Vec<String> = group
                .variants()
                .into_iter()
                .flatten()
                .map(|variant| variant.replace('_', " "))
                .collect();
            let _ = write!(
                page,
                "\nVariants: {}.\n\n![variants of {name}]({stem}.variants.png)\n",
                variants.join(", ")
            );
        }
    }
    page
}

/// Labels and descriptions of the exposed knobs, in their order.
fn knobs(document: &Value) -> Vec<(String, String)> {
    let exposed = document.get("exposed").and_then(Value::as_object);
    let mut knobs: Vec<(u64, String, String)> = exposed
        .into_iter()
        .flatten()
        .map(|(name, knob)| {
            let text = |key: &str| knob.get(key).and_then(Value::as_str).map(str::to_owned);
            let order = knob.get("order").and_then(Value::as_u64).unwrap_or(u64::MAX); // Those without one come last.
            (
                order,
                text("label").unwrap_or_else(|| name.clone()),
                text("about").unwrap_or_default(), // A page shows what there is.
            )
        })
        .collect();
    knobs.sort();
    knobs.into_iter().map(|(_, label, about)| (label, about)).collect()
}
