//! Scenes and nodes: which meshes stand where.

use glam::{DMat4, DQuat, DVec3, Vec3};
use gltf::json;

use super::document::Document;
use crate::load::error::{Fault, damaged};
use crate::load::warnings::Warnings;

/// A mesh that a node places.
pub(super) struct Instance {
    pub(super) mesh: usize,
    pub(super) name: String,
    pub(super) file_from_mesh: DMat4,
}

/// The meshes of the file's scene, in the order of its nodes.
pub(super) fn instances(document: &Document, warnings: &mut Warnings) -> Result<Vec<Instance>, Fault> {
    let roots = roots(document)?;
    let mut instances = Vec::new();
    let mut seen = vec![false; document.nodes.len()];
    // A stack of our own: a chain of nodes may be as long as the file.
    let mut stack: Vec<(u64, DMat4)> = roots.into_iter().rev().map(|node| (node, DMat4::IDENTITY)).collect();
    while let Some((index, file_from_parent)) = stack.pop() {
        let Some(node) = usize::try_from(index).ok().and_then(|index| document.nodes.get(index)) else {
            return damaged(format!("its scene names nodes[{index}], which is not there"));
        };
        if std::mem::replace(&mut seen[index as usize], true) {
            return damaged(format!("nodes[{index}] is below itself or below two nodes"));
        }
        let file_from_node = file_from_parent * parent_from_node(node);
        if let Some(mesh) = node.mesh.map(|mesh| mesh.value()) {
            instances.push(instance(document, node, index, mesh, file_from_node, warnings)?);
        }
        let children = node.children.as_deref().unwrap_or_default();
        stack.extend(
            children
                .iter()
                .rev()
                .map(|child| (child.value() as u64, file_from_node)),
        );
    }
    if instances.is_empty() && !document.meshes.is_empty() {
        warnings.add("The file's scene shows no mesh; all meshes are taken as they are stored.");
        for mesh in 0..document.meshes.len() {
            let name = name(document, None, mesh);
            instances.push(Instance {
                mesh,
                name,
                file_from_mesh: DMat4::IDENTITY,
            });
        }
    }
    Ok(instances)
}

fn instance(
    document: &Document,
    node: &json::Node,
    index: u64,
    mesh: usize,
    file_from_node: DMat4,
    warnings: &mut Warnings,
) -> Result<Instance, Fault> {
    if mesh >= document.meshes.len() {
        return damaged(format!("nodes[{index}] shows meshes[{mesh}], which is not there"));
    }
    let name = name(document, node.name.as_deref(), mesh);
    let mut file_from_mesh = file_from_node;
    if node.skin.is_some() {
        warnings.add(format!("The skin of `{name}` is left out: it is taken at rest."));
        // glTF 2.0, 3.7.3.3: joints place a skinned mesh, its node does not.
        file_from_mesh = DMat4::IDENTITY;
    }
    Ok(Instance {
        mesh,
        name,
        file_from_mesh,
    })
}

/// Root nodes of the default scene, else of the first one, else all nodes that are nobody's child.
fn roots(document: &Document) -> Result<Vec<u64>, Fault> {
    let index = document.default_scene.unwrap_or(0);
    match usize::try_from(index).ok().and_then(|index| document.scenes.get(index)) {
        Some(nodes) => Ok(nodes.clone()),
        None if document.default_scene.is_some() => {
            damaged(format!("its scene is scenes[{index}], which is not there"))
        }
        None => {
            let mut is_child = vec![false; document.nodes.len()];
            for child in document
                .nodes
                .iter()
                .filter_map(|node| node.children.as_deref())
                .flatten()
            {
                if let Some(is_child) = is_child.get_mut(child.value()) {
                    *is_child = true;
                }
            }
            Ok((0..is_child.len())
                .filter(|node| !is_child[*node])
                .map(|node| node as u64)
                .collect())
        }
    }
}

/// The node's name, else the mesh's, else its number.
fn name(document: &Document, node: Option<&str>, mesh: usize) -> String {
    let of_mesh = document.meshes.get(mesh).and_then(|mesh| mesh.name.as_deref());
    let named = [node, of_mesh].into_iter().flatten().find(|name| !name.is_empty());
    named.map_or_else(|| format!("mesh {mesh}"), str::to_string)
}

fn parent_from_node(node: &json::Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    let scale = node.scale.map_or(DVec3::ONE, |scale| Vec3::from(scale).as_dvec3());
    let translation = node
        .translation
        .map_or(DVec3::ZERO, |translation| Vec3::from(translation).as_dvec3());
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |rotation| {
        let quaternion = DQuat::from_array(rotation.0.map(f64::from));
        let length = quaternion.length();
        // Four zeros turn nothing.
        if length.is_finite() && length > 0.0 {
            quaternion / length
        } else {
            DQuat::IDENTITY
        }
    });
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
