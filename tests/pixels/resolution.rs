//! A small map shows the same as a large map that is seen from far away.

use std::collections::BTreeMap;

use sabi_tests::{OnMesh, extent, range};

use crate::specimens::{for_each, on_own_mesh};

/// Results of which only the mean is compared, each with its reason.
const EXEMPT: [(&str, &str); 30] = [
    ("adjust/coverage", "its border is narrower than a texel"),
    ("adjust/threshold", "its border is narrower than a texel"),
    ("color/split.hue", "hues turn quickly where colors are nearly gray"),
    (
        "color/split.saturation",
        "it has a kink where another component is the least",
    ),
    ("filter/distance", "what is just at its threshold is on one map only"),
    (
        "filter/distance.distance",
        "what is just at its threshold is on one map only",
    ),
    (
        "filter/distance.direction",
        "it turns at once where two sources are equally near",
    ),
    ("filter/distance.id", "it jumps where two sources are equally near"),
    ("filter/denoise", "it tells grain from detail by single texels"),
    ("filter/grow", "its border is as narrow as a texel"),
    ("filter/median", "it chooses one of several texels"),
    ("filter/streak", "its ways begin at single texels"),
    ("filter/smooth", "its reach is counted in texels, as its text says"),
    ("noise/cells.id", "a map of steps"),
    ("noise/chips", "its borders are narrower than a texel, and follow rays"),
    (
        "noise/chips.height",
        "its borders are narrower than a texel, and follow rays",
    ),
    ("noise/chips.id", "a map of steps"),
    ("noise/dots.id", "a map of steps"),
    ("noise/scratches.id", "a map of steps"),
    ("noise/white", "a map of steps"),
    ("noise/white.id", "a map of steps"),
    (
        "noise/wood",
        "its years end and its pores begin within less than a texel",
    ),
    (
        "noise/wood.height",
        "its years end and its pores begin within less than a texel",
    ),
    ("relief/cavity", "bends of a relief that the small map does not carry"),
    ("relief/edges", "bends of a relief that the small map does not carry"),
    (
        "relief/occlusion",
        "slopes of a relief that the small map does not carry",
    ),
    (
        "relief/occlusion.ao",
        "slopes of a relief that the small map does not carry",
    ),
    (
        "surface/bent_normal.mask",
        "all noise on a cube, which covers nothing of itself",
    ),
    ("surface/cavity", "all noise on a cube, which has no creases"),
    (
        "surface/edges",
        "narrower than a texel of the small map, and not even in the bend",
    ),
];

const SMALL: u32 = 64;
const FACTOR: u32 = 4;
/// Root mean square of the difference, as a share of the range.
const TOLERANCE: f64 = 0.02;
/// Difference of the means of narrow results, as a share of the range: the most that was seen is 6.5 %, of the veins of
/// `noise/flow`, which are thinner than a texel of the small map.
const TOLERANCE_OF_NARROW_MEANS: f64 = 0.07;

/// For each owned texel of the small atlas whose whole footprint is owned in the large one: the texels it covers there.
fn footprints(small: &OnMesh, large: &OnMesh, factor: u32) -> BTreeMap<usize, Vec<usize>> {
    let mut found = BTreeMap::new();
    for (index, triangle) in small.owned() {
        let chart = small.atlas().triangle_chart[triangle as usize];
        let [from, to] = [small, large].map(|on_mesh| &on_mesh.atlas().charts[chart as usize]);
        let [_, x, y] = small.texel(index);
        let corner = |texel: u32, axis: usize| {
            (texel as i32 - from.texel_from_uv[axis]) * factor as i32 + to.texel_from_uv[axis]
        };
        let (first_x, first_y) = (corner(x, 0) as u32, corner(y, 1) as u32);
        let covered: Vec<usize> = (0..factor * factor)
            .map(|tap| large.index([to.page, first_x + tap % factor, first_y + tap / factor]))
            .collect();
        let is_owned = |texel: &usize| {
            matches!(large.owner(*texel), sabi_surface::atlas::Owner::Triangle(_)) && large.chart(*texel) == Some(chart)
        };
        if covered.iter().all(is_owned) {
            found.insert(index, covered);
        }
    }
    found
}

