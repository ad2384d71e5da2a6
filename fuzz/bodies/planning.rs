//! Planning of results on a plain model.

use std::collections::BTreeMap;

use sabi_graph::FlatGraph;
use sabi_nodes::Library;
use sabi_plan::{FileContents, Lengths, LevelWidths, Limits, Mode, Plan, Planner, Target};

/// Plans results; each fault has a text.
pub fn planned(graph: &FlatGraph, library: &Library, targets: &[Target], mode: Mode) -> Plan {
    let nothing = BTreeMap::new();
    let planner = Planner {
        graph,
        library,
        sources: &nothing,
        sinks: &nothing,
        files: &FileContents::new(),
        lengths: Lengths {
            working_from: &|_| 1.0,
            largest_piece: 1.0,
            extent: &|_| [0.0, 1.0],
        },
        level_widths: LevelWidths::of_texels(0.001, 0),
        surface_key: [0; 32],
        mode,
        most_rays: None,
        limits: Limits::default(),
    };
    let (plan, errors) = planner.plan(targets);
    assert!(errors.iter().all(|error| !error.to_string().is_empty()));
    plan
}
