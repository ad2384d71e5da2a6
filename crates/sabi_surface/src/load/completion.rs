//! Completion of triangles that were read: invalid attributes are repaired, and missing ones are computed.

use sabi_cancel::look;
use std::collections::BTreeSet;

use super::blur::warn_of_storage;
use super::normals::{self, NormalMethod};
use super::submesh::Submesh;
use super::tangents;
use super::warnings::{TRIANGLES, VERTICES, Warnings, counted};

/// Rules of completion, the same for all triangles of a file.
pub(super) struct Completion {
    /// How to compute normals that the file does not have.
    pub(super) missing: NormalMethod,
    /// Clause about vertices with a repaired normal, for a file with normals.
    pub(super) repaired_normals: &'static str,
    /// [`super::LoadOptions::smooth_degrees`].
    pub(super) smooth_degrees: Option<f32>,
}

/// Clause of [`Completion::repaired_normals`] for formats whose vertices may lack a normal.
pub(super) const LACKING_NORMALS: &str = "had no normal, or one without a direction; these were computed";

impl Completion {
    /// Repairs invalid attributes and computes missing ones. `who` names the triangles in warnings; `framed` are the UV sets of
    /// normal maps besides the chosen one. Returns what [`tangents::complete`] returns for the chosen set.
    pub(super) fn complete(
        &self,
        submesh: &mut Submesh,
        framed: &BTreeSet<u32>,
        who: &str,
        warnings: &mut Warnings,
    ) -> bool {
        look();
        warn_of_storage(submesh.blurred_by_file, who, warnings);
        let dropped = submesh.drop_broken();
        if dropped > 0 {
            warnings.add(format!(
                "{} of {who} had positions that are no numbers and had to be left out.",
                counted(dropped, TRIANGLES)
            ));
        }
        let repaired = submesh.repair_attributes();
        if repaired > 0 {
            warnings.add(format!(
                "{} of {who} had texture coordinates or colors that are no numbers; these were replaced.",
                counted(repaired, VERTICES)
            ));
        }
        if let Some(degrees) = self.smooth_degrees {
            normals::replace(submesh, degrees);
        }
        let had_normals = !submesh.normals.is_empty();
        let missing = if had_normals {
            NormalMethod::Crease
        } else {
            self.missing
        };
        let made = normals::complete(submesh, missing);
        if had_normals && made > 0 {
            warnings.add(format!(
                "{} of {who} {}.",
                counted(made, VERTICES),
                self.repaired_normals
            ));
        }
        look();
        let has_own_tangents = tangents::complete(submesh, who, warnings);
        for index in 0..submesh.texture_uvs.len() {
            if framed.contains(&submesh.texture_uvs[index].set) {
                submesh.swap_set(index);
                tangents::complete(submesh, who, warnings);
                submesh.swap_set(index);
            }
        }
        has_own_tangents
    }
}
