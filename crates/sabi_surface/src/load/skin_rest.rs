//! Rest pose of skinned meshes: the common transform with which all joints place a mesh while its skeleton is in the pose
//! in which it was bound.

use glam::{DMat3, DMat4};

use super::warnings::Warnings;

/// Maximum relative difference between the transforms of joints in the rest pose that is explained by rounding.
const SAME: f64 = 1e-3;

/// Placement of a mesh by one joint.
pub(super) struct JointPlacement {
    pub(super) file_from_mesh: DMat4,
    /// Distance of the joint from the origin, to which the rounding error of the transform is proportional.
    pub(super) reach: f64,
}

/// Maximum number of joints and matrices of all skins of a file together.
const MOST_JOINTS: u64 = 1 << 22;
/// Reason why a skin is not read.
pub(super) const TOO_MANY_JOINTS: &str = "the skins of the file have too many joints together";

/// Number of joints and matrices that may still be read. Meshes and skins may share them, so that the size of the file does
/// not limit their number.
pub(super) struct JointBudget(u64);

impl Default for JointBudget {
    fn default() -> JointBudget {
        JointBudget(MOST_JOINTS)
    }
}

impl JointBudget {
    /// Takes joints or matrices from the budget; `None` if not enough are left.
    pub(super) fn take(&mut self, count: u64) -> Option<()> {
        self.0 = self.0.checked_sub(count)?;
        Some(())
    }
}

/// Rest pose of a skin. It is the same for all meshes that use the skin.
#[derive(Clone, Copy)]
pub(super) enum RestPose {
    /// Nothing is known about its joints.
    Unknown,
    /// All joints place the mesh with this transform.
    At(DMat4),
    /// The joints have different transforms, or scale the mesh to nothing.
    Posed,
    /// The skin has too many joints.
    TooLarge,
}

impl RestPose {
    /// Finds the rest of a skin by the placements of its joints.
    pub(super) fn of(placements: &[JointPlacement]) -> RestPose {
        let [first, others @ ..] = placements else {
            return RestPose::Unknown;
        };
        let matrix = first.file_from_mesh;
        let is_usable = matrix.is_finite() && DMat3::from_mat4(matrix).determinant() != 0.0;
        if is_usable && others.iter().all(|other| agree(first, other)) {
            RestPose::At(matrix)
        } else {
            RestPose::Posed
        }
    }

    /// Returns the transform of the mesh `name`; this is `bound` unless the skin defines another one.
    pub(super) fn file_from_bound(self, bound: DMat4, name: &str, warnings: &mut Warnings) -> DMat4 {
        match self {
            RestPose::Unknown => bound,
            RestPose::At(file_from_mesh) => {
                warnings.add(format!("The skin of `{name}` is left out: it is taken at rest."));
                file_from_mesh
            }
            RestPose::Posed => {
                warnings.add(format!(
                    "The skeleton of `{name}` stands in a pose; the mesh is taken as it was bound, without it."
                ));
                bound
            }
            RestPose::TooLarge => {
                warnings.add(format!(
                    "The skin of `{name}` cannot be read ({TOO_MANY_JOINTS}); the mesh is taken as it was bound."
                ));
                bound
            }
        }
    }
}

/// Returns true if two joints place a mesh in the same way, up to rounding.
pub(super) fn agree(a: &JointPlacement, b: &JointPlacement) -> bool {
    let [a_turns, b_turns] = [a, b].map(|placement| DMat3::from_mat4(placement.file_from_mesh));
    let size = a_turns
        .to_cols_array()
        .into_iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let apart = a.file_from_mesh.w_axis - b.file_from_mesh.w_axis;
    a_turns.abs_diff_eq(b_turns, SAME * size) && apart.length() <= SAME * (a.reach + b.reach)
}
