//! A node's result on a flat square, as a picture for brushes.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use sabi_gpu::Gpu;
use sabi_graph::{Fit, Overrides, PortType};
use sabi_plan::Mode;
use sabi_surface::model::{Mesh, Model, ModelMaterial};

use super::node_argument::graph_and_target;
use super::preview::picture;
use crate::error::EngineError;
use crate::evaluating::evaluator::{Evaluator, EvaluatorOptions};
use crate::evaluating::texture_sets::texture_sets;
use crate::evaluating::texture_space::TextureSpace;
use crate::opening::document::OpenGraph;
use crate::opening::graph_faults::refuse_faults;
use crate::opening::kinds::Kinds;
use crate::opening::linked_model::{LinkedModel, ModelOptions};
use crate::phases::NoProgress;
use sabi_gpu::{CasterChoice, DEFAULT_BUDGET_BYTES};

/// Name of the square, for nodes that know models by their names.
const NAME: &str = "square";

/// A result on a square.
#[derive(Clone, Debug, PartialEq)]
pub struct StampSquare {
    /// PNG file: gray for masks, sRGB for colors and for the base color of materials.
    pub png: Vec<u8>,
    /// True for a mask, whose light parts should be stamped.
    pub is_mask: bool,
}

/// Evaluates the result of a node, `id` or `id.port`, on an upright square with sides of one working unit, as a picture of `side` pixels
/// squared. So a pattern becomes a picture that a ribbon lays end to end.
///
/// # Errors
/// The graph has no such node, or the node has no result or a fault.
pub fn stamp_square(
    open: &OpenGraph,
    kinds: Kinds,
    gpu: Arc<Gpu>,
    adapter: sabi_gpu::AdapterChoice,
    node: &str,
    side: u32,
) -> Result<StampSquare, EngineError> {
    let options = EvaluatorOptions {
        model: ModelOptions::new(Path::new(NAME), side),
        overrides: Overrides::of_preview(&open.document),
        fit: Some(Fit::Unit),
        adapter,
        caster: CasterChoice::Auto,
        budget_bytes: DEFAULT_BUDGET_BYTES,
    };
    let (graph, target) = graph_and_target(open, &kinds, &options, node)?;
    refuse_faults(open, &graph, &kinds, std::slice::from_ref(&target))?;
    let linked = Arc::new(LinkedModel::link(square(), &options.model, &NoProgress)?);
    let sets = texture_sets(&linked.model, &linked.atlas, None)?;
    let mut evaluator = Evaluator::assemble(open, graph, kinds, linked.clone(), gpu, &options)?;
    let plan = evaluator.plan(&[target], Mode::Bake { fuse: true })?;
    let run = evaluator.run(&plan, Duration::from_millis(50), &NoProgress, None)?;
    let nothing = || {
        let why = format!("node '{node}' is muted and passes nothing on, so it has no result; unmute it");
        EngineError::new(crate::error::ErrorKind::BadInput, open.with_path(why))
    };
    let result = plan.results.first().ok_or_else(nothing)?;
    let texture_space = TextureSpace::new(&linked, sets[0].key);
    let planes = texture_space.planes(&evaluator, &plan, &run, result)?;
    Ok(StampSquare {
        png: picture(texture_space.layout.size, result.stored.ty, &planes[0])?,
        is_mask: result.stored.ty == PortType::Mask,
    })
}

/// Returns a square that faces +z and fills its texture.
fn square() -> Model {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mesh = Mesh {
        positions: corners.map(|[u, v]| [u, 1.0 - v, 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
        uvs: corners.to_vec(),
        uv_set: Some(0),
        triangles: vec![[0, 2, 1], [0, 3, 2]],
        triangle_material: vec![0, 0],
        triangle_part: vec![0, 0],
        ..Mesh::default()
    };
    Model {
        stem: NAME.to_owned(),
        materials: vec![ModelMaterial::default()],
        parts: vec![NAME.to_owned()],
        mesh,
        ..Model::default()
    }
}
