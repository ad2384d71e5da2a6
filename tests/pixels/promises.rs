//! Guarantees of every node for its results: they are finite numbers, the same each time, and in range.

use sabi_graph::PortType;
use sabi_nodes::Library;
use sabi_nodes::kind::{Kind, Memory, Param, Role};
use sabi_tests::{NodeResult, OnMesh};
use serde_json::{Value, json};

use crate::specimens::{Specimen, for_each, on_own_mesh};

fn numbers(on_mesh: &OnMesh, evaluated: &NodeResult) -> Result<(), String> {
    for (name, values) in evaluated.components() {
        if let Some(index) = on_mesh.covered().find(|index| !values[*index].is_finite()) {
            let texel = on_mesh.texel(index);
            return Err(format!("{name} is {} at texel {texel:?} (page, x, y)", values[index]));
        }
    }
    Ok(())
}

#[test]
fn every_result_is_a_number_on_charts_and_ghosts() {
    for_each(|specimen| {
        for graph in [&specimen.connected, &specimen.alone] {
            let mut on_mesh = on_own_mesh(graph, "cube", 64);
            let evaluated = on_mesh.evaluate(&specimen.target());
            numbers(&on_mesh, &evaluated)?;
        }
        Ok(())
    });
}

/// Settings that put one knob to one of its ends.
fn ends(kind: &Kind) -> Vec<Value> {
    let numbers = kind
        .params
        .iter()
        .filter(|param| matches!(param.ty.role, Role::Plain | Role::Length | Role::Angle));
    let both = |param: &Param| {
        param.ty.range.unwrap_or_default().map(|end| {
            let value = match param.ty.memory {
                Memory::U32 => json!(end as u32),
                Memory::I32 => json!(end as i32),
                _ if param.ty.components() == 1 => json!(end),
                _ => json!(vec![end; param.ty.components()]),
            };
            json!({ param.name.as_str(): value })
        })
    };
    numbers.flat_map(both).collect()
}

#[test]
fn every_result_is_a_number_with_any_knob_at_either_end() {
    let library = Library::builtin();
    for_each(|specimen| {
        let mut on_mesh = on_own_mesh(&specimen.alone, "cube", 32);
        for params in ends(library.kind(&specimen.kind).expect("a built-in kind")) {
            let mut graph: Value = serde_json::from_str(&specimen.alone).expect("a graph");
            graph["nodes"]["node"]["params"] = params.clone();
            on_mesh.set_graph(&graph.to_string());
            let evaluated = on_mesh.evaluate(&specimen.target());
            numbers(&on_mesh, &evaluated).map_err(|why| format!("{why}, with {params}"))?;
        }
        Ok(())
    });
}

#[test]
fn the_same_graph_gives_the_same_bytes() {
    for_each(|specimen| {
        let mut on_mesh = on_own_mesh(&specimen.connected, "cube", 64);
        let first = on_mesh.evaluate(&specimen.target()).bytes();
        let again = on_mesh.evaluate(&specimen.target()).bytes();
        let fresh = on_own_mesh(&specimen.connected, "cube", 64)
            .evaluate(&specimen.target())
            .bytes();
        match (first == again, first == fresh) {
            (true, true) => Ok(()),
            (false, _) => Err("a second run gives other bytes".to_owned()),
            (_, false) => Err("a second session gives other bytes".to_owned()),
        }
    });
}

/// Returns the lowest and the highest allowed value of a component while all parameters have their defaults.
fn bounds(name: &str) -> [f32; 2] {
    match name {
        // Of a material, or a map for one.
        "height" => [-1.0, 1.0],
        // A rise over a run, which a bevel lets end at 80 degrees.
        "slope" => [-5.8, 5.8],
        // A place in a cell of a pattern, with a depth of its own for each cell.
        "place" => [-64.0, 64.0],
        // A length that is below 0 outside of a mark.
        "away" => [-1.0, 1.0],
        _ if name.starts_with("vector") || name.starts_with("slope") || name.starts_with("normal") => [-1.001, 1.001],
        // A mask, a color and what a material is made of are shares; half floats round up by at most 2⁻¹¹.
        _ => [0.0, 1.0],
    }
}

fn in_bounds(specimen: &Specimen) -> Result<(), String> {
    let mut on_mesh = on_own_mesh(&specimen.alone, "cube", 64);
    let evaluated = on_mesh.evaluate(&specimen.target());
    for (name, values) in evaluated.components() {
        let is_wide = ["height", "slope", "place", "away"].contains(&specimen.port.as_str());
        let [low, high] = bounds(if is_wide { &specimen.port } else { &name });
        if let Some(index) = on_mesh.covered().find(|index| !(low..=high).contains(&values[*index])) {
            return Err(format!("{name} is {}, outside of {low} to {high}", values[index]));
        }
    }
    let is_material = specimen.ty == PortType::Material;
    if is_material && evaluated.normals.is_some() {
        let up = evaluated.component("normal.z");
        if on_mesh.owned().any(|(index, _)| up[index] <= 0.0) {
            return Err("a normal points into the surface".to_owned());
        }
    }
    Ok(())
}

#[test]
fn with_every_knob_at_its_default_results_stay_in_range() {
    for_each(in_bounds);
}
