//! Looks of a model's materials: textures on the device, computed from a run's results.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use glam::DVec3;
use sabi_export::Channel;
use sabi_gpu::{
    DeviceMaps, Exported, MaterialSlots, ResultCache, ResultsIdentity, Run, RunOptions, ShownMaps, result_extents,
};
use sabi_graph::PortType;
use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;
use sabi_plan::{Mode, Plan, PlannedResult, SlotRef, Target};
use sabi_view::{MaterialLook, NodeLook, NodeType};

use crate::error::EngineError;
use crate::evaluating::evaluator::Evaluator;
use crate::evaluating::texture_sets::assign_shown_nodes;
use crate::opening::graph_faults::targets;
use crate::phases::Progress;

/// Looks of all materials of a model.
pub struct ModelLooks {
    /// Distinct looks.
    pub looks: Vec<MaterialLook>,
    /// Index into `looks` for each material of the model.
    pub look_of_material: Vec<usize>,
    /// True if the looks are materials, which are lit; false for a node's numbers or colors.
    pub is_lit: bool,
    /// Lowest and highest height, in working units.
    pub height_range: [f32; 2],
    /// Identity, which distinguishes them from earlier looks of the model; `None` if it is not known.
    pub identity: Option<LooksIdentity>,
}

/// Identity of the looks of a model, which distinguishes them from earlier ones.
#[derive(Clone, Debug, PartialEq)]
pub struct LooksIdentity {
    /// Hash of all that they show.
    pub key: [u8; 32],
    /// Hash of earlier looks, and corners of boxes in model space outside of which these looks are the same.
    pub since: Option<([u8; 32], Vec<[DVec3; 2]>)>,
}

/// Assignment of results to the materials that show them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum LookAssignment {
    /// All materials show the only result.
    One,
    /// Each material shows the result of the node that serves it, by material index.
    Served(BTreeMap<u32, usize>),
}

/// Longest time of one GPU submission.
const SUBMISSION: Duration = Duration::from_millis(200);

/// Evaluates the looks of a model: of one node, or otherwise of the outputs, with the model's own materials where no output serves them.
pub fn evaluate_looks(
    evaluator: &mut Evaluator,
    subject: Option<&Target>,
    progress: &dyn Progress,
) -> Result<ModelLooks, EngineError> {
    let (wanted, assignment) = match subject {
        Some(target) => (vec![target.clone()], LookAssignment::One),
        None => {
            let (node_of_material, unused) = assign_shown_nodes(evaluator.graph(), evaluator.linked());
            evaluator.warn(unused);
            if node_of_material
                .values()
                .any(|&node| node == evaluator.graph().nodes.len())
            {
                evaluator.append_model_source();
            }
            let nodes: BTreeSet<usize> = node_of_material.values().copied().collect();
            (targets(nodes), LookAssignment::Served(node_of_material))
        }
    };
    evaluator.evaluate_shown_alone();
    let plan = evaluator.plan(&wanted, Mode::Bake { fuse: true })?;
    let mut run = evaluator.run_once(&plan, SUBMISSION, progress)?;
    let is_canceled = || progress.is_canceled();
    let options = evaluator.run_options(SUBMISSION, &is_canceled);
    looks_of_run(evaluator, &plan, &mut run, &assignment, &options, None)
}

/// Creates the looks of all materials from the results of a run. With a cache, only changed looks are created again.
pub(crate) fn looks_of_run(
    evaluator: &Evaluator,
    plan: &Plan,
    run: &mut Run,
    assignment: &LookAssignment,
    options: &RunOptions<'_>,
    mut cache: Option<&mut ResultCache>,
) -> Result<ModelLooks, EngineError> {
    let (are_opaque, height_range) = value_extents(evaluator, plan, run, options, cache.as_deref_mut())?;
    let exported = Exported {
        // Results that are not kept are used only for drawing, so they may be changed. Two results may share a plane, so
        // this is done only for a single result.
        changes_results: cache.is_none() && plan.results.len() == 1,
        ..evaluator.exported()?
    };
    // Materials without triangles have the neutral look.
    let mut looks = vec![neutral_look()];
    for (result, is_opaque) in plan.results.iter().zip(are_opaque) {
        looks.push(MaterialLook {
            is_opaque,
            ..look(evaluator, run, result, exported, options, cache.as_deref_mut())?
        });
    }
    let of_material = |material: u32| match assignment {
        LookAssignment::One => Some(looks.len() - 1),
        LookAssignment::Served(node_of_material) => {
            let node = node_of_material.get(&material)?;
            Some(1 + plan.results.iter().position(|result| result.target.node == *node)?)
        }
    };
    let materials = 0..evaluator.linked().model.materials.len() as u32;
    Ok(ModelLooks {
        // The neutral look is the first.
        look_of_material: materials.map(|material| of_material(material).unwrap_or(0)).collect(),
        is_lit: looks.iter().all(|look| look.node.is_none()),
        height_range,
        identity: identity(evaluator, plan, run, assignment, &looks)?,
        looks,
    })
}

