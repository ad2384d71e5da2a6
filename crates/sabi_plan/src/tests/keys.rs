//! A result's name changes with everything that can change the result, and with nothing else.

use super::{Bench, FUSED, UNFUSED, graph};

const LINES: &str = "
    a noise/simplex seed=1
    b adjust/levels source=a black=0.1
    c noise/cells
    m blend/mask below=b above=c
    out output/mask source=m";

fn key(lines: &str) -> [u8; 32] {
    let (plan, errors) = Bench::new().plan(&graph(lines), FUSED);
    assert_eq!(errors, []);
    plan.results[0].key
}

#[test]
fn what_changes_the_result_changes_its_key() {
    let changes = [
        ("seed=1", "seed=2"),
        ("black=0.1", "black=0.2"),
        ("noise/cells", "noise/white"),
        ("above=c", "above=a"),
        ("below=b above=c", "below=c above=b"),
        ("below=b", "below=a"),
        ("above=c", "above=c.id"),
    ];
    for (from, to) in changes {
        assert_ne!(key(LINES), key(&LINES.replace(from, to)), "{from} to {to}");
    }
}

#[test]
fn a_knob_is_part_of_the_key_only_while_nothing_is_connected() {
    let open = "b adjust/invert source=0.3\n out output/mask source=b";
    assert_ne!(key(open), key(&open.replace("0.3", "0.4")));
}

#[test]
fn how_passes_are_cut_does_not_change_the_key() {
    let graph = graph(LINES);
    let (fused, _) = Bench::new().plan(&graph, FUSED);
    let (single, _) = Bench::new().plan(&graph, UNFUSED);
    assert_eq!(fused.results[0].key, single.results[0].key);
}

#[test]
fn names_do_not_change_the_key() {
    let renamed = LINES
        .replace("a noise", "clouds noise")
        .replace("source=a", "source=clouds");
    assert_eq!(key(LINES), key(&renamed));
}
