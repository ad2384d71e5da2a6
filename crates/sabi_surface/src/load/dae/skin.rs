//! Skins: the transform of a mesh in the rest pose of its skeleton.

use std::collections::HashMap;

use glam::DMat4;
use roxmltree::{Node, NodeId};

use super::document::{DaeDocument, child, children, numbers, text};
use crate::load::skin_rest::{JointBudget, JointPlacement, RestPose};
use crate::load::warnings::Warnings;

/// Transforms of nodes by their ids, and by the names with which skins refer to joints. If several nodes share a name, the first is used.
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

/// Rest poses of the skins of a file, each computed once.
#[derive(Default)]
pub(super) struct DaeSkins {
    /// Rest poses with the transform of the mesh that applies before the joints.
    known: HashMap<NodeId, (RestPose, DMat4)>,
    joints: JointBudget,
}

impl DaeSkins {
    /// Returns the transform of a skinned mesh. A joint transforms a vertex by its own transform times its inverse bind
    /// matrix times the bind shape matrix (COLLADA 1.4, 4.7). In the rest pose these transforms are equal for all joints.
    pub(super) fn scene_from_bound<'d>(
        &mut self,
        document: &DaeDocument<'d>,
        skin: Node<'d, 'd>,
        scene_from_node: DMat4,
        joints: &Joints<'d>,
        warnings: &mut Warnings,
    ) -> (RestPose, DMat4) {
        let (rest, shape) = match self.known.get(&skin.id()) {
            Some(known) => *known,
            None => {
                let shape =
                    child(skin, "bind_shape_matrix").map_or(DMat4::IDENTITY, |shape| matrix(&numbers(shape, warnings)));
                // If a skin is incomplete, its mesh gets the transform of its node.
                let rest = self
                    .rest(document, skin, shape, joints, warnings)
                    .unwrap_or(RestPose::Unknown);
                self.known.insert(skin.id(), (rest, shape));
                (rest, shape)
            }
        };
        (rest, scene_from_node * shape)
    }

    /// Returns the rest pose according to all joints that exist in the scene; `None` if the skin is incomplete.
    fn rest<'d>(
        &mut self,
        document: &DaeDocument<'d>,
        skin: Node<'d, 'd>,
        shape: DMat4,
        joints: &Joints<'d>,
        warnings: &mut Warnings,
    ) -> Option<RestPose> {
        let list = child(skin, "joints")?;
        let source = |semantic: &str| {
            let input = children(list, "input").find(|input| input.attribute("semantic") == Some(semantic))?;
            document.referenced(input, "source")
        };
        let names = source("JOINT")?;
        let names = child(names, "Name_array").or_else(|| child(names, "IDREF_array"))?;
        let binds = child(source("INV_BIND_MATRIX")?, "float_array")?;
        // Skins may share these lists. A name takes at least a letter and a space, and a matrix sixteen digits with a space each.
        // Their whole elements are counted, which does not take looking at their texts again for each skin.
        let most = names.range().len() / 2 + binds.range().len() / 32;
        if self.joints.take(most as u64).is_none() {
            return Some(RestPose::TooLarge);
        }
        let binds = numbers(binds, warnings);
        let names = text(names);
        let bound = names.split_ascii_whitespace().zip(binds.as_chunks::<16>().0);
        let placements = bound.filter_map(|(name, bind)| {
            let scene_from_joint = joints.scene_from_joint(name)?;
            Some(JointPlacement {
                file_from_mesh: scene_from_joint * matrix(bind) * shape,
                reach: scene_from_joint.w_axis.truncate().length(),
            })
        });
        Some(RestPose::of(&placements.collect::<Vec<JointPlacement>>()))
    }
}

/// Returns a matrix from its rows.
fn matrix(values: &[f64]) -> DMat4 {
    let values: Option<[f64; 16]> = values.try_into().ok();
    values.map_or(DMat4::IDENTITY, |values| DMat4::from_cols_array(&values).transpose())
}
