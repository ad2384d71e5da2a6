//! What each material of a model looks like, still on the device.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use sabi_export::Channel;
use sabi_gpu::{DeviceMaps, MaterialSlots, Run, RunOptions};
use sabi_graph::{Fit, FlatNode, PortType};
use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;
use sabi_plan::{Mode, Plan, PlannedResult, SlotRef, Target};
use sabi_surface::atlas::{Atlas, GHOST_BIT};
use sabi_view::{MaterialLook, NodeLook, NodeType};

use crate::error::EngineError;
use crate::modelless::targets;
use crate::sets::shown_by;
use crate::source::SOURCE_MODEL;
use crate::stages::Progress;
use crate::workpiece::Workpiece;

/// A node that shows the model's own looks. No node of a file can have its id.
pub(crate) fn models_own(fit: Fit) -> FlatNode {
    FlatNode {
        id: "(model)".to_owned(),
        kind: SOURCE_MODEL.to_owned(),
        version: 1,
        params: BTreeMap::new(),
        inputs: BTreeMap::new(),
        muted: false,
        seeds: Vec::new(),
        length_scale: 1.0,
        fit,
        file: None,
    }
}

/// What is shown of a model.
pub struct Shown {
    /// What its materials look like.
    pub looks: Vec<MaterialLook>,
    /// For each material of the model which of the looks it has.
    pub look_of_material: Vec<usize>,
    /// Whether these are materials, which are lit, and no node's number or color.
    pub is_lit: bool,
    /// Lowest and highest height, working units.
    pub height_range: [f32; 2],
}

/// How long one submission may take.
const SUBMISSION: Duration = Duration::from_millis(200);

/// Evaluates what is shown: one node, or else the outputs, and the model's own looks where no output serves a material.
pub fn show(workpiece: &mut Workpiece, seen: Option<&Target>, progress: &dyn Progress) -> Result<Shown, EngineError> {
    let options = RunOptions {
        is_canceled: &|| progress.is_canceled(),
        ..RunOptions::new(SUBMISSION, workpiece.budget_bytes)
    };
    let mode = Mode::Bake { fuse: true };
    let limits = workpiece.gpu.limits();
    if let Some(target) = seen {
        let plan = workpiece.plan(std::slice::from_ref(target), mode, limits)?;
        let mut run = workpiece.run_once(&plan, SUBMISSION, progress)?;
        return look_of_node(workpiece, &plan, &mut run, &options);
    }
    let (serving, idle) = shown_by(&workpiece.graph, &workpiece.prepared.model, &workpiece.prepared.atlas);
    workpiece.warn(idle);
    if serving.values().any(|&node| node == workpiece.graph.nodes.len()) {
        workpiece.graph.nodes.push(models_own(workpiece.fit));
    }
    let nodes: BTreeSet<usize> = serving.values().copied().collect();
    let plan = workpiece.plan(&targets(nodes), mode, limits)?;
    let mut run = workpiece.run_once(&plan, SUBMISSION, progress)?;
    looks(workpiece, &plan, &mut run, &serving, &options)
}

/// What each material looks like by the node that serves it.
fn looks(
    workpiece: &Workpiece,
    plan: &Plan,
    run: &mut Run,
    serving: &BTreeMap<u32, usize>,
    options: &RunOptions<'_>,
) -> Result<Shown, EngineError> {
    // Materials that cover no triangle look plain.
    let mut looks = vec![plain()];
    for result in &plan.results {
        looks.push(look(workpiece, plan, run, result, options)?);
    }
    let of_material = |material: u32| {
        let node = serving.get(&material)?;
        Some(1 + plan.results.iter().position(|result| result.target.node == *node)?)
    };
    let materials = 0..workpiece.prepared.model.materials.len() as u32;
    Ok(Shown {
        looks,
        look_of_material: materials.map(|material| of_material(material).unwrap_or(0)).collect(),
        is_lit: true,
        height_range: height_range(workpiece, plan, run)?,
    })
}

