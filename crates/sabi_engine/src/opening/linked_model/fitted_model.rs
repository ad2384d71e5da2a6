//! Model with a fit, which provides lengths in working units.

use sabi_gpu::SurfaceTables;
use sabi_graph::Fit;
use sabi_surface::atlas::Atlas;

use super::LinkedModel;

/// Model with a fit. The fit defines which length of the model is one working unit.
#[derive(Clone, Copy)]
pub struct FittedModel<'m> {
    linked: &'m LinkedModel,
    fit: Fit,
}

impl<'m> FittedModel<'m> {
    pub(super) fn new(linked: &'m LinkedModel, fit: Fit) -> FittedModel<'m> {
        FittedModel { linked, fit }
    }

    /// The model itself.
    pub fn linked(&self) -> &'m LinkedModel {
        self.linked
    }

    /// Factor from model units to working units.
    pub fn working_from_model(&self) -> f64 {
        match self.fit {
            // A single unit is used for all pieces; nodes multiply by the size of each piece.
            Fit::Unit | Fit::Piece => 1.0 / self.linked.largest_side,
            Fit::Metres => 1.0,
            Fit::Length(length) => 1.0 / length,
        }
    }

    /// Factor from working units to model units.
    pub fn model_from_working(&self) -> f64 {
        1.0 / self.working_from_model()
    }

    /// Factor from working units to the units of the model's file, in which heights are exported.
    pub fn file_from_working(&self) -> f64 {
        1.0 / (self.working_from_model() * self.linked.scale)
    }

    /// Returns the factor from lengths of another fit to working units. For shares of pieces, the mean size of pieces is used.
    pub(crate) fn working_from(&self, other: Fit) -> f64 {
        if other == Fit::Piece {
            return self.linked.pieces.mean_size * self.working_from_model();
        }
        self.working_from_model() / self.linked.fitted(other).working_from_model()
    }

    /// Returns the size of the largest piece in working units.
    pub(crate) fn largest_piece(&self) -> f64 {
        let sizes = self.linked.pieces.boxes.iter().map(|piece| piece.typical_size());
        f64::from(sizes.fold(0.0_f32, f32::max)) * self.working_from_model()
    }

    /// Returns the width of the finest texels in working units.
    pub(crate) fn finest_texel(&self) -> f64 {
        self.linked.finest_texel() * self.working_from_model()
    }

    /// Returns the area of the surface in square working units.
    pub(crate) fn area(&self) -> f64 {
        self.linked.area() * self.working_from_model().powi(2)
    }

    /// Returns the largest coordinate in working units.
    pub(crate) fn farthest(&self) -> f64 {
        self.linked.farthest * self.working_from_model()
    }

    /// Computes the tables that kernels read, in working units.
    pub fn tables(&self, seed: u32) -> SurfaceTables {
        self.tables_of(&self.linked.atlas, seed)
    }

    /// Computes the tables of another level of the atlas.
    pub(crate) fn tables_of(&self, atlas: &Atlas, seed: u32) -> SurfaceTables {
        let LinkedModel { model, pieces, .. } = self.linked;
        SurfaceTables::new(&model.mesh, pieces, atlas, self.working_from_model(), seed)
    }

    /// Returns the lowest and the highest `dot(vertex, direction)` in working units.
    pub(crate) fn extent(&self, direction: [f32; 3]) -> [f32; 2] {
        let scale = self.working_from_model();
        let mesh = &self.linked.model.mesh;
        let along = |position: &[f32; 3]| {
            let dot: f64 = position
                .iter()
                .zip(direction)
                .map(|(x, d)| f64::from(*x) * f64::from(d))
                .sum();
            (dot * scale) as f32
        };
        let start = [f32::INFINITY, f32::NEG_INFINITY];
        let used = mesh.triangles.iter().flatten();
        let positions = used.filter_map(|vertex| mesh.positions.get(*vertex as usize));
        let [low, high] = positions
            .map(along)
            .fold(start, |[low, high], x| [low.min(x), high.max(x)]);
        if low <= high { [low, high] } else { [0.0, 1.0] }
    }
}
