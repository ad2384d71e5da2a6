//! Sentences that refer to nodes by their titles.

use super::*;
use crate::node_paths::with_titles;

#[test]
fn ids_kinds_and_names_in_a_sentence_are_replaced_by_titles_and_labels() {
    let document = opened(
        r#""groups": { "Worn": { "outputs": { "mask": "blur.mask" }, "nodes": { "blur": { "kind": "filter/blur" } } } },"#,
        r#""image_2": { "kind": "source/image", "label": "Rust photo" },
           "octaves": { "kind": "noise/simplex" },
           "worn": { "kind": "graph/group", "group": "Worn" }"#,
    );
    let clouds = document.title(&id("octaves"));
    let worn = document.title(&id("worn"));
    let told = [
        (
            "parameter 'file' of node 'image_2' (source/image): rust.png is missing",
            "parameter 'File' of node 'Rust photo': rust.png is missing".to_owned(),
        ),
        (
            "parameter 'octaves' of node 'octaves' (noise/simplex) takes a whole number, not 'image_2'",
            format!("parameter 'Detail' of node '{clouds}' takes a whole number, not 'image_2'"),
        ),
        (
            "input 'in' of node 'image_2' takes a mask, but 'octaves' gives a material; connect a mask",
            format!("input 'in' of node 'Rust photo' takes a mask, but '{clouds}' gives a material; connect a mask"),
        ),
        (
            "parameter 'radius' of node 'worn/blur' (filter/blur) takes a number, not 'radius'",
            format!("parameter 'Radius' of node '{worn} › Blur' takes a number, not 'radius'"),
        ),
        (
            "input 'source' of node 'worn/blur' asks 'image_2' for 'source', which it does not give",
            format!("input 'Source' of node '{worn} › Blur' asks 'Rust photo' for 'source', which it does not give"),
        ),
        (
            "node 'octaves' (noise/simplex) has no parameter 'base_color_strength'; it is kept and ignored",
            format!("node '{clouds}' has no parameter 'base_color_strength'; it is kept and ignored"),
        ),
        (
            "waiting for node 'worn/blur'",
            format!("waiting for node '{worn} › Blur'"),
        ),
        (
            "the nodes 'image_2', 'octaves' took too long",
            format!("the nodes 'Rust photo', '{clouds}' took too long"),
        ),
        (
            "node \"image_2\" needs the group file \"image_2\", which cannot be read",
            "node \"Rust photo\" needs the group file \"image_2\", which cannot be read".to_owned(),
        ),
        (
            "the nodes feed each other in a circle: image_2 → octaves; remove one of these links",
            format!("the nodes feed each other in a circle: Rust photo → {clouds}; remove one of these links"),
        ),
        ("node 'gone' isn't there", "node 'gone' isn't there".to_owned()),
    ];
    for (sentence, expected) in told {
        assert_eq!(with_titles(&document, sentence), expected);
    }
}