/// What the whole model looks like by one node, which is all that the plan has.
fn look_of_node(
    workpiece: &Workpiece,
    plan: &Plan,
    run: &mut Run,
    options: &RunOptions<'_>,
) -> Result<Shown, EngineError> {
    let result = plan.results.first();
    let look = result
        .map(|result| look(workpiece, plan, run, result, options))
        .transpose()?;
    let look = look.unwrap_or_else(plain);
    Ok(Shown {
        is_lit: look.node.is_none(),
        looks: vec![look],
        look_of_material: vec![0; workpiece.prepared.model.materials.len()],
        height_range: height_range(workpiece, plan, run)?,
    })
}

/// Lowest and highest height of all results, working units; 0 where nothing sets it.
fn height_range(workpiece: &Workpiece, plan: &Plan, run: &Run) -> Result<[f32; 2], EngineError> {
    let mut range = [f32::INFINITY, f32::NEG_INFINITY];
    for result in &plan.results {
        let Some(slot) = slot_of(result, Plane::Material(Stored::Height)) else {
            continue;
        };
        let heights = workpiece.gpu.read(&workpiece.surface, plan, run, slot)?;
        for texel in owned_texels(&workpiece.prepared.atlas) {
            let [height, ..] = heights.texel(texel);
            range = [range[0].min(height), range[1].max(height)];
        }
    }
    Ok(if range[0] <= range[1] { range } else { [0.0; 2] })
}

/// What one result looks like: a material with its maps, anything else as the number or color it is. Where charts share a
/// place it is what a bake or a preview writes there; see [`Workpiece::shares`].
fn look(
    workpiece: &Workpiece,
    plan: &Plan,
    run: &mut Run,
    result: &PlannedResult,
    options: &RunOptions<'_>,
) -> Result<MaterialLook, EngineError> {
    let holds = match result.stored.ty {
        PortType::Mask => NodeType::Mask,
        PortType::Color => NodeType::Color,
        PortType::Vector => NodeType::Vector,
        PortType::Material => {
            let slots = material_slots(result);
            let is_opaque = match slots.color {
                Some(slot) => is_opaque(workpiece, plan, run, slot)?,
                None => true,
            };
            let shares = workpiece.shares()?;
            let maps = workpiece
                .gpu
                .device_maps(&workpiece.surface, run, slots, shares, options)?;
            return Ok(MaterialLook {
                maps,
                is_opaque,
                ..plain()
            });
        }
    };
    let Workpiece { gpu, surface, .. } = workpiece;
    let texture = gpu.shown_texture(surface, run, result.slots[0], workpiece.shares()?)?;
    Ok(MaterialLook {
        node: Some(NodeLook { texture, holds }),
        ..plain()
    })
}

/// Whether all of a color plane's alpha is 1.
fn is_opaque(workpiece: &Workpiece, plan: &Plan, run: &Run, slot: SlotRef) -> Result<bool, EngineError> {
    let colors = workpiece.gpu.read(&workpiece.surface, plan, run, slot)?;
    Ok(owned_texels(&workpiece.prepared.atlas).all(|texel| colors.texel(texel)[3] >= 1.0))
}

/// Texels of an atlas that lie on the model.
fn owned_texels(atlas: &Atlas) -> impl Iterator<Item = usize> {
    let owners = atlas.owners.iter().enumerate();
    owners
        .filter(|(_, owner)| **owner & GHOST_BIT == 0)
        .map(|(texel, _)| texel)
}

/// Where the planes of a material are.
fn material_slots(result: &PlannedResult) -> MaterialSlots {
    let slot = |channel| slot_of(result, Plane::Material(channel));
    MaterialSlots {
        color: slot(Stored::Color),
        surface: slot(Stored::Surface),
        height: slot(Stored::Height),
        slope: slot(Stored::Slope),
        emission: slot(Stored::Emission),
    }
}

/// The slot of a plane of a result.
pub(crate) fn slot_of(result: &PlannedResult, plane: Plane) -> Option<SlotRef> {
    let at = result.stored.planes().iter().position(|stored| *stored == plane)?;
    result.slots.get(at).copied()
}

/// What a material is where nothing sets it, as it would be exported.
fn plain() -> MaterialLook {
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
