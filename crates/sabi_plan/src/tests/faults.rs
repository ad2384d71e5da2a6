//! Messages for graphs that cannot be planned.

use super::{FUSED, TestPlanner, graph};

fn said(lines: &str) -> Vec<String> {
    TestPlanner::new()
        .plan(&graph(lines), FUSED)
        .1
        .iter()
        .map(ToString::to_string)
        .collect()
}

#[test]
fn each_fault_is_a_sentence_with_the_node_and_the_port() {
    let cases = [
        (
            "a noise/simplx\n out output/mask source=a",
            "node 'a' is of kind 'noise/simplx', which no loaded node file describes; did you mean 'noise/simplex'?",
        ),
        (
            "a noise/simplex@9\n out output/mask source=a",
            "node 'a' was made with version 9 of 'noise/simplex', but version 1 is loaded; update Sabi or its node folder",
        ),
        (
            "b source/material\n out output/mask source=b",
            "input 'source' of node 'out' takes a mask, but 'b' gives a material; connect a mask",
        ),
        (
            "a noise/simplex\n b adjust/invert sourc=a\n out output/mask source=b",
            "node 'b' (adjust/invert) has no input 'sourc'; did you mean 'source'?",
        ),
        (
            "a noise/cells\n out output/mask source=a.idd",
            "input 'source' of node 'out' asks 'a' for 'idd', which it does not give; did you mean 'id'?",
        ),
        (
            "out output/mask",
            "input 'source' of node 'out' (output/mask) must be connected to a mask",
        ),
        (
            "s filter/smooth\n out output/mask source=s",
            "input 'source' of node 's' (filter/smooth) must be connected to a mask",
        ),
        (
            "a noise/simplex octaves=99\n out output/mask source=a",
            "parameter 'octaves' of node 'a' (noise/simplex) takes a whole number from 1 to 16, not 99",
        ),
        (
            "a noise/simplex mode=\"rigged\"\n out output/mask source=a",
            "parameter 'mode' of node 'a' (noise/simplex) takes one of fbm, billow, ridged, not \"rigged\"",
        ),
        (
            "a adjust/curve points=[[0,0],[1]]\n out output/mask source=a",
            "parameter 'points' of node 'a' (adjust/curve) takes a list of 1 to 16 points such as [0.5, 0.8], both \
             numbers from -10 to 10, not [[0, 0], [1]]",
        ),
        (
            "a adjust/curve points=[[0,0],[1,1e9]]\n out output/mask source=a",
            "parameter 'points' of node 'a' (adjust/curve) takes a list of 1 to 16 points such as [0.5, 0.8], both \
             numbers from -10 to 10, not [[0, 0], [1, 1000000000]]",
        ),
        (
            "a noise/simplex sizee=1\n out output/mask source=a",
            "node 'a' (noise/simplex) has no parameter 'sizee'; it is kept and ignored; did you mean 'size'?",
        ),
    ];
    for (lines, expected) in cases {
        assert_eq!(said(lines), [expected], "{lines}");
    }
}

#[test]
fn a_parameter_that_is_not_a_number_for_each_place_refuses_a_mask() {
    let said = said("a noise/cells\n b noise/simplex octaves=a\n out output/mask source=b");
    let expected = "parameter 'octaves' of node 'b' (noise/simplex) is not read for each place, so no mask can multiply it; \
                    remove the link";
    assert_eq!(said, [expected]);
}

#[test]
fn a_fault_leaves_the_rest_of_the_graph_alone() {
    let lines = "
        a noise/simplex
        bad noise/simplx
        waits adjust/invert source=bad
        out output/mask source=a
        lost output/mask source=waits";
    let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(errors.len(), 1);
    assert_eq!(plan.to_string(), "pass a -> s0\nresult mask s0\n");
}

#[test]
fn problems_of_a_muted_node_are_reported_too() {
    let cases = [
        (
            "a noise/simplx muted\n b adjust/invert source=a\n out output/mask source=b",
            "node 'a' is of kind 'noise/simplx', which no loaded node file describes; did you mean 'noise/simplex'?",
        ),
        (
            "a noise/cells muted\n b adjust/invert source=a.idd\n out output/mask source=b",
            "input 'source' of node 'b' asks 'a' for 'idd', which it does not give; did you mean 'id'?",
        ),
        (
            "a output/mask@7 source=b\n b noise/simplex\n out output/mask source=b",
            "node 'a' was made with version 7 of 'output/mask', but version 1 is loaded; update Sabi or its node folder",
        ),
    ];
    for (lines, expected) in cases {
        assert_eq!(said(lines), [expected], "{lines}");
    }
}

#[test]
fn only_six_hexadecimal_digits_are_a_color() {
    for wrong in ["#+12345", "#12345g", "123456", "#12345"] {
        let lines = format!("c color/constant color=\"{wrong}\"\n out output/mask source=c");
        let expected = format!(
            "parameter 'color' of node 'c' (color/constant) takes a color such as \"#6b3a1e\", not \"{wrong}\""
        );
        assert_eq!(said(&lines), [expected]);
    }
}
