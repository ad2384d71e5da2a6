//! Skins: the transform of a mesh in the rest pose of its skeleton.

use std::collections::BTreeMap;

use glam::{DMat3, DMat4, DVec4};
use serde_json::Value;

use super::source::GltfSource;
use super::storage::AccessorSemantic;
use crate::load::skin_rest::{JointBudget, JointPlacement, TOO_MANY_JOINTS, agree};
use crate::load::warnings::Warnings;

/// Rest poses of the skins of a file, each computed once.
pub(super) struct GltfSkins<'s> {
    source: &'s GltfSource<'s>,
    file_from_node: &'s [Option<DMat4>],
    known: BTreeMap<usize, Result<GltfRestPose, String>>,
    joints: JointBudget,
}

/// Rest pose of a skin.
#[derive(Clone, Copy)]
struct GltfRestPose {
    file_from_mesh: DMat4,
    /// False if its joints have different transforms.
    is_at_rest: bool,
}

impl<'s> GltfSkins<'s> {
    pub(super) fn new(source: &'s GltfSource<'s>, file_from_node: &'s [Option<DMat4>]) -> GltfSkins<'s> {
        GltfSkins {
            source,
            file_from_node,
            known: BTreeMap::new(),
            joints: JointBudget::default(),
        }
    }

    /// Returns the transform of the mesh instance `name` in the bind pose of a skin.
    pub(super) fn file_from_bound(&mut self, skin: usize, name: &str, warnings: &mut Warnings) -> DMat4 {
        let found = match self.known.get(&skin) {
            Some(known) => known.clone(),
            None => {
                let found = self.rest(skin, warnings);
                self.known.insert(skin, found.clone());
                found
            }
        };
        match found {
            Err(reason) => {
                warnings.add(format!(
                    "The skin of `{name}` cannot be read ({reason}); the mesh is taken as it is stored."
                ));
                DMat4::IDENTITY
            }
            Ok(rest) => {
                warnings.add(match rest.is_at_rest {
                    true => format!("The skin of `{name}` is left out: it is taken at rest."),
                    false => format!(
                        "The skeleton of `{name}` stands in a pose; the mesh is taken as it was bound, without it."
                    ),
                });
                rest.file_from_mesh
            }
        }
    }

    fn rest(&mut self, skin: usize, warnings: &mut Warnings) -> Result<GltfRestPose, String> {
        let claimed = claimed(self.source, skin);
        self.joints.take(claimed).ok_or(TOO_MANY_JOINTS)?;
        let placements = placements(self.source, skin, self.file_from_node, warnings)?;
        Ok(match placements.as_slice() {
            [] => GltfRestPose {
                file_from_mesh: DMat4::IDENTITY,
                is_at_rest: true,
            },
            [first, others @ ..] => GltfRestPose {
                file_from_mesh: first.file_from_mesh,
                is_at_rest: others.iter().all(|other| agree(first, other)),
            },
        })
    }
}

/// Returns the number of joints and matrices that a skin declares. Skins may share matrices, which are read again for each skin.
fn claimed(source: &GltfSource, index: usize) -> u64 {
    let Some(skin) = source.document.skins.get(index) else {
        return 0;
    };
    let joints = skin.get("joints").and_then(Value::as_array).map_or(0, Vec::len) as u64;
    let accessor = skin.get("inverseBindMatrices").and_then(Value::as_u64);
    let accessor = accessor.and_then(|accessor| source.document.accessors.get(usize::try_from(accessor).ok()?));
    joints.saturating_add(accessor.map_or(0, |accessor| accessor.count.0))
}

/// Returns the placements by the joints. A joint transforms its mesh by its global transform times its inverse bind matrix
/// (glTF 2.0, 3.7.3). In the rest pose these transforms are equal for all joints. The node of the mesh is ignored.
fn placements(
    source: &GltfSource,
    index: usize,
    file_from_node: &[Option<DMat4>],
    warnings: &mut Warnings,
) -> Result<Vec<JointPlacement>, String> {
    let skin = source
        .document
        .skins
        .get(index)
        .ok_or(format!("there is no skins[{index}]"))?;
    let joints = skin
        .get("joints")
        .and_then(Value::as_array)
        .map_or(&[][..], Vec::as_slice);
    if joints.is_empty() {
        return Err("it has no joints".into());
    }
    let matrices = match skin.get("inverseBindMatrices") {
        None => vec![DMat4::IDENTITY.to_cols_array().map(|x| x as f32); joints.len()],
        Some(accessor) => {
            let accessor = accessor.as_u64().and_then(|accessor| usize::try_from(accessor).ok());
            let accessor = accessor.ok_or("its inverse bind matrices are nowhere")?;
            let read = source.floats::<16>(accessor, AccessorSemantic::Matrix, "inverse bind matrices", warnings);
            read.map_err(|fault| fault.to_string())?
        }
    };
    if matrices.len() < joints.len() {
        return Err(format!(
            "it has {} joints and {} matrices",
            joints.len(),
            matrices.len()
        ));
    }
    joints
        .iter()
        .zip(matrices)
        .map(|(joint, matrix)| {
            let placed = joint
                .as_u64()
                .and_then(|joint| *file_from_node.get(usize::try_from(joint).ok()?)?);
            let file_from_joint = placed.ok_or(format!("its joint {joint} is not in the scene"))?;
            let mut joint_from_mesh = DMat4::from_cols_array(&matrix.map(f64::from)).transpose();
            // The last row of an affine matrix is 0, 0, 0, 1, whatever the file stores.
            joint_from_mesh.w_axis = DVec4::W;
            let joint_from_mesh = joint_from_mesh.transpose();
            let file_from_mesh = file_from_joint * joint_from_mesh;
            if !file_from_mesh.is_finite() || DMat3::from_mat4(file_from_mesh).determinant() == 0.0 {
                return Err(format!("its joint {joint} leaves nothing of it"));
            }
            let reach = file_from_joint.w_axis.truncate().length();
            Ok(JointPlacement { file_from_mesh, reach })
        })
        .collect()
}
