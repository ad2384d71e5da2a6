//! Skins: the transform of a mesh in the rest pose of its skeleton.

use std::collections::HashMap;

use glam::DMat4;
use roxmltree::Node;

use super::document::{Document, child, children, numbers, text};
use crate::load::skin_rest::{self, Placement};
use crate::load::warnings::Warnings;

/// Transforms of nodes by their ids, and by the names that skins use for joints; of several nodes the first counts.
#[derive(Default)]
pub(super) struct Joints<'d>(HashMap<&'d str, DMat4>);

impl<'d> Joints<'d> {
    /// Adds the transform of a node under one of its names.
    pub(super) fn add(&mut self, name: &'d str, scene_from_node: DMat4) {
        self.0.entry(name).or_insert(scene_from_node);
    }

    fn scene_from_joint(&self, name: &str) -> Option<DMat4> {
        self.0.get(name).copied()
    }
}

/// COLLADA 1.4, 4.7: a joint transforms a vertex by its own transform times its inverse bind matrix times the bind shape matrix.
/// At rest the transforms of all joints are equal.
pub(super) fn scene_from_bound<'d>(
    document: &Document<'d>,
    skin: Node<'d, 'd>,
    name: &str,
    scene_from_node: DMat4,
    joints: &Joints<'d>,
    warnings: &mut Warnings,
) -> DMat4 {
    let shape = child(skin, "bind_shape_matrix").map_or(DMat4::IDENTITY, |shape| matrix(&numbers(shape)));
    // A skin that does not say enough leaves its mesh where its node stands.
    let placements = placements(document, skin, shape, joints).unwrap_or_default();
    skin_rest::file_from_bound(&placements, scene_from_node * shape, name, warnings)
}

/// The placements by all joints that the scene has; `None` where the skin does not say enough.
fn placements<'d>(
    document: &Document<'d>,
    skin: Node<'d, 'd>,
    shape: DMat4,
    joints: &Joints<'d>,
) -> Option<Vec<Placement>> {
    let list = child(skin, "joints")?;
    let source = |semantic: &str| {
        let input = children(list, "input").find(|input| input.attribute("semantic") == Some(semantic))?;
        document.referenced(input, "source")
    };
    let names = source("JOINT")?;
    let names = child(names, "Name_array").or_else(|| child(names, "IDREF_array"))?;
    let binds = numbers(child(source("INV_BIND_MATRIX")?, "float_array")?);
    let bound = text(names).split_ascii_whitespace().zip(binds.as_chunks::<16>().0);
    let placements = bound.filter_map(|(name, bind)| {
        let scene_from_joint = joints.scene_from_joint(name)?;
        Some(Placement {
            file_from_mesh: scene_from_joint * matrix(bind) * shape,
            reach: scene_from_joint.w_axis.truncate().length(),
        })
    });
    Some(placements.collect())
}

/// A matrix whose rows follow each other.
fn matrix(values: &[f32]) -> DMat4 {
    let values: Option<[f32; 16]> = values.try_into().ok();
    values.map_or(DMat4::IDENTITY, |values| {
        DMat4::from_cols_array(&values.map(f64::from)).transpose()
    })
}
