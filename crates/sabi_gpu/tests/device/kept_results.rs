//! Results that are kept for later runs.

use super::*;

/// Store of results.
#[derive(Default)]
struct Store {
    results: BTreeMap<[u8; 32], Vec<u8>>,
    read: usize,
}

impl SourceFill for Store {
    fn plane(
        &mut self,
        step: &SourceStep,
        _output: &str,
        _plane: Plane,
        _inputs: &[Option<PlaneData>],
        _tiles: Option<&TileSet>,
    ) -> Result<Vec<u8>, String> {
        Err(format!("nobody fills '{}'", step.id))
    }

    fn scene(&mut self) -> Result<RayScene<'_>, String> {
        Err("there is nothing to follow rays through".to_owned())
    }

    fn keeps_results(&self) -> bool {
        true
    }

    fn has_result(&self, key: &[u8; 32]) -> bool {
        self.results.contains_key(key)
    }

    fn kept_result(&mut self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.read += 1;
        self.results.get(key).cloned()
    }

    fn keep_result(&mut self, key: &[u8; 32], result: &[u8]) {
        self.results.insert(*key, result.to_vec());
    }
}

fn run(bench: &Bench, plan: &Plan, store: &mut Store, keeps_from: Duration) -> Run {
    let options = RunOptions {
        keeps_from,
        ..options()
    };
    let surfaces = Surfaces::only(&bench.surface);
    run_plan(&bench.gpu, surfaces, &bench.library, plan, &options, store, None).unwrap()
}

/// Returns the plan of a chain of three passes, of which the last has a knob.
fn chain(bench: &Bench, low: f32) -> Plan {
    let nodes = format!(
        r#"
    "clouds": {{ "kind": "noise/simplex" }},
    "soft": {{ "kind": "filter/smooth", "inputs": {{ "source": "clouds" }}, "params": {{ "steps": 3 }} }},
    "last": {{ "kind": "adjust/levels", "inputs": {{ "source": "soft" }}, "params": {{ "low": {low} }} }}"#
    );
    bench.plan(&nodes, Mode::Bake { fuse: false }).with_own_slots()
}

fn passes(run: &Run) -> Vec<&str> {
    let steps = run.report.steps.iter();
    steps.map(|step| step.nodes[0].0.as_str()).collect()
}

#[test]
fn steps_that_depend_on_a_change_are_computed_and_others_are_read() {
    let bench = Bench::new(128);
    let mut store = Store::default();
    let first = run(&bench, &chain(&bench, 0.0), &mut store, Duration::ZERO);
    assert_eq!(passes(&first), ["clouds", "soft", "last"]);
    assert_eq!((first.report.kept_results.len(), store.results.len()), (0, 3));
    let plan = chain(&bench, 0.25);
    let changed = run(&bench, &plan, &mut store, Duration::ZERO);
    assert_eq!(passes(&changed), ["last"]);
    assert_eq!(changed.report.kept_results, ["soft"]);
    let alone = run(&bench, &plan, &mut Store::default(), Duration::ZERO);
    assert_eq!(bench.bytes(&plan, &changed), bench.bytes(&plan, &alone));
    let again = run(&bench, &plan, &mut store, Duration::ZERO);
    assert_eq!(passes(&again), [""; 0]);
    assert_eq!(bench.bytes(&plan, &again), bench.bytes(&plan, &alone));
}

#[test]
fn a_result_that_is_computed_quickly_is_not_kept() {
    let bench = Bench::new(64);
    let mut store = Store::default();
    run(&bench, &chain(&bench, 0.0), &mut store, Duration::from_secs(3600));
    assert_eq!(store.results.len(), 0);
}

#[test]
fn a_damaged_result_is_computed_again() {
    let bench = Bench::new(64);
    let plan = chain(&bench, 0.0);
    let mut store = Store::default();
    let whole = run(&bench, &plan, &mut store, Duration::ZERO);
    for result in store.results.values_mut() {
        result.truncate(10);
    }
    let again = run(&bench, &plan, &mut store, Duration::ZERO);
    assert!(store.read > 0);
    assert_eq!(passes(&again), ["clouds", "soft", "last"]);
    assert_eq!(bench.bytes(&plan, &again), bench.bytes(&plan, &whole));
}
