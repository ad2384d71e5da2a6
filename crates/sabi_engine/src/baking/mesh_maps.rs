//! Maps of the model itself. They are nodes that are appended to the graph, and are planned, cached and written like its own nodes.

use std::collections::BTreeMap;

use sabi_export::{Channel, MeshMap, SetOptions};
use sabi_graph::{Fit, FlatNode, FlatRef, Value};
use sabi_plan::Target;

use crate::evaluating::evaluator::Evaluator;

/// Number of rays of a texel. Four times as many would halve the noise.
const RAYS: f64 = 64.0;
/// Reach of occlusion, bent normals and thickness, as a share of the model's largest side.
const REACH: f64 = 0.2;
/// Reach of curvature, as a share of the model's largest side.
const BEND_RADIUS: f64 = 0.02;

/// Appends the nodes of the maps that presets request to the graph, and returns the result of each map.
pub(super) fn append_mesh_maps(evaluator: &mut Evaluator, options: &SetOptions) -> Vec<(MeshMap, Target)> {
    let is_wanted = |wanted: &MeshMap| {
        let channel = Channel::Mesh(*wanted);
        let mut presets = options.presets.iter();
        presets.any(|named| named.preset.maps_of(&channel).next().is_some())
    };
    let mut targets = Vec::new();
    for map in MeshMap::ALL.iter().copied().filter(is_wanted) {
        let (nodes, port) = nodes_of(map, evaluator.graph().nodes.len());
        evaluator.append_nodes(nodes);
        let node = evaluator.graph().nodes.len() - 1;
        let port = Some(port.to_owned());
        targets.push((map, Target { node, port }));
    }
    targets
}

/// Returns the nodes of a map and the port of its result, which belongs to the last node. The first node gets the index `first`.
fn nodes_of(map: MeshMap, first: usize) -> (Vec<FlatNode>, &'static str) {
    let single = |kind: &str, params: &[(&str, Value)]| vec![node(map, kind, params)];
    let by = |word: &str| [("by", Value::Text(word.to_owned()))];
    let rays = |reach: &'static str, length| [(reach, Value::Number(length)), ("rays", Value::Number(RAYS))];
    match map {
        MeshMap::Id => (single("surface/id", &by("part")), "color"),
        MeshMap::MaterialId => (single("surface/id", &by("material")), "color"),
        MeshMap::WorldNormal => (single("surface/normal", &[]), "normal"),
        MeshMap::Position => (position(first), "vector"),
        MeshMap::BentNormal => (single("surface/bent_normal", &rays("distance", REACH)), "direction"),
        MeshMap::AmbientOcclusion => (single("surface/occlusion", &rays("distance", REACH)), "ao"),
        MeshMap::Thickness => (single("surface/thickness", &rays("distance", REACH)), "mask"),
        MeshMap::Curvature => (single("surface/curvature", &rays("radius", BEND_RADIUS)), "mask"),
    }
}

/// Returns nodes for a ramp over the bounding box along each axis, and for the vector of these ramps.
fn position(first: usize) -> Vec<FlatNode> {
    let axes = ["x", "y", "z"];
    let ramp = |axis: usize| {
        let along = (0..3).map(|at| Value::Number(if at == axis { 1.0 } else { 0.0 }));
        let mut ramp = node(
            MeshMap::Position,
            "surface/position",
            &[("along", Value::List(along.collect()))],
        );
        ramp.id = format!("(mesh position {})", axes[axis]);
        ramp
    };
    let mut vector = node(MeshMap::Position, "vector/combine", &[]);
    for (axis, name) in axes.into_iter().enumerate() {
        let link = FlatRef {
            node: first + axis,
            port: None,
        };
        vector.inputs.insert(name.to_owned(), link);
    }
    vec![ramp(0), ramp(1), ramp(2), vector]
}

/// Returns a node whose id is not valid in a graph file. It does not depend on the fit and the seed of the document.
fn node(map: MeshMap, kind: &str, params: &[(&str, Value)]) -> FlatNode {
    let params = params.iter().map(|(name, value)| ((*name).to_owned(), value.clone()));
    FlatNode {
        id: format!("(mesh {})", map.name()),
        kind: kind.to_owned(),
        version: 1,
        params: params.collect(),
        inputs: BTreeMap::new(),
        muted: false,
        seeds: Vec::new(),
        length_scale: 1.0,
        fit: Fit::Unit,
        file: None,
    }
}

/// Returns the lowest and highest coordinates of the model, in the units of its file.
pub(super) fn file_bounds(evaluator: &Evaluator) -> [[f32; 3]; 2] {
    let model = evaluator.model();
    let scale = model.file_from_working();
    let of_axis = |axis: usize| {
        let direction = std::array::from_fn(|at| if at == axis { 1.0 } else { 0.0 });
        model.extent(direction).map(|end| (f64::from(end) * scale) as f32)
    };
    let ends = [of_axis(0), of_axis(1), of_axis(2)];
    [0, 1].map(|end| ends.map(|of_axis| of_axis[end]))
}
