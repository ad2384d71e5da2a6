//! Choice of the pipelines of a picture.

use std::collections::BTreeSet;

use sabi_gpu::Gpu;

use super::{Renderer, development};
use crate::error::ViewError;
use crate::model::MaterialRange;
use crate::pipelines::{Backdrop, BackgroundKey, BloomStep, PipelineKey, RasterVariant, Shading, Switches};
use crate::scene::{Background, MaterialLook, Mode, Scene, Shot};

/// Maximum number of looks in a picture: a stencil has eight bits, and 0 means no look.
const MOST_LOOKS: usize = 255;

/// Pipelines that a picture needs and that have not been created yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingPipelines(BTreeSet<PipelineKey>);

impl Renderer {
    /// Returns the pipelines that have to be created before a picture can be drawn; `None` if all exist. Creating them
    /// takes longer than a frame of a window. Includes the pipelines for pictures of one sample and of several.
    pub fn missing(&self, scene: &Scene<'_>, shot: &Shot) -> Option<MissingPipelines> {
        let missing = self.pipelines.missing(needed(scene, shot));
        (!missing.is_empty()).then_some(MissingPipelines(missing))
    }

    /// Compiles missing pipelines. May be called on any thread while pictures are drawn.
    pub fn make(&self, gpu: &Gpu, missing: &MissingPipelines) -> Result<(), ViewError> {
        for key in &missing.0 {
            self.pipelines.get(gpu, *key)?;
        }
        Ok(())
    }
}

/// Pipelines of a picture.
fn needed(scene: &Scene<'_>, shot: &Shot) -> Vec<PipelineKey> {
    let mut needed = vec![
        PipelineKey::Shadow(None),
        PipelineKey::Encode(development(shot)),
        PipelineKey::EncodeModel(development(shot)),
        PipelineKey::Accumulate(development(shot)),
        PipelineKey::EncodeMean,
    ];
    if shot.has_bloom() {
        needed.extend(BloomStep::ALL.map(PipelineKey::Bloom));
    }
    needed.extend(background(scene, shot));
    needed.extend(shot.lines.iter().map(|_| PipelineKey::Lines));
    needed.extend(looks(scene).iter().map(|look| shading(look, scene, shot)));
    let ranges = scene.model.ranges.iter();
    for (range, (_, look)) in ranges.filter_map(|range| Some((range, look_of(range, scene)?))) {
        needed.push(raster(range, look, shot));
        needed.extend(veiled_shadow(look, shot));
    }
    needed
}

/// Returns the looks of a scene, up to [`MOST_LOOKS`].
pub(super) fn looks<'s>(scene: &Scene<'s>) -> &'s [MaterialLook] {
    &scene.looks[..scene.looks.len().min(MOST_LOOKS)]
}

/// Returns number and look of a range of triangles. Looks beyond the highest number share that number.
pub(super) fn look_of<'s>(range: &MaterialRange, scene: &Scene<'s>) -> Option<(usize, &'s MaterialLook)> {
    let index = *scene.look_of_material.get(range.material as usize)?;
    Some((index.min(MOST_LOOKS - 1), scene.looks.get(index)?))
}

/// Pipeline of the background.
pub(super) fn background(scene: &Scene<'_>, shot: &Shot) -> Option<PipelineKey> {
    let has_ground = scene.ground(shot).is_some();
    let backdrop = match shot.background {
        _ if shot.mode != Mode::Material => return None,
        Background::Environment => Backdrop::ENVIRONMENT,
        Background::Blurred => Backdrop::BLURRED,
        Background::Studio => Backdrop::STUDIO,
        Background::Plain(_) | Background::Clear if has_ground => Backdrop::NOTHING,
        Background::Plain(_) | Background::Clear => return None,
    };
    Some(PipelineKey::Background(BackgroundKey {
        backdrop,
        has_ground,
        switches: match has_ground {
            true => Switches::lights_of(scene, shot),
            false => Switches::default(),
        },
    }))
}

/// Pipeline that shades a look.
pub(super) fn shading(look: &MaterialLook, scene: &Scene<'_>, shot: &Shot) -> PipelineKey {
    let shading = match shot.has_relief {
        _ if shot.mode != Mode::Material => Shading::Unlit,
        true => Shading::LitRelief,
        false => Shading::Lit,
    };
    PipelineKey::Shade(shading, Switches::of_shading(look, scene, shot))
}

/// Pipeline that rasters a range of triangles.
pub(super) fn raster(range: &MaterialRange, look: &MaterialLook, shot: &Shot) -> PipelineKey {
    let has_relief = shot.has_relief && look.maps.height.is_some();
    let variant = match (has_relief, shows_transparency(look, shot.mode)) {
        (false, false) => RasterVariant::Opaque,
        (false, true) => RasterVariant::Transparent,
        (true, false) => RasterVariant::Relief,
        (true, true) => RasterVariant::TransparentRelief,
    };
    PipelineKey::Raster {
        is_double_sided: range.is_double_sided,
        variant,
        switches: Switches::of_raster(look, shot.mode, variant),
    }
}

/// Returns the pipeline for the shadow of a look with transparent places; `None` if the look casts a shadow everywhere.
pub(super) fn veiled_shadow(look: &MaterialLook, shot: &Shot) -> Option<PipelineKey> {
    let switches = || Switches::of_raster(look, shot.mode, RasterVariant::Transparent);
    shows_transparency(look, shot.mode).then(|| PipelineKey::Shadow(Some(switches())))
}

/// Returns true if surfaces behind a look are visible through its transparent places. This is so only in modes that show a whole material.
fn shows_transparency(look: &MaterialLook, mode: Mode) -> bool {
    !look.is_opaque && matches!(mode, Mode::Material | Mode::Clay)
}
