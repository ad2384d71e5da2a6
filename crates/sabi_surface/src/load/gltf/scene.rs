//! Scenes and nodes, which place meshes.

use glam::{DMat4, DQuat, DVec3};
use sabi_cancel::look;
use serde_json::Value;

use super::document::{GltfDocument, GltfNode};
use super::skin::GltfSkins;
use super::source::GltfSource;
use crate::load::error::{ModelFault, damaged};
use crate::load::name_lists::joined;
use crate::load::parts::NodeGroups;
use crate::load::text::part_name;
use crate::load::warnings::Warnings;

/// Maximum deviation of a quaternion from unit length that counts as rounding: exporters write as few as three digits.
const ROUNDED: f64 = 2e-3;

/// A mesh that a node places.
pub(super) struct GltfInstance {
    /// Node that places the mesh; `None` if the scene contains no mesh.
    pub(super) node: Option<usize>,
    pub(super) mesh: usize,
    pub(super) name: String,
    /// The node above it.
    pub(super) group: Option<usize>,
    pub(super) file_from_mesh: DMat4,
}

/// The meshes of a scene.
pub(super) struct SceneMeshes {
    /// In the order of their nodes.
    pub(super) instances: Vec<GltfInstance>,
    /// Nodes above them.
    pub(super) groups: NodeGroups,
}

/// A node that shows a mesh.
struct GltfMeshNode {
    node: usize,
    mesh: usize,
    group: Option<usize>,
    placed: DMat4,
}

/// A node to be visited.
struct NodeVisit {
    node: u64,
    /// The node above it.
    group: Option<usize>,
    file_from_parent: DMat4,
    is_hidden: bool,
}

/// Reads the meshes of the file's scene.
pub(super) fn read(source: &GltfSource, warnings: &mut Warnings) -> Result<SceneMeshes, ModelFault> {
    let document = source.document;
    let mut shown = Vec::new();
    let mut groups = NodeGroups::default();
    let mut file_from_node: Vec<Option<DMat4>> = vec![None; document.nodes.len()];
    // An explicit stack is used, since a chain of nodes may be as long as the file.
    let mut stack: Vec<NodeVisit> = below(&roots(source, warnings)?, None, DMat4::IDENTITY, false).collect();
    while let Some(step) = stack.pop() {
        look();
        let Some((index, node)) = usize::try_from(step.node)
            .ok()
            .and_then(|index| Some((index, document.nodes.get(index)?)))
        else {
            return damaged(format!("its scene names nodes[{}], which is not there", step.node));
        };
        let placed = step.file_from_parent * parent_from_node(node, &document.node_label(index), warnings);
        if file_from_node[index].replace(placed).is_some() {
            return damaged(format!("nodes[{index}] is below itself or below two nodes"));
        }
        let is_hidden = step.is_hidden || is_hidden(node);
        if let Some(mesh) = node.mesh {
            if mesh >= document.meshes.len() {
                return damaged(format!("nodes[{index}] shows meshes[{mesh}], which is not there"));
            }
            if is_hidden {
                warnings.add("Nodes that the file hides (KHR_node_visibility) are left out.");
            } else {
                shown.push(GltfMeshNode {
                    node: index,
                    mesh,
                    group: step.group,
                    placed,
                });
            }
        }
        if !node.children.is_empty() {
            let name = node.name.as_deref().unwrap_or_default(); // A name is optional in glTF.
            let group = groups.add(name, step.group, node.mesh.is_some());
            stack.extend(below(&node.children, Some(group), placed, is_hidden));
        }
    }
    if shown.is_empty() && !document.meshes.is_empty() {
        warnings.add("The file's scene shows no mesh; all meshes are taken as they are stored.");
        let instances = (0..document.meshes.len()).map(|mesh| GltfInstance {
            node: None,
            mesh,
            name: name(document, None, mesh),
            group: None,
            file_from_mesh: DMat4::IDENTITY,
        });
        return Ok(SceneMeshes {
            instances: instances.collect(),
            groups,
        });
    }
    let mut skins = GltfSkins::new(source, &file_from_node);
    let instances = shown
        .into_iter()
        .map(|shown| instance(document, shown, &mut skins, warnings))
        .collect();
    Ok(SceneMeshes { instances, groups })
}

/// Returns the steps in reverse, so that a stack returns them in order.
fn below(
    nodes: &[u64],
    group: Option<usize>,
    file_from_parent: DMat4,
    is_hidden: bool,
) -> impl Iterator<Item = NodeVisit> {
    nodes.iter().rev().map(move |node| NodeVisit {
        node: *node,
        group,
        file_from_parent,
        is_hidden,
    })
}