/// Root mean square of the texels' differences, and difference of the means.
fn differences(footprints: &BTreeMap<usize, Vec<usize>>, coarse: &[f32], fine: &[f32]) -> [f64; 2] {
    let count = footprints.len() as f64;
    let (mut squares, mut sum) = (0.0, 0.0);
    for (index, covered) in footprints {
        let mean = covered.iter().map(|texel| f64::from(fine[*texel])).sum::<f64>() / covered.len() as f64;
        let difference = mean - f64::from(coarse[*index]);
        squares += difference * difference;
        sum += difference;
    }
    [(squares / count).sqrt(), (sum / count).abs()]
}

#[test]
fn a_small_map_is_the_mean_of_a_large_one() {
    for_each(|specimen| {
        // The joints of patterns are narrower than a texel, and their cells are steps.
        let is_exempt =
            specimen.is_pattern() || specimen.is_narrow() || EXEMPT.iter().any(|(name, _)| *name == specimen.name());
        let mut small = on_own_mesh(&specimen.coarse, "cube", SMALL);
        let mut large = on_own_mesh(&specimen.coarse, "cube", SMALL * FACTOR);
        let coarse = small.evaluate(&specimen.target()).components();
        let fine = large.evaluate(&specimen.target()).components();
        let footprints = footprints(&small, &large, FACTOR);
        assert!(footprints.len() > 1000, "only {} texels are inside", footprints.len());
        for ((name, coarse), (_, fine)) in coarse.iter().zip(&fine) {
            // Normals are derivatives: `closed_forms` holds them.
            if name.starts_with("normal") {
                continue;
            }
            let [low, high] = extent(large.owned().map(|(index, _)| fine[index]));
            let whole = range([low, high]);
            // What half floats round.
            let rounding = f64::from(low.abs().max(high.abs())) / 2048.0;
            let difference = differences(&footprints, coarse, fine)[usize::from(is_exempt)];
            let tolerance = if specimen.is_narrow() {
                TOLERANCE_OF_NARROW_MEANS
            } else {
                TOLERANCE
            };
            if difference > tolerance * whole + rounding {
                return Err(format!(
                    "{name} differs by {:.2} % of its range",
                    100.0 * difference / whole
                ));
            }
        }
        Ok(())
    });
}

#[test]
fn marks_far_below_a_texel_are_the_mean_of_what_is_there() {
    // At 128² a texel of the cube is several times as wide as a crack, a scratch or a small dot. Pieces and spacings are a
    // few texels wide: where cracks meet within a texel only the nearest one counts, which takes that long to fade.
    for (kind, params) in [
        ("cells", r#""size": 0.15"#),
        ("cells", r#""size": 0.2, "sharpness": 3"#),
        // Finer levels and bends are narrower than a texel themselves.
        ("cracks", r#""size": 0.4, "levels": 1, "bend": 0"#),
        (
            "cracks",
            r#""size": 0.4, "levels": 1, "bend": 0, "stretch": [1, 1, 3], "rotate": [20, 30, 0]"#,
        ),
        ("dots", r#""size": 0.03, "spacing": 0.1"#),
        (
            "dots",
            r#""size": 0.006, "spacing": 0.06, "sharpness": 1, "variation": 0"#,
        ),
        ("scratches", ""),
        ("scratches", r#""density": 1, "width": 0.002, "stretch": [3, 1, 1]"#),
    ] {
        let graph = format!(
            r#"{{ "format": "sabi", "version": 1, "nodes": {{
                "noise": {{ "kind": "noise/{kind}", "params": {{ {params} }} }} }} }}"#
        );
        let [mut small, mut large] = [128, 1024].map(|size| on_own_mesh(&graph, "cube", size));
        let [coarse, fine] = [&mut small, &mut large].map(|on_mesh| on_mesh.evaluate("noise").component("mask"));
        let footprints = footprints(&small, &large, 8);
        let [rms, mean] = differences(&footprints, &coarse, &fine);
        assert!(rms <= TOLERANCE, "noise/{kind}, {params}: {:.2} %", 100.0 * rms);
        assert!(
            mean <= 0.005,
            "noise/{kind}, {params}: the mean by {:.2} %",
            100.0 * mean
        );
    }
}
