//! Choice of the pipelines of a picture.

use std::collections::BTreeSet;

use sabi_gpu::Gpu;

use super::{Renderer, transform};
use crate::error::ViewError;
use crate::model::Part;
use crate::pipelines::{Draws, Ground, Paint, Switches};
use crate::scene::{Background, MaterialLook, Mode, Scene, Shot};

/// Most looks in a picture: a stencil has eight bits, and 0 is none.
const MOST_LOOKS: usize = 255;

/// Pipelines that a picture needs and that are not made yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing(BTreeSet<Draws>);

impl Renderer {
    /// Returns the pipelines to make before a picture is drawn, which takes longer than a frame of a window; `None` if
    /// all exist. Includes the pipelines for pictures of one sample and of several.
    pub fn missing(&self, scene: &Scene<'_>, shot: &Shot) -> Option<Missing> {
        let missing = self.pipelines.missing(all(scene, shot));
        (!missing.is_empty()).then_some(Missing(missing))
    }

    /// Compiles missing pipelines on any thread; pictures are drawn meanwhile.
    pub fn make(&self, gpu: &Gpu, missing: &Missing) -> Result<(), ViewError> {
        for draws in &missing.0 {
            self.pipelines.get(gpu, *draws)?;
        }
        Ok(())
    }
}

fn all(scene: &Scene<'_>, shot: &Shot) -> Vec<Draws> {
    let mut all = vec![
        Draws::Shadow,
        Draws::Encode(transform(shot)),
        Draws::Gather(transform(shot)),
        Draws::EncodeSum,
    ];
    all.extend(background(shot));
    all.extend(shot.lines.iter().map(|_| Draws::Lines));
    all.extend(looks(scene).iter().map(|look| paint(look, scene, shot)));
    let parts = scene.model.parts.iter();
    all.extend(parts.filter_map(|part| Some(raster(part, look_of(part, scene)?.1, shot))));
    all
}

/// The looks of a scene, at most [`MOST_LOOKS`].
pub(super) fn looks<'s>(scene: &Scene<'s>) -> &'s [MaterialLook] {
    &scene.looks[..scene.looks.len().min(MOST_LOOKS)]
}

/// The look of a part of the model, and as which one it is told apart.
pub(super) fn look_of<'s>(part: &Part, scene: &Scene<'s>) -> Option<(usize, &'s MaterialLook)> {
    let index = *scene.look_of_material.get(part.material as usize)?;
    Some((index.min(MOST_LOOKS - 1), scene.looks.get(index)?))
}

/// Pipeline of the background.
pub(super) fn background(shot: &Shot) -> Option<Draws> {
    let is_blurred = match shot.background {
        _ if shot.mode != Mode::Material => return None,
        Background::Environment => false,
        Background::Blurred => true,
        Background::Plain(_) | Background::Clear => return None,
    };
    Some(Draws::Background { is_blurred })
}

/// The light of a look.
pub(super) fn paint(look: &MaterialLook, scene: &Scene<'_>, shot: &Shot) -> Draws {
    let paint = match shot.has_relief {
        _ if shot.mode != Mode::Material => Paint::Shown,
        true => Paint::LitRelief,
        false => Paint::Lit,
    };
    Draws::Paint(paint, Switches::of_paint(look, scene, shot))
}

/// Pipeline of the raster of a part of the model.
pub(super) fn raster(part: &Part, look: &MaterialLook, shot: &Shot) -> Draws {
    let has_relief = shot.has_relief && look.maps.height.is_some();
    let ground = match (has_relief, has_veils(look, shot.mode)) {
        (false, false) => Ground::Plain,
        (false, true) => Ground::Veiled,
        (true, false) => Ground::Relief,
        (true, true) => Ground::VeiledRelief,
    };
    Draws::Raster {
        is_double_sided: part.is_double_sided,
        ground,
        switches: Switches::of_raster(look, shot.mode, ground),
    }
}

/// Returns true if surfaces behind a look show through its clear parts: only in modes that show a whole material.
fn has_veils(look: &MaterialLook, mode: Mode) -> bool {
    !look.is_opaque && matches!(mode, Mode::Material | Mode::Clay)
}