/// Identity of looks.
fn identity(
    evaluator: &Evaluator,
    plan: &Plan,
    run: &Run,
    assignment: &LookAssignment,
    looks: &[MaterialLook],
) -> Result<Option<LooksIdentity>, EngineError> {
    let slots: Vec<SlotRef> = plan
        .results
        .iter()
        .flat_map(|result| result.slots.iter().copied())
        .collect();
    let Some(ResultsIdentity { key, before }) = run.identity(evaluator.surface(), &slots) else {
        return Ok(None);
    };
    let are_opaque: Vec<bool> = looks.iter().map(|look| look.is_opaque).collect();
    let of = |key: [u8; 32]| {
        let text = format!("{assignment:?} {are_opaque:?}");
        *blake3::Hasher::new()
            .update(&key)
            .update(text.as_bytes())
            .finalize()
            .as_bytes()
    };
    let shares = evaluator.shares()?;
    let since = before.map(|(before, tiles)| {
        let shown = shares.map_or_else(|| tiles.clone(), |shares| shares.spread(&tiles));
        (of(before), evaluator.bounds_of(&shown))
    });
    Ok(Some(LooksIdentity { key: of(key), since }))
}

/// Returns which results are opaque everywhere, and the lowest and highest height of all results, in working units; 0 without heights.
fn value_extents(
    evaluator: &Evaluator,
    plan: &Plan,
    run: &Run,
    options: &RunOptions<'_>,
    cache: Option<&mut ResultCache>,
) -> Result<(Vec<bool>, [f32; 2]), EngineError> {
    const ALPHA: u32 = 3;
    let mut asked = Vec::new();
    for (at, result) in plan.results.iter().enumerate() {
        for (channel, component) in [(Stored::Color, ALPHA), (Stored::Height, 0)] {
            if let Some(slot) = slot_of(result, Plane::Material(channel)) {
                asked.push((at, slot, component));
            }
        }
    }
    let components: Vec<(SlotRef, u32)> = asked.iter().map(|(_, slot, component)| (*slot, *component)).collect();
    let gpu = evaluator.gpu();
    let extents = result_extents(gpu, evaluator.surface(), run, &components, options, cache)?;
    let mut are_opaque = vec![true; plan.results.len()];
    let mut heights = [f32::INFINITY, f32::NEG_INFINITY];
    for ((at, _, component), extent) in asked.iter().zip(extents) {
        if *component == ALPHA {
            are_opaque[*at] = extent.not_numbers == 0 && extent.range.is_none_or(|[low, _]| low >= 1.0);
        } else if let Some([low, high]) = extent.range {
            heights = [heights[0].min(low), heights[1].max(high)];
        }
    }
    Ok((are_opaque, if heights[0] <= heights[1] { heights } else { [0.0; 2] }))
}

/// Creates the look of one result that counts as opaque: a material with its maps, any other type as numbers or colors. Where charts
/// overlap and at the borders of charts, it shows the values that a bake writes there; see [`Evaluator::exported`].
fn look(
    evaluator: &Evaluator,
    run: &mut Run,
    result: &PlannedResult,
    exported: Exported<'_>,
    options: &RunOptions<'_>,
    mut cache: Option<&mut ResultCache>,
) -> Result<MaterialLook, EngineError> {
    let shown = ShownMaps {
        gpu: evaluator.gpu(),
        surface: evaluator.surface(),
        exported,
    };
    let value_type = match result.stored.ty {
        PortType::Mask => NodeType::Mask,
        PortType::Color => NodeType::Color,
        PortType::Vector => NodeType::Vector,
        PortType::Material => {
            let maps = shown.material(run, material_slots(result), options, cache.as_deref_mut())?;
            return Ok(MaterialLook { maps, ..neutral_look() });
        }
    };
    let (slot, plane) = (result.slots[0], result.stored.planes()[0]);
    let texture = shown.plane(run, slot, plane, cache)?;
    Ok(MaterialLook {
        node: Some(NodeLook { texture, value_type }),
        ..neutral_look()
    })
}

/// Returns the slots of a material's planes.
fn material_slots(result: &PlannedResult) -> MaterialSlots {
    let slot = |channel| slot_of(result, Plane::Material(channel));
    MaterialSlots {
        color: slot(Stored::Color),
        surface: slot(Stored::Surface),
        height: slot(Stored::Height),
        slope: slot(Stored::Slope),
        emission: slot(Stored::Emission),
        coat: slot(Stored::Coat),
        anisotropy: slot(Stored::Anisotropy),
        sheen: slot(Stored::Sheen),
        subsurface: slot(Stored::Subsurface),
    }
}

/// Returns the slot of a plane of a result.
pub(crate) fn slot_of(result: &PlannedResult, plane: Plane) -> Option<SlotRef> {
    let at = result.stored.planes().iter().position(|stored| *stored == plane)?;
    result.slots.get(at).copied()
}

/// Returns the look of the neutral material, as it would be exported.
fn neutral_look() -> MaterialLook {
    let [color, opacity] = [Channel::BaseColor, Channel::Opacity].map(|channel| channel.neutral());
    let surface = [Channel::Roughness, Channel::Metallic, Channel::Occlusion].map(|channel| channel.neutral()[0]);
    MaterialLook {
        maps: DeviceMaps::default(),
        color: [color[0], color[1], color[2], opacity[0]],
        surface,
        is_opaque: true,
        node: None,
    }
}
