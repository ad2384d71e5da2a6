//! Passes of plans and slots of results.

use sabi_graph::Document;

use super::{FUSED, TestPlanner, UNFUSED, flat, graph};
use crate::{Level, Mode, Plan, Step};

const TWELVE: &str = "
    clouds noise/simplex
    grains noise/white
    cells noise/cells
    levels adjust/levels source=clouds
    cut adjust/threshold source=cells
    turned adjust/invert source=cut
    both blend/mask below=levels above=turned
    all blend/mask below=both above=grains
    tint color/gradient source=clouds
    base source/material
    rust effect/layer base=base mask=all color_map=tint
    worn material/blend below=base above=rust mask=levels
    out output/material material=worn";

#[test]
fn a_chain_of_twelve_nodes_is_one_pass() {
    let (plan, errors) = TestPlanner::new().plan(&graph(TWELVE), FUSED);
    assert_eq!(errors, []);
    assert_eq!((plan.passes(), plan.nodes.len()), (1, 12), "{plan}");
}

#[test]
fn each_node_of_a_fused_pass_is_called_once() {
    let (plan, _) = TestPlanner::new().plan(&graph(TWELVE), FUSED);
    let Step::Kernel(kernel) = &plan.steps[0] else {
        panic!("{plan}")
    };
    assert_eq!(kernel.spec.calls.len(), 12);
}

#[test]
fn without_fusion_every_node_is_a_pass() {
    let (plan, _) = TestPlanner::new().plan(&graph(TWELVE), UNFUSED);
    assert_eq!(plan.passes(), 12, "{plan}");
}

#[test]
fn a_slot_is_reused_once_its_last_reader_has_run() {
    let lines = "
        a noise/simplex
        b adjust/invert source=a
        c adjust/invert source=b
        d adjust/invert source=c
        out output/mask source=d";
    let (plan, _) = TestPlanner::new().plan(&graph(lines), UNFUSED);
    let expected = "\
        pass a -> s0\n\
        pass b <- s0 -> s1\n\
        pass c <- s1 -> s0\n\
        pass d <- s0 -> s1\n\
        result mask s1\n";
    assert_eq!(plan.to_string(), expected);
}

#[test]
fn what_needs_most_memory_runs_while_little_else_is_stored() {
    // The blur needs five textures of vectors while it runs. Each noise leaves only one texture of numbers.
    let lines = "
        a noise/simplex
        b noise/cells
        c noise/spots
        soft filter/blur source=d radius=0.001
        d noise/white
        ab blend/mask below=a above=b
        abc blend/mask below=ab above=c
        all blend/mask below=abc above=soft
        out output/mask source=all";
    let (bake, _) = TestPlanner::new().plan(&graph(lines), UNFUSED);
    let places = |plan: &Plan, node: &str| -> Vec<usize> {
        let steps = plan.steps.iter().enumerate();
        let of_node = steps.filter(|(_, step)| matches!(step, Step::Kernel(kernel) if kernel.nodes == [node]));
        of_node.map(|(at, _)| at).collect()
    };
    let last_of_blur = places(&bake, "soft").pop();
    assert!(
        ["a", "b", "c"]
            .iter()
            .all(|noise| places(&bake, noise).first().copied() > last_of_blur),
        "{bake}"
    );
    // In interactive mode all results are kept, and groups run in the order of their inputs.
    let (live, _) = TestPlanner::new().plan(&graph(lines), Mode::Interactive);
    assert!(places(&live, "a").first() < places(&live, "soft").first(), "{live}");
}

#[test]
fn a_pass_for_a_position_runs_once_something_moves_it() {
    let bench = TestPlanner::new();
    let (still, errors) = bench.plan(&graph("net noise/cracks\nout output/mask source=net"), FUSED);
    assert_eq!(errors, []);
    assert_eq!(
        still.to_string(),
        "pass net -> s0 halo\npass net <- s0 -> s1 halo\nresult mask s1\n"
    );
    let Step::Kernel(net) = &still.steps[0] else {
        panic!("{still}")
    };
    assert_eq!(net.reads, [None], "the way to where the noise is read is 0 everywhere");
    let moved = "warped vector/warp\nnet noise/cracks position=warped\nout output/mask source=net";
    let (moved, errors) = bench.plan(&graph(moved), FUSED);
    assert_eq!(errors, []);
    let of_net = moved
        .steps
        .iter()
        .filter(|step| matches!(step, Step::Kernel(kernel) if kernel.nodes == ["net"]));
    assert_eq!(of_net.count(), 3, "{moved}");
}

