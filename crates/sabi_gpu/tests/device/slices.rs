//! Kernels that may take long.

use std::path::PathBuf;

use sabi_nodes::SourceFile;

use super::*;

/// Returns a node that computes the sine of a place this many times.
fn sines(rounds: u32) -> SourceFile {
    SourceFile {
        path: PathBuf::from("own/sines.wgsl"),
        id: "own/sines".to_owned(),
        text: format!(
            "//! Sines\n//! Takes sines of sines.\n\n/// The last of them.\nfn mask(at: Surface) -> f32 {{\n    \
             var x = at.uv.x;\n    for (var i = 0; i < {rounds}; i++) {{ x = sin(x); }}\n    return x;\n}}\n"
        ),
    }
}

/// Returns how often a run asks whether it is canceled.
fn times_asked(rounds: u32) -> usize {
    let mut bench = Bench::new(64);
    bench.library.replace(sines(rounds)).unwrap();
    let plan = bench.plan(r#""last": { "kind": "own/sines" }"#, FUSED);
    let asked = Cell::new(0);
    let counted = RunOptions {
        is_canceled: &|| {
            asked.set(asked.get() + 1);
            false
        },
        ..options()
    };
    bench.run(&plan, &counted, None).unwrap();
    asked.get()
}

#[test]
fn a_kernel_that_may_take_long_begins_with_one_tile_and_is_stopped_between_its_slices() {
    // A run asks before a step, before its kernel, and before each slice: of one tile, of at most eight, and of the rest.
    let asked = times_asked(20_000);
    assert!(asked >= 5, "{asked}");
}