fn is_hidden(node: &GltfNode) -> bool {
    let extension = node.extensions.get("KHR_node_visibility");
    let visible = extension.and_then(|extension| extension.get("visible"));
    visible.and_then(Value::as_bool) == Some(false)
}

fn instance(
    document: &GltfDocument,
    shown: GltfMeshNode,
    skins: &mut GltfSkins,
    warnings: &mut Warnings,
) -> GltfInstance {
    let node = &document.nodes[shown.node];
    let name = name(document, node.name.as_deref(), shown.mesh);
    let file_from_mesh = match node.skin {
        Some(skin) => skins.file_from_bound(skin, &name, warnings),
        None => shown.placed,
    };
    GltfInstance {
        node: Some(shown.node),
        mesh: shown.mesh,
        name,
        group: shown.group,
        file_from_mesh,
    }
}

/// Returns the root nodes of the chosen scene, otherwise of the default scene, otherwise of the first scene, otherwise all
/// nodes without a parent.
fn roots(source: &GltfSource, warnings: &mut Warnings) -> Result<Vec<u64>, ModelFault> {
    let GltfSource { document, scene, .. } = *source;
    if let Some(asked) = scene {
        let chosen = usize::try_from(asked).ok().and_then(|index| document.scenes.get(index));
        return chosen
            .map(|scene| scene.nodes.clone())
            .ok_or_else(|| ModelFault::Scene {
                asked,
                there: match document.scenes.len() {
                    0 => "the file has no scenes".to_owned(),
                    count => format!("it has {}", scene_labels(document, 0..count)),
                },
            });
    }
    // If the file names no scene, glTF viewers show the first one.
    let index = document.default_scene.unwrap_or(0);
    let shown = usize::try_from(index).ok();
    match shown.and_then(|index| Some((index, document.scenes.get(index)?))) {
        Some((shown, scene)) => {
            let count = document.scenes.len();
            if count > 1 {
                let others = scene_labels(document, (0..count).filter(|other| *other != shown));
                warnings.add(format!(
                    "The file has {count} scenes, and scene {} is taken; {} {others}.",
                    document.scene_label(shown),
                    if count == 2 { "the other is" } else { "the others are" }
                ));
            }
            Ok(scene.nodes.clone())
        }
        None if document.default_scene.is_some() => {
            damaged(format!("its scene is scenes[{index}], which is not there"))
        }
        None => Ok(parentless(document)),
    }
}

/// Maximum number of scenes that a message lists.
const MOST_SCENES_NAMED: usize = 8;

/// Labels of scenes, as a list.
fn scene_labels(document: &GltfDocument, scenes: impl Iterator<Item = usize>) -> String {
    joined(
        scenes.map(|scene| document.scene_label(scene)).collect(),
        MOST_SCENES_NAMED,
    )
}

/// Nodes that are no children.
fn parentless(document: &GltfDocument) -> Vec<u64> {
    let mut is_child = vec![false; document.nodes.len()];
    for child in document.nodes.iter().flat_map(|node| &node.children) {
        let place = usize::try_from(*child).ok();
        if let Some(is_child) = place.and_then(|child| is_child.get_mut(child)) {
            *is_child = true;
        }
    }
    let roots = (0..is_child.len()).filter(|node| !is_child[*node]);
    roots.map(|node| node as u64).collect()
}

/// Returns the name of the node, otherwise of the mesh, otherwise its number.
fn name(document: &GltfDocument, node: Option<&str>, mesh: usize) -> String {
    let of_mesh = document.meshes.get(mesh).and_then(|mesh| mesh.name.as_deref());
    let named = [node, of_mesh].into_iter().flatten().find(|name| !name.is_empty());
    named.map_or_else(|| format!("mesh {mesh}"), part_name)
}

fn parent_from_node(node: &GltfNode, label: &str, warnings: &mut Warnings) -> DMat4 {
    if let Some(matrix) = node.matrix {
        if node.translation.is_some() || node.rotation.is_some() || node.scale.is_some() {
            warnings.add(format!(
                "The {label} has both a matrix and a translation, rotation or scale; the matrix is taken."
            ));
        }
        return DMat4::from_cols_array(&matrix);
    }
    let scale = node.scale.map_or(DVec3::ONE, DVec3::from);
    let translation = node.translation.map_or(DVec3::ZERO, DVec3::from);
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |rotation| {
        let quaternion = DQuat::from_array(rotation);
        let length = quaternion.length();
        if (length - 1.0).abs() > ROUNDED || !length.is_finite() {
            warnings.add(format!(
                "The rotation of the {label} is not of unit length; it is taken as if it were."
            ));
        }
        // A quaternion of zeros is not a rotation.
        if length.is_finite() && length > 0.0 {
            quaternion / length
        } else {
            DQuat::IDENTITY
        }
    });
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
