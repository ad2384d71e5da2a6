//! Skins: the transform of a mesh in the rest pose of its skeleton.

use std::collections::HashMap;

use glam::DMat4;
use roxmltree::{Node, NodeId};

use super::document::{Document, child, children, numbers, text};
use crate::load::skin_rest::{JointBudget, Placement, Rest};
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

/// Rests of the skins of a file, each found once.
#[derive(Default)]
pub(super) struct Skins {
    /// With the transform of the mesh before the joints.
    known: HashMap<NodeId, (Rest, DMat4)>,
    joints: JointBudget,
}

impl Skins {
    /// COLLADA 1.4, 4.7: a joint transforms a vertex by its own transform times its inverse bind matrix times the bind shape matrix.
    /// At rest the transforms of all joints are equal.
    pub(super) fn scene_from_bound<'d>(
        &mut self,
        document: &Document<'d>,
        skin: Node<'d, 'd>,
        scene_from_node: DMat4,
        joints: &Joints<'d>,
        warnings: &mut Warnings,
    ) -> (Rest, DMat4) {
        let (rest, shape) = match self.known.get(&skin.id()) {
            Some(known) => *known,
            None => {
                let shape =
                    child(skin, "bind_shape_matrix").map_or(DMat4::IDENTITY, |shape| matrix(&numbers(shape, warnings)));
                // A skin that does not say enough leaves its mesh where its node stands.
                let rest = self
                    .rest(document, skin, shape, joints, warnings)
                    .unwrap_or(Rest::Unknown);
                self.known.insert(skin.id(), (rest, shape));
                (rest, shape)
            }
        };
        (rest, scene_from_node * shape)
    }

    /// The rest by all joints that the scene has; `None` where the skin does not say enough.
    fn rest<'d>(
        &mut self,
        document: &Document<'d>,
        skin: Node<'d, 'd>,
        shape: DMat4,
        joints: &Joints<'d>,
        warnings: &mut Warnings,
    ) -> Option<Rest> {
        let list = child(skin, "joints")?;
        let source = |semantic: &str| {
            let input = children(list, "input").find(|input| input.attribute("semantic") == Some(semantic))?;
            document.referenced(input, "source")
        };
        let names = source("JOINT")?;
        let names = child(names, "Name_array").or_else(|| child(names, "IDREF_array"))?;
        let binds = child(source("INV_BIND_MATRIX")?, "float_array")?;
        // Skins may share them: names of a letter each, and matrices of sixteen digits, each with a space.
        let most = text(names).len() / 2 + text(binds).len() / 32;
        if self.joints.take(most as u64).is_none() {
            return Some(Rest::TooLarge);
        }
        let binds = numbers(binds, warnings);
        let bound = text(names).split_ascii_whitespace().zip(binds.as_chunks::<16>().0);
        let placements = bound.filter_map(|(name, bind)| {
            let scene_from_joint = joints.scene_from_joint(name)?;
            Some(Placement {
                file_from_mesh: scene_from_joint * matrix(bind) * shape,
                reach: scene_from_joint.w_axis.truncate().length(),
            })
        });
        Some(Rest::of(&placements.collect::<Vec<Placement>>()))
    }
}

/// A matrix whose rows follow each other.
fn matrix(values: &[f64]) -> DMat4 {
    let values: Option<[f64; 16]> = values.try_into().ok();
    values.map_or(DMat4::IDENTITY, |values| DMat4::from_cols_array(&values).transpose())
}
