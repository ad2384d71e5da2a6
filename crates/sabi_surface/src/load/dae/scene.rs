//! Nodes of the scene, and the meshes that they show.

use std::collections::HashMap;

use glam::{DMat4, DQuat, DVec3};
use roxmltree::{Node, NodeId};

use super::document::{DaeDocument, child, children, numbers};
use super::skin::{DaeSkins, Joints};
use crate::load::error::{ModelFault, damaged};
use crate::load::parts::NodeGroups;
use crate::load::text::part_name;
use crate::load::warnings::Warnings;

/// Maximum number of nodes that are visited: a node may be used many times, together with all nodes below it.
const MOST_NODES: usize = 1 << 20;
/// Maximum number of elements of all visited nodes.
const MOST_ELEMENTS: usize = 1 << 26;

/// A mesh that a node instantiates.
pub(super) struct DaeMeshInstance<'d> {
    /// The `geometry`.
    pub(super) mesh: Node<'d, 'd>,
    /// The `instance_geometry` or `instance_controller`.
    pub(super) instance: Node<'d, 'd>,
    pub(super) name: String,
    /// The node above the one that shows it.
    pub(super) group: Option<usize>,
    pub(super) scene_from_mesh: DMat4,
}

/// A node of the scene, as often as it is used.
#[derive(Clone, Copy)]
struct DaeNodeVisit<'d> {
    node: Node<'d, 'd>,
    /// The node above it.
    group: Option<usize>,
    /// Of the node above it before the visit, of itself behind it.
    placed: DMat4,
}

/// The meshes of the scene in the order of its nodes, and the nodes above them.
pub(super) fn shown<'d>(
    document: &DaeDocument<'d>,
    groups: &mut NodeGroups,
    warnings: &mut Warnings,
) -> Result<Vec<DaeMeshInstance<'d>>, ModelFault> {
    let mut joints = Joints::default();
    let mut visited: Vec<DaeNodeVisit> = Vec::new();
    // An explicit stack is used, since a chain of nodes may be as long as the file.
    let mut stack: Vec<DaeNodeVisit> = Vec::new();
    if let Some(scene) = scene(document) {
        push_nodes(children(scene, "node"), None, DMat4::IDENTITY, &mut stack);
    }
    let mut transforms: HashMap<NodeId, DMat4> = HashMap::new();
    let mut elements = 0;
    while let Some(DaeNodeVisit { node, group, placed }) = stack.pop() {
        elements += elements_of(node);
        if visited.len() + stack.len() >= MOST_NODES {
            return damaged(format!(
                "its nodes use each other until there are more than {MOST_NODES} of them"
            ));
        }
        if elements > MOST_ELEMENTS {
            return damaged(format!(
                "its nodes use each other until they have more than {MOST_ELEMENTS} elements"
            ));
        }
        let own = transforms.entry(node.id());
        let placed = placed * *own.or_insert_with(|| parent_from_node(node, warnings));
        for name in ["id", "sid", "name"]
            .into_iter()
            .filter_map(|name| node.attribute(name))
        {
            joints.add(name, placed);
        }
        visited.push(DaeNodeVisit { node, group, placed });
        let below = node.children().filter_map(|below| match below.tag_name().name() {
            "node" => Some(below),
            "instance_node" => document.referenced(below, "url"),
            _ => None,
        });
        let below: Vec<Node> = below.collect();
        if !below.is_empty() {
            let names = [node.attribute("name"), node.attribute("id")];
            let name = names.into_iter().flatten().find(|name| !name.is_empty());
            let is_part = ["instance_geometry", "instance_controller"]
                .into_iter()
                .any(|name| child(node, name).is_some());
            // Both names are optional.
            let group = groups.add(name.unwrap_or_default(), group, is_part);
            push_nodes(below.into_iter(), Some(group), placed, &mut stack);
        }
    }
    let mut all = Vec::new();
    let mut skins = DaeSkins::default();
    for visit in visited {
        for geometry in children(visit.node, "instance_geometry") {
            let mesh = document.referenced(geometry, "url");
            all.extend(mesh.and_then(|mesh| shown_mesh(visit, geometry, mesh)));
        }
        for controller in children(visit.node, "instance_controller") {
            all.extend(controlled(document, visit, controller, &joints, &mut skins, warnings));
        }
    }
    Ok(all)
}

/// Returns the number of elements that are examined when a node is visited: those directly inside it, and those of its meshes.
fn elements_of(node: Node<'_, '_>) -> usize {
    let instances = ["instance_geometry", "instance_controller"].into_iter();
    let below: usize = instances
        .flat_map(|name| children(node, name))
        .map(|instance| instance.descendants().count())
        .sum();
    1 + below + node.children().count()
}