#[test]
fn a_hundred_nodes_in_a_chain_need_two_slots() {
    let mut lines = "n0 noise/simplex\n".to_owned();
    for node in 1..100 {
        lines += &format!("n{node} adjust/invert source=n{}\n", node - 1);
    }
    lines += "out output/mask source=n99";
    let (plan, _) = TestPlanner::new().plan(&graph(&lines), UNFUSED);
    assert_eq!((plan.passes(), plan.slots.len()), (100, 2));
}

#[test]
fn a_field_separates_two_regions_and_fills_its_ghosts() {
    let lines = "
        a noise/simplex
        b adjust/levels source=a
        soft filter/smooth source=b steps=3
        c adjust/invert source=soft
        d blend/mask below=c above=b
        out output/mask source=d";
    let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(errors, []);
    let expected = "\
        pass a b -> s0\n\
        pass soft <- s0 -> s1 x3 via s2 halo\n\
        pass c d <- s1 s0 -> s2\n\
        result mask s2\n";
    assert_eq!(plan.to_string(), expected);
}

#[test]
fn a_kernel_is_divided_at_the_number_of_textures_the_adapter_can_write() {
    let mut bench = TestPlanner::new();
    bench.limits.storage_textures = 2;
    let mut lines = String::new();
    for node in 0..5 {
        lines += &format!("n{node} noise/simplex seed={node}\nm{node} blend/mask below=n{node} above=n0\n");
        lines += &format!("o{node} output/mask source=m{node}\n");
    }
    let (plan, _) = bench.plan(&graph(&lines), FUSED);
    for step in &plan.steps {
        let Step::Kernel(kernel) = step else { continue };
        assert!(kernel.writes.len() <= 2, "{plan}");
    }
    assert_eq!(plan.results.len(), 5);
}

#[test]
fn only_what_is_asked_for_is_planned() {
    let lines = "
        a noise/simplex
        idle noise/cells
        out output/mask source=a";
    let (plan, _) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(plan.nodes, ["a"]);
}

#[test]
fn a_muted_node_passes_its_first_fitting_input_on() {
    let lines = "
        a noise/simplex
        b noise/cells
        mix blend/mask below=a above=b muted
        out output/mask source=mix";
    let (plan, _) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(plan.to_string(), "pass a -> s0\nresult mask s0\n");
}

#[test]
fn a_muted_node_without_inputs_leaves_its_reader_its_knob() {
    let lines = "
        a noise/simplex muted
        b adjust/invert source=a
        out output/mask source=b";
    let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(errors, []);
    assert_eq!(plan.nodes, ["b"]);
}

#[test]
fn channels_that_nothing_sets_take_no_storage() {
    let lines = "
        base source/material
        coat effect/layer base=base height_on=false
        out output/material material=coat";
    let (plan, _) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(plan.slots.len(), 2, "color and surface only: {plan}");
    let raised = lines.replace("height_on=false", "height=0.1");
    let (plan, _) = TestPlanner::new().plan(&graph(&raised), FUSED);
    assert_eq!(plan.slots.len(), 3, "and height: {plan}");
}

#[test]
fn a_knob_at_zero_takes_no_storage_and_a_wire_does() {
    let slots = |lines: &str| {
        let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
        assert_eq!(errors, []);
        plan.slots.len()
    };
    let combined = "all material/combine\n out output/material material=all";
    assert_eq!(slots(combined), 2, "color and surface");
    assert_eq!(slots(&combined.replace("combine\n", "combine height=0.1\n")), 3);
    assert_eq!(
        slots(&combined.replace("combine\n", "combine emission=\"#ffffff\"\n")),
        3
    );
    let wired = format!(
        "a noise/simplex\n {}",
        combined.replace("combine\n", "combine height=a\n")
    );
    assert_eq!(slots(&wired), 3);
    let sunk = "all effect/relief depth=0\n out output/material material=all";
    assert_eq!(slots(sunk), 2);
    assert_eq!(slots(&sunk.replace("depth=0", "depth=0.1")), 3);
}

#[test]
fn rewiring_an_interactive_graph_needs_no_new_kernel() {
    let specs = |lines: &str| {
        let (plan, _) = TestPlanner::new().plan(&graph(lines), Mode::Interactive);
        let kernels = plan.steps.iter().map(|step| match step {
            Step::Kernel(kernel) => (kernel.spec.calls[0].kind.clone(), kernel.spec.clone()),
            other => panic!("{other:?}"),
        });
        kernels.collect::<std::collections::BTreeMap<_, _>>()
    };
    let wired = "
        a noise/simplex
        c color/constant
        t adjust/threshold source=a
        m blend/mask below=a above=t mask=a
        out output/mask source=m";
    let rewired = "
        a noise/simplex
        c color/constant
        t adjust/threshold source=c
        m blend/mask below=t
        n blend/mask below=m above=a
        out output/mask source=n";
    let (before, after) = (specs(wired), specs(rewired));
    for (kind, spec) in &after {
        if let Some(known) = before.get(kind) {
            assert_eq!(known, spec, "{kind}");
        }
    }
    assert_eq!(after.len(), 4);
}

