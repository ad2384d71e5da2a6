//! Runs that compute only the shown tiles.

use super::*;
use sabi_gpu::ShownTiles;

const TEXELS: u32 = 128;
/// A tile in the middle of the square.
const TILE: [u32; 3] = [7, 6, 0];
/// Number of texels of this tile and the eight tiles around it.
const NINE_TILES: u64 = 9 * 64;

fn atlas() -> Atlas {
    Atlas::build(&square(), &AtlasOptions::new(TEXELS)).unwrap()
}

fn shown() -> ShownTiles {
    ShownTiles::new(&atlas(), [TILE])
}

fn all(bench: &Bench) -> u64 {
    u64::from(bench.surface.tile_count()) * 64
}

/// Returns a chain whose last node reads a survey, or the result of this kind over the clouds.
fn chain_over(kind: &str) -> String {
    format!(
        r#""clouds": {{ "kind": "noise/simplex" }},
        "read": {{ "kind": "{kind}", "inputs": {{ "source": "clouds" }} }},
        "last": {{ "kind": "adjust/invert", "inputs": {{ "source": "read" }} }}"#
    )
}

#[test]
fn passes_over_texels_compute_only_the_shown_tiles_and_those_around_them() {
    let bench = Bench::new(TEXELS);
    let plan = bench.plan(CHAIN, Mode::Bake { fuse: false });
    let shown = shown();
    let some = RunOptions {
        shown: Some(&shown),
        ..options()
    };
    let [alone, whole] = [&some, &options()].map(|options| bench.run(&plan, options, None).unwrap());
    assert_eq!(
        (alone.report.texels, whole.report.texels),
        (3 * NINE_TILES, 3 * all(&bench))
    );
    let [alone, whole] = [alone, whole].map(|run| bench.bytes(&plan, &run));
    let [column, row, width] = [TILE[0], TILE[1], atlas().page_size[0]].map(|at| at as usize);
    for y in 8 * row..8 * (row + 1) {
        let first = 4 * (y * width + 8 * column);
        assert_eq!(alone[first..first + 32], whole[first..first + 32]);
    }
}

#[test]
fn inputs_of_a_filter_or_a_survey_are_computed_everywhere() {
    let bench = Bench::new(TEXELS);
    let shown = shown();
    let some = RunOptions {
        shown: Some(&shown),
        ..options()
    };
    for kind in ["filter/smooth", "adjust/coverage"] {
        let plan = bench.plan(&chain_over(kind), Mode::Bake { fuse: false });
        let [alone, whole] = [&some, &options()].map(|options| bench.run(&plan, options, None).unwrap());
        let spared = whole.report.texels - alone.report.texels;
        // The filter fills ghosts, so all of it is computed. Passes after the filter or the survey are computed only where shown.
        let spared_passes = if kind == "filter/smooth" { 1 } else { 2 };
        assert_eq!(spared, spared_passes * (all(&bench) - NINE_TILES), "{kind}");
    }
}

#[test]
fn results_of_some_tiles_are_not_reused_as_results_of_all_tiles() {
    let bench = Bench::new(TEXELS);
    let plan = bench.plan(CHAIN, Mode::Interactive);
    let shown = shown();
    let some = RunOptions {
        shown: Some(&shown),
        ..options()
    };
    let mut cache = ResultCache::new(DEFAULT_BUDGET_BYTES);
    let mut steps = |options: &RunOptions<'_>| {
        let run = bench.run(&plan, options, Some(&mut cache)).unwrap();
        (run.report.steps.len(), bench.bytes(&plan, &run))
    };
    assert_eq!(steps(&some).0, 3);
    assert_eq!(steps(&some).0, 0);
    let (count, whole) = steps(&options());
    assert_eq!(count, 3, "the texels of the other tiles hold anything");
    assert_eq!(bench.bytes(&plan, &bench.run(&plan, &options(), None).unwrap()), whole);
}
