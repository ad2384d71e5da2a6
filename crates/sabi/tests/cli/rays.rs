//! Settings of rays and filters that make no sense: each a sentence, before any ray is shot.

use crate::cli_folder::{CliFolder, graph};

/// A node whose parameter has a value, and an output that reads it.
fn with(kind: &str, param: &str, value: &str) -> String {
    let source = if kind.starts_with("filter/") {
        r#", "inputs": { "source": "noise" }"#
    } else {
        ""
    };
    graph(&format!(
        r#"    "clouds": {{ "kind": "{kind}", "params": {{ "{param}": {value} }}{source} }},
    "noise": {{ "kind": "noise/simplex" }},
    "out": {{ "kind": "output/mask", "inputs": {{ "source": "clouds.mask" }} }}"#
    ))
}

#[test]
fn no_rays_and_lengths_of_nothing_are_refused_with_what_is_taken() {
    let place = CliFolder::new();
    let rays = "a whole number from 1 to 1024";
    let length = "a number from 0.00001 to 1000";
    let cases = [
        ("surface/occlusion", "rays", "0", rays),
        ("surface/occlusion", "rays", "-1", rays),
        ("surface/occlusion", "rays", "1.5", rays),
        ("surface/occlusion", "rays", "1025", rays),
        ("surface/occlusion", "distance", "0", length),
        ("surface/thickness", "distance", "-0.1", length),
        ("surface/bent_normal", "distance", "1001", length),
        ("surface/curvature", "rays", "1", "a whole number from 2 to 1024"),
        ("surface/curvature", "radius", "0", length),
        ("surface/edges", "width", "-1", length),
        ("surface/cavity", "width", "0", length),
        ("filter/blur", "radius", "-0.1", "a number from 0 to 1"),
        ("filter/distance", "width", "0", "a number from 0.0001 to 2"),
        ("filter/grow", "radius", "-2", "a number from -1 to 1"),
    ];
    for (kind, param, value, takes) in cases {
        let text = with(kind, param, value);
        let line = text.lines().nth(7).unwrap();
        let column = 1 + line.find(&format!("\"{param}\"")).unwrap();
        place.write("bad.sabi", &text);
        let words =
            format!("bad.sabi:8:{column}: parameter '{param}' of node 'clouds' ({kind}) takes {takes}, not {value}");
        place.refuses("bad.sabi", "cube.glb", &[], 65, &words);
    }
}
