//! Direction in which a place is displaced: the rounded normal.
//!
//! Along a hard edge all faces share one direction, that of a miter: a step of 1 along it is a step of 1 along the normal
//! of each face. Away from the edge it turns linearly into the normal of the face, over a distance of twice the largest
//! height, so that places keep their order. A face that sinks by `d` then ends where the sunk plane of its neighbor begins,
//! and its border of width `2d` is compressed to a width of `d`.

use glam::{DMat3, DVec3};

use super::edges::HardEdges;

/// Maximum step along a rounded normal for a step of 1 along the normals of the faces: that of an edge of 120°. Longer
/// ones, at sharper edges, are shortened.
const LONGEST: f64 = 2.0;
/// Weight of the mean normal in directions that the faces do not determine.
const LEAST_WEIGHT: f64 = 1e-9;

/// Rounded normals of a mesh for heights up to a limit.
pub(super) struct NormalRounding<'e> {
    edges: &'e HardEdges,
    /// Distance from an edge at which the normal equals that of the face again.
    reach: f64,
}

impl<'e> NormalRounding<'e> {
    /// Creates rounded normals near `edges`, which must have been found for the same `reach`.
    pub(super) fn new(edges: &'e HardEdges, reach: f64) -> NormalRounding<'e> {
        NormalRounding { edges, reach }
    }

    /// Returns the rounded normal of a place where faces with these `normals` meet, whose mean is `mean`; `None` if there
    /// is no hard edge nearby, so that the mean can be used.
    pub(super) fn at(&self, place: DVec3, normals: &[DVec3], mean: DVec3) -> Option<DVec3> {
        let mut system = LeastSquares::new(mean);
        let mut is_hard = false;
        for &normal in normals {
            system.require(normal, 1.0, 1.0);
            for side in self.edges.near(place) {
                let Some((distance, beside)) = side.beside(place, normal) else {
                    continue;
                };
                let share = (1.0 - distance / self.reach) * beside * beside;
                if share > 0.0 {
                    let step = share + (1.0 - share) * normal.dot(side.other);
                    system.require(side.other, step, share * share);
                    is_hard = true;
                }
            }
        }
        if !is_hard {
            return None;
        }
        let direction = system.solved();
        let direction = direction.clamp_length_max(LONGEST);
        direction.is_finite().then_some(direction)
    }
}

/// Least squares system for a direction that makes given steps along given normals, and otherwise equals a mean direction.
struct LeastSquares {
    matrix: DMat3,
    right: DVec3,
}

impl LeastSquares {
    fn new(mean: DVec3) -> LeastSquares {
        LeastSquares {
            matrix: DMat3::from_diagonal(DVec3::splat(LEAST_WEIGHT)),
            right: mean * LEAST_WEIGHT,
        }
    }

    fn require(&mut self, normal: DVec3, step: f64, weight: f64) {
        let scaled = normal * weight;
        self.matrix += DMat3::from_cols(scaled * normal.x, scaled * normal.y, scaled * normal.z);
        self.right += scaled * step;
    }

    fn solved(&self) -> DVec3 {
        self.matrix.inverse() * self.right
    }
}
