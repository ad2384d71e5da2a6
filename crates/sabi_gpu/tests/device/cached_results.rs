//! Results that are cached from run to run.

use std::cell::Cell;

use super::*;

#[test]
fn a_slider_runs_only_its_node_and_the_nodes_that_depend_on_it() {
    let bench = Bench::new(64);
    let mut cache = ResultCache::new(DEFAULT_BUDGET_BYTES);
    let mut names = |nodes: &str| {
        let plan = bench.plan(nodes, Mode::Interactive);
        let run = bench.run(&plan, &options(), Some(&mut cache)).unwrap();
        let names = run
            .report
            .steps
            .iter()
            .flat_map(|step| step.nodes.iter().map(|(name, _)| name.clone()));
        names.collect::<Vec<_>>()
    };
    assert_eq!(names(CHAIN), ["clouds", "cut", "last"]);
    assert_eq!(names(CHAIN), [""; 0]);
    let moved = CHAIN.replace(
        r#""adjust/threshold","#,
        r#""adjust/threshold", "params": { "at": 0.3 },"#,
    );
    assert_eq!(names(&moved), ["cut", "last"]);
    assert_eq!(names(CHAIN), [""; 0], "what was made before is still known");
}

#[test]
fn a_full_cache_drops_the_least_recently_used_result() {
    let bench = Bench::new(64);
    let one_result = bench.surface.texels() * 4;
    let mut cache = ResultCache::new(2 * one_result);
    let plan = bench.plan(CHAIN, Mode::Interactive);
    bench.run(&plan, &options(), Some(&mut cache)).unwrap();
    let (held, allowed) = cache.bytes();
    assert!(held > 0 && held <= allowed);
}

#[test]
fn steps_that_ended_before_a_run_was_stopped_do_not_run_again() {
    let bench = Bench::new(64);
    let mut cache = ResultCache::new(DEFAULT_BUDGET_BYTES);
    let plan = bench.plan(CHAIN, Mode::Interactive);
    let ended = Cell::new(0);
    let after_two = RunOptions {
        is_canceled: &|| ended.get() == 2,
        progress: &|done, _| ended.set(done),
        ..options()
    };
    let stopped = bench.run(&plan, &after_two, Some(&mut cache));
    assert_eq!(stopped.err(), Some(GpuError::Canceled));
    let run = bench.run(&plan, &options(), Some(&mut cache)).unwrap();
    let names: Vec<&str> = run.report.steps.iter().map(|step| step.nodes[0].0.as_str()).collect();
    assert_eq!(names, ["last"]);
    let fresh = bench.run(&plan, &options(), None).unwrap();
    assert_eq!(bench.bytes(&plan, &run), bench.bytes(&plan, &fresh));
}

/// Returns the plan of a chain that starts at a source which returns this many masks at once.
fn plan_of_masks(bench: &Bench, masks: usize) -> Plan {
    let mut plan = bench.plan(CHAIN, Mode::Interactive);
    let slot = plan.slots[plan.results[0].slots[0]];
    let mask = |at: usize| (format!("mask {at}"), vec![(Plane::Mask, at)]);
    let step = SourceStep {
        node: 0,
        id: "masks".into(),
        kind: "source/image".into(),
        values: SourceValues::default(),
        reads: Vec::new(),
        writes: (0..masks).map(mask).collect(),
        keys: (0..masks).map(|at| [at as u8; 32]).collect(),
    };
    plan.steps = vec![sabi_plan::Step::Source(step)];
    plan.slots = vec![slot; masks];
    plan.results[0].slots = (0..masks).collect();
    plan
}

#[test]
fn a_texture_that_was_returned_to_the_caller_is_never_written_again() {
    let bench = Bench::new(64);
    let mut cache = ResultCache::new(DEFAULT_BUDGET_BYTES);
    let mut first_mask = |masks: usize| {
        let mut source = Counted {
            bytes: 4 * bench.surface.texels() as usize,
            asked: Rc::default(),
        };
        let surfaces = Surfaces::only(&bench.surface);
        let plan = plan_of_masks(&bench, masks);
        let (gpu, library) = (&bench.gpu, &bench.library);
        let run = run_plan(gpu, surfaces, library, &plan, &options(), &mut source, Some(&mut cache));
        (run.unwrap().texture(0).unwrap(), source.asked.get())
    };
    let (first, made) = first_mask(1);
    assert_eq!(made, 1);
    let (known, made) = first_mask(1);
    assert_eq!((&known, made), (&first, 0));
    // The second mask is not cached, so the source has to return both.
    let (again, made) = first_mask(2);
    assert_eq!(made, 2);
    assert_ne!(again, first);
}
