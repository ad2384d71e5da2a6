//! Nodes that have a mesh.

use glam::{DMat4, DVec3};
use ufbx::{ElementType, Matrix, Mesh, Node};

use super::FbxSourceMesh;
use crate::load::assembly::MeshInstance;
use crate::load::parts::NodeGroups;
use crate::load::skin_rest::{JointBudget, JointPlacement, RestPose};
use crate::load::text::part_name;
use crate::load::warnings::Warnings;

/// A node with its mesh.
pub(super) struct FbxMeshNode<'s> {
    pub(super) node: &'s Node,
    pub(super) mesh: &'s Mesh,
    /// The node above it.
    pub(super) group: Option<usize>,
}

/// The meshes of the scene in the order of its nodes, and the nodes above them.
pub(super) fn shown<'s>(
    scene: &'s ufbx::Scene,
    groups: &mut NodeGroups,
    warnings: &mut Warnings,
) -> Vec<FbxMeshNode<'s>> {
    let mut shown = Vec::new();
    // An explicit stack is used, since a chain of nodes may be as long as the file.
    let mut stack: Vec<(&Node, Option<usize>)> = vec![(&scene.root_node, None)];
    while let Some((node, above)) = stack.pop() {
        if !node.visible && !node.is_root {
            if has_mesh(node) {
                warnings.add("Nodes that the file hides are left out.");
            }
            continue;
        }
        if let Some(mesh) = node.mesh.as_deref() {
            shown.push(FbxMeshNode {
                node,
                mesh,
                group: above,
            });
        }
        let levels = if node.attrib_type == ElementType::LodGroup {
            1
        } else {
            usize::MAX
        };
        if node.children.len() > levels {
            warnings.add("Of several levels of detail only the first is taken.");
        }
        let children: Vec<&Node> = node.children.into_iter().take(levels).collect();
        let group =
            (!node.is_root && !children.is_empty()).then(|| groups.add(&node.element.name, above, node.mesh.is_some()));
        // In reverse, so that the stack returns them in order.
        stack.extend(children.into_iter().rev().map(|child| (child, group)));
    }
    shown
}

/// Returns true if a node or one below it shows a mesh.
fn has_mesh(node: &Node) -> bool {
    let mut stack = vec![node];
    while let Some(node) = stack.pop() {
        if node.mesh.is_some() {
            return true;
        }
        stack.extend(&node.children);
    }
    false
}

impl FbxMeshNode<'_> {
    /// Name of the node, else of the mesh.
    pub(super) fn name(&self) -> String {
        let names = [&self.node.element.name, &self.mesh.element.name];
        let named = names.into_iter().find(|name| !name.is_empty());
        named.map_or_else(
            || format!("mesh {}", self.mesh.element.typed_id),
            |name| part_name(name),
        )
    }

    /// Returns the instance of the mesh at index `place` in the assembly.
    pub(super) fn instance(&self, place: usize, source: &FbxSourceMesh, warnings: &mut Warnings) -> MeshInstance {
        let name = self.name();
        let bound = matrix(&self.node.geometry_to_world);
        let file_from_mesh = source.rest.file_from_bound(bound, &name, warnings);
        if !self.mesh.blend_deformers.is_empty() {
            warnings.add(format!(
                "Morph targets of mesh `{name}` are left out: it is taken at rest."
            ));
        }
        MeshInstance {
            mesh: place,
            name,
            group: self.group,
            file_from_mesh,
            // A node may assign other materials than the mesh.
            materials: self
                .node
                .materials
                .into_iter()
                .map(|material| material.element.typed_id)
                .collect(),
        }
    }
}

/// The rest of the skins of a mesh.
pub(super) fn rest(mesh: &Mesh, joints: &mut JointBudget) -> RestPose {
    let skins = || mesh.skin_deformers.into_iter();
    let most: usize = skins().map(|skin| skin.clusters.len()).sum();
    if joints.take(most as u64).is_none() {
        return RestPose::TooLarge;
    }
    let clusters = skins()
        .flat_map(|skin| &skin.clusters)
        .filter(|cluster| cluster.num_weights > 0);
    let placements = clusters.map(|cluster| JointPlacement {
        file_from_mesh: matrix(&cluster.geometry_to_world),
        reach: cluster.bone_node.as_ref().map_or(0.0, |bone| {
            let at = bone.node_to_world;
            DVec3::new(at.m03, at.m13, at.m23).length()
        }),
    });
    RestPose::of(&placements.collect::<Vec<JointPlacement>>())
}

fn matrix(from: &Matrix) -> DMat4 {
    DMat4::from_cols_array(&[
        from.m00, from.m10, from.m20, 0.0, from.m01, from.m11, from.m21, 0.0, from.m02, from.m12, from.m22, 0.0,
        from.m03, from.m13, from.m23, 1.0,
    ])
}
