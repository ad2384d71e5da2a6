//! A result's key changes with everything that can change the result, and with nothing else.

use sabi_graph::PortType;
use sabi_nodes::kind::Param;

use super::{FUSED, TestPlanner, UNFUSED, graph, kind, port};
use crate::{FileFault, FileFaultKind};

const LINES: &str = "
    a noise/simplex seed=1
    b adjust/levels source=a black=0.1
    c noise/cells
    m blend/mask below=b above=c
    out output/mask source=m";

fn key(lines: &str) -> [u8; 32] {
    let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
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

/// Creates a planner with a source that has a parameter of each type.
fn bench_with_source() -> TestPlanner {
    let mut bench = TestPlanner::new();
    let mut own = kind("source/own", Vec::new(), vec![port("mask", PortType::Mask, &[])]);
    own.params = vec![
        Param::text("name", "a", ""),
        Param::file("file", ""),
        Param::choice("look", &["flat", "round"], ""),
        Param::length("size", 1.0, "").within(0.1, 10.0),
        Param::toggle("on", true, ""),
        Param::vector("toward", [0.0, 1.0, 0.0], ""),
    ];
    bench.sources.insert(own.id.clone(), own);
    bench
}

#[test]
fn the_key_of_a_source_depends_on_exactly_its_values_and_file_contents() {
    let line = |params: &str| format!("s source/own {params}\n out output/mask source=s");
    let key = |params: &str, content: u8| {
        let mut bench = bench_with_source();
        let graph = graph(&line(params));
        bench.files.insert(graph.find("s").unwrap(), Ok([content; 32]));
        let (plan, errors) = bench.plan(&graph, FUSED);
        assert_eq!(errors, []);
        plan.results[0].key
    };
    let plain = key("", 1);
    let changes = [
        "name=\"b\"",
        "file=\"x.png\"",
        "look=\"round\"",
        "size=2",
        "on=false",
        "toward=[1,0,0]",
    ];
    for change in changes {
        assert_ne!(plain, key(change, 1), "{change}");
    }
    assert_ne!(plain, key("", 2), "other bytes under the same name");
    let same = "name=\"a\" look=\"flat\" size=1 on=true toward=[0,1,0]";
    assert_eq!(plain, key(same, 1), "what is the default anyway");
}

#[test]
fn parameters_of_a_source_are_validated() {
    let cases = [
        (
            "name=7",
            "'name' of node 's' (source/own) takes a text such as \"a\", not 7",
        ),
        (
            "file=7",
            "'file' of node 's' (source/own) takes the path of a file, as a text, not 7",
        ),
        (
            "look=\"square\"",
            "'look' of node 's' (source/own) takes one of flat, round, not \"square\"",
        ),
        (
            "size=11",
            "'size' of node 's' (source/own) takes a number from 0.1 to 10, not 11",
        ),
        ("on=1", "'on' of node 's' (source/own) takes true or false, not 1"),
        (
            "toward=1",
            "'toward' of node 's' (source/own) takes a list of 3 numbers, not 1",
        ),
    ];
    for (params, words) in cases {
        let graph = graph(&format!("s source/own {params}\n out output/mask source=s"));
        let (_, errors) = bench_with_source().plan(&graph, FUSED);
        let said: Vec<String> = errors.iter().map(ToString::to_string).collect();
        assert_eq!(said, [format!("parameter {words}")]);
    }
}

#[test]
fn a_node_with_an_unusable_file_is_reported_and_its_readers_are_not_planned() {
    let mut bench = bench_with_source();
    let graph = graph(
        "s source/own\n i adjust/invert source=s\n out output/mask source=i\n n noise/white\n o output/mask source=n",
    );
    let fault = FileFault {
        param: "file".to_owned(),
        why: "rust.png: there is no such file; check the path".to_owned(),
        kind: FileFaultKind::Missing,
    };
    bench.files.insert(graph.find("s").unwrap(), Err(fault));
    let (plan, errors) = bench.plan(&graph, FUSED);
    let said: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        ["parameter 'file' of node 's' (source/own): rust.png: there is no such file; check the path"]
    );
    assert_eq!(plan.results.len(), 1, "the rest goes on");
}

#[test]
fn a_knob_is_part_of_the_key_only_while_nothing_is_connected() {
    let open = "b adjust/invert source=0.3\n out output/mask source=b";
    assert_ne!(key(open), key(&open.replace("0.3", "0.4")));
}

#[test]
fn how_passes_are_cut_does_not_change_the_key() {
    let graph = graph(LINES);
    let (fused, _) = TestPlanner::new().plan(&graph, FUSED);
    let (single, _) = TestPlanner::new().plan(&graph, UNFUSED);
    assert_eq!(fused.results[0].key, single.results[0].key);
}

#[test]
fn names_do_not_change_the_key() {
    let renamed = LINES
        .replace("a noise", "clouds noise")
        .replace("source=a", "source=clouds");
    assert_eq!(key(LINES), key(&renamed));
}