#[test]
fn a_graph_in_groups_six_deep_has_the_passes_of_its_flat_form() {
    let inner = |name: usize, body: &str| {
        format!(r#""g{name}": {{ "inputs": {{ "mask": {{ "to": [{body}"], "type": "mask" }} }}"#,)
    };
    // Three effects in nested groups read the same mask.
    let mut groups = Vec::new();
    groups.push(format!(
        r#"{}, "outputs": {{ "material": "e3" }}, "nodes": {{
            "b": {{ "kind": "source/material" }},
            "e1": {{ "kind": "effect/layer", "inputs": {{ "base": "b" }} }},
            "e2": {{ "kind": "effect/layer", "inputs": {{ "base": "e1" }} }},
            "e3": {{ "kind": "effect/layer", "inputs": {{ "base": "e2" }} }} }} }}"#,
        inner(1, r#""e1.mask", "e2.mask", "e3.mask"#)
    ));
    for level in 2..=6 {
        groups.push(format!(
            r#"{}, "outputs": {{ "material": "in.material" }}, "nodes": {{
                "in": {{ "kind": "graph/group", "group": "g{}" }} }} }}"#,
            inner(level, r#""in.mask"#),
            level - 1
        ));
    }
    let nested = format!(
        r#"{{ "format": "sabi", "version": 1, "name": "nested", "groups": {{ {} }}, "nodes": {{
            "m": {{ "kind": "noise/simplex" }},
            "top": {{ "kind": "graph/group", "group": "g6", "inputs": {{ "mask": "m" }} }},
            "out": {{ "kind": "output/material", "inputs": {{ "material": "top.material" }} }} }} }}"#,
        groups.join(", ")
    );
    let document = Document::from_json(&nested).unwrap_or_else(|error| panic!("{error}"));
    let (deep, errors) = TestPlanner::new().plan(&flat(&document), FUSED);
    assert_eq!(errors, []);
    let lines = "
        m noise/simplex
        b source/material
        e1 effect/layer base=b mask=m
        e2 effect/layer base=e1 mask=m
        e3 effect/layer base=e2 mask=m
        out output/material material=e3";
    let (plain, _) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!((deep.passes(), plain.passes()), (1, 1));
    assert_eq!(deep.nodes.len(), plain.nodes.len());
    assert_eq!(
        deep.results[0].key, plain.results[0].key,
        "the same content has the same name"
    );
}

#[test]
fn a_muted_node_passes_on_the_first_input_that_leads_to_an_unmuted_node() {
    let lines = "
        dead source/material muted
        base source/material
        mix material/blend below=dead above=base muted
        out output/material material=mix";
    let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(errors, []);
    assert_eq!(plan.nodes, ["base"]);
}

#[test]
fn a_color_is_converted_to_a_stored_mask_before_a_field_reads_it() {
    let lines = "
        a color/constant
        b filter/smooth source=a
        out output/mask source=b";
    for mode in [FUSED, Mode::Interactive] {
        let (plan, errors) = TestPlanner::new().plan(&graph(lines), mode);
        assert_eq!(errors, []);
        let steps: Vec<String> = plan.to_string().lines().map(str::to_owned).collect();
        assert!(steps[1].starts_with("convert <- s0 -> s1"), "{plan}");
        assert!(steps[2].starts_with("pass b <- s1"), "{plan}");
    }
}

#[test]
fn a_ladder_of_thousands_of_nodes_is_cut_into_few_kernels() {
    let rungs = 3000;
    let mut lines = "m0 noise/simplex\nm1 noise/cells\n".to_owned();
    for rung in 2..rungs {
        lines += &format!("m{rung} blend/mask below=m{} above=m{}\n", rung - 1, rung - 2);
    }
    let graph = graph(&(lines + &format!("out output/mask source=m{}", rungs - 1)));
    let bench = TestPlanner::new();
    let (plan, errors) = bench.plan(&graph, FUSED);
    assert_eq!(errors, []);
    assert_eq!(plan.nodes.len(), rungs);
    let cost = (rungs as u32) * bench.library.kind("blend/mask").unwrap().cost.straight;
    assert!(
        plan.passes() as u32 <= 2 + cost / (bench.limits.cost.straight / 2),
        "{}",
        plan.passes()
    );
}

