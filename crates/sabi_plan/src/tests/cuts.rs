//! Kernels that are divided because they would be too large.

use super::{FUSED, TestPlanner, graph};
use crate::Step;

#[test]
fn a_kernel_is_cut_at_the_cost_limit() {
    let mut bench = TestPlanner::new();
    bench.limits.cost.all = 4 * bench.library.kind("noise/simplex").unwrap().cost.all + 400;
    let mut lines = "n0 noise/simplex\n".to_owned();
    for node in 1..10 {
        lines += &format!("n{node} noise/simplex\nb{node} blend/mask below=n{node} above=");
        lines += &if node == 1 {
            "n0\n".to_owned()
        } else {
            format!("b{}\n", node - 1)
        };
    }
    lines += "out output/mask source=b9";
    let (plan, _) = bench.plan(&graph(&lines), FUSED);
    assert!((3..=4).contains(&plan.passes()), "{plan}");
    for step in &plan.steps {
        let Step::Kernel(kernel) = step else { continue };
        let noises = kernel.nodes.iter().filter(|node| node.starts_with('n')).count();
        assert!(noises <= 4, "{plan}");
    }
}

#[test]
fn a_kernel_is_cut_where_its_nodes_together_take_too_long() {
    let lines = "a noise/simplex\nb noise/simplex\nc noise/simplex\n\
                 ab blend/mask below=a above=b\nabc blend/mask below=ab above=c\nout output/mask source=abc";
    let mut bench = TestPlanner::new();
    assert_eq!(bench.plan(&graph(lines), FUSED).0.passes(), 1);
    let work = |kind: &str| bench.library.kind(kind).unwrap().work;
    let (noise, blend) = (work("noise/simplex"), work("blend/mask"));
    bench.limits.work = 2 * noise + blend;
    let (plan, _) = bench.plan(&graph(lines), FUSED);
    assert_eq!(plan.passes(), 2, "{plan}");
    // A node that exceeds the limit alone gets a separate kernel.
    bench.limits.work = noise - 1;
    let (plan, errors) = bench.plan(&graph(lines), FUSED);
    assert_eq!((plan.passes(), errors.len()), (5, 0), "{plan}");
}
