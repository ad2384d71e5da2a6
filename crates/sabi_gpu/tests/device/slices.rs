//! Kernels that may take long.

use std::path::PathBuf;

use sabi_nodes::SourceFile;

use super::*;

/// A node that takes the sine of a place this often.
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

/// Time between two looks at whether a run is canceled.
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
    // A run asks before a step and before its kernel, and then before each slice: one tile, at most eight, and the rest.
    let asked = times_asked(20_000);
    assert!(asked >= 5, "{asked}");
}