#[test]
fn a_pass_runs_on_the_coarsest_level_that_is_fine_enough_and_what_it_reads_is_moved_there() {
    let plan = |radius: f64| {
        let lines = format!(
            "
            a noise/simplex
            b filter/blur source=a radius={radius}
            c filter/sharpen source=a radius={radius}
            out output/mask source=b
            crisp output/mask source=c"
        );
        let (plan, errors) = TestPlanner::new().plan(&graph(&lines), FUSED);
        assert_eq!(errors, []);
        plan
    };
    let moves = |plan: &Plan| -> Vec<[Level; 2]> {
        let levels = plan.steps.iter().filter_map(|step| match step {
            Step::Move(step) => Some(step.levels),
            _ => None,
        });
        levels.collect()
    };
    use Level::{Points, Texels};
    const FINEST: Level = Level::FINEST;
    // Levels here have texels of 0.001, 0.002, 0.004 and 0.008, and points of 0.016 and 0.008. A blur requests three points
    // for its radius, or 2.4 texels.
    assert_eq!(moves(&plan(0.0045)), [] as [[Level; 2]; 0]);
    // Both passes read the noise on the same level, so it is moved there once.
    let coarse = Texels(2);
    assert_eq!(
        moves(&plan(0.012)),
        [[FINEST, coarse], [coarse, FINEST], [coarse, FINEST]]
    );
    // The cells of points consist of texels a quarter as wide, so the plane is moved to that level on the way.
    for (radius, cells, points) in [(0.03, Texels(1), Points(1)), (0.5, Texels(2), Points(0))] {
        assert_eq!(
            moves(&plan(radius)),
            [[FINEST, cells], [cells, points], [points, FINEST], [points, FINEST]]
        );
    }
    // A kernel that reads no texture is also evaluated for ghosts.
    let text = plan(0.012).to_string();
    assert!(text.contains("pass c -> s1 level 2\n"), "{text}");
}

#[test]
fn rays_start_from_the_level_that_suits_their_length_and_what_they_find_is_moved_to_the_finest() {
    // Texels are twice as wide for rays from twenty finest texels on, and four times from eighty on.
    let down = |level| [Level::Texels(level), Level::FINEST];
    for (width, moves) in [
        (0.015, vec![]),
        (0.03, vec![down(1)]),
        (0.07, vec![down(1)]),
        (0.9, vec![down(2)]),
    ] {
        let lines = format!("a surface/edges width={width}\nb adjust/levels source=a\nout output/mask source=b");
        let (plan, errors) = TestPlanner::new().plan(&graph(&lines), Mode::Interactive);
        assert_eq!(errors, []);
        let moved = plan.steps.iter().filter_map(|step| match step {
            Step::Move(step) => Some((step.levels, step.result.is_some())),
            _ => None,
        });
        let expected: Vec<_> = moves.iter().map(|levels| (*levels, true)).collect();
        assert_eq!(moved.collect::<Vec<_>>(), expected, "{width}: {plan}");
    }
}

#[test]
fn denoised_means_over_rays_are_stored_and_read_by_another_step() {
    let lines = "a surface/occlusion distance=0.0001\nb output/mask source=a\nc output/mask source=a.ao";
    let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(errors, []);
    let text = plan.to_string();
    let steps: Vec<&str> = text.lines().filter(|line| !line.starts_with("result")).collect();
    let expected = [
        "pass a -> s0 8 rays halo",
        "normals -> s1",
        "pass a <- s1 s0 -> s2 s3 halo",
    ];
    assert_eq!(steps, expected);
    let rays = plan.steps.iter().find_map(|step| match step {
        Step::Kernel(kernel) => kernel.rays.as_ref().map(|rays| (rays.results.len(), kernel.keys.len())),
        _ => None,
    });
    assert_eq!(rays, Some((2, 0)), "the rays are those of both results, and store none");
}

#[test]
fn no_fused_kernel_has_more_parameters_than_a_block_holds() {
    let mut lines = "m0 noise/simplex\n".to_owned();
    for node in 1..=10 {
        lines += &format!("m{node} adjust/curve source=m{}\n", node - 1);
    }
    let mut bench = TestPlanner::new();
    // A curve takes 256 bytes, and so does a knob.
    bench.limits.block_bytes = 1024;
    let (plan, errors) = bench.plan(&graph(&(lines + "out output/mask source=m10")), FUSED);
    assert_eq!(errors, []);
    assert_eq!(plan.passes(), 4, "{plan}");
}