/// Returns the scene that the file selects, otherwise its first scene.
fn scene<'d>(document: &DaeDocument<'d>) -> Option<Node<'d, 'd>> {
    let instance = document
        .first("scene")
        .and_then(|scene| child(scene, "instance_visual_scene"));
    let chosen = instance.and_then(|instance| document.referenced(instance, "url"));
    chosen.or_else(|| child(document.first("library_visual_scenes")?, "visual_scene"))
}

fn push_nodes<'d>(
    nodes: impl Iterator<Item = Node<'d, 'd>>,
    group: Option<usize>,
    placed: DMat4,
    stack: &mut Vec<DaeNodeVisit<'d>>,
) {
    let first = stack.len();
    stack.extend(nodes.map(|node| DaeNodeVisit { node, group, placed }));
    // Reversed, so that the stack returns them in order.
    stack[first..].reverse();
}

/// A mesh that an `instance` of the visited node shows.
fn shown_mesh<'d>(visit: DaeNodeVisit<'d>, instance: Node<'d, 'd>, mesh: Node<'d, 'd>) -> Option<DaeMeshInstance<'d>> {
    let names = [
        visit.node.attribute("name"),
        visit.node.attribute("id"),
        mesh.attribute("name"),
        mesh.attribute("id"),
    ];
    let name = names.into_iter().flatten().find(|name| !name.is_empty());
    (mesh.tag_name().name() == "geometry").then(|| DaeMeshInstance {
        mesh,
        instance,
        name: part_name(name.unwrap_or("mesh")),
        group: visit.group,
        scene_from_mesh: visit.placed,
    })
}

/// Returns a mesh with a skin or morph targets. These are ignored.
fn controlled<'d>(
    document: &DaeDocument<'d>,
    visit: DaeNodeVisit<'d>,
    instance: Node<'d, 'd>,
    joints: &Joints<'d>,
    skins: &mut DaeSkins,
    warnings: &mut Warnings,
) -> Option<DaeMeshInstance<'d>> {
    let mut source = document.referenced(instance, "url")?;
    let node = visit.node;
    let mut placed = visit.placed;
    // A skin may contain morph targets, and these a mesh.
    for _ in 0..2 {
        if let Some(morph) = child(source, "morph") {
            let name = node.attribute("name").or(source.attribute("id")).unwrap_or("mesh");
            warnings.add(format!(
                "Morph targets of mesh `{}` are left out: it is taken at rest.",
                part_name(name)
            ));
            source = document.referenced(morph, "source")?;
        } else if let Some(skin) = child(source, "skin") {
            let name = node.attribute("name").or(source.attribute("id")).unwrap_or("mesh");
            let (rest, bound) = skins.scene_from_bound(document, skin, visit.placed, joints, warnings);
            placed = rest.file_from_bound(bound, &part_name(name), warnings);
            source = document.referenced(skin, "source")?;
        }
    }
    shown_mesh(DaeNodeVisit { placed, ..visit }, instance, source)
}

/// Returns the transform of a node. Its transforms apply in order, the last one first to the mesh (COLLADA 1.4, 5.3.2).
fn parent_from_node(node: Node<'_, '_>, warnings: &mut Warnings) -> DMat4 {
    let mut placed = DMat4::IDENTITY;
    for step in node.children() {
        let kind = step.tag_name().name();
        match kind {
            "matrix" | "translate" | "rotate" | "scale" => {}
            "lookat" | "skew" => {
                warnings.add("Transforms by `lookat` and `skew` are left out.");
                continue;
            }
            _ => continue,
        }
        match transform(kind, &numbers(step, warnings)) {
            Some(transform) => placed *= transform,
            None => warnings.add(format!(
                "A `{kind}` of node `{}` has not the numbers that it needs and is left out.",
                part_name(
                    node.attribute("name")
                        .or(node.attribute("id"))
                        .unwrap_or("without a name")
                )
            )),
        }
    }
    placed
}

/// Returns the transform of a kind with these numbers; `None` if they are invalid for it.
fn transform(kind: &str, values: &[f64]) -> Option<DMat4> {
    if !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    match (kind, values) {
        ("matrix", values) => {
            let values: [f64; 16] = values.try_into().ok()?;
            Some(DMat4::from_cols_array(&values).transpose())
        }
        ("translate", [x, y, z]) => Some(DMat4::from_translation(DVec3::new(*x, *y, *z))),
        ("scale", [x, y, z]) => Some(DMat4::from_scale(DVec3::new(*x, *y, *z))),
        // Without an axis there is no rotation.
        ("rotate", [x, y, z, degrees]) => {
            let axis = DVec3::new(*x, *y, *z).try_normalize();
            Some(axis.map_or(DMat4::IDENTITY, |axis| {
                DMat4::from_quat(DQuat::from_axis_angle(axis, degrees.to_radians()))
            }))
        }
        _ => None,
    }
}
