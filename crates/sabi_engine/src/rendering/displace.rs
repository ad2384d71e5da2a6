//! Displacement of a model by the heights of its looks.

use sabi_gpu::{AdapterKind, read_numbers};
use sabi_surface::atlas::Atlas;
use sabi_surface::displace::{DisplaceOptions, HeightPlane, displaced, texel_length};
use sabi_view::{MaterialLook, ViewModel};

use crate::error::EngineError;
use crate::evaluating::evaluator::Evaluator;
use crate::evaluating::looks::ModelLooks;

/// Triangle limit of a displaced copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriangleLimit {
    /// Limit that suits the adapter: 2 million, or 500 000 for a software driver.
    Fitting,
    /// Given limit.
    AtMost(usize),
}

impl TriangleLimit {
    fn budget(self, kind: AdapterKind) -> usize {
        match (self, kind) {
            (TriangleLimit::AtMost(count), _) => count,
            (TriangleLimit::Fitting, AdapterKind::Cpu) => 500_000,
            (TriangleLimit::Fitting, _) => DisplaceOptions::default().triangle_budget,
        }
    }
}

/// Creates a finer copy of the model, displaced by the heights of each material's look.
pub(crate) fn displaced_model(
    evaluator: &mut Evaluator,
    shown: &ModelLooks,
    triangles: TriangleLimit,
) -> Result<ViewModel, EngineError> {
    let linked = evaluator.linked().clone();
    let (model, atlas) = (&linked.model, &linked.atlas);
    let model_from_working = evaluator.model().model_from_working();
    let of_looks = shown.looks.iter();
    let heights: Vec<Option<Vec<f32>>> = of_looks
        .map(|look| heights_of(evaluator, look, model_from_working))
        .collect::<Result<_, _>>()?;
    let options = DisplaceOptions {
        // A map has no detail that is narrower than two texels.
        edge_length: 2.0 * texel_length(&model.mesh, atlas),
        triangle_budget: triangles.budget(evaluator.gpu().summary().kind),
    };
    let height = |chart: u32, texel: [f32; 2]| match plane_of(chart, atlas, shown, &heights) {
        Some(plane) => plane.at(chart, texel),
        // Without a height the surface is not moved, and its neighbors connect to it.
        None => Some(0.0),
    };
    let copy = displaced(&model.mesh, atlas, &options, height);
    let made = ViewModel::displaced(evaluator.gpu(), &copy, evaluator.view_parts())?;
    let flat = heights.iter().all(Option::is_none).then(|| {
        "displacing the model has no effect: the shown result has no height; show the material of a graph whose layers \
         have one"
            .to_owned()
    });
    evaluator.warn(flat.or(copy.note));
    Ok(made)
}

/// Returns the heights of a chart's material, if its look has any.
fn plane_of<'h>(
    chart: u32,
    atlas: &'h Atlas,
    shown: &ModelLooks,
    heights: &'h [Option<Vec<f32>>],
) -> Option<HeightPlane<'h>> {
    let material = atlas.charts.get(chart as usize)?.material;
    let look = *shown.look_of_material.get(material as usize)?;
    let heights = heights.get(look)?.as_ref()?;
    Some(HeightPlane::new(atlas, heights))
}

/// Reads back the heights of a look in model units, page by page and row by row; empty without heights.
fn heights_of(
    evaluator: &Evaluator,
    look: &MaterialLook,
    model_from_working: f64,
) -> Result<Option<Vec<f32>>, EngineError> {
    let Some(map) = &look.maps.height else {
        return Ok(None);
    };
    let mut heights = read_numbers(evaluator.gpu(), map)?;
    for height in &mut heights {
        *height = (f64::from(*height) * model_from_working) as f32;
    }
    Ok(Some(heights))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_software_driver_is_given_fewer_triangles_unless_the_artist_says_how_many() {
        assert_eq!(TriangleLimit::Fitting.budget(AdapterKind::Discrete), 2_000_000);
        assert_eq!(TriangleLimit::Fitting.budget(AdapterKind::Integrated), 2_000_000);
        assert_eq!(TriangleLimit::Fitting.budget(AdapterKind::Cpu), 500_000);
        assert_eq!(TriangleLimit::AtMost(7).budget(AdapterKind::Cpu), 7);
    }
}
